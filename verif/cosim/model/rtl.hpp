// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/core.hpp"
#include "cosim/diverge/stage_values.hpp"
#include "cosim/model/driver/rtl_model.h"

namespace kage::cosim {

struct RtlOptions {
  std::uint64_t seed = 1;        ///< of the stalls, and of the initial state
  std::uint64_t initial = 0;     ///< another one's initial state, with this seed's stalls: 0 is its own
  int idle_percent = 0;          ///< share of clocks without input offered
  int backpressure_percent = 0;  ///< share of clocks without output taken
  int mutant = 0;                ///< of a model that has mutants: which one it is, from 1; 0: none
  bool assertions = true;        ///< false: go on where the RTL's assertions fail

  /// Gets what the RTL writes, as by $display or an assertion that fails, in pieces of any size, with the number of the
  /// frame at hand. Without it, the text goes to standard error.
  std::function<void(int frame, std::string_view text)> text = {};

  /// Gives the words of a frame for every number, negative ones too; it may break rules. With it, some frames meet a
  /// core that was reset within such a frame just before. Others come right behind one or two such frames, or a few
  /// clocks later, mostly before their pixels have left. Seed and number decide which. The earlier frames' pixels and
  /// errors are looked at too. A core that records has seen their end before.
  std::function<std::vector<std::uint32_t>(int number)> prelude = {};
};

/// An access of a register by AXI4-Lite.
struct RegisterAccess {
  const char* name;     ///< for RegisterError
  kage_rtl_access bus;  ///< what goes there, and comes from there
};

/// The RTL, simulated. Events and handshakes need a model that was built with monitors, waveforms and counts of lines
/// one that was built for them (ModelOptions).
class RtlCore : public Core {
 public:
  /// A write, a read (the other is nullptr), or both at the same time, while the streams go on; by a master that takes
  /// its time (kage_rtl_table::reg_access). Throws RegisterError where no response comes, or one that breaks
  /// AXI4-Lite's rules; CoreFailure as of Core.
  virtual void access(RegisterAccess* write, RegisterAccess* read) = 0;

  /// A write, or a read, whose address and data come in its first clock, and whose response is taken in the clock in
  /// which it comes. Throws as access() does.
  virtual void access_at_once(RegisterAccess& access, bool write) = 0;
  [[nodiscard]] virtual bool interrupt() const = 0;

  /// Two clocks of reset, between frames.
  virtual void reset() = 0;

  /// Whether it stood still in the frame at hand, with input waiting: it takes nothing more of it.
  [[nodiscard]] virtual bool stuck() const = 0;

  /// The words of the frame at hand have all been fed: its last beat may come from now on. Nothing is waited for;
  /// finish() must follow.
  virtual void end_input() = 0;

  /// Output is taken in no clock from now on, or as the stalls have it again. Nothing but pass() and access() lets time
  /// pass meanwhile: feed() and finish() might wait for ever.
  virtual void hold_output(bool on) = 0;

  /// Let so many clocks pass at most; fewer if nothing moves any more.
  virtual void pass(std::uint64_t clocks) = 0;

  [[nodiscard]] virtual bool monitored() const = 0;

  /// Monitors that do not fit the RTL, "a, b", and a bit for each stage of which there are no events therefore.
  [[nodiscard]] virtual std::string missing_monitors() const = 0;
  [[nodiscard]] virtual std::uint32_t unwatched() const = 0;

  /// Record events from now on, or no longer. `often` is called within feed() and finish() once so many clocks have
  /// passed that events should be taken, whatever the core does; it may throw, and then the core can be given nothing
  /// more.
  virtual void record(bool on, std::function<void()> often = {}) = 0;

  /// The events since the last call. Valid until the next.
  virtual std::span<const kage_rtl_event> take_events() = 0;

  /// Who waits for whom: kage_rtl_table::handshakes.
  virtual Handshakes handshakes() = 0;

  /// Clocks of the model's life.
  virtual std::uint64_t clock() = 0;

  /// Write a waveform of the clocks first .. last to an FST file; it is whole once they have passed, or with the
  /// model's end. Throws Error if the model was not built for waveforms.
  virtual void wave(const std::filesystem::path& path, std::uint64_t first, std::uint64_t last) = 0;

  /// Ends it. 0: it is whole; else the errno of what could not be written.
  virtual int end_wave() = 0;

  /// Each line and branch of the RTL ("token_reader.sv:120 else"), and how often it has run in the model's life. Throws
  /// Error if the model was not built to count them.
  virtual std::map<std::string, std::uint64_t> lines() = 0;
};

/// The RTL, simulated by the model library that find_model() gave. Throws Error if the library does not fit.
std::unique_ptr<RtlCore> make_rtl(const std::filesystem::path& library, const Config& config,
                                  const RtlOptions& options = {});

}  // namespace kage::cosim
