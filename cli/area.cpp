// SPDX-License-Identifier: Apache-2.0
// kage area CONFIG...: what a core takes of an FPGA, counted by yosys and estimated.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command.hpp"
#include "cost/cells.hpp"
#include "explore/synthesis.hpp"
#include "kage/config.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"

namespace kage::cli {
namespace {

struct AreaCommand : Options {
  std::vector<std::string> configs;
  bool estimate = false;
  bool anew = false;
};

Json counted_json(const std::optional<explore::Synthesis>& done) {
  if (!done) return nullptr;
  return {{"luts", done->cells.luts}, {"flip_flops", done->cells.flip_flops},
          {"rams", done->cells.rams}, {"dsps", done->cells.dsps},
          {"yosys", done->yosys},     {"seconds", done->seconds}};
}

/// The terms whose weighted sum is the estimate; tools/area fits the weights.
Json terms_json(const Config& config, std::span<const CellTerm> terms) {
  Json j = Json::object();
  for (const CellTerm& t : terms) j[std::string(t.name)] = t.value(config);
  return j;
}

double off(double estimated, int counted) { return 100 * (estimated / counted - 1); }

int run(const AreaCommand& o) {
  reads_files(o.configs);
  check_json(o, o.json);
  std::vector<NamedConfig> list;
  if (o.configs.empty()) list = named_configs();
  for (const std::string& name : o.configs) list.push_back(load_config(name));
  Progress progress;
  Json j = Json::array();
  for (const NamedConfig& named : list) {
    check_interrupt();
    const Cells cells = estimated_cells(named.config);
    std::optional<explore::Synthesis> done;
    if (!o.estimate) {
      progress.show(named.name + ": yosys counts its cells");
      done = explore::synthesize(named.config, check_interrupt, o.anew);
      progress.clear();
    }
    if (!json_only(o.json)) {
      const std::string exact = fmt::format("{} bits of RAM, {} bits a pixel", cells.ram_bits, cells.bits_per_pixel);
      if (done)
        fmt::print("{}: {} LUTs (estimated {:+.0f} %), {} flip-flops ({:+.0f} %), {} block RAMs, {} multipliers; {}\n",
                   named.name, done->cells.luts, off(cells.luts, done->cells.luts), done->cells.flip_flops,
                   off(cells.flip_flops, done->cells.flip_flops), done->cells.rams, done->cells.dsps, exact);
      else
        fmt::print("{}: some {:.0f} LUTs and {:.0f} flip-flops, estimated; {}\n", named.name, cells.luts,
                   cells.flip_flops, exact);
    }
    j.push_back({{"name", named.name},
                 {"counted", counted_json(done)},
                 {"estimated", {{"luts", cells.luts}, {"flip_flops", cells.flip_flops}}},
                 {"ram_bits", cells.ram_bits},
                 {"bits_per_pixel", cells.bits_per_pixel},
                 {"terms", terms_json(named.config, kCellTermInfo)},
                 {"front_end_terms", named.config.active > 0 ? terms_json(named.config, kFrontEndTermInfo) : nullptr},
                 {"linear_terms", named.config.linear_bits > 0 ? terms_json(named.config, kLinearTermInfo) : nullptr},
                 {"config", cli::to_json(named.config)}});
  }
  write_json(o.json, {"kage.area/1", j});
  return kSame;
}

}  // namespace

void add_area(Program& program, Action& action) {
  Command c =
      program.add("area", "Count what configurations take of an FPGA",
                  "  kage area default full\n"
                  "  kage area mine.yaml --json -\n"
                  "  kage area --estimate\n"
                  "Cells are those of an ECP5, counted by yosys before placement, which takes ten seconds to some\n"
                  "minutes and is kept; tools/fpga places a core and says its clock.");
  const auto o = std::make_shared<AreaCommand>();
  c.add_option("CONFIG", o->configs, "names in rtl/defs/configs.yaml or YAML files, default: all names")
      .take_all()
      .type_name("NAME|FILE");
  c.add_flag("--estimate", o->estimate, "do not count: print the estimate alone, which kage plan goes by");
  c.add_flag("--anew", o->anew, "count again what is kept");
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
