// SPDX-License-Identifier: Apache-2.0
//
// The table by which RESOLVE takes each light's share from a colour that is the sum of all. [Matsumoto, section 6.]
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/shade.hpp"
#include "kage/geometry.hpp"
#include "kage/light.hpp"

namespace kage {

/// Puts faces in classes and says what each class loses in shadow. A class is a quantised normal and the lights that
/// reach the face; only classes that some face has get a number. Light from directional lights depends on the surface's
/// normal alone, so an entry is that of the class's normal. Light from other lights depends on the place too: then an
/// entry is the mean, by area, over the faces that have the class.
class LightTable {
 public:
  /// No table if the configuration has none. `samples`: of each light that casts shadows; the others have share 0.
  LightTable(const Config& config, const Look& look, std::span<const Light> lights, const Lighting& lighting,
             std::span<const int> samples);

  [[nodiscard]] bool exists() const { return normals_.has_value(); }

  /// A number for the class of a face that some casting light reaches, until finish() gives it its own.
  std::uint32_t classify(const glm::dvec3& normal, const glm::dvec3& place, double area,
                         const std::bitset<kMaxLights>& lit);

  /// Once all faces are classified: numbers of polygons become those of the table, and FrameGeometry::shares is made.
  /// Where there are more classes than the table holds, coarser normals are taken, by halves.
  void finish(FrameGeometry& out);

 private:
  struct Class {
    int normal = 0;  // of normals_
    std::bitset<kMaxLights> lit;
    std::vector<glm::dvec3> parts;  // of each casting light, weighted, if some light is not directional
    double weight = 0;
  };
  using Key = std::pair<int, std::uint64_t>;  // normal and lights

  void coarsen(int count, bool by_light, std::vector<std::uint32_t>& number);
  [[nodiscard]] std::vector<glm::dvec3> shares(const Class& c) const;

  const Config* config_;
  const Lighting* lighting_;
  std::span<const int> samples_;
  bool positional_ = false;
  std::optional<NormalClasses> normals_;
  std::vector<Class> classes_;
  std::map<Key, std::uint32_t> numbers_;  // of classes_, from 1
};

}  // namespace kage
