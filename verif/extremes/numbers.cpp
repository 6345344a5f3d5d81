// SPDX-License-Identifier: Apache-2.0
#include "extremes/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "extremes/shadow_checks.hpp"
#include "geometry/shade.hpp"
#include "kage/error.hpp"

namespace kage::verif {
namespace {

constexpr int kNumberWidth = 64;
constexpr int kNumberHeight = 48;

}  // namespace

SceneFrame plain_scene() {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -2, 0}, {4, 0.2, 4}, Turn{}, {1, 1, 1});
  add_solid(f, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  look_at(f.camera, {3, 2, 4}, {0, -1, 0});
  return f;
}

void NotFiniteCase::fields(Fields& f) {
  f.choice("value", value, std::array{"nan", "inf", "-inf"});
  f.choice("place", place,
           std::array{"vertex_x", "vertex_y", "vertex_z", "eye", "forward", "up", "half_height", "near",
                      "light_direction", "light_colour", "light_position", "light_axis", "light_cone"});
  f.number("index", index, 0, 13);
}

Outcome NotFiniteCase::check(const Context& context) const {
  const double inf = std::numeric_limits<double>::infinity();
  const double bad = context.injected(Injection::finite_value) ? 0
                     : value == 0                              ? std::numeric_limits<double>::quiet_NaN()
                     : value == 1                              ? inf
                                                               : -inf;
  SceneFrame f = plain_scene();
  std::string says = "camera";
  f.lights.push_back({});
  Light& l = f.lights[1];
  if (place >= 10) {  // of a light at infinity these do not count
    l.directional = false;
    l.spot = true;
    l.shape = LightShape::disc;
    l.position = {1, 3, 2};
    l.axis_u = l.axis_v = {1, 0, 0};
  }
  switch (place) {
    case 0:
    case 1:
    case 2:
      f.vertices[static_cast<std::size_t>(index)][place] = bad;
      says = fmt::format("vertex {}", index);
      break;
    case 3:
      f.camera.eye.x = bad;
      break;
    case 4:
      f.camera.forward.z = bad;
      break;
    case 5:
      f.camera.up.y = bad;
      break;
    case 6:
      f.camera.half_height = bad;
      break;
    case 7:
      f.camera.near = bad;
      break;
    default:
      says = "light 1: ";
      (place == 8    ? l.direction.z
       : place == 9  ? l.color.y
       : place == 10 ? l.position.x
       : place == 11 ? l.axis_u.y
                     : l.inner_cosine) = bad;
  }
  Outcome o;
  o.items = 1;
  try {
    (void)make_geometry(f, Config{}, kNumberWidth, kNumberHeight);
    o.fail("it is accepted");
  } catch (const Error& e) {
    if (std::string(e.what()).find(says) == std::string::npos)
      o.fail(fmt::format("\"{}\" does not name \"{}\"", e.what(), says));
  }
  return o;
}

void ScaledCase::fields(Fields& f) {
  f.number("exponent", exponent, -300, 30);
  f.flag("denormal", denormal);
  scene.fields(f);
}

Outcome ScaledCase::check(const Context& context) const {
  const double scale = std::pow(10.0, exponent);
  SceneCase at = scene;
  at.lamp.placed = false;
  SceneFrame f = at.frame();
  for (glm::dvec3& p : f.vertices) p *= scale;
  f.camera.eye *= scale;
  f.camera.near *= scale;
  if (!f.camera.perspective) f.camera.half_height *= scale;
  if (denormal) f.vertices[0].x = std::numeric_limits<double>::denorm_min();
  return picture_is_the_oracles(make_geometry(f, Config{}, kNumberWidth, kNumberHeight, {.look = at.look()}), Config{},
                                context);
}

void CurveCase::fields(Fields& f) { f.real("linear", linear, 0, 1); }

Outcome CurveCase::check(const Context& context) const {
  const double exact = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  const double got = srgb_encode(linear) * (context.injected(Injection::large_share) ? 65.0 / 64 : 1);
  Outcome o;
  o.measure(std::abs(got - exact) * 255, 0.017);
  // Doubles may fall by their last place from one to the next, not over a step that is seen.
  if (srgb_encode(linear) < srgb_encode(std::max(0.0, linear - 5e-6))) o.fail("it falls");
  o.items = 1;
  return o;
}

void add_number_families(Families& to) {
  add_family<NotFiniteCase>(to, {10, "10", "a number that is not finite is an error that names it", {}, 0, 0.1});
  add_family<ScaledCase>(to, {10, "10 scale", "scenes next to nothing large, and huge"});
  add_family<CurveCase>(to, {0, "curve", "the sRGB curve by square roots", "LSB", 60, 0.2});
}

}  // namespace kage::verif
