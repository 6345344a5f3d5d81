// SPDX-License-Identifier: Apache-2.0
// Light after light (docs/stream.md): what it shows against the reference of light, that nothing but colours moves,
// that each light comes to each surface once, and that units show what spans show.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_reference.hpp"
#include "stimulus/scenes/lit_scenes.hpp"
#include "test/support/catch.hpp"
#include "test/support/polygon_level.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

bool is_soft(const SceneFrame& f) {
  return std::any_of(f.lights.begin(), f.lights.end(), [](const Light& l) { return l.shape != LightShape::point; });
}

Config linear(const SceneFrame& f) {
  Config c;
  c.linear_bits = 12;
  c.smooth = 1;
  c.color_frac = 8;
  c.dsf_bits = 4;
  c.count_bits = is_soft(f) ? 4 : 0;
  return c;
}

std::map<std::string, SceneFrame> frames() {
  std::map<std::string, SceneFrame> all;
  for (const LitScene& s : lit_scenes()) all.emplace(s.name, Scene::from(s.parts).frame(0, 1));
  for (const char* name : {"courtyard", "knot", "inside", "polyhedra", "penumbra", "three-lights", "cutaway", "depths"})
    all.emplace(name, Scene::load(name).frame(0, 1));
  return all;
}

/// The states of a frame's pixels, and the passes of each line.
class Taker : public CoreObserver {
 public:
  void before(std::uint32_t /*index*/, const Token& t, std::span<const std::uint32_t> /*words*/,
              const LineView& line) override {
    if (t.kind == Kind::RESOLVE) ++passes_;
    if (t.kind != Kind::EOL) return;
    for (int x = 0; x < line.width(); ++x) {
      all.states.push_back(line.pixel(x));
      all.passes.push_back(passes_);
    }
    passes_ = 0;
  }

  struct Frame {
    std::vector<PixelState> states;
    std::vector<int> passes;
  };
  Frame all;

 private:
  int passes_ = 0;
};

Taker::Frame taken(const FrameGeometry& g, const Config& c) {
  std::vector<std::uint32_t> words;
  make_frame(g, c, 0, words, {.threads = 1});
  check_frame(c, words, "front end", 0);
  Taker taker;
  GoldenCore core(c);
  core.observe(&taker);
  CHECK(core.frame(words, [](int, std::span<const std::uint8_t>) {}).error == ErrorCode::NONE);
  return taker.all;
}

}  // namespace

TEST_CASE("with light after light colours in shadow are those of the reference, whatever the lights are") {
  struct Bound {
    double mean, worst;
  };
  // Issue 49 asks for 0.4 and 4 with lamps, spots and ranges. A window's samples are taken for alike, and a pixel in
  // half of its shadow is as far off as they are not.
  const std::map<std::string, Bound> bounds{
      {"lamp", {0.4, 4}},   {"three-lamps", {0.4, 4}},   {"three-spots", {0.4, 4}},   {"three-ranges", {0.4, 4}},
      {"office", {0.4, 4}}, {"two-triangles", {0.4, 4}}, {"table-and-window", {1, 8}}};
  for (const LitScene& s : lit_scenes()) {
    CAPTURE(s.name);
    const SceneFrame f = Scene::from(s.parts).frame(0, 1);
    const Config c = linear(f);
    const RayScene rays(f);
    const auto reference =
        reference_picture(LightReference(f, rays, sampled_points(f, {}), kWidth, kHeight), kWidth, kHeight);
    const LightError e = compare_light(draw(make_geometry(f, c, kWidth, kHeight), c), reference);
    const auto bound = bounds.find(s.name);
    if (bound != bounds.end()) {
      CHECK(e.mean() <= bound->second.mean);
      CHECK(e.worst <= bound->second.worst);
    } else {
      CHECK(e.mean_beyond() <= 0.05);  // suns: nothing but rounding
      CHECK(e.worst <= 2.5);
    }
    CHECK(e.lit_mean() <= 0.6);
  }
}

TEST_CASE("light after light changes colours alone, and each light comes to each surface once") {
  for (const auto& [name, f] : frames()) {
    CAPTURE(name);
    const Config c = linear(f);
    Config plain = c;
    plain.linear_bits = 0;
    const Taker::Frame with = taken(make_geometry(f, c, kWidth, kHeight), c);
    Look look;
    look.fit = true;
    const Taker::Frame without = taken(make_geometry(f, plain, kWidth, kHeight, {.look = look}), plain);
    REQUIRE(with.states.size() == without.states.size());
    const std::uint32_t clear = (1U << c.z_bits) - 1U;
    int wrong_depth = 0;
    int unserved = 0;
    for (std::size_t i = 0; i < with.states.size(); ++i) {
      const PixelState& p = with.states[i];
      wrong_depth += p.z != without.states[i].z ? 1 : 0;
      if (p.z == clear) continue;
      CHECK(with.passes[i] == static_cast<int>(f.lights.size()));
      unserved += p.served != (static_cast<std::uint32_t>(with.passes[i]) & 1U) || p.counts[0] != 0 ? 1 : 0;
    }
    CHECK(wrong_depth == 0);
    CHECK(unserved == 0);
  }
}

TEST_CASE("polyhedra in units show what they show as spans, with every light") {
  for (const auto& [name, f] : frames()) {
    CAPTURE(name);
    Config c = linear(f);
    const auto spans = draw(make_geometry(f, c, kWidth, kHeight), c);
    c.units = 8;
    const FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
    PolyhedraReport report;
    std::vector<std::uint32_t> words;
    make_frame(g, c, 0, words, {.threads = 1, .report = &report});
    CHECK((draw(g, c) == spans));
    if (name == "polyhedra") CHECK(std::ranges::any_of(report.unit_of, [](int u) { return u >= 0; }));
  }
}

TEST_CASE("at the polygon level light after light is what it is at the span level") {
  for (const auto& [name, f] : frames()) {
    CAPTURE(name);
    Config c = linear(f);
    c.active = 512;
    for (const int units : {0, 8}) {
      c.units = units;
      const BothLevels both = both_levels(make_geometry(f, c, kWidth, kHeight), c);
      CHECK(both.fault == "");
      CHECK(both.polygons.size() < both.spans.size());
      CHECK(both.report.made().spans > 0);
    }
  }
}

TEST_CASE("light after light has no limit of eight lights") {
  SceneParts parts = lit_scenes()[0].parts;
  const Light one = parts.lights.at(0).at(0);
  std::vector<Light>& lights = parts.lights.at(0);
  lights.assign(20, one);
  for (Light& l : lights) l.color = one.color / 20.0;
  const SceneFrame many = Scene::from(parts).frame(0, 1);
  const SceneFrame single = Scene::from(lit_scenes()[0].parts).frame(0, 1);
  const Config c = linear(many);
  const auto a = draw(make_geometry(many, c, kWidth, kHeight), c);
  const auto b = draw(make_geometry(single, c, kWidth, kHeight), c);
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (unsigned k = 0; k < 24; k += 8)
      most = std::max(most, std::abs(static_cast<int>(a[i] >> k & 255U) - static_cast<int>(b[i] >> k & 255U)));
  CHECK(most <= 2);  // twenty roundings of half a level each, where the curve is steepest
}
