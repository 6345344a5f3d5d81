// SPDX-License-Identifier: Apache-2.0
// How long a display's line must be, against a display and a core that are played clock by clock.
#include "cost/line_clocks.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "test/support/catch.hpp"

using namespace kage;

namespace {

/// Whether a core that takes `lines` clocks for its lines is ready for each line of a display, `each` clocks a line,
/// that begins as late as two line buffers let it: when both are full, or when there is no third line to work on. One
/// buffer leaves, one waits, and a line can be handed to a buffer once that is free.
bool in_time(const std::vector<std::uint64_t>& lines, double each) {
  std::vector<double> ready(lines.size());
  std::vector<double> gone(lines.size());
  double core = 0;
  const double start = static_cast<double>(lines[0] + (lines.size() > 1 ? lines[1] : 0));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    core += static_cast<double>(lines[i]);
    if (i >= 2) core = std::max(core, gone[i - 2]);
    ready[i] = core;
    const double due = start + static_cast<double>(i) * each;
    if (ready[i] > due + 1e-6) return false;
    gone[i] = due + each;
  }
  return true;
}

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
