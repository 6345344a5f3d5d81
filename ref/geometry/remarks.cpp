// SPDX-License-Identifier: Apache-2.0
#include "geometry/remarks.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "contract/derived.hpp"
#include "geometry/seen.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

// Where the far plane is taken for the one at which the furthest vertex lies.
constexpr double kFarMargin = 1e-9;
// Longer than this share of the scene's size, a step of depth is worth a word.
constexpr double kLongStep = 1e-4;

class Remarker {
 public:
  Remarker(const SceneFrame& frame, const Config& config, int width, int height, const Look& look)
      : frame_(frame),
        config_(config),
        width_(width),
        height_(height),
        look_(look),
        picture_(frame.camera, width, height),
        eye_points_(eye_points(frame)),
        depth_(depth_range(frame, config, width, height, look, eye_points_)) {}

  Remarks run() {
    find_far();
    find_backs();
    find_coarse_depth();
    return out_;
  }

 private:
  [[nodiscard]] bool in_picture(const Polygon& polygon, double least) {
    return !picture_.of(frame_.outline(polygon), eye_points_, least).empty();
  }

  [[nodiscard]] const Triangle& triangle(const Polygon& p) const { return frame_.triangles[p.triangle]; }

  void find_far() {
    const double far = frame_.camera.far * (1 + kFarMargin);
    if (!(far > 0) || depth_.far < far) return;
    const auto beyond = [&](const Polygon& p) {
      const auto outline = frame_.outline(p);
      return triangle(p).alpha > 0 &&
             std::any_of(outline.begin(), outline.end(), [&](std::uint32_t v) { return eye_points_[v].z > far; }) &&
             in_picture(p, far);
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
        if (!(t.sides == Sides::front ? side < 0 : side > 0) || !in_picture(p, frame_.camera.near)) continue;
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

  // docs/numbers.md, "How long a step of depth is". With perspective steps grow with the distance. The far end is never
  // nearer than what is seen, so where steps are short there, no face is looked at.
  void find_coarse_depth() {
    SpaceBox box;
    for (const glm::dvec3& p : frame_.vertices) box.add(p);
    const double most = kLongStep * box.diagonal();
    const View view(frame_.camera, width_, height_, config_.z_bits, depth_);
    if (!(view.step(depth_.far) > most)) return;
    const double furthest = furthest_seen(frame_, config_, width_, height_, look_, eye_points_);
    if (furthest == 0 || !(view.step(furthest) > most)) return;
    const double steps = view.step(furthest) / most * static_cast<double>(derived::most_depth(config_) - 1);
    out_.step = view.step(furthest);
    out_.furthest = furthest;
    out_.extent = box.diagonal();
    Config wider = config_;
    for (wider.z_bits = config_.z_bits + 1; wider.z_bits <= kGreatest.z_bits && out_.z_bits_needed == 0; ++wider.z_bits)
      if (static_cast<double>(derived::most_depth(wider) - 1) >= steps) out_.z_bits_needed = wider.z_bits;
  }

  const SceneFrame& frame_;
  const Config& config_;
  int width_;
  int height_;
  const Look& look_;
  PictureCut picture_;
  std::vector<EyePoint> eye_points_;  // of the frame's vertices
  DepthRange depth_;
  Remarks out_;
};

}  // namespace

Remarks remarks(const SceneFrame& frame, const Config& config, int width, int height, const Look& look) {
  return Remarker(frame, config, width, height, look).run();
}

}  // namespace kage
