// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cosim/core.hpp"
#include "kage/image.hpp"

namespace kage::cosim {

/// Difference::frame of what the register check finds, which comes behind the frames and needs all of them the same.
inline constexpr int kBehindFrames = -1;

/// The first place where a core departs from the golden model.
struct Difference {
  int frame = 0;      ///< kBehindFrames: of the register check
  int line = -1;      ///< -1: of the frame as a whole
  int x = -1;         ///< -1: not at a pixel
  std::string field;  ///< A pixel: "grey", "red", "green", "blue"; "missing" (pixels from there on). A frame: "width",
                      ///< "height", "error", "error_frame", "error_line", "error_token", "error_unit". Others: "port";
                      ///< "register" (a remark says which); "signature" (of a line on a board); "assertion", "finish"
                      ///< (of the RTL); "stage" (between the RTL's modules: --stages).
  std::int64_t expected = 0;
  std::int64_t actual = 0;
  std::string remark;               ///< more in words, or empty
  std::string assertion;            ///< the RTL's that ended the frame, "rtl/frame_control.sv:312", or empty
  bool other_state = false;         ///< seen from RunOptions::other_state alone: the run's own core has the frame right
  Before before = Before::nothing;  ///< this frame
  bool ahead = false;               ///< this frame is right: the one right ahead of it has wrong pixels

  /// Whether it is of registers, or of what failed while they were checked: no stage shows it in a frame, and no frame
  /// is to blame.
  [[nodiscard]] bool of_registers() const { return frame == kBehindFrames || field == "register"; }
};

/// Lines of one length, one after the other. Neighbours that are the same take room once, so the background that
/// follows an error in a frame is one line.
class Lines {
 public:
  void add(std::span<const std::uint8_t> line);
  [[nodiscard]] bool empty() const { return next_ == repeats_.size(); }
  [[nodiscard]] std::span<const std::uint8_t> front() const;
  void pop();
  [[nodiscard]] std::size_t bytes() const { return bytes_.size() + repeats_.size() * sizeof repeats_[0]; }

 private:
  std::size_t length_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint32_t> repeats_;
  std::size_t next_ = 0;
};

/// Compares a frame line by line, exactly: pixels in reading order, then size, then status, then conduct at the port.
/// Keeps the lines that the expected core is ahead.
class FrameComparison {
 public:
  /// With `keep`, what actual() was given from the first difference on is kept for drawn().
  FrameComparison(int frame, int channels, bool keep) : frame_(frame), channels_(channels), keep_(keep) {}

  /// The next lines of the expected core. They must be here before those of the actual one.
  void expect(Lines lines) {
    if (!lines.empty()) expected_.push_back(std::move(lines));
  }

  /// The next line of the actual core.
  void actual(std::span<const std::uint8_t> line);

  /// The actual core can go no further.
  void failed(const CoreFailure& failure) { failure_ = failure; }

  /// Both frames have ended. Nothing where all agree. After failed() what the actual one says of its frame is nothing.
  [[nodiscard]] std::optional<Difference> finish(const FrameEnd& expected, const FrameEnd& actual) const;

  /// A picture of which pixels may be missing: they are black, and the last ones.
  struct Drawn {
    Image image;
    std::size_t came = 0;  ///< bytes of `image` that are there, in reading order
  };

  /// After finish(): what the actual core drew, given what the expected one did; the same above the first difference.
  [[nodiscard]] Drawn drawn(const Image& expected) const;

 private:
  [[nodiscard]] std::optional<Difference> first_of(const FrameEnd& expected, const FrameEnd& actual) const;

  int frame_;
  int channels_;
  bool keep_;
  std::deque<Lines> expected_;
  int lines_ = 0;                    // that came from the actual core
  std::uint64_t pixels_ = 0;         // in them
  std::optional<Difference> first_;  // of pixels
  std::optional<CoreFailure> failure_;
  struct Unlike {
    int line;
    int expected;
    int actual;
  };
  std::optional<Unlike> unlike_;  // the first line of another length
  int kept_from_ = 0;             // line
  std::size_t kept_line_ = 0;     // its bytes
  std::vector<std::uint8_t> kept_;
};

/// "frame 3, line 17, x 204, red: expected 12, got 13".
std::string describe(const Difference& difference);

}  // namespace kage::cosim
