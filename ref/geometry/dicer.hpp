// SPDX-License-Identifier: Apache-2.0
//
// Dicing: a drawn triangle's colour in parts, each linear on the screen, so that all of them are near the light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/face_shading.hpp"
#include "geometry/screen_faces.hpp"

namespace kage {

/// Parts triangles of the picture by halves of their longest edges until colour is within Look::max_shading of light,
/// or an edge is a few pixels long. Light is looked at on a grid of pixels, so what is narrower than its step may be
/// missed. Refers to what it is made of.
class Dicer {
 public:
  Dicer(const View& view, const ScreenFaces& faces, const FaceShading& shading, int max_shading, FrameGeometry& out)
      : view_(&view), faces_(&faces), shading_(&shading), max_shading_(max_shading), out_(&out) {}

  /// Dices a triangle of a face between three points that clipping has left, with the colours of these. Where no cut is
  /// needed it is a part by itself: then `triangle` and the class are those of the part.
  /// @return ScreenPolygon::shade_cut: the first cut, or -1
  std::int32_t dice(const FaceShading::Shaded& face, std::span<ClipPoint, 3> triangle, std::uint32_t& normal_class);

  /// The planes of a triangle's linear light: ScreenPolygon::light_planes.
  std::uint32_t add_light(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle);
  /// The same of a triangle that has one light all over.
  std::uint32_t add_light(const FaceShading::Light& light);

  /// Whether a triangle is not what the face is all over: dice() would cut it, or give it another class.
  [[nodiscard]] bool differs(const FaceShading::Shaded& face, const std::array<ClipPoint, 3>& triangle);

 private:
  /// A corner on the screen, with the colour of its place.
  struct Corner {
    double x;
    double y;
    ClipPoint clip;
    std::optional<FaceShading::Place> place;  // once it is asked for
    FaceShading::Light light;                 // of a face with linear light
  };
  using Corners = std::array<std::uint32_t, 3>;  // into corners_

  /// It is not too small, and colour varies.
  [[nodiscard]] bool may_cut(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle) const;
  [[nodiscard]] const Corner& at(std::uint32_t corner) const { return corners_[corner]; }
  [[nodiscard]] Corners begin(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle);
  std::uint32_t add(const FaceShading::Shaded& face, const ClipPoint& p);
  [[nodiscard]] ClipPoint between(const Corners& t, const glm::dvec3& part) const;
  /// The edge that begins at a corner and is the longest, and its length.
  struct Edge {
    std::size_t from;
    double length;
  };
  [[nodiscard]] Edge longest_edge(const Corners& t) const;
  /// The rectangle of the picture in which a part lies.
  struct Window {
    double x0;
    double x1;
    double y0;
    double y1;
  };
  [[nodiscard]] std::optional<Window> window(const Corners& t) const;
  [[nodiscard]] bool off(const FaceShading::Shaded& face, const Corners& t, const Window& in) const;
  [[nodiscard]] bool is_off(const FaceShading::Shaded& face, const Corners& t, const glm::dvec3& part,
                            const ClipPoint& p) const;
  std::uint32_t add_light(const Corners& t);
  [[nodiscard]] bool is_large(const Corners& t) const;
  [[nodiscard]] bool needs_cut(const FaceShading::Shaded& face, const Corners& t);
  [[nodiscard]] FaceShading::Part part_of(const FaceShading::Shaded& face, const Corners& t);
  std::int32_t part(const FaceShading::Shaded& face, const Corners& t);
  std::int32_t cut(const FaceShading::Shaded& face, const Corners& t);
  std::int32_t shade(const FaceShading::Shaded& face, const Corners& t);

  const View* view_;
  const ScreenFaces* faces_;
  const FaceShading* shading_;
  int max_shading_;
  FrameGeometry* out_;
  std::vector<Corner> corners_;  // of the triangle at hand
  std::vector<ClipPoint> triangle_;
};

}  // namespace kage
