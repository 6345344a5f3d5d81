// SPDX-License-Identifier: Apache-2.0
//
// Remarks for a person on the pictures of a scene's frames, summed up over the frames.
#pragma once

#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/cosim.hpp"
#include "kage/scene.hpp"

namespace kage::cosim {

class FrameRemarks {
 public:
  /// `cull`: as --cull. Refers to nothing that is given.
  FrameRemarks(const Config& config, const Size& size, bool cull) : config_(config), size_(size), cull_(cull) {}

  void add(const Scene& scene, const SceneFrame& frame);

  /// Adds the remarks of frames that come behind these.
  void absorb(const FrameRemarks& later);

  /// A sentence for each kind of remark, with the number of frames that it is about unless that is all.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  Config config_;
  Size size_;
  bool cull_;
  int frames_ = 0;
  int far_ = 0;             // frames with something beyond the camera's far plane,
  int backs_ = 0;           // with a face seen from behind, though the file says that it shows nothing there,
  int coarse_ = 0;          // in which a step of depth is long,
  std::string coarse_why_;  // as in the first of these
};

/// Sentences of a scene before it is drawn: what was ignored or added, and whether its camera asks for pictures of
/// another shape than the default. `first`: its first frame.
std::vector<std::string> scene_notes(const Scene& scene, const SceneFrame& first, const SourceOptions& options);

/// " in 2 of 8 frames", or nothing if it is all.
std::string in_frames(int some, int all);

}  // namespace kage::cosim
