// SPDX-License-Identifier: Apache-2.0
// What a frame takes at the polygon level beside the span level, how many of its spans the front end makes, and why not
// the others: the first frame of all built-in scenes and of four meshes at 640x480, ACTIVE as usual.
// `bench_polygon_level SCENE...` prints those.
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
  fmt::print("{:<18} {:<11} {:>9} {:>9} {:>5.1f} {:>8} {:>8} {:>6.1f} {:>6.1f} {:>6}",
             std::filesystem::path(path).filename().string(), named.name, spans, r.words * 4,
             static_cast<double>(spans) / static_cast<double>(r.words * 4), all.polygons, all.spans,
             percent(r.made().spans, all.spans), percent(r.made().tall_spans, all.tall_spans), r.active);
  for (std::size_t way = 1; way < kPolygonWays; ++way) fmt::print(" {:>9.2f}", percent(r.ways[way].spans, all.spans));
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<18} {:<11} {:>9} {:>9} {:>5} {:>8} {:>8} {:>6} {:>6} {:>6}", "scene", "config", "spans", "polygons",
             "ratio", "faces", "spans", "made", "tall", "active");
  for (const char* cause : {"crossings", "wide", "rounded", "cut", "words", "active", "place"})
    fmt::print(" {:>9}", cause);
  fmt::print("\n{:<18} {:<11} {:>9} {:>9} {:>5} {:>8} {:>8} {:>6} {:>6} {:>6} {:>9}\n", "", "", "bytes", "bytes", "",
             "", "", "%", "%", "", "% of the spans");
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
