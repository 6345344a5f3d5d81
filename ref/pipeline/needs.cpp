// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "geometry/view.hpp"
#include "kage/pipeline.hpp"

namespace kage {
namespace {

bool is_grey(const glm::dvec3& c) { return c.x == c.y && c.y == c.z; }

/// Whether `test` holds for each corner of a component.
template <class Test>
bool each_corner(const SceneFrame& frame, const Component& c, Test test) {
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t)
    for (const std::uint32_t v : frame.triangles[t].vertex)
      if (!test(frame.vertices[v])) return false;
  return true;
}

/// By what a frame shows of a scene, from where its camera is.
class Seen {
 public:
  Seen(const SceneFrame& frame, int width, int height)
      : frame_(&frame),
        view_(frame.camera, width, height, kGreatest.z_bits, {frame.camera.near, 2 * frame.camera.near}),
        width_(width),
        height_(height) {}

  /// No if all of it is beyond one side of the picture, by a pixel and more, or before the near plane.
  [[nodiscard]] bool component(const Component& c) const {
    const auto beyond = [&](auto distance) {
      return each_corner(*frame_, c, [&](const glm::dvec3& at) { return distance(clip(at)) < 0; });
    };
    return !beyond([](const ClipPoint& p) { return p.sx + p.q; }) &&
           !beyond([this](const ClipPoint& p) { return (width_ + 1) * p.q - p.sx; }) &&
           !beyond([](const ClipPoint& p) { return p.sy + p.q; }) &&
           !beyond([this](const ClipPoint& p) { return (height_ + 1) * p.q - p.sy; }) &&
           !beyond([this](const ClipPoint& p) { return p.w - frame_->camera.near * (1 - kNearly); });
  }

  /// Whether all of it is behind the near plane: then the eye is outside, and sees no inner side.
  [[nodiscard]] bool from_outside(const Component& c) const {
    return each_corner(*frame_, c,
                       [&](const glm::dvec3& at) { return clip(at).w > frame_->camera.near * (1 + kNearly); });
  }

 private:
  static constexpr double kNearly = 1e-9;  // more than a distance is rounded by

  [[nodiscard]] ClipPoint clip(const glm::dvec3& at) const { return view_.to_clip(view_.to_eye(at)); }

  const SceneFrame* frame_;
  View view_;
  int width_;
  int height_;
};

/// Needs that depend on where the eye is.
struct SeenNeeds {
  bool shadows = false;
  bool several_volumes = false;
  bool color = false;
  bool translucency = false;

  SeenNeeds& operator|=(const SeenNeeds& o) {
    shadows = shadows || o.shadows;
    several_volumes = several_volumes || o.several_volumes;
    color = color || o.color;
    translucency = translucency || o.translucency;
    return *this;
  }
  bool operator==(const SeenNeeds&) const = default;
};

SeenNeeds seen_needs(const SceneFrame& frame, const Seen* seen) {
  SeenNeeds needs;
  needs.color = std::any_of(frame.lights.begin(), frame.lights.end(), [](const Light& l) { return !is_grey(l.color); });
  std::vector<const Component*> casters;
  for (const Component& c : frame.components) {
    const bool in_view = seen == nullptr || seen->component(c);
    if (c.translucent)
      needs.translucency = needs.translucency || in_view;
    else
      casters.push_back(&c);
    for (std::uint32_t t = c.first; in_view && !needs.color && t < c.first + c.count; ++t)
      for (const std::uint32_t v : frame.triangles[t].shading)
        needs.color = needs.color || !is_grey(frame.shading[v].color);
  }
  needs.several_volumes =
      casters.size() > 1 || std::any_of(casters.begin(), casters.end(), [](const auto* c) { return !c->convex; });
  // From outside, a lone convex body hides no light that arrives at a face of it.
  const bool alone = !needs.several_volumes && seen != nullptr;
  needs.shadows = !casters.empty() && !(alone && seen->from_outside(*casters[0]));
  return needs;
}

}  // namespace

Needs needs_of(const Scene& scene, const SceneFrame& frame, int width, int height, int samples) {
  Needs needs;
  needs.width = width;
  needs.height = height;
  const Seen seen(frame, width, height);
  const SeenNeeds of_seen = seen_needs(frame, &seen);
  needs.shadows = of_seen.shadows;
  needs.several_volumes = of_seen.several_volumes;
  needs.color = of_seen.color;
  needs.translucency = of_seen.translucency;
  needs.smooth = scene.needs_smooth();
  needs.lights = static_cast<int>(frame.lights.size());
  const auto soft = [](const Light& l) { return l.shape != LightShape::point; };
  if (std::any_of(frame.lights.begin(), frame.lights.end(), soft)) needs.samples = samples;
  Config counted;
  counted.count_bits = kGreatest.count_bits;
  Look look;
  look.samples = samples;
  const LightDemand light = light_demand(frame, counted, look);
  needs.share_error = light.share_error;
  needs.color_spread = light.color_spread;
  return needs;
}

Needs needs_of_frames(const Scene& scene, int frames, int width, int height, int samples) {
  const SceneFrame first = scene.frame(0, frames);
  Needs needs = needs_of(scene, first, width, height, samples);
  SeenNeeds all{needs.shadows, needs.several_volumes, needs.color, needs.translucency};
  // Where the first frame has all that the scene could ask for, others have no more.
  for (int i = 1; i < frames && all != seen_needs(first, nullptr); ++i) {
    const SceneFrame frame = scene.frame(i, frames);
    const Seen seen(frame, width, height);
    all |= seen_needs(frame, &seen);
  }
  needs.shadows = all.shadows;
  needs.several_volumes = all.several_volumes;
  needs.color = all.color;
  needs.translucency = all.translucency;
  return needs;
}

}  // namespace kage
