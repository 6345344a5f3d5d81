// SPDX-License-Identifier: Apache-2.0
#include "help_groups.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace kage::cli {
namespace {

struct HelpGroup {
  std::string_view name;
  std::initializer_list<std::string_view> options;
};

constexpr std::string_view kRest = "Options";

const HelpGroup kGroups[] = {
    {"Input", {"--allow-outside", "--module", "--sound-only", "--pixel", "--port", "--baud", "--exclude", "--part"}},
    {"Picture",
     {"--size", "--frames", "--frame", "--order", "--alpha", "--cull", "--max-fragments", "--samples", "--seeds",
      "--classes", "--max-shading", "--sub-bits", "--level"}},
    {"Core",
     {"--config", "--degrade", "--units-only", "--all-spans", "--through-words", "--front-end", "--netlist", "--fault",
      "--mutant", "--plan", "--axes", "--grid"}},
    {"Limits",
     {"--max-z", "--max-color", "--max-wrong", "--guarantee", "--prefer", "--clock", "--device", "--fps",
      "--total-lines"}},
    {"Comparison",
     {"--stages", "--no-divergence", "--no-shrink", "--rtl", "--check", "--compare", "--no-rtl", "--lsb", "--abs",
      "--ulp", "--max-pixels", "--max-percent", "--region", "--mask", "--ignore-alpha", "--perceptual"}},
    {"Run", {"--seed",       "--idle",    "--backpressure", "--threads",        "--jobs",
             "--shard",      "--minutes", "--rounds",       "--cache-verdicts", "--no-cache-verdicts",
             "--max-memory", "--timeout", "--loop",         "--leave",          "--estimate",
             "--anew",       "--eyes",    "--repeats",      "--budget",         "--cover",
             "--sizes",      "--no-area", "--no-cosim",     "--no-flip",        "--place",
             "--store",      "--resume",  "--take",         "--list",           "--older-than",
             "--max-size"}},
    {"Output", {"--out",    "--json",   "--junit", "--annotate",  "--no-report", "--coverage", "--changes",
                "--tokens", "--clocks", "--exr",   "--error-map", "--csv",       "--blink",    "--save",
                "--plot",   "--bless",  "--prune", "--dry-run",   "--man",       "--bash",     "--zsh"}},
};

}  // namespace

std::string help_group(const std::string& option) {
  for (const HelpGroup& group : kGroups)
    if (std::find(group.options.begin(), group.options.end(), option) != group.options.end())
      return std::string(group.name);
  return std::string(kRest);
}

const std::vector<std::string>& help_groups() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const HelpGroup& group : kGroups) all.emplace_back(group.name);
    all.emplace_back(kRest);
    return all;
  }();
  return names;
}

}  // namespace kage::cli
