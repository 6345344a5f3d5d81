// SPDX-License-Identifier: Apache-2.0
#include "rtl_run.hpp"

#include <fmt/format.h>

#include "file/real_path.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"
#include "options.hpp"
#include "planned.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// The folder rtl/ nearest to the current folder, in it or in one above it; empty if there is none.
std::filesystem::path rtl_at_hand() {
  namespace fs = std::filesystem;
  std::error_code ec;
  for (fs::path folder = fs::current_path(ec); !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / "rtl/kage_top.sv", ec)) return folder / "rtl";
    if (folder == folder.root_path()) break;
  }
  return {};
}

/// Says, once in a run, that the RTL is not that of the tree in which the user stands: a change there would go unseen.
void tell_other_rtl() {
  static bool told = false;
  const std::filesystem::path here = rtl_at_hand();
  if (told || here.empty()) return;
  told = true;
  const std::string used = rtl_directory();
  if (real_path(here / "kage_top.sv") == real_path(used + "/kage_top.sv")) return;
  say(fmt::format("kage: note: the RTL is that of {}, not of {} (KAGE_DATA_DIR={} takes the latter)\n", used,
                  here.string(), quoted(here.parent_path().string())));
}

}  // namespace

void option_rtl(CLI::App& command, RtlRun& rtl) {
  command
      .add_option("--idle", rtl.options.idle_percent,
                  "percent of clocks at random in which no input is offered, default 0")
      ->check(whole_number(0, 95))
      ->type_name("P");
  command
      .add_option("--backpressure", rtl.options.backpressure_percent,
                  "percent of clocks at random in which no output is taken, default 0")
      ->check(whole_number(0, 95))
      ->type_name("P");
  option_netlist(command, rtl.netlist);
  option_defect(command, rtl);
}

void option_netlist(CLI::App& command, std::string& netlist) {
  command
      .add_option("--netlist", netlist,
                  "in place of the RTL run the cells that yosys makes of it for a family of FPGAs, as models of "
                  "verif/cosim/model/cells (docs/gates.md)")
      ->check(one_of({"ice40", "ecp5"}))
      ->type_name("FAMILY");
}

void option_defect(CLI::App& command, RtlRun& rtl) {
  option_fault(command, rtl.fault);
  // Help leaves out an option without a group, and so does CLI11's message when a check of it fails: hence the name.
  const auto take = [&rtl](const std::string& text) {
    if (const std::string wrong = whole_number(1, 100000)(text); !wrong.empty())
      throw CLI::ValidationError("--mutant", wrong);
    rtl.options.mutant = static_cast<int>(std::stoul(text));
  };
  command.add_option_function<std::string>("--mutant", take)->type_name("N")->group("");
}

void refuse_rtl(const RtlRun& rtl, const std::string& why) {
  const char* const given = !rtl.fault.empty()                      ? "--fault"
                            : rtl.options.idle_percent != 0         ? "--idle"
                            : rtl.options.backpressure_percent != 0 ? "--backpressure"
                            : rtl.options.mutant != 0               ? "--mutant"
                            : !rtl.netlist.empty()                  ? "--netlist"
                                                                    : nullptr;
  if (given != nullptr) throw Error(fmt::format("{}: {}", given, why));
}

cosim::Model model_of(const NamedConfig& config, const RtlRun& rtl, ModelFor what) {
  tell_other_rtl();
  Progress progress;
  const bool monitors = what == ModelFor::kMonitors;
  const bool waves = what == ModelFor::kWaveforms;
  const bool lines = what == ModelFor::kLines;
  if (!rtl.netlist.empty() && rtl.options.mutant != 0)
    throw Error("--mutant: a mutant is chosen within a model of the RTL: not with --netlist (--fault is built in)");
  const std::string name = fmt::format("the {} of configuration {}{}",
                                       rtl.netlist.empty() ? "RTL model" : rtl.netlist + " netlist", config.name,
                                       monitors             ? " with monitors"
                                       : waves              ? " for waveforms"
                                       : lines              ? " that counts lines"
                                       : !rtl.ports.empty() ? " with ports"
                                                            : "");
  const cosim::ModelOptions options{.fault = rtl.fault,
                                    .monitors = monitors,
                                    .waves = waves,
                                    .lines = lines,
                                    .mutants = rtl.options.mutant != 0,
                                    .ports = rtl.ports,
                                    .netlist = rtl.netlist,
                                    .progress = [&](double seconds) {
                                      check_interrupt();
                                      progress.show(fmt::format("building {}: {:.0f} s", name, seconds));
                                    }};
  // What a person has not named may be new: whether its model takes a minute is told before the minute passes.
  if (config.name == kPlanned)
    say(fmt::format("kage: {} {}\n", name,
                    cosim::has_model(config.config, options) ? "is there" : "is not there, and is built first"));
  cosim::Model model = cosim::find_model(config.config, options);
  progress.clear();
  if (!model.damage.empty())
    say(fmt::format("kage: {} was damaged ({}) and has been built anew: {}\n", name, model.damage,
                    model.library.string()));
  return model;
}

cosim::RtlIdentity identity_of(const NamedConfig& config) {
  tell_other_rtl();
  return cosim::rtl_identity(config.config);
}

std::string rtl_directory() { return std::filesystem::absolute(data_directory() / "rtl").lexically_normal().string(); }

cosim::ReplayOptions replay(const NamedConfig& config, const RtlRun& rtl, ModelFor what) {
  cosim::ReplayOptions options;
  options.library = model_of(config, rtl, what).library;
  options.rtl = rtl.options;
  options.rtl.assertions = false;
  options.wait = check_interrupt;
  return options;
}

}  // namespace kage::cli
