// SPDX-License-Identifier: Apache-2.0
#include "stimulus/scenes/lit_scenes.hpp"

#include <array>
#include <glm/geometric.hpp>

#include "kage/light.hpp"
#include "scene/functions.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {
Light lamp(const glm::dvec3& position, const glm::dvec3& color) {
  Light l;
  l.directional = false;
  l.position = position;
  l.color = color;
  l.falls_off = true;
  return l;
}

namespace {

/// A plate in the plane y = 0, from -half to half, of so many cells a side.
SceneObject plate(float half, int cells) {
  SceneObject o;
  o.name = "floor";
  for (int i = 0; i <= cells; ++i)
    for (int k = 0; k <= cells; ++k)
      o.positions.emplace_back(half * (2.0F * static_cast<float>(i) / static_cast<float>(cells) - 1), 0,
                               half * (2.0F * static_cast<float>(k) / static_cast<float>(cells) - 1));
  const auto at = [cells](int i, int k) { return static_cast<std::uint32_t>(i * (cells + 1) + k); };
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < cells; ++k) {
      o.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      o.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  return o;
}

SceneObject block(const glm::vec3& middle, const glm::vec3& half) {
  SceneObject o;
  o.name = "block";
  const Solid box = box_solid();
  for (const glm::dvec3& v : box.vertices) o.positions.push_back(middle + half * glm::vec3(v));
  o.triangles = box.faces;
  return o;
}

/// A ball of squares round its axis, with the normals of a true one.
SceneObject ball(const glm::vec3& middle, float radius, int rings) {
  SceneObject o;
  o.name = "ball";
  const int segments = 2 * rings;
  const auto add = [&](double down, double round) {
    const glm::vec3 n(portable::sin(down) * portable::cos(round), portable::cos(down),
                      portable::sin(down) * portable::sin(round));
    o.positions.push_back(middle + radius * n);
    o.normals.push_back(n);
  };
  add(0, 0);
  for (int i = 1; i < rings; ++i)
    for (int k = 0; k < segments; ++k) add(portable::kPi * i / rings, 2 * portable::kPi * k / segments);
  add(portable::kPi, 0);
  const auto at = [segments](int i, int k) {
    return static_cast<std::uint32_t>(1 + (i - 1) * segments + k % segments);
  };
  const auto last = static_cast<std::uint32_t>(o.positions.size() - 1);
  for (int k = 0; k < segments; ++k) {
    o.triangles.push_back({0, at(1, k + 1), at(1, k)});
    o.triangles.push_back({last, at(rings - 1, k), at(rings - 1, k + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      o.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      o.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return o;
}

Material white() {
  Material m;
  m.color = {0.95, 0.95, 0.95};
  return m;
}

Camera eye_at(const glm::dvec3& eye, const glm::dvec3& target, double angle) {
  Camera c;
  c.eye = eye;
  c.forward = glm::normalize(target - eye);
  c.right = glm::normalize(glm::cross(c.forward, glm::dvec3(0, 1, 0)));
  c.up = glm::cross(c.right, c.forward);
  c.half_height = portable::sin(angle / 2) / portable::cos(angle / 2);
  return c;
}

Light sun(const glm::dvec3& towards, const glm::dvec3& color) {
  Light l;
  l.direction = glm::normalize(-towards);
  l.color = color;
  return l;
}

Light spot(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& color, double inner, double outer) {
  Light l = lamp(position, color);
  l.spot = true;
  l.direction = glm::normalize(target - position);
  l.inner_cosine = portable::cos(inner);
  l.outer_cosine = portable::cos(outer);
  return l;
}

Light ranged(const glm::dvec3& position, const glm::dvec3& color, double range) {
  Light l = lamp(position, color);
  l.range = range;
  return l;
}

/// A ball and a block on a floor of so many cells a side.
LitScene still_life(const std::string& name, const std::string& about, int cells, const std::vector<Light>& lights) {
  LitScene s{name, about, {}};
  s.parts.name = name;
  s.parts.objects = {plate(4, cells), ball({-0.6F, 0.7F, 0.2F}, 0.7F, 14), block({1, 0.5F, -0.4F}, {0.4F, 0.5F, 0.5F})};
  s.parts.materials = {white()};
  s.parts.cameras = {eye_at({3.2, 3, 5}, {0, 0.4, 0}, 0.75)};
  s.parts.lights = {lights};
  return s;
}

constexpr glm::dvec3 kRed{1, 0.3, 0.25};
constexpr glm::dvec3 kGreen{0.25, 1, 0.3};
constexpr glm::dvec3 kBlue{0.3, 0.4, 1};
constexpr glm::dvec3 kWhite{1, 1, 1};

}  // namespace

LitScene table_and_window(double height) {
  LitScene s{"table-and-window", "a window, a part of it behind the table's face", {}};
  s.parts.name = s.name;
  s.parts.objects = {plate(1.5F, 16), block({-0.3F, 0.25F, 0.1F}, {0.2F, 0.25F, 0.2F}),
                     block({0.5F, 0.15F, -0.4F}, {0.25F, 0.15F, 0.2F})};
  s.parts.materials = {white()};
  s.parts.cameras = {eye_at({1.6, 2.1, 2.9}, {0, 0.1, 0}, 0.75)};
  Light window = lamp({-2.6, height, 0.3}, kWhite * 8.0);
  window.shape = LightShape::rectangle;
  window.axis_u = {0, 0, 0.8};
  window.axis_v = {0, 1, 0};
  s.parts.lights = {{window}};
  return s;
}

std::vector<LitScene> lit_scenes() {
  std::vector<LitScene> all;
  const glm::dvec3 high{-0.6, 0.8, 0.2};
  const glm::dvec3 low{-0.9, 0.23, 0.37};  // 13 degrees
  all.push_back(still_life("sun", "one sun", 24, {sun(high, kWhite)}));
  all.push_back(still_life("low-sun", "one sun, 13 degrees up", 24, {sun(low, kWhite)}));
  all.push_back(still_life("sun-and-millionth", "one sun, and one of a millionth", 24,
                           {sun(high, kWhite), sun(-low, 1e-6 * kWhite)}));
  all.push_back(still_life("lamp", "one lamp", 24, {lamp({-1.6, 1.7, 1.6}, 6.0 * kWhite)}));
  all.push_back(still_life("three-suns", "three suns", 24,
                           {sun(high, kRed), sun({0.7, 0.7, 0.3}, kGreen), sun({-0.1, 0.8, -0.6}, kBlue)}));
  const std::array<glm::dvec3, 3> places{glm::dvec3(-2.2, 1.8, 1.2), {2.4, 1.6, 1.5}, {0.3, 2.2, -2.2}};
  all.push_back(still_life("three-lamps", "three lamps", 24,
                           {lamp(places[0], 6.0 * kRed), lamp(places[1], 6.0 * kGreen), lamp(places[2], 6.0 * kBlue)}));
  all.push_back(still_life("three-spots", "three cones", 24,
                           {spot({-2.5, 3, 1.5}, {-0.3, 0, 0.3}, 20.0 * kRed, 0.2, 0.35),
                            spot({2.5, 3, 1.5}, {0.4, 0, 0}, 20.0 * kGreen, 0.15, 0.4),
                            spot({0, 3.5, -2}, {0, 0, 0}, 20.0 * kBlue, 0, 0.5)}));
  all.push_back(still_life(
      "three-ranges", "three lamps that end", 24,
      {ranged(places[0], 6.0 * kRed, 4), ranged(places[1], 6.0 * kGreen, 3), ranged(places[2], 6.0 * kBlue, 5)}));
  std::vector<Light> office;
  for (int i = 0; i < 8; ++i)
    office.push_back(ranged({-2.4 + 1.6 * (i % 4), 2.6, i < 4 ? -1.2 : 1.2}, 2.0 * kWhite, 6));
  all.push_back(still_life("office", "eight lamps under a ceiling", 24, office));
  all.push_back(table_and_window(0.5));
  all.push_back(
      still_life("two-triangles", "a lamp over a floor of two triangles", 1, {lamp({-1.6, 1.7, 1.6}, 6.0 * kWhite)}));
  all.push_back(still_life("spot-inside", "a cone within one triangle", 1,
                           {spot({-0.5, 3, 2}, {0.6, 0, 1.9}, 20.0 * kWhite, 0.1, 0.2)}));
  return all;
}

std::vector<std::vector<LightPoint>> sampled_points(const SceneFrame& frame, const Look& look) {
  std::vector<std::vector<LightPoint>> points;
  for (std::size_t l = 0; l < frame.lights.size(); ++l)
    points.push_back(light_points(frame.lights[l], look.samples, look.seed + l));
  return points;
}

}  // namespace kage::verif
