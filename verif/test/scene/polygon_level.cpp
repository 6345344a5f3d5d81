// SPDX-License-Identifier: Apache-2.0
// Built-in scenes at the polygon level: the front end makes the very tokens of the span level of them, and the core the
// same pixels.
#include "test/support/polygon_level.hpp"

#include <array>

#include "kage/geometry.hpp"
#include "opinion/light_truth.hpp"
#include "test/scene/scene_configs.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

/// The configurations that a scene is drawn with here: by parity flat, smooth, with units and by counting, with what it
/// needs of blending and light counters.
std::vector<Config> configs_for(const Scene& scene) {
  std::vector<Config> all;
  for (int way = 0; way < 4; ++way) {
    Config c = wide_enough();
    c.active = kUsualActive;
    c.smooth = way == 1 ? 1 : 0;
    c.color_frac = 8 * c.smooth;
    c.units = way == 2 ? 16 : 0;
    c.dsf_bits = way == 3 ? 4 : 1;
    c.translucency = translucent(scene) ? 1 : 0;
    all.push_back(config_for_lights(scene.frame(0, scene.frame_count()), Look{}.samples, c));
  }
  return all;
}

void check_scenes(int width, int height, int step) {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    for (const Config& c : configs_for(scene))
      for (int i = 0; i < scene.frame_count(); i += step) {
        const SceneFrame f = scene.frame(i, scene.frame_count());
        CAPTURE(name, i, width, c.smooth, c.units, c.dsf_bits);
        const BothLevels both = both_levels(make_geometry(f, c, width, height), c);
        CHECK(both.fault == "");
        CHECK(both.counts.made > 0);
      }
  }
}

}  // namespace

TEST_CASE("built-in scenes: the polygon level gives the tokens of the span level") { check_scenes(160, 120, 5); }

TEST_CASE("built-in scenes at the polygon level: bytes, and the share that the front end makes") {
  for (const auto& [name, least_share] : {std::pair{"courtyard", 95.0}, {"knot", 95.0}}) {
    const Scene scene = Scene::load(name);
    Config c = wide_enough();
    c.active = kUsualActive;
    std::vector<std::uint32_t> words;
    PolygonReport r;
    const FrameGeometry g = make_geometry(scene.frame(0, scene.frame_count()), c, 640, 480);
    make_frame(g, c, 0, words, {.level = Level::polygons, .polygons = &r});
    const double share = 100 * static_cast<double>(r.made().tall_spans) / static_cast<double>(r.all().tall_spans);
    INFO(name << ": " << share << " %");
    CHECK(share >= least_share);
  }
}

TEST_CASE("the front end's table of polygons may be small: what it does not hold goes as spans") {
  const Scene scene = Scene::load("courtyard");
  std::uint64_t before = ~std::uint64_t{0};
  for (const int active : {1, 4, 32, kUsualActive}) {
    Config c = wide_enough();
    c.active = active;
    const FrameGeometry g = make_geometry(scene.frame(0, scene.frame_count()), c, 160, 120);
    const BothLevels both = both_levels(g, c);
    CAPTURE(active);
    CHECK(both.fault == "");
    CHECK(both.report.active <= active);
    CHECK(both.report.words < before);
    CHECK((both.report.ways[static_cast<std::size_t>(PolygonWay::active)].spans > 0) == (active < 512));
    before = both.report.words;
  }
}

}  // namespace kage::verif
