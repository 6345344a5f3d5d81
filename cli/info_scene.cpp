// SPDX-License-Identifier: Apache-2.0
#include "info_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "command.hpp"
#include "cosim/session/remarks.hpp"
#include "cosim/session/source.hpp"
#include "kage/config.hpp"
#include "kage/scene.hpp"
#include "options.hpp"
#include "pipeline/choose.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

// Remarks are made of so many frames, spread over the scene's own.
constexpr int kMostFramesLooked = 16;

std::string_view kind_of(const Light& l) {
  if (l.shape == LightShape::disc) return "disc";
  if (l.shape == LightShape::rectangle) return "rectangle";
  if (l.shape == LightShape::sphere) return "sphere";
  return l.directional ? "directional" : l.spot ? "spot" : "point";
}

Json components_of(const Scene& scene, const SceneFrame& frame) {
  const auto number = [&](auto is) { return std::count_if(frame.components.begin(), frame.components.end(), is); };
  const auto first = [&](auto is) -> Json {
    const auto at = std::find_if(frame.components.begin(), frame.components.end(), is);
    if (at == frame.components.end()) return nullptr;
    return {{"component", at - frame.components.begin()},
            {"object", scene.objects()[frame.triangles[at->first].object]},
            {"why", at->reason}};
  };
  return {{"all", frame.components.size()},
          {"closed", number([](const Component& c) { return c.closed; })},
          {"convex", number([](const Component& c) { return c.convex; })},
          {"translucent", number([](const Component& c) { return c.translucent; })},
          {"first_not_closed", first([](const Component& c) { return !c.closed; })},
          {"first_not_convex", first([](const Component& c) { return c.closed && !c.convex; })}};
}

Json contents_of(const Scene& scene, const SceneFrame& frame) {
  const SceneContents& c = scene.contents();
  Json lights = Json::array();
  for (const Light& l : frame.lights)
    if (c.lights > 0) lights.push_back(kind_of(l));
  Json j;
  j["scene"] = scene.name();
  j["frames"] = scene.frame_count();
  j["objects"] = scene.objects().size();
  j["triangles"] = frame.triangles.size();
  j["polygons"] = frame.polygons.size();
  j["vertices"] = frame.vertices.size();
  j["components"] = components_of(scene, frame);
  j["smooth"] = scene.needs_smooth();
  j["materials"] = {
      {"all", c.materials}, {"translucent", c.translucent}, {"unlit", c.unlit}, {"single_sided", c.single_sided}};
  j["cameras"] = c.cameras;
  j["lights"] = lights;
  j["animations"] = c.animations;
  j["moving_nodes"] = c.moving;
  return j;
}

/// Which named configurations draw it, what the others lack, and what is told of the pictures.
void add_configurations(const Options& o, const Scene& scene, const SceneFrame& frame, Json& j) {
  const Needs needs = needs_of_frames(scene, scene.frame_count(), o.size.width, o.size.height, o.samples);
  j["size"] = {o.size.width, o.size.height};
  j["light"] = {{"share_error", needs.share_error}, {"color_spread", needs.color_spread}};
  j["configurations"] = Json::array();
  j["configuration"] = nullptr;
  j["lacks"] = Json::object();
  DrawOptions draw = cosim::draw_options(o);
  draw.frames = scene.frame_count();
  j["costs"] = Json::array();
  for (const ChoiceCost& c : choices(frame, needs, draw))
    j["costs"].push_back({{"name", c.named.name}, {"clocks", c.clocks}, {"luts", c.luts}, {"approximates", c.rough}});
  Config config;
  for (const NamedConfig& named : named_configs()) {
    const std::vector<std::string> missing = lacks(named.config, needs);
    if (!missing.empty()) {
      j["lacks"][named.name] = missing;
      continue;
    }
    j["configurations"].push_back(named.name);
  }
  if (!j["configurations"].empty()) {
    const NamedConfig chosen = choose_config(scene, draw);
    j["configuration"] = chosen.name;
    config = chosen.config;
  }
  const std::string line = j["configuration"].is_null() ? widened_config(needs) : std::string();
  j["widened"] = line.empty() ? Json(nullptr) : Json(line);
  cosim::FrameRemarks remarks(config, o.size, o.cull);
  const int frames = std::min(scene.frame_count(), kMostFramesLooked);
  for (int i = 0; i < frames; ++i) remarks.add(scene, scene.frame(i, frames));
  j["notes"] = scene.notes();
  for (const std::string& note : remarks.notes()) j["notes"].push_back(note);
}

std::string names(const Json& list) { return fmt::format("{}", fmt::join(list.get<std::vector<std::string>>(), ", ")); }

/// ", 2 translucent" for what there is some of.
std::string of_these(const Json& j, const char* key, const char* text) {
  const auto n = j[key].get<std::uint64_t>();
  return n == 0 ? std::string() : fmt::format(", {} {}", n, text);
}

void print_reason(const Json& first, const char* what) {
  if (first.is_null()) return;
  fmt::print("  not {}: first component {}, of {}: {}\n", what, first["component"].get<std::uint64_t>(),
             shown(first["object"].get<std::string>()), shown(first["why"].get<std::string>()));
}

void print(const Options& o, const Json& j) {
  const auto number = [](const Json& v) { return v.get<std::uint64_t>(); };
  const Json& parts = j["components"];
  const Json& materials = j["materials"];
  fmt::print("{}: {}, {}, {}, {}\n", shown(o.input), counted(number(j["triangles"]), "triangle"),
             fmt::format("{} {}", number(j["vertices"]), number(j["vertices"]) == 1 ? "vertex" : "vertices"),
             counted(number(j["objects"]), "object"), counted(number(j["frames"]), "frame"));
  fmt::print("components: {}, {} closed, {} closed and convex{}\n", number(parts["all"]), number(parts["closed"]),
             number(parts["convex"]), of_these(parts, "translucent", "translucent"));
  print_reason(parts["first_not_closed"], "closed");
  print_reason(parts["first_not_convex"], "convex");
  fmt::print("materials: {}{}{}{}; colours {} within a face\n", number(materials["all"]),
             of_these(materials, "translucent", "translucent"), of_these(materials, "unlit", "unlit"),
             of_these(materials, "single_sided", "single-sided"), j["smooth"].get<bool>() ? "vary" : "do not vary");
  fmt::print("cameras: {}; lights: {}{}\n", number(j["cameras"]), j["lights"].size(),
             j["lights"].empty() ? "" : fmt::format(" ({})", names(j["lights"])));
  fmt::print("animations: {}{}\n", number(j["animations"]),
             number(j["moving_nodes"]) == 0 ? "" : ", " + counted(number(j["moving_nodes"]), "node") + " moved");
  for (const Json& note : j["notes"]) fmt::print("note: {}\n", shown(note.get<std::string>()));
  const double share_error = j["light"]["share_error"].get<double>();
  fmt::print("light: {}; one colour a face leaves it {:.1f} off\n",
             share_error > 0 ? fmt::format("one share for all shadows leaves them {:.2f} steps of 255 off, root mean "
                                           "square",
                                           share_error)
                             : "one share does for all shadows, or none is seen",
             j["light"]["color_spread"].get<double>());
  const std::string size = fmt::format("{}x{}", o.size.width, o.size.height);
  if (j["configurations"].empty())
    fmt::print(
        "configurations that draw it at {}: none{}\n", size,
        j["widened"].is_null() ? "" : "; --config FILE can, with this line in it: " + j["widened"].get<std::string>());
  else
    fmt::print("configurations that draw it at {}: {}; {} without --config\n", size, names(j["configurations"]),
               j["configuration"].get<std::string>());
  const Json& costs = j["costs"];
  if (costs.size() > 1)
    for (const Json& c : costs)
      fmt::print("  {} takes {} clocks for the first frame at {}x{}, and some {:.0f} look-up tables{}\n",
                 c["name"].get<std::string>(), number(c["clocks"]), kJudgedWidth, kJudgedHeight,
                 c["luts"].get<double>(),
                 c["approximates"].empty() ? "" : "; it approximates " + names(c["approximates"]));
  for (const auto& [name, missing] : j["lacks"].items()) fmt::print("  {} lacks {}\n", name, names(missing));
}

}  // namespace

int describe_scene(const Options& o) {
  const Scene scene = cosim::load_scene(o.input, o, terminal(), 1);
  Json j;
  {
    const EndsAtOnce nothing_is_written;
    const SceneFrame frame = scene.frame(0, scene.frame_count());
    j = contents_of(scene, frame);
    add_configurations(o, scene, frame, j);
  }
  check_interrupt();
  write_json(o.json, {"kage.info-scene/1", j});
  if (!json_only(o.json)) print(o, j);
  return kSame;
}

}  // namespace kage::cli
