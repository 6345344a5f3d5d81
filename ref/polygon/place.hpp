// SPDX-License-Identifier: Apache-2.0
//
// A place in a frame's order (docs/stream.md, "The polygon level"): one number of 48 bits, whose fields AT has.
#pragma once

#include <cstdint>

#include "contract/derived.hpp"
#include "kage/token.hpp"

namespace kage {

/// Layer of a place, as AT has it.
enum class Layer : std::uint8_t { opaque = 0, volumes = 1, translucent = 2 };

/// Compared by its number, which has the layer highest.
class Place {
 public:
  constexpr Place() = default;
  constexpr Place(const PolygonToken& at, int light)
      : number_(put(at.layer, kLayerLsb) | put(at.sample, kSampleLsb) | put(light, kLightLsb) |
                put(at.volume, kVolumeLsb) | put(at.rank, 0)) {}
  /// In the layers of drawn polygons, which have one number for all of them.
  constexpr Place(Layer layer, std::uint32_t order)
      : number_(put(static_cast<int>(layer), kLayerLsb) | std::uint64_t{order}) {}

  /// The fields of its AT, but for the light.
  [[nodiscard]] constexpr PolygonToken token() const {
    PolygonToken t;
    t.layer = layer();
    t.sample = field(kSampleLsb, kSampleBits);
    t.volume = field(kVolumeLsb, kVolumeBits);
    t.rank = field(0, kRankBits);
    return t;
  }

  [[nodiscard]] constexpr std::uint64_t number() const { return number_; }
  [[nodiscard]] constexpr int layer() const { return field(kLayerLsb, kLayerBits); }
  [[nodiscard]] constexpr int light() const { return field(kLightLsb, kLightPlaceBits); }
  /// With linear light: of a light's own spans, behind its volumes.
  [[nodiscard]] constexpr bool is_light(const Config& config) const {
    return config.linear_bits > 0 && layer() == static_cast<int>(Layer::volumes) && light() > 0;
  }
  /// The samples of that light.
  [[nodiscard]] constexpr int samples(const Config& config) const {
    return field(kVolumeLsb, derived::pass_samples_bits(config));
  }
  /// The same for all faces of a volume, or all of a light's own spans, and for nothing else.
  [[nodiscard]] constexpr std::uint64_t volume() const { return number_ >> kVolumeLsb; }
  /// The same for all volumes of a light's sample, and for nothing else.
  [[nodiscard]] constexpr std::uint64_t sample() const { return number_ >> kLightLsb; }

  constexpr auto operator<=>(const Place&) const = default;

 private:
  static constexpr int kVolumeLsb = kRankBits;
  static constexpr int kLightLsb = kVolumeLsb + kVolumeBits;
  static constexpr int kSampleLsb = kLightLsb + kLightPlaceBits;
  static constexpr int kLayerLsb = kSampleLsb + kSampleBits;
  static_assert(kLayerLsb + kLayerBits == kPlaceBits);
  static_assert(kLightLsb == 32);  // what a layer's one number has

  static constexpr std::uint64_t put(int value, int lsb) { return static_cast<std::uint64_t>(value) << lsb; }
  [[nodiscard]] constexpr int field(int lsb, int bits) const {
    return static_cast<int>(number_ >> lsb & ((std::uint64_t{1} << bits) - 1));
  }

  std::uint64_t number_ = 0;
};

}  // namespace kage
