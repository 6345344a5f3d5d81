// SPDX-License-Identifier: Apache-2.0
// kage list [scenes|configs|faults]: the names that other commands take.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <vector>

#include "command.hpp"
#include "cosim/model/model.hpp"
#include "file/read_file.hpp"
#include "json/foreign_json.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"
#include "kage/scene.hpp"
#include "options.hpp"
#include "results.hpp"

namespace kage::cli {
namespace {

struct ListCommand : Options {
  std::string what;
};

/// The parameters that are not at their defaults.
std::string differences(const Config& config) {
  const Config defaults;
  std::vector<std::string> values;
  for (const ParamInfo& p : kParams)
    if (config.*(p.member) != defaults.*(p.member)) values.push_back(fmt::format("{}={}", p.name, config.*(p.member)));
  return fmt::format("{}", fmt::join(values, " "));
}

/// Description of a built-in scene, from its file. Most of the file stands behind it, and is not parsed.
std::string about_scene(const std::string& name) {
  const std::filesystem::path path = data_directory() / "scenes" / (name + ".gltf");
  const Json asset = json_member(read_file(path), "asset", path.string());
  const Json about = asset.is_object() ? asset.value("/extras/kage/about"_json_pointer, Json()) : Json();
  if (!about.is_string()) throw Error(fmt::format("{}: has no asset.extras.kage.about", path.string()));
  return about.get<std::string>();
}

int run(const ListCommand& o) {
  check_json(o, o.json);
  struct Entry {
    std::string name;
    std::string about;
  };
  struct Group {
    std::string name;
    std::string title;
    std::vector<Entry> entries;
  };
  std::vector<Group> groups{
      {"scenes", "scenes, for every command that takes one; scenes/README.md says more of each", {}},
      {"configs", "configurations, for --config: parameters that are not at their defaults", {}},
      {"faults", "deliberate defects of the RTL, for --fault", {}}};
  for (const std::string& name : builtin_scenes()) groups[0].entries.push_back({name, about_scene(name)});
  for (const NamedConfig& named : named_configs()) groups[1].entries.push_back({named.name, differences(named.config)});
  if (o.what.empty() || o.what == "faults")
    for (const cosim::Fault& fault : cosim::faults()) groups[2].entries.push_back({fault.name, fault.breaks});

  Json j = Json::object();
  std::string text;
  for (const Group& group : groups) {
    if (!o.what.empty() && o.what != group.name) continue;
    Json entries = Json::array();
    if (o.what.empty()) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", group.title);
    for (const Entry& entry : group.entries) {
      entries.push_back({{"name", entry.name}, {"about", entry.about}});
      std::string line = o.what.empty() ? fmt::format("  {:<22} {}", entry.name, entry.about) : entry.name;
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    j[group.name] = entries;
  }
  TempFiles files;
  finish(o.json, {"kage.list/1", j}, files, text);
  return kSame;
}

}  // namespace

void add_list(Program& program, Action& action) {
  Command c = program.add("list", "List the built-in scenes, the named configurations and the deliberate defects",
                          "  kage list\n"
                          "  kage list configs               # the names alone, one a line\n"
                          "  kage list --json -");
  const auto o = std::make_shared<ListCommand>();
  c.add_option("WHAT", o->what, "scenes, configs or faults: their names alone; without it: all, with what they are")
      .check(one_of({"scenes", "configs", "faults"}))
      .type_name("");
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
