// SPDX-License-Identifier: Apache-2.0
#include "geometry/remarks.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "contract/derived.hpp"
#include "geometry/view.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

// Where the far plane is taken for the one at which the furthest vertex lies.
constexpr double kFarMargin = 1e-9;

class Remarker {
 public:
  Remarker(const SceneFrame& frame, const Config& config, int width, int height)
      : frame_(frame),
        view_(frame.camera, width, height, config.z_bits, furthest(frame)),
        range_(static_cast<double>(derived::most_depth(config) - 1)),
        height_(height),
        slope_y_(frame.camera.half_height),
        slope_x_(frame.camera.half_height * width / height) {
    for (const glm::dvec3& p : frame.vertices) eye_points_.push_back(view_.to_eye(p));
  }

  Remarks run() {
    find_far();
    find_backs();
    if (frame_.camera.perspective) find_coarse_depth();
    return out_;
  }

 private:
  // What of a polygon lies in the picture, before the near plane and beyond `least`: its corners in eye space.
  std::span<const EyePoint> in_picture(const Polygon& polygon, double least) {
    corners_.clear();
    for (const std::uint32_t v : frame_.outline(polygon)) corners_.push_back(eye_points_[v]);
    const bool perspective = frame_.camera.perspective;
    const auto across = [&](const EyePoint& p) { return perspective ? p.z : 1.0; };
    cut([&](const EyePoint& p) { return p.z - least; });
    cut([&](const EyePoint& p) { return slope_x_ * across(p) - p.x; });
    cut([&](const EyePoint& p) { return slope_x_ * across(p) + p.x; });
    cut([&](const EyePoint& p) { return slope_y_ * across(p) - p.y; });
    cut([&](const EyePoint& p) { return slope_y_ * across(p) + p.y; });
    return corners_;
  }

  // Keep what of corners_ has inside() >= 0.
  template <class Inside>
  void cut(Inside inside) {
    buffer_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const EyePoint& a = corners_[i];
      const EyePoint& b = corners_[i + 1 == corners_.size() ? 0 : i + 1];
      const double da = inside(a);
      const double db = inside(b);
      if (da >= 0) buffer_.push_back(a);
      if ((da >= 0) != (db >= 0)) buffer_.push_back(a + da / (da - db) * (b - a));
    }
    corners_.swap(buffer_);
  }

  [[nodiscard]] const Triangle& triangle(const Polygon& p) const { return frame_.triangles[p.triangle]; }

  void find_far() {
    const double far = frame_.camera.far * (1 + kFarMargin);
    if (!(far > 0) || furthest(frame_) < far) return;
    const auto beyond = [&](const Polygon& p) {
      const auto outline = frame_.outline(p);
      return triangle(p).alpha > 0 &&
             std::any_of(outline.begin(), outline.end(), [&](std::uint32_t v) { return eye_points_[v].z > far; }) &&
             !in_picture(p, far).empty();
    };
    out_.beyond_far = std::any_of(frame_.polygons.begin(), frame_.polygons.end(), beyond);
  }

  // The inside of a closed opaque body is seen from within it only, unless its faces are meant to be seen from there.
  void find_backs() {
    for (const Component& part : frame_.components) {
      const auto faces = std::span(frame_.polygons).subspan(part.first_polygon, part.polygon_count);
      const bool shut = part.closed && !part.translucent && !surrounds_eye(part);
      for (const Polygon& p : faces) {
        const Triangle& t = triangle(p);
        if (t.sides == Sides::both || t.alpha == 0 || (shut && t.sides == Sides::front)) continue;
        const double side = facing(t);
        if (!(t.sides == Sides::front ? side < 0 : side > 0) || in_picture(p, frame_.camera.near).empty()) continue;
        out_.backs = true;
        return;
      }
    }
  }

  // In eye space, where the eye is the origin.
  [[nodiscard]] double facing(const Triangle& t) const {
    const EyePoint& a = eye_points_[t.vertex[0]];
    // The axes of eye space are left-handed, so the product is turned.
    const glm::dvec3 normal = glm::cross(eye_points_[t.vertex[2]] - a, eye_points_[t.vertex[1]] - a);
    return frame_.camera.perspective ? -glm::dot(normal, a) : -normal.z;
  }

  // How often a closed body winds round the eye, by the faces that a ray into an odd direction meets.
  [[nodiscard]] bool surrounds_eye(const Component& part) const {
    const glm::dvec3 way{0.3819660112501051, 0.2360679774997897, 0.8934663516839487};
    SpaceBox box;
    int winding = 0;
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i)
      for (const std::uint32_t v : frame_.triangles[i].vertex) box.add(eye_points_[v]);
    if (!box.contains({0, 0, 0})) return false;
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      const auto& v = frame_.triangles[i].vertex;
      const EyePoint& a = eye_points_[v[0]];
      const EyePoint& b = eye_points_[v[1]];
      const EyePoint& c = eye_points_[v[2]];
      const double s0 = glm::dot(way, glm::cross(a, b));
      const double s1 = glm::dot(way, glm::cross(b, c));
      const double s2 = glm::dot(way, glm::cross(c, a));
      const bool forth = s0 > 0 && s1 > 0 && s2 > 0;
      const bool back = s0 < 0 && s1 < 0 && s2 < 0;
      const bool ahead = glm::dot(a, glm::cross(b, c)) * (forth ? 1 : -1) > 0;
      if ((forth || back) && ahead) winding += forth ? 1 : -1;
    }
    return winding != 0;
  }

  // docs/numbers.md, "A near plane too near": fine enough where two steps at the nearest surface are no longer than a
  // pixel is wide there.
  void find_coarse_depth() {
    const Camera& camera = frame_.camera;
    const double least_steps = height_ / camera.half_height;
    const double limit = view_.steps_beyond(1) / least_steps;  // no surface nearer than this asks for more
    double nearest = std::numeric_limits<double>::infinity();
    for (const Polygon& p : frame_.polygons) {
      const auto outline = frame_.outline(p);
      const auto closer = [&](std::uint32_t v) { return eye_points_[v].z < nearest; };
      if (triangle(p).alpha == 0 || std::none_of(outline.begin(), outline.end(), closer)) continue;
      for (const EyePoint& corner : in_picture(p, camera.near)) nearest = std::min(nearest, corner.z);
      if (nearest <= limit) return;
    }
    if (nearest == std::numeric_limits<double>::infinity()) return;
    const double needed = nearest / (range_ / least_steps + nearest / furthest(frame_));
    if (!(needed < nearest)) return;  // no near plane would do: it is the configuration that has too few
    out_.nearest = nearest;
    out_.steps = view_.steps_beyond(nearest);
    out_.near_needed = needed;
  }

  const SceneFrame& frame_;
  View view_;
  double range_;
  double height_;
  double slope_y_;  // half the picture's height and width: per distance (perspective) or as they are
  double slope_x_;
  std::vector<EyePoint> eye_points_;  // of the frame's vertices
  std::vector<EyePoint> corners_;
  std::vector<EyePoint> buffer_;
  Remarks out_;
};

}  // namespace

Remarks remarks(const SceneFrame& frame, const Config& config, int width, int height) {
  return Remarker(frame, config, width, height).run();
}

}  // namespace kage
