// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/models.hpp"

#include <fmt/format.h>

#include "cosim/session/cores.hpp"
#include "cosim/session/host.hpp"
#include "cosim/session/planned.hpp"
#include "cosim/session/random_registers.hpp"
#include "file/real_path.hpp"
#include "file/shown.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
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

/// Says that the RTL is not that of the tree in which the user stands: a change there would go unseen.
void tell_other_rtl(Host& host) {
  const std::filesystem::path here = rtl_at_hand();
  if (here.empty()) return;
  const std::string used = rtl_directory();
  if (real_path(here / "kage_top.sv") == real_path(used + "/kage_top.sv")) return;
  say_once(host, fmt::format("kage: note: the RTL is that of {}, not of {} (KAGE_DATA_DIR={} takes the latter)\n", used,
                             here.string(), quoted(here.parent_path().string())));
}

}  // namespace

RtlOptions rtl_options(const RtlRun& rtl, std::uint64_t seed) {
  RtlOptions options;
  options.seed = seed;
  options.idle_percent = rtl.idle;
  options.backpressure_percent = rtl.backpressure;
  options.mutant = rtl.mutant;
  return options;
}

Model model_of(const NamedConfig& config, const RtlRun& rtl, Host& host, ModelFor what, const std::string& ports) {
  tell_other_rtl(host);
  const std::unique_ptr<Progress> progress = host.progress();
  ModelOptions options{.fault = rtl.fault, .mutants = rtl.mutant != 0, .ports = ports, .netlist = rtl.netlist};
  const auto be_for = [&options](ModelFor use) {
    options.monitors = use == ModelFor::kMonitors || use == ModelFor::kSearch;
    options.waves = use == ModelFor::kWaveforms || use == ModelFor::kSearch;
    options.lines = use == ModelFor::kLines;
  };
  be_for(what);
  // The model that a search has left serves its parts as well.
  if (options.monitors != options.waves && !cosim::has_model(config.config, options)) {
    be_for(ModelFor::kSearch);
    if (!cosim::has_model(config.config, options)) be_for(what);
  }
  if (!rtl.netlist.empty() && rtl.mutant != 0)
    throw Error("--mutant: a mutant is chosen within a model of the RTL: not with --netlist (--fault is built in)");
  const std::string name = fmt::format("the {} of configuration {}{}",
                                       rtl.netlist.empty() ? "RTL model" : rtl.netlist + " netlist", config.name,
                                       options.monitors && options.waves ? " with monitors and waveforms"
                                       : options.monitors                ? " with monitors"
                                       : options.waves                   ? " for waveforms"
                                       : options.lines                   ? " that counts lines"
                                       : !ports.empty()                  ? " with ports"
                                                                         : "");
  options.progress = [&](double seconds) {
    host.check();
    progress->show(fmt::format("building {}: {:.0f} s", name, seconds));
  };
  // A configuration that nobody has named may be new: whether its model takes a minute is told before it passes.
  if (config.name == kPlanned)
    host.say(fmt::format("kage: {} {}\n", name,
                         cosim::has_model(config.config, options) ? "is there" : "is not there, and is built first"));
  Model model = cosim::find_model(config.config, options);
  progress->clear();
  if (!model.damage.empty())
    host.say(fmt::format("kage: {} was damaged ({}) and has been built anew: {}\n", name, model.damage,
                         model.library.string()));
  return model;
}

namespace {

class RtlCores final : public Cores {
 public:
  Model model(const NamedConfig& config, const RtlRun& rtl, Host& host) override { return model_of(config, rtl, host); }
  RtlIdentity identity(const NamedConfig& config, Host& host) override {
    tell_other_rtl(host);
    return rtl_identity(config.config);
  }
  std::unique_ptr<Core> core(const Model& model, const Config& config, const RtlOptions& options) override {
    return make_rtl(model.library, config, options);
  }
  std::optional<Difference> registers(const Model& model, const Config& config, const RtlOptions& options,
                                      const std::function<void()>& wait) override {
    return register_difference(model.library, config, options, wait);
  }
};

}  // namespace

Cores& rtl_cores() {
  static RtlCores cores;
  return cores;
}

std::string rtl_directory() { return std::filesystem::absolute(data_directory() / "rtl").lexically_normal().string(); }

ReplayOptions replay(const NamedConfig& config, const RtlRun& rtl, const RtlOptions& options, ModelFor what,
                     Host& host) {
  ReplayOptions again;
  again.library = model_of(config, rtl, host, what).library;
  again.rtl = options;
  again.rtl.assertions = false;
  again.wait = [&host] { host.check(); };
  return again;
}

}  // namespace kage::cosim
