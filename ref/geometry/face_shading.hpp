// SPDX-License-Identifier: Apache-2.0
// A face's shading: the colours of its corners and places, and its class.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/light_table.hpp"
#include "geometry/sampled_lights.hpp"
#include "geometry/shade.hpp"
#include "geometry/surface.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Refers to what it is made of.
class FaceShading {
 public:
  FaceShading(const SceneFrame& frame, const Config& config, const SampledLights& lights, const Lighting& lighting,
              const LightTable& table)
      : frame_(&frame), config_(&config), lights_(&lights), lighting_(&lighting), table_(&table) {}

  /// A face, seen from the eye, with the colours of its corners.
  struct Shaded {
    FaceSide side;
    FaceSurface surface;
    double facing;               ///< below 0 where the eye sees its inside
    bool unlit;                  ///< Triangle::unlit
    bool varies;                 ///< colours follow from the place
    bool lit;                    ///< shadows take from its colour
    bool classed;                ///< its class says how much: of no translucent face, since TP has none
    std::uint32_t normal_class;  ///< into the light table, or 0
    glm::dvec3 factor;           ///< of color_at(), for its own shadow
    glm::dvec3 mean;             ///< of the corners' colours
    bool same_color;             ///< at all of them
    /// With linear light, of an opaque face: of each light its samples before the face, or, where the face's own volume
    /// counts none of them, all. Else empty.
    std::vector<int> before;
    bool linear = false;  ///< it has light in place of colours
  };

  /// Gives `corners`, those of polygon `index` in its order, their colours before RESOLVE: what the points of lights
  /// before it give, and what its own shadow of those behind it will take (LightTable::before_own_shadow()). At most
  /// 255.
  Shaded shade(std::uint32_t index, std::span<ClipPoint> corners) const;

  /// The colour of a place of the face, before its own shadow.
  [[nodiscard]] glm::dvec3 color_at(const Shaded& face, const glm::dvec3& place) const;

  /// The linear light of a place: that from everywhere, then what comes of one sample of each light, in 1/256 of white.
  using Light = std::vector<glm::dvec3>;
  [[nodiscard]] Light light_at(const Shaded& face, const glm::dvec3& place) const;

  /// How far two such are apart as displayed, in steps of 255: the most over channels, with all lights, with none, and
  /// with each alone.
  [[nodiscard]] double difference(const Shaded& face, const Light& a, const Light& b) const;

  /// A place of the face that has a class of the table: its colour, what shadows take from it, and the class that asks
  /// for.
  struct Place {
    glm::dvec3 color;
    LightTable::Loss loss;
    std::uint32_t normal_class = 0;
  };
  [[nodiscard]] Place place(const Shaded& face, const glm::dvec3& at, const glm::dvec3& color) const;

  /// The class of a part of a face.
  struct Part {
    std::uint32_t normal_class;  ///< into the light table, or 0: the face's
    glm::dvec3 factor;           ///< of color_at(), for its own shadow
    double error;                ///< by how much more a corner's colour is off than with its own class, in steps of 255
  };
  /// The part between three places of the face: the class of one of them, that of least error for all. No places are
  /// asked for where the face has no class of the table.
  [[nodiscard]] Part part(const Shaded& face, const std::array<const Place*, 3>& corners) const;

 private:
  /// How far a colour is off with a class, in steps of 255.
  struct Error {
    double shadowed;  ///< in the full shadow of a light
    double lit;       ///< in none: what the face's own shadow asks for above white

    [[nodiscard]] double most() const { return std::max(shadowed, lit); }
    /// The latter shows wherever the face does, the former only where something casts a shadow on it.
    [[nodiscard]] double weighed() const { return std::max(shadowed, 16 * lit); }
  };
  [[nodiscard]] Error error_of(const Shaded& face, const Place& at, std::uint32_t number) const;
  [[nodiscard]] glm::dvec3 color_of(const Shaded& face, const SurfacePoint& at) const;

  const SceneFrame* frame_;
  const Config* config_;
  const SampledLights* lights_;
  const Lighting* lighting_;
  const LightTable* table_;
};

}  // namespace kage
