// SPDX-License-Identifier: Apache-2.0
// Casters of many points of a light, made together, are those of each point alone.
#include "shadow/shadow_caster.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

TEST_CASE("casters made together are those made one by one, whatever the light's size") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    SceneFrame f = random_scene(random, random.in(1, 8));
    // From a point's to many times the scene's; within the scene and far off.
    const double size = i % 5 == 0 ? 0 : std::pow(10, random.real(-6, 3));
    const glm::dvec3 middle = random_direction(random) * std::pow(10, random.real(-2, 4));
    std::vector<LightPoint> points(static_cast<std::size_t>(random.in(1, 20)));
    for (LightPoint& l : points) {
      l.directional = i % 7 == 0;
      l.direction = random_direction(random);
      l.position = middle + random_direction(random) * size * random.real(0, 1);
    }
    std::vector<glm::dvec3> near;
    for (int k = 0; k < 4; ++k) near.push_back(random_direction(random) * random.real(0, 20));
    const auto together = ShadowCaster::of_points(f, points, near, 1.5);
    REQUIRE(together.size() == points.size());
    const std::vector<SpaceBox> boxes = component_boxes(f);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const ShadowCaster alone(f, points[k], near, 1.5);
      CHECK(together[k].light().position == points[k].position);
      CHECK(together[k].edge_on() == alone.edge_on());
      std::vector<CapFace> caps;
      std::vector<CapFace> same;
      for (std::size_t c = 0; c < boxes.size(); ++c) {
        alone.caps(f.components[c], boxes[c], caps);
        together[k].caps(f.components[c], boxes[c], same);
        CHECK(caps == same);
        CHECK(alone.far_factor(caps) == together[k].far_factor(caps));
      }
      // Further than all there is.
      double least = INFINITY;
      double most = 0;
      for (const glm::dvec3& p : f.vertices) most = std::max(most, length(p - points[k].position));
      for (const glm::dvec3& p : near) most = std::max(most, length(p - points[k].position));
      if (points[k].directional) continue;
      alone.caps(f.components[0], boxes[0], caps);
      if (caps.empty()) continue;
      const double factor = alone.far_factor(caps);
      for (const CapFace& cap : caps) {
        const FacePlane plane(f, f.polygons[cap.polygon]);
        const double d = std::abs(glm::dot(plane.normal, points[k].position - plane.point)) / plane.normal_length;
        least = std::min(least, d * factor);
      }
      CHECK(least >= most * 1.5);
    }
  }
}

TEST_CASE("a face seen edge-on by a light casts nothing, one just off it does") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  const std::vector<SpaceBox> boxes = component_boxes(f);
  CHECK(boxes[0].low == glm::dvec3(-1, -1, -1));
  CHECK(boxes[0].high == glm::dvec3(1, 1, 1));
  const auto lit = [&](double y) {
    LightPoint l;
    l.directional = false;
    l.position = {3, y, 0.5};
    const ShadowCaster caster(f, l, {}, 1);
    CHECK(caster.light_outside(boxes[0]));
    std::vector<CapFace> caps;
    caster.caps(f.components[0], boxes[0], caps);
    return caps.size();
  };
  CHECK(lit(0.5) == 1);
  CHECK(lit(1) == 1);         // in the plane of the top
  CHECK(lit(1 + 1e-9) == 1);  // by less than 10^-9 of the furthest vertex
  CHECK(lit(1 + 1e-7) == 2);
  LightPoint within;
  within.directional = false;
  within.position = {1, 0.2, 0.3};  // on the box's side is not surely outside
  CHECK_FALSE(ShadowCaster(f, within, {}, 1).light_outside(boxes[0]));
}

}  // namespace kage::verif
