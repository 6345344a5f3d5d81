// SPDX-License-Identifier: Apache-2.0
//
// Shadow volumes on the screen: their faces as snapped polygons, and their section with the near plane.
#pragma once

#include <span>
#include <vector>

#include "geometry/screen_faces.hpp"
#include "geometry/shadow_volume.hpp"

namespace kage {

class VolumeMaker {
 public:
  /// `eye_points`: the frame's vertices. `drawn`: of each polygon of the frame what was drawn. `far_ends`:
  /// Look::far_ends.
  VolumeMaker(const SceneFrame& frame, const View& view, Clipper& clipper, std::span<const EyePoint> eye_points,
              std::span<const DrawnRange> drawn, bool far_ends, FrameGeometry& out)
      : frame_(&frame),
        view_(&view),
        clipper_(&clipper),
        eye_points_(eye_points),
        drawn_(drawn),
        far_ends_(far_ends),
        faces_(view, clipper, out),
        out_(&out) {}

  /// Append the volume, which light sample `sample` makes, to the geometry, unless nothing of it is there.
  void add(const WorldVolume& w, std::uint32_t sample);

 private:
  void add_side(const SideFace& s);
  template <class MakePlane>
  void add_face(MakePlane make_plane);
  void cut_only();
  void clip_and_cut();
  [[nodiscard]] ScreenPlane side_plane(const DrawnRange& cap, const EyePoint& a, const EyePoint& b,
                                       const EyePoint& c) const;

  const SceneFrame* frame_;
  const View* view_;
  Clipper* clipper_;
  std::span<const EyePoint> eye_points_;
  std::span<const DrawnRange> drawn_;
  bool far_ends_;
  ScreenFaces faces_;
  FrameGeometry* out_;
  std::vector<EyePoint> points_;
  std::vector<ClipPoint> polygon_;
  std::vector<NearCut> cuts_;
};

}  // namespace kage
