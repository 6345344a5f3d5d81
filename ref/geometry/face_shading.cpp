// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_shading.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "geometry/facing.hpp"

namespace kage {
namespace {

bool same_side(double facing, int light_side) {
  return (facing > 0 && light_side > 0) || (facing < 0 && light_side < 0);
}

}  // namespace

FaceShading::FaceShading(const SceneFrame& frame, const Config& config, const SampledLights& lights,
                         const Lighting& lighting, bool has_table)
    : frame_(&frame), config_(&config), lights_(&lights), lighting_(&lighting) {
  if (has_table) lit_faces_.resize(frame.polygons.size());
}

FaceShading::Shaded FaceShading::shade(std::uint32_t index, std::span<ClipPoint> corners) {
  const Polygon& face = frame_->polygons[index];
  const auto outline = frame_->outline(face);
  const Triangle& t = frame_->triangles[face.triangle];
  const glm::dvec3 normal = normal_of(*frame_, t);
  Shaded s{facing_of(*frame_, t, normal), FacePlane(*frame_, face), {}, {0, 0, 0}, false};
  for (std::size_t l = 0; l < lights_->middles.size(); ++l)
    s.lit[l] = same_side(s.facing, lights_->middles[l].facing(s.plane));

  const bool by_place = lighting_->depends_on_place(s.lit);
  const bool grey = config_->channels == 1;
  glm::dvec3 mean_normal{0, 0, 0};
  glm::dvec3 middle{0, 0, 0};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // More corners than a triangle's share one look.
    const std::uint32_t look = t.shading[corners.size() == 3 ? i : 0];
    const ShadingVertex& v = frame_->shading[look];
    const glm::dvec3 towards_eye = s.facing < 0 ? -v.normal : v.normal;
    const glm::dvec3& at = frame_->vertices[outline[i]];
    const bool as_before = i > 0 && !by_place && (corners.size() > 3 || look == t.shading[i - 1]);
    corners[i].color = as_before ? corners[i - 1].color
                       : t.unlit ? Lighting::displayed_unlit(v.color, grey)
                                 : lighting_->displayed(at, towards_eye, v.color, s.lit, grey);
    s.mean += corners[i].color;
    mean_normal += towards_eye;
    middle += at;
  }
  s.same_color =
      std::all_of(corners.begin(), corners.end(), [&](const ClipPoint& c) { return c.color == corners[0].color; });
  s.mean = s.same_color ? corners[0].color : s.mean / static_cast<double>(corners.size());
  if (!lit_faces_.empty()) {
    const double mean_length = length(mean_normal);
    lit_faces_[index] = {mean_length > 0 ? mean_normal / mean_length : mean_normal,
                         middle / static_cast<double>(corners.size()), length(normal), s.lit};
  }
  return s;
}

bool FaceShading::takes_shadow(const Shaded& face) const {
  const std::size_t casting = lights_->casting();
  if (casting == 0) return face.lit[0];
  if (!lit_faces_.empty()) return (face.lit << (kMaxLights - casting)).any();
  return std::all_of(lights_->samples.begin(), lights_->samples.end(),
                     [&](const ShadowCaster& c) { return same_side(face.facing, c.facing(face.plane)); });
}

void FaceShading::classify(LightTable& table, std::span<ScreenPolygon> polygons) const {
  std::vector<std::uint32_t> of_face(frame_->polygons.size(), 0);
  for (ScreenPolygon& p : polygons) {
    if (!p.lit) continue;
    std::uint32_t& number = of_face[p.source];
    const LitFace& face = lit_faces_[p.source];
    if (number == 0) number = table.classify(face.normal, face.middle, face.area, face.lit);
    p.normal_class = number;
  }
}

}  // namespace kage
