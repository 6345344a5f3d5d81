// SPDX-License-Identifier: Apache-2.0
//
// Data of ShadowCache: volumes as sets of faces, which depend on casters and light but not on the eye.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kage/shadow.hpp"
#include "shadow/shadow_caster.hpp"

namespace kage {

/// Volumes of one light sample.
struct KeptSample {
  struct Volume {
    WorldVolume volume;
    std::uint32_t component = 0;
  };

  LightPoint light;
  double edge_on = -1;
  std::optional<std::vector<Volume>> volumes;                             // all
  std::vector<std::optional<std::vector<std::vector<CapFace>>>> patches;  // by component, of those that need them
};

struct ShadowCache::Data {
  /// Forget what does not hold for this frame: all if its faces are others, else what depends on vertices that moved.
  void take(const SceneFrame& frame, int limit, VolumeWay way);

  /// The kept volumes of a sample, or an empty KeptSample.
  KeptSample& sample(std::size_t number, const ShadowCaster& caster);

  [[nodiscard]] EdgeTable& edges() { return *edges_; }

 private:
  struct Part {
    std::uint32_t first_polygon;
    std::uint32_t polygon_count;
    bool closed, convex, translucent;
    bool operator==(const Part&) const = default;
  };
  /// A polygon's corners and the triangle that has its plane.
  struct Face {
    std::uint32_t first;
    std::uint32_t count;
    std::array<std::uint32_t, 3> plane;
    bool operator==(const Face&) const = default;
  };

  int limit_ = 0;
  VolumeWay way_ = VolumeWay::fewest;
  std::vector<Part> parts_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> corners_;
  std::vector<glm::dvec3> vertices_;
  std::optional<EdgeTable> edges_;
  std::vector<KeptSample> samples_;
};

/// The library's way into a cache.
struct ShadowCacheInside {
  using Data = ShadowCache::Data;
  static Data& of(ShadowCache& cache) { return *cache.data_; }
};

}  // namespace kage
