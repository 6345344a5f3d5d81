// SPDX-License-Identifier: Apache-2.0

/// @file
/// Shadow volumes: how many a caster has, and what of them is kept from frame to frame. geometry.hpp makes them.
#pragma once

#include <cstdint>
#include <memory>

namespace kage {

/// How many volumes casters have.
enum class VolumeWay : std::uint8_t {
  fewest,    ///< as few as DSF_BITS allows
  per_face,  ///< one for each face of what is not convex, which changes no picture but in near ties; for tests
};

/// Keeps what a scene's shadow volumes are made of from frame to frame, so that it is not found again for a light and
/// casters that have not moved. It changes no frame. Not for several threads at once.
class ShadowCache {
 public:
  /// Nothing is kept yet.
  ShadowCache();
  ~ShadowCache();
  ShadowCache(ShadowCache&&) noexcept;
  ShadowCache& operator=(ShadowCache&&) noexcept;

 private:
  friend struct ShadowCacheInside;  // how the library itself comes to what is kept
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage
