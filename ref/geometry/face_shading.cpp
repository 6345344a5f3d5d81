// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_shading.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>

#include "contract/derived.hpp"
#include "geometry/facing.hpp"

namespace kage {

FaceShading::Shaded FaceShading::shade(std::uint32_t index, std::span<ClipPoint> corners) const {
  const Polygon& face = frame_->polygons[index];
  const auto outline = frame_->outline(face);
  const Triangle& t = frame_->triangles[face.triangle];
  const double facing = facing_of(*frame_, t, normal_of(*frame_, t));
  const FaceSide side(*frame_, *lights_, index, facing > 0 ? 1 : facing < 0 ? -1 : 0);
  Shaded s{!t.unlit && side.takes_shadow(*lights_), 0, {0, 0, 0}, false};
  glm::dvec3 factor{1, 1, 1};
  // A translucent face has no class, since TP knows none.
  if (s.lit && (t.alpha == 255 || config_->translucency == 0)) {
    const std::uint32_t number = table_->number(side);
    s.lit = number > 0;
    factor = table_->before_own_shadow(side, number);
    if (derived::has_table(*config_)) s.normal_class = number;
  }

  const bool by_place = lighting_->depends_on_place(side.sides, side.eye_side);
  std::array<glm::dvec3, kMaxLights> arrive;
  const std::span<glm::dvec3> of_lights = std::span(arrive).first(lighting_->lights());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // More corners than a triangle's share one look.
    const std::uint32_t look = t.shading[corners.size() == 3 ? i : 0];
    const bool as_before = i > 0 && !by_place && (corners.size() > 3 || look == t.shading[i - 1]);
    const ShadingVertex& v = frame_->shading[look];
    if (as_before) {
      corners[i].color = corners[i - 1].color;
    } else if (t.unlit) {
      corners[i].color = Lighting::displayed_unlit(v.color, config_->channels == 1);
    } else {
      const glm::dvec3 towards_eye = facing < 0 ? -v.normal : v.normal;
      lighting_->arriving(frame_->vertices[outline[i]], towards_eye, side.sides, side.eye_side, of_lights);
      glm::dvec3 light{0, 0, 0};
      for (const glm::dvec3& one : of_lights) light += one;
      corners[i].color = glm::min(lighting_->displayed(towards_eye, v.color, light) * factor, glm::dvec3(255));
    }
    s.mean += corners[i].color;
  }
  s.same_color =
      std::all_of(corners.begin(), corners.end(), [&](const ClipPoint& c) { return c.color == corners[0].color; });
  s.mean = s.same_color ? corners[0].color : s.mean / static_cast<double>(corners.size());
  return s;
}

}  // namespace kage
