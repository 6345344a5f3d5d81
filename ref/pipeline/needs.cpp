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

/// Needs that may differ from frame to frame.
struct FrameNeeds {
  bool shadows = false;
  bool several_volumes = false;
  bool color = false;
  bool translucency = false;
  bool soft = false;
  int lights = 1;

  FrameNeeds& operator|=(const FrameNeeds& o) {
    shadows = shadows || o.shadows;
    several_volumes = several_volumes || o.several_volumes;
    color = color || o.color;
    translucency = translucency || o.translucency;
    soft = soft || o.soft;
    lights = std::max(lights, o.lights);
    return *this;
  }
};

/// Whether --cull would show inner sides of a closed body: it is inside out, and has one side.
bool shows_inside(const SceneFrame& frame, const Component& c) {
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t)
    if (frame.triangles[t].sides == Sides::back) return true;
  return false;
}

FrameNeeds frame_needs(const SceneFrame& frame, int width, int height) {
  const Seen seen(frame, width, height);
  FrameNeeds needs;
  needs.lights = static_cast<int>(frame.lights.size());
  for (const Light& l : frame.lights) {
    needs.color = needs.color || !is_grey(l.color);
    needs.soft = needs.soft || l.shape != LightShape::point;
  }
  std::vector<const Component*> casters;
  for (const Component& c : frame.components) {
    const bool in_view = seen.component(c);
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
  const bool none = casters.empty() ||
                    (!needs.several_volumes && seen.from_outside(*casters[0]) && !shows_inside(frame, *casters[0]));
  needs.shadows = !none;
  return needs;
}

Needs needs_by(const Scene& scene, const SceneFrame& first, const FrameNeeds& of, int width, int height, int samples) {
  Needs needs;
  needs.width = width;
  needs.height = height;
  needs.shadows = of.shadows;
  needs.several_volumes = of.several_volumes;
  needs.color = of.color;
  needs.translucency = of.translucency;
  needs.smooth = scene.needs_smooth();
  needs.lights = of.lights;
  if (of.soft) needs.samples = samples;
  Config counted;
  counted.count_bits = kGreatest.count_bits;
  Look look;
  look.samples = samples;
  const LightDemand light = light_demand(first, counted, look);
  if (needs.shadows) needs.share_error = light.share_error;
  needs.color_spread = light.color_spread;
  return needs;
}

}  // namespace

Needs needs_of(const Scene& scene, const SceneFrame& frame, int width, int height, int samples) {
  return needs_by(scene, frame, frame_needs(frame, width, height), width, height, samples);
}

Needs needs_of_frames(const Scene& scene, int frames, int width, int height, int samples,
                      const std::function<void()>& step) {
  const SceneFrame first = scene.frame(0, frames);
  FrameNeeds all = frame_needs(first, width, height);
  for (int i = 1; i < frames; ++i) {
    if (step) step();
    all |= frame_needs(scene.frame(i, frames), width, height);
  }
  return needs_by(scene, first, all, width, height, samples);
}

}  // namespace kage
