// SPDX-License-Identifier: Apache-2.0
// How long a display's line must be, against a display and a core that are played clock by clock.
#include "cost/line_clocks.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "test/support/catch.hpp"

using namespace kage;

namespace {

using Lines = std::vector<std::uint64_t>;

/// Whether a core that takes `frames` clocks for the lines of its frames is ready for each line of a display. The
/// display takes `each` clocks a line and `blank` lines behind each frame. It begins as late as two line buffers let
/// it: when both are full, or when there is no third line to work on. One buffer leaves, one waits, and a line can be
/// handed to a buffer once that is free.
bool in_time(const std::vector<Lines>& frames, double each, int blank) {
  std::vector<double> gone;
  double core = 0;
  const Lines& head = frames[0];
  double due = static_cast<double>(head[0] + (head.size() > 1 ? head[1] : 0));
  for (const Lines& frame : frames) {
    for (const std::uint64_t clocks : frame) {
      core += static_cast<double>(clocks);
      if (gone.size() >= 2) core = std::max(core, gone[gone.size() - 2]);
      if (core > due + 1e-6) return false;
      due += each;
      gone.push_back(due);
    }
    due += blank * each;
  }
  return true;
}

bool in_time(const Lines& lines, double each) { return in_time(std::vector<Lines>{lines}, each, 0); }

}  // namespace

TEST_CASE("a display line as long as the need is never waited for, in the steady state of two full buffers") {
  rc::check("needed_line() against a display that is played", [] {
    const auto count = *rc::gen::inRange(1, 40);
    std::vector<std::uint64_t> lines;
    for (int i = 0; i < count; ++i) lines.push_back(*rc::gen::inRange<std::uint64_t>(1, 1000));
    const LineClocks::Need need = needed_line(lines);
    // The need is that of some neighbours and their display lines, one more than they are themselves.
    double sum = kWayOutClocks;
    for (int i = need.first; i < need.first + need.count; ++i)
      sum += static_cast<double>(lines[static_cast<std::size_t>(i)]);
    RC_ASSERT(std::abs(sum / (need.count + 1) - need.clocks) < 1e-9);
    // And of no others more.
    for (std::size_t first = 0; first < lines.size(); ++first) {
      double all = kWayOutClocks;
      for (std::size_t i = first; i < lines.size(); ++i) {
        all += static_cast<double>(lines[i]);
        RC_ASSERT(all / static_cast<double>(i - first + 2) <= need.clocks + 1e-9);
      }
    }
    RC_ASSERT(in_time(lines, need.clocks));
  });
}

TEST_CASE("a single heavy line has the time of two, and a run of m has that of m + 1") {
  CHECK(needed_line(std::vector<std::uint64_t>{10, 10, 10, 900, 10, 10}).clocks == (900 + kWayOutClocks) / 2);
  const LineClocks::Need two = needed_line(std::vector<std::uint64_t>{10, 10, 900, 900, 10});
  CHECK(two.clocks == (1800 + kWayOutClocks) / 3);
  CHECK(two.first == 2);
  CHECK(two.count == 2);
  CHECK(needed_line({}).clocks == 0);
}

TEST_CASE("a line a clock shorter than the need is waited for") {
  // Buffers full, then nothing but heavy lines: each of n has its own line's time, and one more between them.
  std::vector<std::uint64_t> lines{1, 1};
  for (int i = 0; i < 20; ++i) lines.push_back(1000);
  const double need = needed_line(lines).clocks;
  CHECK(in_time(lines, need));
  CHECK_FALSE(in_time(lines, need - 1));
}

TEST_CASE("heavy lines at a frame's end and at the next one's begin are late without a blank line between them") {
  // Each heavy line alone has the time of two lines; both together, of three where no line is blank.
  const std::vector<Lines> frames{{10, 10, 10, 900}, {900, 10, 10, 10}};
  const double need = std::max(needed_line(frames[0]).clocks, needed_line(frames[1]).clocks);
  CHECK(need == (900 + kWayOutClocks) / 2);
  CHECK_FALSE(in_time(frames, need, 0));
  CHECK(in_time(frames, need, 1));
  // A frame that is shown again and again: 1,000 clocks a line, where a display's line has 802.
  const std::vector<Lines> same(8, Lines(4, 1000));
  CHECK_FALSE(in_time(same, needed_line(same[0]).clocks, 0));
  CHECK(in_time(same, needed_line(same[0]).clocks, 1));
}

TEST_CASE("with a blank line behind each frame, what each frame needs is enough for all") {
  rc::check("frames one behind the other", [] {
    const auto height = *rc::gen::inRange(1, 8);
    const auto count = *rc::gen::inRange(1, 12);
    std::vector<Lines> frames;
    double need = 0;
    for (int f = 0; f < count; ++f) {
      Lines lines;
      for (int i = 0; i < height; ++i) lines.push_back(*rc::gen::elementOf(Lines{1, 10, 400, 1000}));
      need = std::max(need, needed_line(lines).clocks);
      frames.push_back(std::move(lines));
    }
    RC_ASSERT(in_time(frames, need, *rc::gen::inRange(1, 4)));
  });
}
