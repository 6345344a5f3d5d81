// SPDX-License-Identifier: Apache-2.0
#include "screen.hpp"

#include <utility>

namespace kage::board {

void Screen::complain(std::string text) {
  if (fault_.empty()) fault_ = std::move(text) + " (clock " + std::to_string(clock_) + ")";
}

void Screen::expect(std::string_view what, std::string_view unit, long measured, long expected) {
  if (measured == expected) return;
  complain(std::string(what) + " is " + std::to_string(measured) + " " + std::string(unit) + ", expected " +
           std::to_string(expected));
}

std::vector<ShownFrame> Screen::take_frames() { return std::exchange(done_, {}); }

// A line begins with the pulse of hsync; vsync changes there too.
void Screen::line_begins() {
  if (hsync_began_ >= 0) expect("a line", "pixels long", clock_ - hsync_began_, mode_.h_total());
  if (line_has_pixels_) {
    expect("the horizontal front porch", "pixels wide", clock_ - active_ended_, mode_.h_front);
    blank_lines_ = 0;
  } else if (blank_lines_ >= 0) {
    ++blank_lines_;
  }
  line_has_pixels_ = false;
  hsync_began_ = clock_;
  if (lines_since_frame_ >= 0) ++lines_since_frame_;
  if (lines_since_vsync_ >= 0) ++lines_since_vsync_;
}

void Screen::frame_begins() {
  if (lines_since_frame_ >= 0) {
    expect("a frame", "lines high", lines_since_frame_, mode_.v_total());
    expect("the picture", "lines high", active_lines_, mode_.v_active);
    now_.width = mode_.h_active;
    now_.height = static_cast<int>(active_lines_);
    if (now_.pixels.size() == static_cast<std::size_t>(now_.width) * static_cast<std::size_t>(now_.height)) {
      done_.push_back(std::move(now_));
      ++frames_;
    }
  }
  if (blank_lines_ >= 0) expect("the vertical front porch", "lines high", blank_lines_, mode_.v_front);
  now_ = {};
  lines_since_frame_ = 0;
  active_lines_ = 0;
}

void Screen::put(const VideoPixel& pixel) {
  const bool hsync = pixel.hsync == mode_.h_positive;
  const bool vsync = pixel.vsync == mode_.v_positive;
  if (pixel.active && hsync)
    complain(mode_.h_positive ? "hsync is negative, expected positive" : "hsync is positive, expected negative");
  if (pixel.active && vsync)
    complain(mode_.v_positive ? "vsync is negative, expected positive" : "vsync is positive, expected negative");

  if (started_) {
    const bool hsync_before = before_.hsync == mode_.h_positive;
    const bool vsync_before = before_.vsync == mode_.v_positive;
    const bool line = hsync && !hsync_before;
    if (!pixel.active && before_.active) {
      if (active_began_ >= 0) expect("the picture", "pixels wide", clock_ - active_began_, mode_.h_active);
      active_ended_ = clock_;
    }
    if (line) line_begins();
    if (!hsync && hsync_before) {
      if (hsync_began_ >= 0) expect("hsync", "pixels wide", clock_ - hsync_began_, mode_.h_sync);
      hsync_ended_ = clock_;
    }
    if (vsync != vsync_before && !line)
      complain(std::string("vsync ") + (vsync ? "begins" : "ends") + " where no pulse of hsync begins");
    if (vsync && !vsync_before) frame_begins();
    if (!vsync && vsync_before) {
      if (lines_since_frame_ >= 0) expect("vsync", "lines high", lines_since_frame_, mode_.v_sync);
      lines_since_vsync_ = 0;
    }
    if (pixel.active && !before_.active) {
      if (hsync_ended_ >= 0) expect("the horizontal back porch", "pixels wide", clock_ - hsync_ended_, mode_.h_back);
      if (line_has_pixels_) complain("a line has pixels twice");
      if (active_lines_ == 0 && lines_since_vsync_ >= 0)
        expect("the vertical back porch", "lines high", lines_since_vsync_, mode_.v_back);
      if (active_lines_ >= 0) ++active_lines_;
      line_has_pixels_ = true;
      active_began_ = clock_;
    }
  }
  if (pixel.active && active_lines_ > 0) now_.pixels.push_back(pixel.rgb);
  before_ = pixel;
  started_ = true;
  ++clock_;
}

}  // namespace kage::board
