// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cosim/compare.hpp"
#include "cosim/core.hpp"

namespace kage::cosim {

/// The words of frame `index`, valid until the next call.
using Feed = std::function<std::span<const std::uint32_t>(int index)>;

struct RunOptions {
  std::filesystem::path out;             ///< an existing folder for pictures, or empty for none
  std::string name = "frame";            ///< pictures are NAME_0000.png ...
  bool two_threads = true;               ///< the second core works beside the first
  std::function<void(int frame)> begin;  ///< called before each frame; may throw, which ends the run
};

struct Report {
  bool same = true;
  int frames = 0;  ///< compared; a difference ends the run
  int width = 0;   ///< of the last frame
  int height = 0;
  std::uint64_t pixels_compared = 0;
  std::uint64_t cycles = 0;
  std::uint64_t starved = 0;
  std::uint64_t blocked = 0;
  double expected_seconds = 0;  ///< inside the cores, not making words or pictures
  double actual_seconds = 0;
  std::optional<Difference> first_difference;
  std::vector<std::string> pictures;
};

/// Send every frame through both cores and compare. Each frame of `expected` is written as a picture; at the first
/// difference also NAME_0000_expected.png, _actual.png and _difference.png. They appear together when there is a
/// verdict; without one, what lay in the folder before is untouched. Two frames' words and two pictures are in
/// memory, whatever the number.
/// Throws Error where no verdict is possible: no frames, or a frame that the expected core refuses in its header, so
/// that no pixel could be compared.
Report run(int frames, const Feed& feed, Core& expected, Core& actual, const RunOptions& options);

}  // namespace kage::cosim
