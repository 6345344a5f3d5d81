// SPDX-License-Identifier: Apache-2.0
//
// The truth about a frame's pixels, by the oracle from the snapped polygons: made once, whatever configurations are
// held against it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage::explore {

/// The face of a pixel that shows the background.
inline constexpr std::uint32_t kNothing = ~0U;

struct TruePixel {
  std::uint32_t face = kNothing;         ///< into SceneFrame::polygons; opaque ones only
  double depth = 0;                      ///< share of the depth range, 0 at its near end
  bool lit = false;                      ///< shadows darken it
  std::array<std::uint8_t, 8> counts{};  ///< of each light its samples in shadow
};

struct ScreenTruth {
  int width = 0;
  int height = 0;
  std::vector<TruePixel> pixels;  ///< line by line

  [[nodiscard]] const TruePixel& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Asks the oracle about every pixel. `geometry` was made for `config`, which should be as fine as it can be; shadows
/// are those of parity or of whatever DSF_BITS it has. Lines are shared out among `threads`, 0: one per processor.
/// `step` is called now and then, by several threads, and what it throws goes through.
ScreenTruth screen_truth(const FrameGeometry& geometry, const Config& config, int threads = 0,
                         const std::function<void()>& step = {});

}  // namespace kage::explore
