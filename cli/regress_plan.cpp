// SPDX-License-Identifier: Apache-2.0
#include "regress_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>

#include "kage/error.hpp"
#include "kage/scene.hpp"
#include "options.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::cli {
namespace {

/// Percent of clocks without input, and without output taken.
struct StallPattern {
  int idle;
  int backpressure;
};
constexpr std::array kStalls{StallPattern{0, 0}, StallPattern{30, 30}, StallPattern{0, 70}, StallPattern{60, 0}};

/// How many of them a run has. Those of the first round are few: most defects show in the first frames of some
/// configuration, so every configuration has its first frames before any has many.
constexpr int kFirstFrames = 20;
constexpr int kFrames = 60;

/// Sources by the order of their runs, as indices of verif::kRandomSources: random, random:mixed, random:damaged. Of
/// all orders this one finds a mutant in the least time on average: tools/regress-mutants --each prints that time for
/// each.
constexpr std::array<std::size_t, 3> kSourcesInOrder{0, 2, 1};
static_assert(kSourcesInOrder.size() == verif::kRandomSources.size());

/// Width of a scene's frames where the configuration has it. Small, but pixel centres are where `depths` wants them.
constexpr int kSceneWidth = 160;

/// A configuration in a run's name, which is a folder's too, and stands in lines of text: a file without its folders
/// and ending, and with what could be read as anything but a name replaced.
std::string short_name(const NamedConfig& c) {
  std::string name = std::filesystem::path(c.name).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '_') letter = '_';
  return name;
}

class Round {
 public:
  Round(int round, std::uint64_t seed, const std::vector<std::string>& more)
      : round_(round), seed_(seed), more_(more) {}

  void random(const NamedConfig& c, std::size_t source) {
    const std::string input = verif::kRandomSources[source].name;
    const std::string name = input.substr(input.find(':') + 1);
    add(fmt::format("{}.{}.{}", name, short_name(c), round_), c, source,
        {input, "--frames", std::to_string(round_ == 0 ? kFirstFrames : kFrames)});
  }

  void scene(const NamedConfig& c, const std::string& scene) {
    const int width = std::min(kSceneWidth, c.config.max_width);
    // Scenes and patterns of stalls would come round together: 4 divides 12.
    const std::size_t turn = static_cast<std::size_t>(round_) / builtin_scenes().size();
    add(fmt::format("{}.{}.{}", scene, short_name(c), round_), c, turn,
        {scene, "--size", fmt::format("{}x{}", width, std::max(1, width * 3 / 4)), "--degrade"});
  }

  std::vector<PlannedRun> runs;

 private:
  void add(std::string name, const NamedConfig& c, std::size_t shift, std::vector<std::string> arguments) {
    const StallPattern& stalls = kStalls[(static_cast<std::size_t>(round_) + shift) % kStalls.size()];
    const auto option = [&](const char* flag, const std::string& value) {
      arguments.insert(arguments.end(), {flag, value});
    };
    option("--config", c.name);
    option("--seed", std::to_string(seed_ + static_cast<std::uint64_t>(round_)));
    option("--jobs", "1");  // as the regression runs it: one core gets all frames, so a history of them shows
    if (stalls.idle != 0) option("--idle", std::to_string(stalls.idle));
    if (stalls.backpressure != 0) option("--backpressure", std::to_string(stalls.backpressure));
    if (c.config.active > 0 && std::find(more_.begin(), more_.end(), kFrontEnd) == more_.end())
      option(kFrontEnd, front_end_of(Level::polygons));
    arguments.insert(arguments.end(), more_.begin(), more_.end());
    runs.push_back({std::move(name), c.name, round_, std::move(arguments)});
  }

  int round_;
  std::uint64_t seed_;
  const std::vector<std::string>& more_;
};

}  // namespace

std::vector<PlannedRun> plan_round(const std::vector<NamedConfig>& configs, int round, std::uint64_t seed,
                                   const std::vector<std::string>& more) {
  std::set<std::string> names;
  for (const NamedConfig& c : configs)
    if (!names.insert(short_name(c)).second)
      throw Error(fmt::format("--config: two configurations are called {}", short_name(c)));
  Round r(round, seed, more);
  for (const std::size_t source : kSourcesInOrder)
    for (const NamedConfig& c : configs) r.random(c, source);
  const std::vector<std::string>& scenes = builtin_scenes();
  for (std::size_t i = 0; i < configs.size(); ++i)
    r.scene(configs[i], scenes[(static_cast<std::size_t>(round) + i) % scenes.size()]);
  return std::move(r.runs);
}

}  // namespace kage::cli
