// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cosim/compare.hpp"
#include "cosim/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {

/// Hands the words of frame `index` to `sink`, piece by piece, and returns their counts.
using Feed = std::function<TokenCounts(int index, const WordSink& sink)>;

struct RunOptions {
  std::filesystem::path out;             ///< an existing folder for pictures, or empty for none
  std::string name = "frame";            ///< pictures are NAME_0000.png ...
  bool two_threads = true;               ///< the second core works beside the first
  std::function<void(int frame)> begin;  ///< called before each frame is fed; may throw, which ends the run
  std::function<void()> wait;  ///< called ten times a second while the second core lags; may throw, which ends the run
};

struct Report {
  bool same = true;
  int frames = 0;  ///< compared; a difference ends the run
  int width = 0;   ///< of the last frame
  int height = 0;
  std::uint64_t pixels_compared = 0;
  std::uint64_t spans = 0;  ///< of the frames compared
  std::uint64_t span_pixels = 0;
  std::uint64_t segments = 0;
  std::uint64_t cycles = 0;
  std::uint64_t starved = 0;
  std::uint64_t blocked = 0;
  double expected_seconds = 0;  ///< inside the cores, not making words or pictures
  double actual_seconds = 0;
  std::optional<Difference> first_difference;
  std::vector<std::string> pictures;
};

/// The expected core stops when this many bytes of words and of its own lines wait for the actual one. A single piece
/// may hold more.
inline constexpr std::size_t kAheadBytes = std::size_t{4} << 20;

/// Send every frame through both cores and compare line by line. Each frame of `expected` is written as a picture; at
/// the first difference also NAME_0000_expected.png, _actual.png and _difference.png. They appear together when there
/// is a verdict; without one, what lay in the folder before is untouched. The expected core runs ahead of the actual
/// one by kAheadBytes at most; memory depends neither on the number of frames nor on their height. Only the three
/// pictures of the first difference, with which the run ends, are in memory whole. Throws Error where no verdict is
/// possible: no frames, or a frame that the expected core refuses in its header, so that no pixel could be compared.
Report run(int frames, const Feed& feed, Core& expected, Core& actual, const RunOptions& options);

}  // namespace kage::cosim
