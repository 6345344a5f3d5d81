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

  /// A factor for each channel of a side's colour. The shadow that the side throws on itself counts the points behind
  /// it; what that leaves of the product is the colour.
  [[nodiscard]] glm::dvec3 before_own_shadow(const FaceSide& side, std::uint32_t number) const;

  /// How far colours in the full shadow of a light are off because a class has one share, in steps of 255. It is the
  /// root mean square over lights, channels, and the area of the sides that casters may keep light from.
  [[nodiscard]] double error() const { return error_; }

  /// FrameGeometry::shade or shares.
  void put(FrameGeometry& out) const;

 private:
  /// The share of a sample from a side, for each light and channel, and how much an error there would count: by the
  /// area, and the square of the colour that all samples would take.
  struct Loss {
    std::vector<double> shares;
    std::vector<double> weights;
    double area = 0;
    glm::dvec3 brightest{0, 0, 0};  // colour of its places with no shadow on them, if some points are behind it
  };

  /// A side that is in the table, with what limits its class's entry.
  struct Member {
    std::uint32_t* number;  // where its class is kept
    double area;
    glm::dvec3 brightest;
    std::vector<int> behind;  // of each light that casts, the points that the side keeps from itself
  };

  /// A place of a side: where light is worked out.
  struct Place {
    glm::dvec3 point;
    glm::dvec3 normal;  // turned to the eye
    glm::dvec3 base;
  };

  [[nodiscard]] Loss loss(const FaceSide& side) const;
  [[nodiscard]] glm::dvec3 lit_color(const FaceSide& side, const Place& at) const;
  void add_loss(const FaceSide& side, const Place& at, double weight, Loss& out) const;
  void add_sides(bool inner, WeightedVectors& all, std::vector<Member>& members, double& area);
  void round_middles();
  void limit(const std::vector<Member>& members, const std::vector<std::uint32_t>& of);
  [[nodiscard]] bool shadows_itself(const FaceSide& side) const;
  void make_one(const WeightedVectors& all, const Look& look);
  void measure(const WeightedVectors& all, const std::vector<std::uint32_t>& of, double area);

  const SceneFrame* frame_;
  const Config* config_;
  const SampledLights* lights_;
  const Lighting* lighting_;
  bool self_shadow_;             // every sample of a face that casts shadows it from behind
  std::size_t numbers_;          // of a class: casting lights times channels
  std::vector<double> middles_;  // of each class, a light's channels one after the other
  double error_ = 0;
  std::vector<std::array<std::uint32_t, 2>> class_;  // of each polygon's outside and inside, or 0: not known
};

}  // namespace kage
