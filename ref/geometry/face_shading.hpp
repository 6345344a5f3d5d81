// SPDX-License-Identifier: Apache-2.0
// A face's shading: the colours of its corners, and whether shadows darken it.
#pragma once

#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/light_table.hpp"
#include "geometry/sampled_lights.hpp"
#include "geometry/shade.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Refers to what it is made of.
class FaceShading {
 public:
  FaceShading(const SceneFrame& frame, const Config& config, const SampledLights& lights, const Lighting& lighting,
              bool has_table);

  /// A face with the colours of its corners.
  struct Shaded {
    double facing;  ///< as facing_of()
    FacePlane plane;
    std::bitset<kMaxLights> lit;  ///< by which lights
    glm::dvec3 mean;              ///< of the corners' colours
    bool same_color;              ///< at all of them
  };

  /// Gives `corners`, those of polygon `index` in its order, their colours.
  Shaded shade(std::uint32_t index, std::span<ClipPoint> corners);

  /// Whether shadows darken the face: with a table if some light reaches it. Without, only if all samples do: where
  /// some are behind it, it shadows itself, and a constant share would darken what is nearly unlit anyway, face by
  /// face.
  [[nodiscard]] bool takes_shadow(const Shaded& face) const;

  /// Gives each of the polygons that is lit its class. Each face has a class and weighs in it once, however many
  /// polygons it was drawn as and however often it was tried.
  void classify(LightTable& table, std::span<ScreenPolygon> polygons) const;

 private:
  /// Data of a face for the light table.
  struct LitFace {
    glm::dvec3 normal;
    glm::dvec3 middle;
    double area;
    std::bitset<kMaxLights> lit;
  };

  const SceneFrame* frame_;
  const Config* config_;
  const SampledLights* lights_;
  const Lighting* lighting_;
  std::vector<LitFace> lit_faces_;  // of SceneFrame::polygons, if there is a table
};

}  // namespace kage
