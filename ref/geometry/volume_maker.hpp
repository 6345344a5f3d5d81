// SPDX-License-Identifier: Apache-2.0
//
// Shadow volumes on the screen: their faces as snapped polygons, and their section with the near plane.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "geometry/screen_faces.hpp"
#include "shadow/shadow_caster.hpp"

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
        out_(&out),
        component_of_(frame.polygons.size()) {
    for (std::uint32_t c = 0; c < frame.components.size(); ++c)
      std::fill_n(component_of_.begin() + frame.components[c].first_polygon, frame.components[c].polygon_count, c);
  }

  /// Append the volume to the geometry, unless nothing of it is there. `caster` is that of light sample `sample`;
  /// `component`: that of the volume's first caster. `casts`: by component whether its part of the volume is wanted,
  /// which is closed by itself.
  void add(const WorldVolume& w, const ShadowCaster& caster, std::uint32_t sample, std::uint32_t component,
           const std::vector<bool>& casts);

 private:
  void add_cap(const CapFace& cap);
  void add_side(const SideEdge& s);
  void add_far_end(const CapFace& cap);
  [[nodiscard]] bool clip_face(std::int32_t w);
  void add_polygon(std::int32_t w, const ScreenPlane& plane, const std::vector<ClipPoint>& outline);
  [[nodiscard]] bool start_at_cap(const DrawnRange& cap, std::int64_t side_slope);
  [[nodiscard]] std::optional<ScreenPlane> whole_plane(std::int64_t bound) const;
  void add_joined(std::int32_t w, const ScreenPlane& truth, std::span<const ScreenVertex> cap);
  void cut_only();
  void clip_and_cut(std::int32_t w);
  [[nodiscard]] EyePoint far_point(std::uint32_t vertex) const;
  [[nodiscard]] bool is_edge_on(const ScreenPlane& cap, const ScreenVertex& at, const ClipPoint& corner) const;

  const SceneFrame* frame_;
  const View* view_;
  Clipper* clipper_;
  std::span<const EyePoint> eye_points_;
  std::span<const DrawnRange> drawn_;
  bool far_ends_;
  ScreenFaces faces_;
  FrameGeometry* out_;
  std::vector<std::uint32_t> component_of_;  // of each polygon
  const ShadowCaster* caster_ = nullptr;     // of the volume being made
  double factor_ = 1;
  std::vector<EyePoint> points_;
  std::vector<ClipPoint> polygon_;
  std::vector<DepthVertex> ring_;
  std::vector<ClipPoint> piece_;
  std::vector<NearCut> cuts_;
};

}  // namespace kage
