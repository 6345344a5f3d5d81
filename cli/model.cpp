// SPDX-License-Identifier: Apache-2.0
// kage model CONFIG...: builds RTL models ahead of their use.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "command.hpp"
#include "cosim/session/models.hpp"
#include "cosim/session/option_names.hpp"
#include "cosim/session/planned.hpp"
#include "cosim/session/source.hpp"
#include "kage/config.hpp"
#include "kage/scene.hpp"
#include "options.hpp"
#include "results.hpp"
#include "rtl_options.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace kage::cli {
namespace {

struct ModelCommand : Options {
  std::vector<std::string> configs;
  std::string fault;
  std::string netlist;
  std::vector<std::string> planned;  // scenes
};

/// The plans of the scenes, one by one.
std::vector<NamedConfig> plans(const ModelCommand& o) {
  std::vector<NamedConfig> list;
  for (const std::string& input : o.planned) {
    NamedConfig named =
        cosim::planned_config(o, std::make_shared<const Scene>(cosim::load_scene(input, o, terminal())), terminal());
    named.name = fmt::format("plan of {}", input);
    list.push_back(std::move(named));
  }
  return list;
}

int run(const ModelCommand& o) {
  reads_files(o.configs);
  reads_files(o.planned);
  check_json(o, o.json);
  std::vector<NamedConfig> list;
  if (o.configs.empty() && o.planned.empty()) list = named_configs();
  for (const std::string& name : o.configs) list.push_back(load_config(name));
  for (NamedConfig& named : plans(o)) list.push_back(std::move(named));
  for (NamedConfig& named : list)
    if (cosim::give_front_end(o.level, named.config)) named.name += fmt::format(" with ACTIVE {}", named.config.active);
  Json j = Json::array();
  for (const NamedConfig& named : list) {
    const cosim::Model model = cosim::model_of(named, {.fault = o.fault, .netlist = o.netlist}, terminal());
    if (!json_only(o.json))
      fmt::print("{}: {} ({})\n", named.name, model.library.string(),
                 model.build_seconds > 0 ? fmt::format("built in {:.0f} s", model.build_seconds) : "was there");
    j.push_back({{"name", named.name},
                 {"library", model.library.string()},
                 {"build_seconds", model.build_seconds},
                 {"config", report::to_json(named.config)}});
  }
  write_json(o.json, {"kage.model/1", j});
  return kSame;
}

}  // namespace

void add_model(Program& program, Action& action) {
  Command c = program.add("model", "Build the RTL models of configurations ahead of their use",
                          "  kage model\n"
                          "  kage model default full\n"
                          "  kage model tiny --netlist ice40\n"
                          "  kage model default --front-end rtl              (what kage cosim takes with that option)\n"
                          "  kage model mine.yaml --json -\n"
                          "  kage model --plan courtyard --plan bunny.obj");
  const auto o = std::make_shared<ModelCommand>();
  c.add_option("CONFIG", o->configs, "names in rtl/defs/configs.yaml or YAML files, default: all names")
      .take_all()
      .type_name("NAME|FILE");
  const Option plan =
      c.add_option(
           "--plan", o->planned,
           "a scene: the model of the configuration that --config plan takes for it; more than once for more scenes")
          .take_all()
          .expected(1)
          .type_name("SCENE");
  const std::size_t others = c.options().size();
  options_of_pictures(c, *o);
  std::vector<Option> all = c.options();
  for (std::size_t i = others; i < all.size(); ++i) all[i].needs(plan);
  option_fault(c, o->fault);
  option_netlist(c, o->netlist);
  option_front_end(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
