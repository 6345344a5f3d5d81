// SPDX-License-Identifier: Apache-2.0
//
// Shares of a colour that shadows take: the table by which RESOLVE takes each light's from a colour that is the sum of
// all, or one share for the whole frame. [Matsumoto, section 6.]
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "geometry/clusters.hpp"
#include "geometry/sampled_lights.hpp"
#include "geometry/shade.hpp"
#include "geometry/surface.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// A side of a face, and on which side of it the points of lights are.
struct FaceSide {
  FaceSide(const SceneFrame& frame, const SampledLights& lights, std::uint32_t of_polygon, int of_eye);

  /// Some point of a light that casts is before it: shadows take from its colour.
  [[nodiscard]] bool takes_shadow(const SampledLights& lights) const;

  /// The points of light `l` before it (1) or behind it (-1).
  [[nodiscard]] int count(const SampledLights& lights, std::size_t l, int side) const;

  std::uint32_t polygon;           ///< of SceneFrame::polygons
  int eye_side;                    ///< 1: seen from outside, -1: from inside
  std::vector<std::int8_t> sides;  ///< of each point: 1 outside, -1 inside, 0 edge-on
};

/// The shares of a frame. Faces that lose about the same are in one class and have one entry. Classes follow from all
/// faces of the scene, weighted by area and colour, not from those in view: they stay while scene, lights and the
/// camera's `up`, from which ambient light comes, rest. Refers to what it is made of.
class LightTable {
 public:
  LightTable(const SceneFrame& frame, const Config& config, const Look& look, const SampledLights& lights,
             const Lighting& lighting);

  /// The class of a side that takes shadow, from 1; without a table all are in one. 0: there is none.
  [[nodiscard]] std::uint32_t number(const FaceSide& side) const;

  /// Shares of a colour that shadows take at places of a side: of each light and channel that of a sample, and how much
  /// an error there would count. The latter goes by area, and by the square of the colour that all samples would take.
  struct Loss {
    std::vector<double> shares;
    std::vector<double> weights;
    double spread = 0;  ///< weight times square of what the shares of places are off the mean
    double area = 0;
    glm::dvec3 brightest{0, 0, 0};  ///< colour of places with no shadow on them, if some points are behind the side
    double law = 0;  ///< area times square of what the sum of shares is off, in steps, for each light and channel
  };
  /// At one place of a side, of an area of 1. Empty without a table.
  [[nodiscard]] Loss loss_at(const FaceSide& side, const SurfacePoint& place) const;

  /// The class, from 1, of least error for a loss; of several the first.
  [[nodiscard]] std::uint32_t nearest(const Loss& loss) const;

  /// The error of a place's colour in the full shadow of a light, in steps of 255, if this were its class: the greatest
  /// over the lights that may be kept from the side.
  [[nodiscard]] double error_of(const FaceSide& side, const Loss& loss, std::uint32_t number) const;

  [[nodiscard]] std::uint32_t classes() const { return static_cast<std::uint32_t>(middles_.size() / numbers_); }

  /// A factor for each channel of a side's colour. The shadow that the side throws on itself counts the points behind
  /// it; what that leaves of the product is the colour.
  [[nodiscard]] glm::dvec3 before_own_shadow(const FaceSide& side, std::uint32_t number) const;
  /// The same by shares that are not rounded: what chooses a class by it chooses the same whatever SHADE_FRAC is.
  [[nodiscard]] glm::dvec3 about_own_shadow(const FaceSide& side, std::uint32_t number) const;

  /// Whether the shadow volume that a side throws counts the points behind it.
  [[nodiscard]] bool shadows_itself(const FaceSide& side) const;

  /// How far colours in the full shadow of a light are off because a class has one share, in steps of 255. It is the
  /// root mean square over lights, channels, and the area of the sides that casters may keep light from.
  [[nodiscard]] double error() const { return error_; }

  /// Likewise, because shares of several lights are added, although the display's curve is no straight line. Half of
  /// the shadows are of a light alone, half of all lights together.
  [[nodiscard]] double law_error() const { return law_error_; }

  /// FrameGeometry::shade or shares.
  void put(FrameGeometry& out) const;

 private:
  /// A part of a side. All of it has no corners of its own.
  struct Part {
    std::array<SurfacePoint, 3> corners;
    Loss loss;
    std::size_t number;  // in the order in which they were made
  };

  /// A side, or a part of one, that is in the table, with what limits its class's entry.
  struct Member {
    std::uint32_t* number;  // where a whole side's class is kept
    double area;
    glm::dvec3 brightest;
    std::vector<int> behind;  // of each light that casts, the points that the side keeps from itself
  };

  /// A side of a face.
  struct Known {
    std::uint32_t number = 0;    // of its class, or 0
    std::uint32_t needed = ~0U;  // lights that may be kept from it, a bit each
  };

  [[nodiscard]] const Known& known(const FaceSide& side) const {
    return known_[side.polygon][side.eye_side > 0 ? 0 : 1];
  }
  [[nodiscard]] Loss loss(const FaceSide& side, std::span<const SurfacePoint> outline) const;
  [[nodiscard]] std::vector<Part> parts_of(const FaceSide& side) const;
  [[nodiscard]] glm::dvec3 lit_color(const FaceSide& side, const SurfacePoint& at) const;
  void add_loss(const FaceSide& side, const SurfacePoint& at, double weight, Loss& out) const;
  void add_sides(bool inner, WeightedVectors& all, std::vector<Member>& members, double& area);
  void make_entries(const std::vector<bool>& limited);
  [[nodiscard]] glm::dvec3 own_shadow(const FaceSide& side, std::uint32_t number,
                                      const std::vector<double>& shares) const;
  std::vector<bool> limit(const std::vector<Member>& members, const std::vector<std::uint32_t>& of);
  void make_one(const WeightedVectors& all, const Look& look);
  void measure(const WeightedVectors& all, const std::vector<std::uint32_t>& of, double area);

  const SceneFrame* frame_;
  const Config* config_;
  const SampledLights* lights_;
  const Lighting* lighting_;
  bool self_shadow_;             // every sample of a face that casts shadows it from behind
  bool diced_;                   // faces have parts, with classes of their own
  std::size_t numbers_;          // of a class: casting lights times channels
  std::vector<double> middles_;  // of each class, a light's channels one after the other
  std::vector<double> entries_;  // these, rounded to SHADE_FRAC
  double error_ = 0;
  double law_error_ = 0;
  double law_ = 0;                           // Loss::law of all
  std::vector<std::array<Known, 2>> known_;  // of each polygon's outside and inside
  std::size_t extra_ = 0;                    // parts beyond one of each side
};

}  // namespace kage
