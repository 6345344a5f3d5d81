// SPDX-License-Identifier: Apache-2.0
//
// Which spans of a band have an effect on its pixels. A band's depth is known once its opaque spans are, and does not
// change after that. So it is known of each pixel which opaque span it shows, and before which surface a span counts.
//
// A volume flags a pixel if it counts there otherwise than 0, modulo 2^DSF_BITS. A flag does something only where it is
// the sample's first, and where the sample's light comes to a surface: such pixels are receivers. Spans that count at
// no receiver, and volumes that give no receiver its first flag, are without effect (docs/shadows.md, "Without
// effect").
#pragma once

#include <cstdint>
#include <vector>

#include "frontend/depth_pyramid.hpp"
#include "frontend/sweep.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"
#include "kernels/span_kernels.hpp"

namespace kage {

class BandEffect {
  template <class V>
  auto* row(V& v, int y) const {
    return v.data() + static_cast<std::size_t>(y - y0_) * stride_;
  }

 public:
  BandEffect(const FrameGeometry& geometry, const Config& config);

  /// A band of the lines [y0, y1) begins: nothing is drawn.
  void start(int y0, int y1);

  /// The next opaque span, on line y.
  /// @return its number, from 0
  std::uint32_t draw(int y, const SpanToken& span);

  /// All opaque spans have come: find the pixels that show each.
  void end_drawing();
  /// Pixels of a drawn span that show it, from the first to the last.
  [[nodiscard]] const PixelRange& shown(std::uint32_t span) const { return shown_[span]; }

  /// From now on receivers are the pixels that show spans of which `receives` is true; no pixel is flagged.
  template <class Receives>
  void start_sample(Receives receives) {
    pyramid_.start(y0_, y1_);
    for (int y = y0_; y < y1_; ++y) {
      const std::int32_t* zb = row(zb_, y);
      const std::uint32_t* owner = row(owner_, y);
      std::int32_t* at = row(receivers_, y);
      for (int x = 0; x < width_;) {
        const std::uint32_t number = owner[x];
        const bool takes = number != kNobody && receives(number);
        for (; x < width_ && owner[x] == number; ++x) at[x] = takes ? zb[x] : 0;
      }
      pyramid_.add_line(y, at);
    }
    clear_flags();
  }
  /// The next sample, with the same receivers: no pixel is flagged.
  void clear_flags();

  /// Whether no span of a face counts at any pixel of the band, as far as its box and its plane tell.
  [[nodiscard]] bool hides(const ScreenPolygon& face) const { return pyramid_.hides(face); }
  /// A span of the volume at hand counts where it lies before what is drawn.
  Before count(int y, const SpanToken& span);
  /// Likewise [xl, xr), whatever its depth.
  void count_all(int y, int xl, int xr, int w);
  /// The volume at hand ends: flag the pixels in [xl, xr), where alone it counts.
  /// @return whether that is a receiver's first flag
  bool end_volume(int y, int xl, int xr);

  /// Whether no receiver lies in [xl, xr).
  [[nodiscard]] bool nobody_receives(int y, int xl, int xr) const;

  /// Pixels of a translucent span that lie before what is drawn.
  [[nodiscard]] PixelRange before(int y, const SpanToken& span) const;

 private:
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};

  Config config_;
  int width_;
  std::size_t stride_;
  int y0_ = 0;
  int y1_ = 0;
  DepthPyramid pyramid_;  // of receivers_
  std::vector<std::int32_t> zb_;
  std::vector<std::uint32_t> owner_;     // the span that a pixel shows
  std::vector<std::int32_t> receivers_;  // zb_ of receivers, 0 of others
  std::vector<std::uint8_t> dsf_;        // of the volume at hand
  std::vector<std::uint8_t> flags_;      // of the sample at hand
  std::vector<PixelRange> shown_;
};

}  // namespace kage
