// SPDX-License-Identifier: Apache-2.0
// Cost of a frame at the polygon level beside the span level; how many of its spans the front end makes, and why it
// does not make the others. The first frame of all built-in scenes and of four meshes at 640x480, ACTIVE as usual.
// `bench_polygon_level SCENE...` prints them for these scenes. The table is docs/stream.md's.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/timer.hpp"
#include "kage/config.hpp"
#include "kage/pipeline.hpp"

namespace {

using namespace kage;

double percent(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(all);
}

void print(const std::string& path) {
  const auto scene = std::make_shared<const Scene>(Scene::load(path));
  DrawOptions draw{.width = 640, .height = 480, .threads = 1};
  const NamedConfig named = choose_config(*scene, draw);
  Config config = named.config;
  config.active = kUsualActive;
  const std::uint64_t spans = SceneFrames(scene, config, draw).words(0).size() * 4;
  draw.level = Level::polygons;
  SceneFrames frames(scene, config, draw);
  FrameParts parts;
  (void)frames.frame(
      0, [](std::span<const std::uint32_t>) {}, parts);
  const PolygonReport& r = parts.polygons;
  const PolygonReport::Way all = r.all();
  const auto of = [&](PolygonWay way) { return percent(r.ways[static_cast<std::size_t>(way)].spans, all.spans); };
  const double rest =
      of(PolygonWay::crossings) + of(PolygonWay::wide) + of(PolygonWay::rounded) + of(PolygonWay::place);
  fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n",
             std::filesystem::path(path).filename().string(), named.name, static_cast<double>(spans) / 1000,
             static_cast<double>(r.words) * 4 / 1000, static_cast<double>(spans) / static_cast<double>(r.words * 4),
             percent(r.made().spans, all.spans), percent(r.made().tall_spans, all.tall_spans), r.active,
             of(PolygonWay::words), of(PolygonWay::active), of(PolygonWay::cut), rest);
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print(
      "| scene | config | spans, kB | polygons, kB | times fewer | made, % | tall, % | at once | no fewer words, % | "
      "ACTIVE, % | cut, % | else, % |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) {
    scenes = kage::builtin_scenes();
    for (const char* mesh : {"horse.3ds", "cat.3ds", "asteroid-high.3ds", "bunny.obj"})
      if (const std::string path = std::string("/usr/share/glmark2/models/") + mesh; std::filesystem::exists(path))
        scenes.push_back(path);
  }
  for (const std::string& scene : scenes) print(scene);
  return 0;
}
