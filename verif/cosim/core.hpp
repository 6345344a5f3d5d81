// SPDX-License-Identifier: Apache-2.0
//
// Anything that turns the words of a frame into lines of pixels and a status: the golden model, the RTL. The comparison
// of two cores knows no more about them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "cosim/phases.hpp"
#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "kage/error.hpp"

namespace kage::cosim {

/// For lines that nobody looks at.
inline const LineSink kNowhere = [](int, std::span<const std::uint8_t>) {};

/// Event that RtlOptions::prelude let come right before a frame.
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

/// A core can go no further, by its own fault: it is different from one that can, whatever pixels it has sent.
class CoreFailure : public Error {
 public:
  [[nodiscard]] const std::string& field() const { return field_; }    ///< Difference::field
  [[nodiscard]] const std::string& remark() const { return remark_; }  ///< Difference::remark
  [[nodiscard]] const std::string& where() const { return where_; }    ///< Difference::assertion

 protected:
  /// `more` is what a person is told besides.
  CoreFailure(std::string field, const std::string& remark, std::string where = {}, const std::string& more = {})
      : Error(remark + more), field_(std::move(field)), remark_(remark), where_(std::move(where)) {}

 private:
  std::string field_;
  std::string remark_;
  std::string where_;
};

/// An assertion in the RTL failed.
class AssertionError : public CoreFailure {
 public:
  /// `where`: "rtl/frame_control.sv:312".
  explicit AssertionError(const std::string& where)
      : CoreFailure("assertion", "an assertion failed: " + where, where, " (its message is above)") {}
};

/// The RTL ended its simulation.
class FinishError : public CoreFailure {
 public:
  FinishError() : CoreFailure("finish", "the RTL ends the simulation by $finish") {}
};

/// A register's access went wrong.
class RegisterError : public CoreFailure {
 public:
  /// `what`: "register ERRORS (0x2c) does not answer".
  explicit RegisterError(const std::string& what) : CoreFailure("register", what) {}
};

/// Words flow in and lines flow out: a core keeps a few lines at most, whatever the size of the frame.
class Core {
 public:
  Core() = default;
  virtual ~Core() = default;
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  [[nodiscard]] virtual int channels() const = 0;

  /// The words of frame `number` are next. Random behaviour within a frame, as the clocks in which a port stops,
  /// follows from the core's seed and this number, not from the frames before it.
  virtual void begin(int /*number*/) {}

  /// The next words of the frame at hand, in pieces of any size. Lines that have come out go to `sink` before this
  /// returns, from top to bottom. This and finish() may throw CoreFailure; then nothing more may be asked of the core.
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
