// SPDX-License-Identifier: Apache-2.0
// Built-in scenes at the polygon level: the front end makes the very tokens of the span level of them, and the core the
// same pixels.
#include <memory>

#include "kage/pipeline.hpp"
#include "test/scene/polygon_scenes.hpp"

namespace kage::verif {

TEST_CASE("built-in scenes: the polygon level gives the tokens of the span level") { check_both_levels(160, 120, 5); }

TEST_CASE("courtyard and knot at the polygon level: bytes, and the share that the front end makes") {
  // The parts of diced polygons go as spans.
  for (const auto& [name, least_ratio] : {std::pair{"courtyard", 8.0}, {"knot", 4.0}}) {
    const auto scene = std::make_shared<const Scene>(Scene::load(name));
    DrawOptions draw{.width = 640, .height = 480, .all_spans = true};
    draw.look.max_shading = 0;
    Config c = choose_config(*scene, draw).config;
    c.active = kUsualActive;
    const auto spans = static_cast<double>(SceneFrames(scene, c, draw).words(0).size());
    draw.level = Level::polygons;
    SceneFrames frames(scene, c, draw);
    FrameParts parts;
    frames.frame(
        0, [](std::span<const std::uint32_t>) {}, parts);
    const PolygonReport& r = parts.polygons;
    const double share = 100 * static_cast<double>(r.made().tall_spans) / static_cast<double>(r.all().tall_spans);
    const double ratio = spans / static_cast<double>(r.words);
    CAPTURE(name, share, ratio);
    CHECK(share >= 95);
    CHECK(ratio >= least_ratio);
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
    INFO(both.fault);
    CHECK(both.fault.empty());
    CHECK(both.report.active <= active);
    CHECK(both.report.words < before);
    CHECK((both.report.ways[static_cast<std::size_t>(PolygonWay::active)].spans > 0) == (active < kUsualActive));
    before = both.report.words;
  }
}

}  // namespace kage::verif
