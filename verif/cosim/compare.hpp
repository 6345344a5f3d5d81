// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cosim/core.hpp"

namespace kage::cosim {

/// The first place where a core departs from the golden model.
struct Difference {
  int frame = 0;
  int line = -1;      ///< -1: of the frame as a whole
  int x = -1;         ///< -1: not at a pixel
  std::string field;  ///< "grey", "red", "green", "blue"; "missing" (pixels from there on); "width", "height"; "port";
                      ///< "error", "error_frame", "error_line", "error_token"
  std::int64_t expected = 0;
  std::int64_t actual = 0;
  std::string remark;  ///< more in words, or empty
};

/// Compare exactly: pixels in reading order, then size, then status, then conduct at the port. Nothing where all agree.
std::optional<Difference> first_difference(int frame, const FrameResult& expected, const FrameResult& actual);

/// "frame 3, line 17, x 204, red: expected 12, got 13".
std::string describe(const Difference& difference);

/// Where both differ, at the size of `expected`: that dimmed, red where `actual` is unlike; what `actual` lacks counts
/// as black.
Image difference_picture(const Image& expected, const Image& actual);

}  // namespace kage::cosim
