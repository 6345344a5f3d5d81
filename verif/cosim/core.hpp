// SPDX-License-Identifier: Apache-2.0
//
// Anything that turns the words of a frame into lines of pixels and a status: the golden model, the RTL. What compares
// them knows no more.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "cosim/phases.hpp"
#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "kage/error.hpp"

namespace kage::cosim {

/// For lines that nobody looks at.
inline const LineSink kNowhere = [](int, std::span<const std::uint8_t>) {};

/// What RtlOptions::prelude let come right before a frame.
enum class Before {
  nothing,
  reset,  ///< within another frame, or behind it
  frame   ///< another one, that was still in the core
};

/// How a core ended a frame.
struct FrameEnd {
  FrameStatus status;
  std::string misconduct;  ///< what was wrong with how the pixels came: "TLAST wrong on 2 pixels"; empty if nothing
  double seconds = 0;      ///< wall time inside the core
  Before before = Before::nothing;
  bool ahead_wrong = false;    ///< that other frame has wrong pixels: `misconduct` says so
  std::uint64_t cycles = 0;    ///< core clock edges; 0 for a core without clock
  Stalls stalls;               ///< clocks of them that were lost
  PhaseStalls phase_stalls{};  ///< which of those in which phase
};

/// An assertion in the RTL failed, so that the core can go no further.
class AssertionError : public Error {
 public:
  /// `where`: "rtl/frame_control.sv:312".
  explicit AssertionError(const std::string& where)
      : Error("an assertion failed: " + where + " (its message is above)"), where_(where) {}
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  std::string where_;
};

/// Words flow in and lines flow out: a core keeps a few lines at most, whatever the size of the frame.
class Core {
 public:
  Core() = default;
  virtual ~Core() = default;
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  [[nodiscard]] virtual int channels() const = 0;

  /// The words of frame `number` are next. What is random about a frame, as the clocks in which a port stops, follows
  /// from the core's seed and this number, not from the frames before it.
  virtual void begin(int /*number*/) {}

  /// The next words of the frame at hand, in pieces of any size. Lines that have come out go to `sink` before this
  /// returns, from top to bottom. This and finish() may throw AssertionError; then nothing more may be asked of the
  /// core.
  virtual void feed(std::span<const std::uint32_t> words, const LineSink& sink) = 0;

  /// The frame's words have all been fed, TLAST with the beat of the last. The other lines go to `sink`; the last one
  /// is shorter than the others if pixels are missing. Frames follow each other without a reset.
  virtual FrameEnd finish(const LineSink& sink) = 0;

  /// A frame whose words are all there.
  FrameEnd frame(std::span<const std::uint32_t> words, const LineSink& sink) {
    feed(words, sink);
    return finish(sink);
  }
};

/// The golden model.
std::unique_ptr<Core> make_golden(const Config& config);

}  // namespace kage::cosim
