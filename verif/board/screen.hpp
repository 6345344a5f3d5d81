// SPDX-License-Identifier: Apache-2.0
//
// A screen that is told a pixel a clock: it measures the mode against the one it expects, and collects what it is
// shown.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kage::board {

/// State of a video link in one clock of its pixels. rgb has red in bits 0-7, green in 8-15, blue in 16-23.
struct VideoPixel {
  bool active = false;
  bool hsync = false;
  bool vsync = false;
  std::uint32_t rgb = 0;
};

/// A video mode, in pixels and in lines. A sync that is positive is high in its pulse.
struct VideoMode {
  std::string_view name;
  double mhz = 0;  ///< of the pixel clock
  int h_active = 0, h_front = 0, h_sync = 0, h_back = 0;
  int v_active = 0, v_front = 0, v_sync = 0, v_back = 0;
  bool h_positive = false, v_positive = false;

  constexpr int h_total() const { return h_active + h_front + h_sync + h_back; }
  constexpr int v_total() const { return v_active + v_front + v_sync + v_back; }
};

/// 60 frames a second, as VESA's monitor timings (and CEA-861 for the last) have them.
inline constexpr std::array<VideoMode, 3> kVideoModes{{
    {"640x480", 25.175, 640, 16, 96, 48, 480, 10, 2, 33, false, false},
    {"800x600", 40.0, 800, 40, 128, 88, 600, 1, 4, 23, true, true},
    {"1280x720", 74.25, 1280, 110, 40, 220, 720, 5, 5, 20, true, true},
}};

/// A frame as it was shown, line by line.
struct ShownFrame {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;

  std::uint32_t at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

class Screen {
 public:
  explicit Screen(const VideoMode& expected) : mode_(expected) {}

  /// One clock. Before the first pulses of the syncs, an interval is measured if both its ends were seen, and no
  /// picture is collected.
  void put(const VideoPixel& pixel);

  /// The first measure that differs from the mode, as "hsync is 95 pixels wide, expected 96 (clock 17234)"; else empty.
  const std::string& fault() const { return fault_; }
  /// Frames between two vertical syncs, the oldest first, since they were taken last.
  std::vector<ShownFrame> take_frames();
  /// How many frames have been seen from sync to sync.
  int frames() const { return frames_; }

 private:
  void expect(std::string_view what, std::string_view unit, long measured, long expected);
  void complain(std::string text);
  void line_begins();
  void frame_begins();

  VideoMode mode_;
  std::string fault_;
  std::vector<ShownFrame> done_;
  ShownFrame now_;
  int frames_ = 0;
  long clock_ = 0;

  // The last clock that was seen of each kind, and lines since; below 0 where there was none yet.
  VideoPixel before_;
  bool started_ = false;
  long hsync_began_ = -1, hsync_ended_ = -1, active_began_ = -1, active_ended_ = -1;
  long lines_since_frame_ = -1;  // since vsync began
  long lines_since_vsync_ = -1;  // since vsync ended
  long blank_lines_ = -1;        // since the last line with pixels
  long active_lines_ = -1;       // since vsync
  bool line_has_pixels_ = false;
};

}  // namespace kage::board
