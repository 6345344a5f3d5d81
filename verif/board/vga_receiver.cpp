// SPDX-License-Identifier: Apache-2.0
#include "vga_receiver.hpp"

namespace kage::board {

std::optional<VideoPixel> VgaReceiver::put(bool hsync, bool vsync, unsigned rgb) {
  const bool h = hsync == mode_.h_positive;
  const bool v = vsync == mode_.v_positive;
  if (x_ >= 0) ++x_;
  if (h && !hsync_before_ && (x_ >= 0 || quiet_ >= mode_.h_active + mode_.h_front)) {
    x_ = 0;
    if (y_ >= 0) ++y_;
  }
  if (v && !vsync_before_ && x_ >= 0) y_ = 0;
  quiet_ = h ? 0 : quiet_ + 1;
  hsync_before_ = h;
  vsync_before_ = v;

  ++clock_;
  if (x_ < 0) return {};

  const long left = x_ - mode_.h_sync - mode_.h_back;
  const long top = y_ - mode_.v_sync - mode_.v_back;
  VideoPixel pixel;
  pixel.hsync = hsync;
  pixel.vsync = vsync;
  pixel.active = y_ >= 0 && left >= 0 && left < mode_.h_active && top >= 0 && top < mode_.v_active;
  if (pixel.active) {
    pixel.rgb = (rgb & 3U) * 85 | (rgb >> 2 & 3U) * 85 << 8 | (rgb >> 4 & 3U) * 85 << 16;
  } else if (rgb != 0 && y_ >= 0 && fault_.empty()) {
    fault_ = "a colour in blanking (clock " + std::to_string(clock_) + ")";
  }
  return pixel;
}

}  // namespace kage::board
