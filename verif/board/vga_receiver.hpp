// SPDX-License-Identifier: Apache-2.0
//
// The far end of a VGA cable: it takes the wires once a pixel and finds where pixels are, as a monitor does, by the
// syncs alone.
#pragma once

#include <optional>
#include <string>

#include "board/screen.hpp"

namespace kage::board {

class VgaReceiver {
 public:
  explicit VgaReceiver(const VideoMode& expected) : mode_(expected) {}

  /// One pixel's clock. `rgb` has two bits a colour, red in bits 0-1, green in 2-3, blue in 4-5; the pixel that comes
  /// back has eight of each, 0, 85, 170 or 255. A pixel is active where the mode has its picture behind the last pulses
  /// of hsync and vsync; before the first of vsync none is. Nothing comes back before the first pulse of hsync that
  /// begins where a line's would, since wires may be at anything while a board is powered up or reset.
  std::optional<VideoPixel> put(bool hsync, bool vsync, unsigned rgb);

  /// The first colour outside of the picture, where a monitor takes its black level; else empty.
  const std::string& fault() const { return fault_; }

 private:
  VideoMode mode_;
  std::string fault_;
  bool hsync_before_ = true, vsync_before_ = true;  // in their pulses
  long quiet_ = 0;                                  // clocks since hsync ended
  long clock_ = 0;
  long x_ = -1;  // pixels since hsync began; below 0: it has not yet
  long y_ = -1;  // lines since vsync began
};

}  // namespace kage::board
