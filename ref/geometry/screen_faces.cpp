// SPDX-License-Identifier: Apache-2.0
#include "geometry/screen_faces.hpp"

#include <glm/geometric.hpp>

namespace kage {

void ScreenFaces::add(ScreenPolygon p, const std::vector<ClipPoint>& outline) {
  p.first_vertex = static_cast<std::uint32_t>(out_->vertices.size());
  p.vertex_count = static_cast<std::uint32_t>(outline.size());
  for (const ClipPoint& c : outline) out_->vertices.push_back(snap(c));
  out_->polygons.push_back(p);
}

ScreenPlane ScreenFaces::face_plane(std::size_t corners, const std::array<EyePoint, 3>& t,
                                    const std::vector<ClipPoint>& clipped) const {
  if (corners == 3) {
    const std::array<ClipPoint, 3> p{view_->to_clip(t[0]), view_->to_clip(t[1]), view_->to_clip(t[2])};
    if (clipper_->keeps(p[0]) && clipper_->keeps(p[1]) && clipper_->keeps(p[2]))
      if (const auto plane = plane_through({depth_vertex(p[0]), depth_vertex(p[1]), depth_vertex(p[2])})) return *plane;
  }
  return unsnapped_plane(t[0], t[1], t[2], clipped);
}

ScreenPlane ScreenFaces::unsnapped_plane(const EyePoint& a, const EyePoint& b, const EyePoint& c,
                                         const std::vector<ClipPoint>& clipped) const {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  if (const auto plane = view_->depth_plane(normal, a, clipped[0])) return *plane;
  double sum = 0;
  for (const ClipPoint& p : clipped) sum += view_->depth(p.w);
  return View::flat_plane(sum / static_cast<double>(clipped.size()));
}

}  // namespace kage
