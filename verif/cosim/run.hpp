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
#include "file/temp_file.hpp"
#include "kage/diff.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {

/// Frames of a scene that are run, which are a shard or all of them: `first`, `first + step`, ...
struct FrameSteps {
  int first = 0;
  int step = 1;

  /// How many of them are below `frames`.
  [[nodiscard]] int below(int frames) const { return first >= frames ? 0 : (frames - 1 - first) / step + 1; }
};

/// Hands the words of frame `index` to `sink`, piece by piece, and returns their counts.
using Feed = std::function<TokenCounts(int index, const WordSink& sink)>;

/// Thrown through a feed once enough has been taken.
struct Enough {};

/// A frame that was compared.
struct FrameResult {
  int frame = 0;       ///< its number: with RunOptions::steps frames are left out
  FrameStatus status;  ///< of the expected core
  TokenCounts counts;
  std::uint64_t cycles = 0;  ///< of the actual core, as in FrameEnd
  Stalls stalls;
  PhaseStalls phase_stalls{};
  std::string picture;  ///< what the expected core drew, or empty
  bool taken = false;   ///< the verdict is that of an earlier run (cosim/recall.hpp), and so are the clocks
};

struct RunOptions {
  std::filesystem::path out;   ///< an existing folder for pictures, or empty for none
  std::string name = "frame";  ///< pictures are NAME_0000.png ...
  TempFiles* files = nullptr;  ///< gets the pictures, for the caller to commit; nullptr: run() commits them
  FrameSteps steps;            ///< of the frames
  int before = 0;  ///< so many of the steps before the first are run as well and not compared: a frame finds in the
                   ///< core what those left there
  bool refusals = false;     ///< a frame that both cores refuse in its header counts as compared
  bool all_pictures = true;  ///< false: those of the first difference alone, and no file is written for any other; the
                             ///< lines of the frame at hand are in memory then
  bool two_threads = true;   ///< the second core works beside the first
  Core* other_state = nullptr;           ///< the actual core with another initial state: it gets the first frame too
  std::function<void(int frame)> begin;  ///< called before each frame is fed; may throw, which ends the run
  std::function<void(const FrameResult&)> same;  ///< called behind each frame that was compared and is the same, in the
                                                 ///< thread of the second core
  std::function<void()> wait;  ///< called ten times a second while the second core lags; may throw, which ends the run
};

/// So many frames at most are in Report::each, so that memory does not grow with their number.
inline constexpr std::size_t kFrameResults = 1000;

struct Report {
  bool same = true;
  bool broken = false;  ///< a frame of RunOptions::before ended in a CoreFailure, so that no frame was compared
  int frames = 0;       ///< compared; a difference ends the run
  int width = 0;        ///< of the widest frame
  int height = 0;       ///< of the highest one
  std::uint64_t pixels_compared = 0;
  std::uint64_t spans = 0;  ///< of the frames compared
  std::uint64_t span_pixels = 0;
  std::uint64_t segments = 0;
  std::uint64_t cycles = 0;
  Stalls stalls;
  double expected_seconds = 0;  ///< inside the cores, not making words or pictures
  double actual_seconds = 0;
  std::vector<double> frame_seconds;  ///< inside the cores, of each frame compared
  std::optional<Difference> first_difference;
  std::vector<std::string> pictures;     ///< of a difference that is Difference::ahead none
  std::vector<int> taken;                ///< the frames whose verdict is that of an earlier run
  std::vector<FrameResult> each;         ///< the first kFrameResults frames, and the one that is different
  std::optional<DiffResult> difference;  ///< of its pixels that came, where there are pictures
  std::int64_t missing_pixels = 0;       ///< of its pictures: they are black in _actual and _difference

  /// Counts a frame that has its verdict; `first_difference` is set if it is the one that is different. The seconds are
  /// those in each core.
  void add(const FrameResult& result, double expected, double actual);
};

/// The expected core stops when this many bytes of words and of its own lines wait for the actual one. A single piece
/// may hold more.
inline constexpr std::size_t kAheadBytes = std::size_t{4} << 20;

/// Send every frame, 0 .. frames - 1 as options.steps says, through both cores and compare line by line. Each frame of
/// `expected` is written as a picture; at the first difference also NAME_0000_expected.png, _actual.png and
/// _difference.png. They appear together when there is a verdict, or with the others of options.files; without one,
/// what lay in the folder before is untouched. The expected core runs ahead of the actual one by kAheadBytes at most;
/// memory depends neither on the number of frames nor on their height. Only the three pictures of the first difference,
/// with which the run ends, are in memory whole. Throws Error where no verdict is possible: no frames, or a frame that
/// the expected core refuses in its header, so that no pixel could be compared.
Report run(int frames, const Feed& feed, Core& expected, Core& actual, const RunOptions& options);

}  // namespace kage::cosim
