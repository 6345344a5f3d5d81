// SPDX-License-Identifier: Apache-2.0
//
// The least and the greatest depth of receivers in blocks of a band's lines: most shadow spans lie before none of them,
// or before all, and need no look at single pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "contract/derived.hpp"
#include "frontend/sweep.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"
#include "number/int128.hpp"

namespace kage {

/// How a span lies to the receivers of its pixels.
enum class Standing : std::uint8_t { behind, before, mixed };

class DepthPyramid {
 public:
  static constexpr int kBlock = 32;  // pixels

  DepthPyramid(const FrameGeometry& geometry, const Config& config)
      : g_(&geometry),
        z_frac_(config.z_frac),
        most_(static_cast<std::int32_t>(derived::most_depth(config))),
        blocks_(static_cast<std::size_t>((geometry.width + kBlock - 1) / kBlock)),
        least_(blocks_ * kBandLines),
        greatest_(blocks_ * kBandLines),
        of_band_(blocks_) {}

  void start(int y0, int y1) {
    y0_ = y0;
    y1_ = y1;
    std::fill(of_band_.begin(), of_band_.end(), 0);
  }

  /// The depths of line y, each once: 0 and those past the greatest that is drawn are no receivers'.
  void add_line(int y, const std::int32_t* depths) {
    const std::size_t first = static_cast<std::size_t>(y - y0_) * blocks_;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const int from = static_cast<int>(b) * kBlock;
      const int end = std::min(from + kBlock, g_->width);
      std::int32_t least = kNone;
      std::int32_t greatest = 0;
      for (int x = from; x < end; ++x) {
        const std::int32_t z = depths[x] > most_ ? 0 : depths[x];
        greatest = std::max(greatest, z);
        least = std::min(least, z == 0 ? kNone : z);
      }
      least_[first + b] = least;
      greatest_[first + b] = greatest;
      of_band_[b] = std::max(of_band_[b], greatest);
    }
  }

  /// How a span lies, as far as blocks tell.
  [[nodiscard]] Standing standing(int y, const SpanToken& s) const {
    const std::int64_t last = s.z + s.dz * (s.xr - 1 - s.xl);
    const std::int64_t nearest = std::clamp<std::int64_t>(std::min(s.z, last) >> z_frac_, 1, most_);
    const std::int64_t furthest = std::clamp<std::int64_t>(std::max(s.z, last) >> z_frac_, 1, most_);
    const std::size_t line = static_cast<std::size_t>(y - y0_) * blocks_;
    std::int32_t least = kNone;
    std::int32_t greatest = 0;
    for (int b = s.xl / kBlock; b <= (s.xr - 1) / kBlock; ++b) {
      least = std::min(least, least_[line + static_cast<std::size_t>(b)]);
      greatest = std::max(greatest, greatest_[line + static_cast<std::size_t>(b)]);
    }
    if (nearest >= greatest) return Standing::behind;
    return furthest < least ? Standing::before : Standing::mixed;
  }

  /// Whether no span of a polygon lies before a receiver of the band, as far as its box and its plane tell. A span's
  /// depth is off its plane by half a step of 2^-Z_FRAC at its start, as much with each pixel, and less than a step of
  /// depth when its fraction goes. Past what accumulators hold it is the least or the greatest depth there is.
  [[nodiscard]] bool hides(const ScreenPolygon& p) const {
    const auto outline = g_->outline(p);
    ScreenVertex low = outline[0];
    ScreenVertex high = outline[0];
    for (const ScreenVertex& v : outline) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y)};
    }
    const int xl = std::max((low.x >> 8) - 1, 0);
    const int xr = std::min((high.x >> 8) + 1, g_->width - 1);
    const int top = std::max((low.y >> 8) - 1, y0_);
    const int bottom = std::min((high.y >> 8) + 1, y1_ - 1);
    if (xl > xr || top > bottom) return true;
    std::int32_t greatest = 0;
    for (int b = xl / kBlock; b <= xr / kBlock; ++b)
      greatest = std::max(greatest, of_band_[static_cast<std::size_t>(b)]);
    const ScreenPlane& d = p.depth;
    const Int128 least = static_cast<Int128>(d.c) + static_cast<Int128>(d.a) * ((d.a > 0 ? xl : xr) - d.x0) +
                         static_cast<Int128>(d.b) * ((d.b > 0 ? top : bottom) - d.y0);
    const int off = 3 + ((xr - xl + 2) >> (z_frac_ + 1));
    return (least >> kPlaneFrac) - off >= greatest;
  }

 private:
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

  const FrameGeometry* g_;
  int z_frac_;
  std::int32_t most_;
  std::size_t blocks_;
  int y0_ = 0;
  int y1_ = 0;
  std::vector<std::int32_t> least_;     // of each block of each line
  std::vector<std::int32_t> greatest_;  // likewise
  std::vector<std::int32_t> of_band_;   // the greatest of each column of blocks
};

}  // namespace kage
