// SPDX-License-Identifier: Apache-2.0
// video_timing: every porch, sync and polarity of the three modes; and that the screen that measures them can say no.
#include <string>

#include "Vtiming_1280x720.h"
#include "Vtiming_640x480.h"
#include "Vtiming_800x600.h"
#include "bench.hpp"
#include "board/screen.hpp"

using namespace kage::rtl;
using kage::board::Screen;
using kage::board::VideoMode;

namespace {

// Three frames after reset; the first two syncs bound one, the last two another.
template <class Model>
void mode_test(const VideoMode& mode) {
  each_seed(1, [&](Dice& dice) {
    Bench<Model> top(dice);
    Screen screen(mode);
    const int h_total = mode.h_total();
    const int frame = h_total * mode.v_total();
    top.edge();  // out of reset: the first pixel
    for (int clock = 0; clock < 3 * frame + h_total; ++clock) {
      const int x = clock % h_total;
      const int y = clock / h_total % mode.v_total();
      if (clock % frame % 977 == 0 || x < 3 || x > h_total - 3) {
        REQUIRE(top->x_o == x);
        REQUIRE(top->y_o == y);
      }
      REQUIRE(top->active_o == (x < mode.h_active && y < mode.v_active));
      REQUIRE(top->frame_start_o == (x == 0 && y == 0));
      REQUIRE(top->blank_start_o == (x == 0 && y == mode.v_active));
      screen.put({top->active_o != 0, top->hsync_o != 0, top->vsync_o != 0, static_cast<std::uint32_t>(y << 12 | x)});
      REQUIRE(screen.fault().empty());
      top.edge();
    }
    const auto frames = screen.take_frames();
    REQUIRE(frames.size() == 2);
    for (const auto& shown : frames) {
      REQUIRE(shown.width == mode.h_active);
      REQUIRE(shown.height == mode.v_active);
      REQUIRE(shown.at(0, 0) == 0);
      REQUIRE(shown.at(mode.h_active - 1, mode.v_active - 1) ==
              static_cast<std::uint32_t>((mode.v_active - 1) << 12 | (mode.h_active - 1)));
    }
  });
}

// A mode as the standards draw it, from its numbers alone: two frames and a bit, from the middle of one.
std::string fault_of(const VideoMode& shown, const VideoMode& expected) {
  Screen screen(expected);
  const int h_sync = shown.h_active + shown.h_front;
  const int v_sync = (shown.v_active + shown.v_front - 1) * shown.h_total() + h_sync;  // vsync begins with an hsync
  for (int i = 100; i < 3 * shown.h_total() * shown.v_total(); ++i) {
    const int at = i % (shown.h_total() * shown.v_total());
    const int x = at % shown.h_total();
    const bool hsync = x >= h_sync && x < h_sync + shown.h_sync;
    const bool vsync = at >= v_sync && at < v_sync + shown.v_sync * shown.h_total();
    screen.put({x < shown.h_active && at / shown.h_total() < shown.v_active, hsync == shown.h_positive,
                vsync == shown.v_positive, 0});
  }
  return screen.fault().substr(0, screen.fault().find(" (clock"));
}

}  // namespace

TEST_CASE("640x480 at 60 Hz", "[video_timing]") { mode_test<Vtiming_640x480>(kage::board::kVideoModes[0]); }
TEST_CASE("800x600 at 60 Hz", "[video_timing]") { mode_test<Vtiming_800x600>(kage::board::kVideoModes[1]); }
TEST_CASE("1280x720 at 60 Hz", "[video_timing]") { mode_test<Vtiming_1280x720>(kage::board::kVideoModes[2]); }

TEST_CASE("the modes have the totals and rates of their standards", "[video_timing]") {
  const auto& modes = kage::board::kVideoModes;
  REQUIRE((modes[0].h_total() == 800 && modes[0].v_total() == 525));
  REQUIRE((modes[1].h_total() == 1056 && modes[1].v_total() == 628));
  REQUIRE((modes[2].h_total() == 1650 && modes[2].v_total() == 750));
  for (const VideoMode& mode : modes) {
    const double rate = mode.mhz * 1e6 / (mode.h_total() * mode.v_total());
    REQUIRE(rate > 59.9);
    REQUIRE(rate < 60.4);
  }
}

TEST_CASE("the screen names the measure that differs", "[video_timing]") {
  const VideoMode mode{"small", 1, 16, 5, 6, 9, 6, 2, 2, 3, false, true};
  REQUIRE(fault_of(mode, mode).empty());
  // One of the numbers is 1 more or less, or a polarity is turned; totals are told after the part that made them wrong.
  const auto with = [&](auto member, int more) {
    VideoMode m = mode;
    m.*member += more;
    return fault_of(m, mode);
  };
  REQUIRE(with(&VideoMode::h_sync, -1) == "hsync is 5 pixels wide, expected 6");
  REQUIRE(with(&VideoMode::h_front, 1) == "the horizontal front porch is 6 pixels wide, expected 5");
  REQUIRE(with(&VideoMode::h_back, -1) == "the horizontal back porch is 8 pixels wide, expected 9");
  REQUIRE(with(&VideoMode::h_active, 1) == "the picture is 17 pixels wide, expected 16");
  REQUIRE(with(&VideoMode::v_active, -1) == "a frame is 12 lines high, expected 13");
  REQUIRE(with(&VideoMode::v_front, 1) == "the vertical front porch is 3 lines high, expected 2");
  REQUIRE(with(&VideoMode::v_sync, 1) == "vsync is 3 lines high, expected 2");
  REQUIRE(with(&VideoMode::v_back, -1) == "the vertical back porch is 2 lines high, expected 3");
  VideoMode turned = mode;
  turned.h_positive = true;
  REQUIRE(fault_of(turned, mode) == "hsync is positive, expected negative");
  turned = mode;
  turned.v_positive = false;
  REQUIRE(fault_of(turned, mode) == "vsync is negative, expected positive");
}
