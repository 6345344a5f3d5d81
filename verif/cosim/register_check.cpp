// SPDX-License-Identifier: Apache-2.0
#include "cosim/register_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cosim/register_clocks.hpp"
#include "cosim/register_frames.hpp"
#include "cosim/register_port.hpp"
#include "kage/defs.hpp"
#include "kage/registers.h"

namespace kage::cosim {
namespace {

constexpr std::uint32_t kWatchdog = 50;       // clocks
constexpr std::uint64_t kLong = 20000;        // more than any frame here takes to its standstill
constexpr std::uint32_t kLastAddress = 0xFC;  // that the port has
constexpr std::uint32_t kWaitingForInput = KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_INPUT_MASK;
constexpr std::uint32_t kInterrupts = KAGE_IRQ_FRAME_END_MASK | KAGE_IRQ_ERROR_MASK | KAGE_IRQ_WATCHDOG_MASK;

constexpr std::uint32_t kOverlaps = 12;
constexpr std::size_t kPiece = 512;  // words that are fed between two waits

class Checker : RegisterPort {
 public:
  Checker(RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames, const std::function<void()>& wait)
      : RegisterPort(rtl), rtl_(rtl), config_(config), frames_(frames), wait_(wait) {}

  void all() {
    constants();
    at_reset();
    writable();
    overlaps();
    frames();
    dropped();
    if (config_.units > 1) behind();
    output_stops();
    counts("CYCLES", KAGE_REG_CYCLES, true);
    input_stops();
    untouched();
    reset();
    check_clocks(*this, config_);
  }

 private:
  void constants() {
    const Config& c = config_;
    expect("ID", KAGE_REG_ID, KAGE_ID_VALUE);
    expect("VERSION", KAGE_REG_VERSION, kStreamVersion);
    expect("PARAM_HASH", KAGE_REG_PARAM_HASH, param_hash(c));
    expect("SHAPE", KAGE_REG_SHAPE,
           KAGE_FIELD_IS(KAGE_SHAPE_ARRANGEMENT, static_cast<std::uint32_t>(c.arrangement)) |
               KAGE_FIELD_IS(KAGE_SHAPE_BEAT_WORDS, static_cast<std::uint32_t>(c.beat_words)) |
               KAGE_FIELD_IS(KAGE_SHAPE_LANES, static_cast<std::uint32_t>(c.lanes)) |
               KAGE_FIELD_IS(KAGE_SHAPE_MAX_WIDTH, static_cast<std::uint32_t>(c.max_width)));
    expect("CAPABILITY", KAGE_REG_CAPABILITY,
           KAGE_CAPABILITY_SPANS_MASK | (c.active > 0 ? KAGE_CAPABILITY_POLYGONS_MASK : 0U) |
               KAGE_FIELD_IS(KAGE_CAPABILITY_ACTIVE, static_cast<std::uint32_t>(c.active)));
  }

  // Values after a reset of registers that change, in a core that stands still; CYCLES counts already.
  void at_reset() {
    for (std::uint32_t a = KAGE_REG_CONTROL; a <= KAGE_REG_STALL; a += 4)
      if (a != KAGE_REG_CYCLES) expect(fmt::format("address {:#04x}, behind reset", a).c_str(), a, 0);
    same("irq, behind reset", 0, rtl_.interrupt() ? 1 : 0);
  }

  // All that is written and counted holds something by now.
  void reset() {
    write("CONTROL", KAGE_REG_CONTROL, kInterrupts);
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0x12345678);
    rtl_.reset();
    at_reset();
  }

  // CONTROL is written by interrupts().
  void writable() {
    for (const std::uint32_t value : {0x12345678U, 0U}) {
      write("WATCHDOG", KAGE_REG_WATCHDOG, value);
      expect("WATCHDOG", KAGE_REG_WATCHDOG, value);
    }
    for (const unsigned strobes : {0b0101U, 0b1010U}) {
      write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
      write("WATCHDOG", KAGE_REG_WATCHDOG, 0x12345678, kOkay, strobes);
      expect("WATCHDOG, by bytes", KAGE_REG_WATCHDOG, strobes == 5 ? 0x00340078 : 0x12005600);
    }
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
    interrupts(0);
  }

  // Reads and writes do not know of each other.
  void overlaps() {
    std::uint32_t before = 0;
    for (std::uint32_t i = 0; i < kOverlaps; ++i) {
      RegisterAccess w{"WATCHDOG", {KAGE_REG_WATCHDOG, 0x9E3779B9U * (i + 1), 0b1111, 0}};
      const bool other = i % 2 == 0;
      RegisterAccess r{other ? "PARAM_HASH" : "WATCHDOG", {other ? KAGE_REG_PARAM_HASH : KAGE_REG_WATCHDOG, 0, 0, 0}};
      rtl_.access(&w, &r);
      responded(w, kOkay);
      responded(r, kOkay);
      // The register itself is read before the write, or behind it.
      if (other || r.bus.data != before) same(r.name, other ? param_hash(config_) : w.bus.data, r.bus.data);
      expect("WATCHDOG", KAGE_REG_WATCHDOG, w.bus.data);
      before = w.bus.data;
    }
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
  }

  // ---- what frames leave behind ---------------------------------------------------------------------------

  void frames() {
    for (const KnownFrame& f : frames_) {
      if (f.end.status.width == 0) continue;  // its header is refused: the driver resets the core
      const bool wrong = f.end.status.error != ErrorCode::NONE;
      for (std::size_t at = 0; at < f.words.size(); at += kPiece) {
        wait_();
        rtl_.feed(std::span(f.words).subspan(at, std::min(kPiece, f.words.size() - at)), kNowhere);
      }
      if (wrong) ++errors_;
      ended();
      if (wrong) newest_error(f.end.status);
      const std::uint32_t happened = KAGE_IRQ_FRAME_END_MASK | (wrong ? KAGE_IRQ_ERROR_MASK : 0);
      expect("IRQ", KAGE_REG_IRQ, happened);
      write("IRQ", KAGE_REG_IRQ, happened);
    }
  }

  // The frame at hand ends. Clocks in which a pixel waits are seen at the port, so the driver counts them as BLOCKED
  // does. STARVED also asks whether the core has work left, which the port does not show: counts() looks at it.
  void ended() {
    const FrameEnd end = rtl_.finish(kNowhere);
    ++count_;
    blocked_ += static_cast<std::uint32_t>(end.stalls.blocked);
    expect("FRAMES", KAGE_REG_FRAMES, count_);
    expect("ERRORS", KAGE_REG_ERRORS, errors_);
    expect("BLOCKED", KAGE_REG_BLOCKED, blocked_);
    expect("STATUS", KAGE_REG_STATUS, 0);
    expect("TREE", KAGE_REG_TREE, 0);
  }

  void newest_error(const FrameStatus& status) {
    expect("ERROR", KAGE_REG_ERROR,
           KAGE_FIELD_IS(KAGE_ERROR_LINE, status.line) |
               KAGE_FIELD_IS(KAGE_ERROR_CODE, static_cast<std::uint32_t>(status.error)));
    expect("ERROR_FRAME", KAGE_REG_ERROR_FRAME, status.frame);
    expect("ERROR_TOKEN", KAGE_REG_ERROR_TOKEN, status.token);
    if (is_of_unit(status.error)) expect("ERROR_UNIT", KAGE_REG_ERROR_UNIT, status.unit);
  }

  // ---- standstills ----------------------------------------------------------------------------------------

  // All of the first part is taken, and the core waits for the second.
  void first_part(const FrameInParts& f) {
    rtl_.feed(std::span(f.words).first(f.first + 1), kNowhere);  // the word behind the part stays with the driver
    rtl_.pass(kLong);
  }
  void second_part(const FrameInParts& f) {
    rtl_.feed(std::span(f.words).subspan(f.first + 1), kNowhere);
    ended();
  }

  // A frame with an error lasts until its input has come.
  void dropped() {
    const FrameInParts f = early_error(config_);
    first_part(f);
    ++errors_;
    expect("ERRORS, while input is dropped", KAGE_REG_ERRORS, errors_);
    newest_error(known_frame(config_, f.words).end.status);
    expect("STATUS, while input is dropped", KAGE_REG_STATUS, kWaitingForInput | KAGE_STATUS_DRAINING_MASK);
    expect("FRAMES, while input is dropped", KAGE_REG_FRAMES, count_);
    interrupts(KAGE_IRQ_ERROR_MASK);
    second_part(f);
    interrupts(KAGE_IRQ_FRAME_END_MASK);
  }

  void behind() {
    const FrameInParts f = unit_behind(config_);
    first_part(f);
    const std::uint32_t tree = KAGE_TREE_BEHIND_MASK | KAGE_FIELD_IS(KAGE_TREE_UNIT, 1U);
    expect("TREE", KAGE_REG_TREE, tree);
    expect("STATUS, with a unit behind", KAGE_REG_STATUS, kWaitingForInput);
    bites(KAGE_STALL_ON_INPUT_MASK | KAGE_STALL_BEHIND_MASK | KAGE_FIELD_IS(KAGE_STALL_UNIT, 1U), 0);
    second_part(f);
    interrupts(KAGE_IRQ_FRAME_END_MASK);
  }

  // A frame whose pixels do not leave, though its input is done.
  void output_stops() {
    rtl_.feed(one_line(config_), kNowhere);
    rtl_.hold_output(true);
    rtl_.end_input();
    rtl_.pass(kLong);
    expect("STATUS, while output stands still", KAGE_REG_STATUS,
           KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK);
    expect("FRAMES, while output stands still", KAGE_REG_FRAMES, count_ + 1);
    counts("BLOCKED", KAGE_REG_BLOCKED, true);
    counts("STARVED", KAGE_REG_STARVED, false);
    bites(KAGE_STALL_ON_OUTPUT_MASK | KAGE_FIELD_IS(KAGE_STALL_LINE, 1U), KAGE_IRQ_FRAME_END_MASK);
    rtl_.hold_output(false);
    ended();
  }

  // A frame whose end does not come, behind one with an error: everything has happened then that interrupts.
  void input_stops() {
    const FrameInParts wrong = early_error(config_);
    rtl_.feed(wrong.words, kNowhere);
    ++errors_;
    ended();
    const FrameInParts f = eight_lines(config_);
    const std::uint32_t stall =
        KAGE_STALL_ON_INPUT_MASK | KAGE_FIELD_IS(KAGE_STALL_LINE, static_cast<std::uint32_t>(f.lines));
    const std::uint32_t happened = KAGE_IRQ_FRAME_END_MASK | KAGE_IRQ_ERROR_MASK;
    // The watchdog is awake while the frame moves. It may bite then where a port rests for long, but it bites at the
    // standstill anyway, because what moves has set it back.
    write("WATCHDOG", KAGE_REG_WATCHDOG, kWatchdog);
    first_part(f);
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
    expect("STALL, of a watchdog that was awake before", KAGE_REG_STALL, stall);
    expect("IRQ, of a watchdog that was awake before", KAGE_REG_IRQ, happened | KAGE_IRQ_WATCHDOG_MASK);
    write("IRQ", KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    expect("STATUS, while input stands still", KAGE_REG_STATUS, kWaitingForInput);
    counts("STARVED", KAGE_REG_STARVED, true);
    counts("BLOCKED", KAGE_REG_BLOCKED, false);
    bites(stall, happened);
    second_part(f);
    expect("STALL", KAGE_REG_STALL, stall);
  }

  // ---- what every standstill is asked ---------------------------------------------------------------------

  // The counter goes up by one in each clock, or not at all. A counter of the core's activity meets this exactly while
  // the core stands still: then all clocks are alike.
  void counts(const char* name, std::uint32_t address, bool each_clock) {
    const std::uint64_t before = rtl_.clock();
    const std::uint32_t first = read(name, address);
    rtl_.pass(100);
    const std::uint64_t clocks = rtl_.clock() - before;
    same(name, each_clock ? static_cast<std::uint32_t>(clocks) : 0, read(name, address) - first);
  }

  // The watchdog bites when its time is up, and once. `happened` is in IRQ already.
  void bites(std::uint32_t stall, std::uint32_t happened) {
    expect("IRQ", KAGE_REG_IRQ, happened);
    write("WATCHDOG", KAGE_REG_WATCHDOG, kWatchdog);
    rtl_.pass(kWatchdog / 2);
    expect("IRQ, before the watchdog bites", KAGE_REG_IRQ, happened);
    rtl_.pass(std::uint64_t{2} * kWatchdog);
    expect("STALL", KAGE_REG_STALL, stall);
    interrupts(happened | KAGE_IRQ_WATCHDOG_MASK);
    rtl_.pass(std::uint64_t{2} * kWatchdog);
    expect("IRQ, behind the watchdog's bite", KAGE_REG_IRQ, 0);
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
  }

  // The pin is high while something has happened that is enabled. The bits of what has happened are cleared, one at a
  // time; no enable is left.
  void interrupts(std::uint32_t happened) {
    while (true) {
      expect("IRQ", KAGE_REG_IRQ, happened);
      for (std::uint32_t enabled = 0; enabled <= kInterrupts; ++enabled) {
        write("CONTROL", KAGE_REG_CONTROL, enabled);
        expect("CONTROL", KAGE_REG_CONTROL, enabled);
        same(fmt::format("irq, IRQ {:#x} with CONTROL {:#x}", happened, enabled), (happened & enabled) != 0 ? 1 : 0,
             rtl_.interrupt() ? 1 : 0);
      }
      write("CONTROL", KAGE_REG_CONTROL, 0);
      if (happened == 0) return;
      const std::uint32_t lowest = happened & (~happened + 1);
      write("IRQ", KAGE_REG_IRQ, lowest);
      happened &= ~lowest;
    }
  }

  // ---- what no write changes ------------------------------------------------------------------------------

  // Registers that are only read ignore writes, and addresses behind the last register refuse all accesses. No frame is
  // open, so nothing but CYCLES changes by itself.
  void untouched() {
    write("CONTROL", KAGE_REG_CONTROL, kInterrupts);
    write("WATCHDOG", KAGE_REG_WATCHDOG, 0x12345678);
    std::vector<std::uint32_t> before;
    std::uint64_t cycles_read = 0;
    for (std::uint32_t a = 0; a <= KAGE_REG_LAST; a += 4) {
      if (a == KAGE_REG_CYCLES) cycles_read = rtl_.clock();
      before.push_back(read("a register", a));
    }
    for (std::uint32_t a = 0; a <= kLastAddress; a += 4) {
      const std::string name = fmt::format("address {:#04x}", a);
      if (a > KAGE_REG_LAST) {
        (void)read(name.c_str(), a, kSlverr);
        write(name.c_str(), a, ~0U, kSlverr);
      } else if (a != KAGE_REG_CONTROL && a != KAGE_REG_IRQ && a != KAGE_REG_WATCHDOG) {
        write(name.c_str(), a, ~before[a / 4]);
      }
    }
    for (std::uint32_t a = 0; a <= KAGE_REG_LAST; a += 4) {
      const std::string name = fmt::format("address {:#04x}, behind writes that change nothing", a);
      const auto passed = static_cast<std::uint32_t>(rtl_.clock() - cycles_read);
      expect(name.c_str(), a, before[a / 4] + (a == KAGE_REG_CYCLES ? passed : 0));
    }
  }

  RtlCore& rtl_;
  const Config& config_;
  std::span<const KnownFrame> frames_;
  const std::function<void()>& wait_;
  std::uint32_t count_ = 0;   // of frames that have ended
  std::uint32_t errors_ = 0;  // of them with an error
  std::uint32_t blocked_ = 0;
};

}  // namespace

KnownFrame known_frame(const Config& config, std::vector<std::uint32_t> words, const LineSink& sink) {
  KnownFrame f;
  f.words = std::move(words);
  f.end = make_golden(config)->frame(f.words, sink);
  return f;
}

std::optional<std::string> wrong_register(RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames,
                                          const std::function<void()>& wait) {
  try {
    Checker(rtl, config, frames, wait).all();
  } catch (const WrongRegister& w) {
    return w.what;
  }
  return std::nullopt;
}

}  // namespace kage::cosim
