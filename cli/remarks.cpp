// SPDX-License-Identifier: Apache-2.0
#include "remarks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "contract/derived.hpp"
#include "geometry/remarks.hpp"

namespace kage::cli {
namespace {

/// x, rounded up to one digit that is not 0.
double rounded_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)));
  return std::ceil(x / unit) * unit;
}

}  // namespace

std::string in_frames(int some, int all) {
  return some == all ? std::string() : fmt::format(" in {} of {} frames", some, all);
}

void FrameRemarks::add(const Scene& scene, const SceneFrame& frame) {
  const Remarks r = remarks(frame, config_, size_.width, size_.height);
  ++frames_;
  far_ += r.beyond_far ? 1 : 0;
  backs_ += r.backs && !cull_ && scene.contents().says_sides ? 1 : 0;
  if (r.nearest == 0 || coarse_++ > 0) return;
  coarse_why_ = fmt::format(
      "the nearest surface lies {:.3g} from the eye, the camera's znear is {:.3g}; of {} steps of depth that leaves "
      "{:.3g} for this surface and all behind it; a znear from {:.3g} to {:.3g} would do",
      r.nearest, frame.camera.near, derived::most_depth(config_) - 1, r.steps, rounded_up(r.near_needed), r.nearest);
}

void FrameRemarks::absorb(const FrameRemarks& later) {
  frames_ += later.frames_;
  far_ += later.far_;
  backs_ += later.backs_;
  if (coarse_ == 0) coarse_why_ = later.coarse_why_;
  coarse_ += later.coarse_;
}

std::vector<std::string> FrameRemarks::notes() const {
  std::vector<std::string> all;
  if (far_ > 0)
    all.push_back(fmt::format("the camera's zfar is ignored: things beyond it are drawn{}", in_frames(far_, frames_)));
  if (backs_ > 0)
    all.push_back(
        fmt::format("the backs of single-sided faces are drawn{}: --cull leaves them out", in_frames(backs_, frames_)));
  if (coarse_ > 0) all.push_back(fmt::format("depth is coarse{}: {}", in_frames(coarse_, frames_), coarse_why_));
  return all;
}

}  // namespace kage::cli
