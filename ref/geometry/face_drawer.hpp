// SPDX-License-Identifier: Apache-2.0
// A face of the frame to polygons of the picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/dicer.hpp"
#include "geometry/face_shading.hpp"
#include "geometry/screen_faces.hpp"

namespace kage {

/// The frame's vertices, seen from the camera and on the screen.
struct FramePoints {
  /// `seen`: the frame's vertices, by eye_points().
  FramePoints(std::vector<EyePoint> seen, const ScreenFaces& faces);

  std::vector<EyePoint> eye;
  std::vector<ScreenPoint> screen;
};

/// Refers to what it is made of.
class FaceDrawer {
 public:
  /// `points`: the frame's vertices, by eye_points().
  FaceDrawer(const SceneFrame& frame, std::vector<EyePoint> points, const Config& config, const View& view,
             Clipper& clipper, const FaceShading& shading, int max_shading, FrameGeometry& out);

  /// Appends what is seen of the face to the polygons, and notes which they are.
  void draw(std::uint32_t index);
  /// Likewise a face that is a cap alone, whose colours nobody sees.
  void draw_unseen(std::uint32_t index);

  /// The state of all that has been drawn, and the way back to it: faces after it are not to be drawn.
  struct Mark {
    std::size_t polygons;
    std::size_t vertices;
    std::size_t color_planes;
    std::size_t shade_cuts;
    std::size_t shades;
  };
  [[nodiscard]] Mark mark() const;
  void undo_to(const Mark& mark);

  /// The face that was drawn last is not to be drawn: its polygon, one, goes again.
  void undo(std::uint32_t index);

  [[nodiscard]] const FramePoints& points() const { return points_; }
  [[nodiscard]] const std::vector<DrawnRange>& drawn() const { return drawn_; }  ///< by SceneFrame::polygons

 private:
  void add_fan(const ScreenPolygon& base, const FaceShading::Shaded& shaded);
  [[nodiscard]] bool has_one_light(const FaceShading::Shaded& shaded) const;
  [[nodiscard]] bool is_linear(const FaceShading::Shaded& shaded);
  [[nodiscard]] ScreenPlane depth_plane(std::span<const std::uint32_t> corners, const Triangle& t, bool whole) const;

  const SceneFrame* frame_;
  const Config* config_;
  Clipper* clipper_;
  const FaceShading* shading_;
  FrameGeometry* out_;
  ScreenFaces faces_;
  Dicer dicer_;
  FramePoints points_;
  std::vector<DrawnRange> drawn_;
  bool diced_ = true;
  // Outline of the face being drawn:
  std::vector<ClipPoint> polygon_;
  std::vector<ScreenVertex> snapped_;
};

}  // namespace kage
