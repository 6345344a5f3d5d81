// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/remarks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "contract/derived.hpp"
#include "geometry/remarks.hpp"

namespace kage::cosim {
namespace {

// Shapes of pictures that differ by less are the same to the eye.
constexpr double kShapeTolerance = 0.01;

std::string coarse_text(const Remarks& r, int z_bits, int exponent) {
  const std::string would_do = r.z_bits_needed > 0 ? fmt::format("Z_BITS {} would do", r.z_bits_needed)
                                                   : fmt::format("no Z_BITS up to {} would do", kGreatest.z_bits);
  return fmt::format(
      "with Z_BITS {} surfaces {:.3g} from the eye may be {:.3g} apart and have one depth, more than 1/10000 of the "
      "scene's extent of {:.3g}; {}",
      z_bits, std::ldexp(r.furthest, exponent), std::ldexp(r.step, exponent), std::ldexp(r.extent, exponent), would_do);
}

}  // namespace

std::string in_frames(int some, int all) {
  return some == all ? std::string() : fmt::format(" in {} of {} frames", some, all);
}

std::vector<std::string> scene_notes(const Scene& scene, const SceneFrame& first, const SourceOptions& options) {
  std::vector<std::string> all = scene.notes();
  const double shape = static_cast<double>(options.size.width) / options.size.height;
  const double asked = first.camera.aspect;
  if (!options.size_given && asked > 0 && std::abs(shape / asked - 1) > kShapeTolerance)
    all.push_back(
        fmt::format("the camera's own pictures are {:.3g} times as wide as high, these {:.3g}: --size is "
                    "to be had in its shape",
                    asked, shape));
  return all;
}

void FrameRemarks::add(const Scene& scene, const SceneFrame& frame) {
  Look look;
  look.cull = cull_;
  const Remarks r = remarks(frame, config_, size_.width, size_.height, look);
  ++frames_;
  far_ += r.beyond_far ? 1 : 0;
  backs_ += r.backs && !cull_ && scene.contents().says_sides ? 1 : 0;
  if (r.step > 0 && coarse_++ == 0) coarse_why_ = coarse_text(r, config_.z_bits, frame.exponent);
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

}  // namespace kage::cosim
