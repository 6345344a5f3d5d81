// SPDX-License-Identifier: Apache-2.0
//
// Light after light (docs/stream.md): the linear light of a line's pixels, to which each light of the line adds its
// own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contract/derived.hpp"
#include "contract/display_curve.hpp"
#include "kage/token.hpp"
#include "kernels/span_value.hpp"

namespace kage {

class LinearLight {
 public:
  LinearLight(const Config& config, std::size_t pixels) : config_(config), served_(pixels) {
    levels_.fill(std::vector<std::uint16_t>(pixels));
    const std::size_t count = std::size_t{1} << config.linear_bits;
    for (std::size_t v = 0; v < count; ++v)
      curve_.push_back(displayed(static_cast<std::uint32_t>(v), config.linear_bits));
  }

  /// Whether a RESOLVE of the line has come: an OP then brings a light.
  [[nodiscard]] bool begun() const { return begun_; }
  [[nodiscard]] std::uint32_t bias() const { return bias_; }

  /// RESOLVE: the light of the opaque spans that follow has so many samples; without counters this bias.
  void begin(int samples, std::uint32_t bias) {
    begun_ = true;
    pass_ ^= 1U;
    samples_ = static_cast<std::uint32_t>(samples);
    bias_ = bias;
  }

  /// A line begins: no light has come to any pixel.
  void clear() {
    begun_ = false;
    pass_ = 0;
    bias_ = 0;
    std::fill(served_.begin(), served_.end(), std::uint8_t{0});
  }

  /// A pixel's first light, from everywhere: what an OP or the tree gives to a pixel that it covers.
  void cover(std::size_t x, const std::array<std::uint16_t, 3>& levels) {
    for (std::size_t c = 0; c < 3; ++c) levels_[c][x] = levels[c];
    served_[x] = 0;
  }

  /// Whether the pass has not come to the pixel; then it has.
  bool serve(std::size_t x) {
    const bool first = served_[x] != pass_;
    served_[x] = static_cast<std::uint8_t>(pass_);
    return first;
  }

  /// Adds to a pixel what is left of a light by its count of samples in shadow: level x (samples - count) /
  /// 2^COUNT_BITS, rounded to the nearest, halves up, and at most all ones. Without counters the level, unless the
  /// count is 1.
  void add(std::size_t x, const std::array<std::uint32_t, 3>& levels, std::uint32_t count) {
    const std::uint32_t all = config_.count_bits > 0 ? samples_ : 1;
    const std::uint64_t left = all > count ? all - count : 0;
    const std::uint64_t half = config_.count_bits > 0 ? std::uint64_t{1} << (config_.count_bits - 1) : 0;
    const std::uint64_t most = (std::uint64_t{1} << config_.linear_bits) - 1;
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c)
      levels_[c][x] =
          static_cast<std::uint16_t>(std::min(most, levels_[c][x] + ((levels[c] * left + half) >> config_.count_bits)));
  }

  [[nodiscard]] std::array<std::uint16_t, 3> at(std::size_t x) const {
    std::array<std::uint16_t, 3> level{};
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c) level[c] = levels_[c][x];
    return level;
  }
  [[nodiscard]] std::uint32_t served(std::size_t x) const { return served_[x]; }

  /// The pixel as it is displayed, packed.
  [[nodiscard]] std::uint32_t shown(std::size_t x) const {
    std::uint32_t all = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c)
      all |= std::uint32_t{curve_[levels_[c][x]]} << 8 * c;
    return all;
  }

 private:
  Config config_;
  std::array<std::vector<std::uint16_t>, 3> levels_;
  std::vector<std::uint8_t> served_;
  std::vector<std::uint8_t> curve_;
  bool begun_ = false;
  std::uint32_t pass_ = 0;
  std::uint32_t samples_ = 0;
  std::uint32_t bias_ = 0;
};

}  // namespace kage
