// SPDX-License-Identifier: Apache-2.0
#include "extremes/scene_case.hpp"

namespace kage::verif {

void TurnCase::fields(Fields& f) {
  f.real("turn_a", a, -2, 2);
  f.real("turn_b", b, -2, 2);
  f.real("turn_c", c, -2, 2);
}

Turn TurnCase::turn() const {
  const double n = 1 + a * a + b * b + c * c;
  const auto row = [n](double x, double y, double z) { return glm::dvec3(x, y, z) / n; };
  return {row(1 + a * a - b * b - c * c, 2 * (a * b + c), 2 * (a * c - b)),
          row(2 * (a * b - c), 1 - a * a + b * b - c * c, 2 * (b * c + a)),
          row(2 * (a * c + b), 2 * (b * c - a), 1 - a * a - b * b + c * c)};
}

void SolidCase::fields(Fields& f) {
  f.choice("kind", kind, std::array{"box", "tetrahedron", "octahedron"});
  f.real("x", x, -3, 3);
  f.real("y", y, -2, 2);
  f.real("z", z, -3, 3);
  f.real("wide", wide, 0.1, 1, 1);
  f.real("high", high, 0.1, 1, 1);
  f.real("deep", deep, 0.1, 1, 1);
  turn.fields(f);
}

Solid SolidCase::solid() const {
  return kind == 0 ? box_solid() : kind == 1 ? tetrahedron_solid() : octahedron_solid();
}

void SolidCase::add_to(SceneFrame& frame, std::size_t index, bool convex) const {
  const double shade = 0.2 + 0.1 * static_cast<double>(index % 8);
  add_solid(frame, solid(), {x, y, z}, {wide, high, deep}, turn.turn(), {shade, 1 - shade, 0.5}, convex);
}

void ViewCase::fields(Fields& f) {
  f.real("eye_x", x, -4, 4);
  f.real("eye_y", y, -1.9, 4);
  f.real("eye_z", z, -4, 4, 4);
  f.real("at_x", at_x, -1, 1);
  f.real("at_y", at_y, -1, 1);
  f.real("at_z", at_z, -1, 1);
  f.flag("parallel", parallel);
  f.real("half_height", half_height, parallel ? 1 : 0.2, parallel ? 4 : 1.2, 1);
  f.real("near", near, 0.02, 1.5, 0.125);
}

void ViewCase::apply_to(Camera& camera) const {
  const glm::dvec3 eye(x, y, z);
  glm::dvec3 at(at_x, at_y, at_z);
  if (glm::dot(eye - at, eye - at) < 1e-6) at = eye - glm::dvec3(0, 0, 1);
  look_at(camera, eye, at);
  camera.perspective = !parallel;
  camera.half_height = half_height;
  camera.near = near;
}

void LampCase::fields(Fields& f) {
  f.flag("placed", placed);
  f.real("light_x", x, -4, 4);
  f.real("light_y", y, -2, 5, 4);
  f.real("light_z", z, -4, 4);
}

void LampCase::apply_to(Light& light) const {
  light.directional = !placed;
  light.position = {x, y, z};
  const double length = std::sqrt(x * x + y * y + z * z);
  light.direction = length > 1e-3 ? glm::dvec3(-x, -y, -z) / length : glm::dvec3(0, -1, 0);
}

void sub_bits_field(Fields& f, int& sub_bits) {
  f.number("sub_bits", sub_bits, kLeastSubBits, kMostSubBits, kMostSubBits);
}

Look look_of(int sub_bits) {
  Look look;
  look.sub_bits = sub_bits;
  return look;
}

void SceneCase::fields(Fields& f, std::size_t least, std::size_t most) {
  f.flag("floor", floor);
  f.flag("convex", convex);
  f.list("solid", solids, least, most);
  view.fields(f);
  lamp.fields(f);
  sub_bits_field(f, sub_bits);
}

SceneFrame SceneCase::frame() const {
  SceneFrame f;
  if (floor) add_solid(f, box_solid(), {0, -2.2, 0}, {5, 0.2, 5}, Turn{}, {0.7, 0.7, 0.7}, convex);
  for (std::size_t i = 0; i < solids.size(); ++i) solids[i].add_to(f, i, convex);
  view.apply_to(f.camera);
  lamp.apply_to(f.lights[0]);
  return f;
}

}  // namespace kage::verif
