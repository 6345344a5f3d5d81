// SPDX-License-Identifier: Apache-2.0
//
// Scenes made of simple solids whose topology is known, for tests and benchmarks.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "kage/scene.hpp"
#include "scene/polygons.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// A rotation as three orthonormal columns.
struct Turn {
  glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p) const { return x * p.x + y * p.y + z * p.z; }
};

inline glm::dvec3 random_direction(Random& random) {
  for (;;) {
    const glm::dvec3 v{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
    const double n = glm::dot(v, v);
    if (n > 0.01 && n <= 1) return v / std::sqrt(n);
  }
}

inline Turn random_turn(Random& random) {
  const glm::dvec3 x = random_direction(random);
  glm::dvec3 other = random_direction(random);
  while (std::abs(glm::dot(x, other)) > 0.9) other = random_direction(random);
  const glm::dvec3 y = glm::normalize(glm::cross(x, other));
  return {x, y, glm::cross(x, y)};
}

struct Solid {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;  // counter-clockwise from outside
};

inline Solid box_solid() {
  Solid s;
  for (unsigned i = 0; i < 8; ++i) s.vertices.emplace_back(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
  for (const std::array<std::uint32_t, 4>& q : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                                                {1, 3, 7, 5},
                                                {0, 1, 5, 4},
                                                {2, 6, 7, 3},
                                                {0, 2, 3, 1},
                                                {4, 5, 7, 6}}) {
    s.faces.push_back({q[0], q[1], q[2]});
    s.faces.push_back({q[0], q[2], q[3]});
  }
  return s;
}

inline Solid tetrahedron_solid() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

inline Solid octahedron_solid() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// A rectangle from -1 to 1 in x and y.
inline Solid pane_solid() { return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

/// A sphere as generators make it that know no poles: `rings` rings of twice as many vertices, in single precision. At
/// the lower pole they lie on a circle of radius sin(M_PI), 1.2e-16, so that half of the triangles there are next to
/// nothing wide, but no less faces than others. Elsewhere what is 0 but for rounding is 0.
inline Solid raw_sphere_solid(unsigned rings) {
  Solid s;
  const unsigned segments = 2 * rings;
  const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  for (unsigned i = 0; i <= rings; ++i)
    for (unsigned j = 0; j < segments; ++j) {
      const double r = i == 0 ? 0 : std::sin(M_PI * i / rings);
      const auto number = [&](double x) { return i < rings && std::abs(x) < 1e-9 ? 0.0 : single(x); };
      s.vertices.emplace_back(number(r * std::cos(M_PI * j / rings)), number(std::cos(M_PI * i / rings)),
                              number(r * std::sin(M_PI * j / rings)));
    }
  for (unsigned i = 0; i < rings; ++i)
    for (unsigned j = 0; j < segments; ++j) {
      const unsigned a = i * segments + j;
      const unsigned b = i * segments + (j + 1) % segments;
      if (i > 0) s.faces.push_back({a, b, b + segments});  // at the upper pole it is a line
      s.faces.push_back({a, b + segments, a + segments});
    }
  return s;
}

/// Add a solid as one component: p -> centre + turn(scale * p).
inline void add_solid(SceneFrame& f, const Solid& s, const glm::dvec3& centre, const glm::dvec3& scale,
                      const Turn& turn, const glm::dvec3& color, bool convex = true, bool closed = true,
                      std::uint8_t alpha = 255) {
  const auto base = static_cast<std::uint32_t>(f.vertices.size());
  for (const glm::dvec3& p : s.vertices) f.vertices.push_back(centre + turn(p * scale));
  Component c;
  c.first = static_cast<std::uint32_t>(f.triangles.size());
  c.count = static_cast<std::uint32_t>(s.faces.size());
  c.closed = closed;
  c.convex = convex;
  c.translucent = alpha < 255;
  std::vector<scene::Corners> triangles;
  std::vector<scene::Corners> shading_corners;
  for (const auto& face : s.faces) {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i) t.vertex[i] = base + face[i];
    triangles.push_back(t.vertex);
    const glm::dvec3 a = f.vertices[t.vertex[0]];
    const glm::dvec3 n = glm::cross(f.vertices[t.vertex[1]] - a, f.vertices[t.vertex[2]] - a);
    const auto shading = static_cast<std::uint32_t>(f.shading.size());
    const double length = std::sqrt(glm::dot(n, n));
    f.shading.push_back({length > 0 ? n / length : glm::dvec3(0, 0, 1), color});  // too thin for doubles: any
    t.shading = {shading, shading, shading};
    t.alpha = alpha;
    shading_corners.push_back(t.shading);
    f.triangles.push_back(t);
  }
  c.first_polygon = static_cast<std::uint32_t>(f.polygons.size());
  const std::vector<scene::Surface> surfaces(triangles.size(), {alpha, false, Sides::both});
  scene::append_polygons(f.vertices, triangles, shading_corners, f.shading, surfaces, c.first,
                         convex && closed && alpha == 255, f.polygons, f.corners);
  c.polygon_count = static_cast<std::uint32_t>(f.polygons.size()) - c.first_polygon;
  f.components.push_back(c);
}

/// Add a translucent solid; a pane is neither closed nor convex.
inline void add_glass(SceneFrame& f, const Solid& s, const glm::dvec3& centre, const glm::dvec3& scale,
                      const Turn& turn, const glm::dvec3& color, std::uint8_t alpha) {
  const bool closed = s.faces.size() > 2;
  add_solid(f, s, centre, scale, turn, color, closed, closed, alpha);
}

inline void look_at(Camera& c, const glm::dvec3& eye, const glm::dvec3& target) {
  c.eye = eye;
  c.forward = glm::normalize(target - eye);
  const glm::dvec3 up = std::abs(c.forward.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  c.right = glm::normalize(glm::cross(c.forward, up));
  c.up = glm::cross(c.right, c.forward);
}

/// Solids strewn about the origin, on a floor or not; eye and light at random, often inside or close to something.
inline SceneFrame random_scene(Random& random, int solids, bool convex_flag = true) {
  SceneFrame f;
  if (random.chance(0.7)) add_solid(f, box_solid(), {0, -2.2, 0}, {5, 0.2, 5}, Turn{}, {0.7, 0.7, 0.7}, convex_flag);
  for (int i = 0; i < solids; ++i) {
    const int kind = random.in(0, 2);
    const Solid s = kind == 0 ? box_solid() : kind == 1 ? tetrahedron_solid() : octahedron_solid();
    add_solid(f, s, {random.real(-3, 3), random.real(-2, 2), random.real(-3, 3)},
              {random.real(0.1, 1), random.real(0.1, 1), random.real(0.1, 1)},
              random.chance(0.3) ? Turn{} : random_turn(random),
              {random.real(0.2, 1), random.real(0.2, 1), random.real(0.2, 1)}, convex_flag);
  }
  look_at(f.camera, {random.real(-4, 4), random.real(-1.9, 4), random.real(-4, 4)},
          {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)});
  f.camera.perspective = random.chance(0.8);
  f.camera.half_height = f.camera.perspective ? random.real(0.2, 1.2) : random.real(1, 4);
  f.camera.near = random.real(0.02, 1.5);
  f.lights[0].directional = random.chance(0.5);
  f.lights[0].direction = random_direction(random);
  f.lights[0].position = {random.real(-4, 4), random.real(-2, 5), random.real(-4, 4)};
  return f;
}

}  // namespace kage::verif
