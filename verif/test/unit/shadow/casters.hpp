// SPDX-License-Identifier: Apache-2.0
//
// The casters of the tests of shadow/, and how many faces a ray of light meets at most where the light is straight
// above.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "oracle/light_oracle.hpp"
#include "shadow/shadow_caster.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {

struct Caster {
  SceneFrame frame;
  LightPoint light;
  std::vector<CapFace> caps;
  std::vector<SideEdge> sides;
};

/// The faces of all components that cast, turned to the light.
inline std::vector<CapFace> casting_faces(const SceneFrame& f, const LightPoint& light) {
  const ShadowCaster caster(f, light, {}, 1);
  const std::vector<SpaceBox> boxes = component_boxes(f);
  std::vector<CapFace> all;
  std::vector<CapFace> caps;
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    caster.caps(f.components[c], boxes[c], caps);
    all.insert(all.end(), caps.begin(), caps.end());
  }
  return all;
}

/// Triangles as one component, with all faces turned to the light.
inline Caster caster_of(const Solid& s, const LightPoint& light) {
  Caster c;
  add_solid(c.frame, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  c.light = light;
  c.caps = casting_faces(c.frame, light);
  EdgeTable(c.frame).sides(c.frame, c.caps, c.sides);
  return c;
}

/// The most of `caps` that one ray meets, exactly, in the plane that the caster's light sees. The light shines
/// straight down, from infinity or from the origin.
inline int exact_from_above(const Caster& c, std::span<const CapFace> caps) {
  std::vector<ExactPolygon> triangles;
  for (const CapFace& cap : caps) {
    ExactPolygon t;
    for (const std::uint32_t v : c.frame.outline(c.frame.polygons[cap.polygon])) {
      const glm::dvec3& p = c.frame.vertices[v];
      if (c.light.directional)
        t.push_back({Rational(p.x), Rational(-p.z)});
      else  // below the light at the origin
        t.push_back({Rational(p.x) / Rational(-p.y), Rational(-p.z) / Rational(-p.y)});
    }
    if (turn(t[0], t[1], t[2]) < 0) std::swap(t[1], t[2]);
    triangles.push_back(std::move(t));
  }
  return exact_most(triangles);
}

inline LightPoint above(bool directional) {
  LightPoint l;
  l.directional = directional;
  return l;
}

/// Triangles at random below the origin, that have corners in common.
inline Solid random_faces(Random& random, bool directional, bool coarse, int most) {
  Solid s;
  const int points = random.in(3, most - 2);
  for (int k = 0; k < points; ++k) {
    const auto place = [&] { return coarse ? static_cast<double>(random.in(-3, 3)) : random.real(-3, 3); };
    const double y = directional || !coarse ? random.real(-9, -1) : -random.in(1, 2);
    s.vertices.emplace_back(place(), y, place());
  }
  const int faces = random.in(1, most);
  while (static_cast<int>(s.faces.size()) < faces && !random.chance(0.01)) {
    std::array<std::uint32_t, 3> f{};
    for (auto& v : f) v = static_cast<std::uint32_t>(random.in(0, points - 1));
    if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) s.faces.push_back(f);
  }
  return s;
}

}  // namespace kage::verif
