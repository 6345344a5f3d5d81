// SPDX-License-Identifier: Apache-2.0
#include "cosim/register_check.hpp"

#include <fmt/format.h>

#include <utility>

#include "cosim/register_frames.hpp"
#include "kage/defs.hpp"
#include "kage/registers.h"

namespace kage::cosim {
namespace {

constexpr int kOkay = 0;
constexpr int kSlverr = 2;
constexpr std::uint32_t kWatchdog = 50;  // clocks
constexpr std::uint64_t kLong = 20000;   // more than the spans of any frame here take

constexpr std::uint32_t kOverlaps = 12;

struct Wrong {
  std::string what;
};

/// Throws Wrong at the first thing that is.
class Checker {
 public:
  Checker(RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames)
      : rtl_(rtl), config_(config), frames_(frames) {}

  void all() {
    constants();
    addresses();
    overlaps();
    frames();
    dropped();
    if (config_.units > 1) behind();
    interrupt();
    cycles();
    watchdog();
  }

 private:
  static void same(const char* name, std::uint32_t expected, std::uint32_t actual) {
    if (expected != actual) throw Wrong{fmt::format("{}: expected {:#x}, got {:#x}", name, expected, actual)};
  }
  std::uint32_t read(const char* name, std::uint32_t address, int response = kOkay) {
    RegisterAccess r{name, {address, 0, 0, 0}};
    rtl_.access(nullptr, &r);
    responded(r, response);
    return r.bus.data;
  }
  void expect(const char* name, std::uint32_t address, std::uint32_t value) { same(name, value, read(name, address)); }
  void write(const char* name, std::uint32_t address, std::uint32_t value, int response = kOkay,
             unsigned strobes = 0b1111) {
    RegisterAccess w{name, {address, value, strobes, 0}};
    rtl_.access(&w, nullptr);
    responded(w, response);
  }
  static void responded(const RegisterAccess& access, int response) {
    same(fmt::format("response of {}", access.name).c_str(), static_cast<std::uint32_t>(response),
         static_cast<std::uint32_t>(access.bus.answer));
  }

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
  }

  void addresses() {
    read("an address without register", KAGE_REG_LAST + 4, kSlverr);
    write("an address without register", KAGE_REG_LAST + 4, 1, kSlverr);
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
    const std::uint32_t some = KAGE_CONTROL_FRAME_END_MASK | KAGE_CONTROL_WATCHDOG_MASK;
    write("CONTROL", KAGE_REG_CONTROL, some);
    expect("CONTROL", KAGE_REG_CONTROL, some);
    write("CONTROL", KAGE_REG_CONTROL, 0);
    write("ID", KAGE_REG_ID, 0);
    expect("ID", KAGE_REG_ID, KAGE_ID_VALUE);
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

  void frames() {
    for (const KnownFrame& f : frames_) {
      if (f.end.status.width == 0) continue;  // its header is refused: the driver resets the core
      rtl_.feed(f.words, kNowhere);
      const FrameEnd end = rtl_.finish(kNowhere);
      ++count_;
      blocked_ += static_cast<std::uint32_t>(end.stalls.blocked);
      if (f.end.status.error != ErrorCode::NONE) ++errors_;
      expect("FRAMES", KAGE_REG_FRAMES, count_);
      expect("ERRORS", KAGE_REG_ERRORS, errors_);
      if (f.end.status.error == ErrorCode::NONE) continue;
      expect("ERROR", KAGE_REG_ERROR,
             KAGE_FIELD_IS(KAGE_ERROR_LINE, f.end.status.line) |
                 KAGE_FIELD_IS(KAGE_ERROR_CODE, static_cast<std::uint32_t>(f.end.status.error)));
      expect("ERROR_TOKEN", KAGE_REG_ERROR_TOKEN, f.end.status.token);
    }
    expect("BLOCKED", KAGE_REG_BLOCKED, blocked_);
    expect("STATUS", KAGE_REG_STATUS, 0);
    expect("TREE", KAGE_REG_TREE, 0);
  }

  // A frame with an error lasts until its input has come.
  void dropped() {
    for (const KnownFrame& f : frames_) {
      if (f.end.status.width == 0 || f.end.status.error == ErrorCode::NONE) continue;
      rtl_.feed(f.words, kNowhere);  // but for the last beat
      // Its lines must be out: a blank pixel takes a clock, or several where the output's ready stops.
      const auto pixels =
          static_cast<std::uint64_t>(f.end.status.width) * static_cast<std::uint64_t>(f.end.status.height);
      rtl_.pass(kLong + 20 * pixels);
      const bool early = read("ERRORS", KAGE_REG_ERRORS) != errors_;
      if (early) {
        expect("STATUS, while input is dropped", KAGE_REG_STATUS,
               KAGE_STATUS_OPEN_MASK | KAGE_STATUS_DRAINING_MASK | KAGE_STATUS_WAITING_INPUT_MASK);
        expect("FRAMES, while input is dropped", KAGE_REG_FRAMES, count_);
      }
      (void)rtl_.finish(kNowhere);
      ++count_;
      ++errors_;
      expect("FRAMES", KAGE_REG_FRAMES, count_);
      if (early) return;
    }
  }

  void behind() {
    const FrameInParts f = unit_behind(config_);
    rtl_.feed(std::span(f.words).first(f.first + 1), kNowhere);  // the word behind the part stays with the driver
    rtl_.pass(kLong);
    expect("TREE", KAGE_REG_TREE, KAGE_TREE_BEHIND_MASK | KAGE_FIELD_IS(KAGE_TREE_UNIT, 1U));
    rtl_.feed(std::span(f.words).subspan(f.first + 1), kNowhere);
    (void)rtl_.finish(kNowhere);
    ++count_;
    expect("FRAMES", KAGE_REG_FRAMES, count_);
    expect("ERRORS", KAGE_REG_ERRORS, errors_);
  }

  // Frames have ended, of them some with an error, or none where chance has made no such frame.
  void interrupt() {
    const std::uint32_t error = errors_ > 0 ? 1 : 0;
    expect("IRQ", KAGE_REG_IRQ, KAGE_FIELD_IS(KAGE_IRQ_ERROR, error) | KAGE_IRQ_FRAME_END_MASK);
    same("irq", 0, rtl_.interrupt() ? 1 : 0);
    write("CONTROL", KAGE_REG_CONTROL, KAGE_CONTROL_ERROR_MASK);
    same("irq", error, rtl_.interrupt() ? 1 : 0);
    write("IRQ", KAGE_REG_IRQ, KAGE_IRQ_ERROR_MASK);
    expect("IRQ", KAGE_REG_IRQ, KAGE_IRQ_FRAME_END_MASK);
    same("irq", 0, rtl_.interrupt() ? 1 : 0);
    write("IRQ", KAGE_REG_IRQ, ~0U);
    expect("IRQ", KAGE_REG_IRQ, 0);
  }

  void cycles() {
    const std::uint64_t before = rtl_.clock();
    const std::uint32_t first = read("CYCLES", KAGE_REG_CYCLES);
    rtl_.pass(100);
    const std::uint64_t clocks = rtl_.clock() - before;
    same("CYCLES", static_cast<std::uint32_t>(clocks), read("CYCLES", KAGE_REG_CYCLES) - first);
  }

  // A frame whose end does not come.
  void watchdog() {
    const std::vector<std::uint32_t> words = eight_lines(config_);
    const std::size_t first = words.size() - static_cast<std::size_t>(config_.beat_words);
    rtl_.feed(std::span(words).first(first), kNowhere);
    write("WATCHDOG", KAGE_REG_WATCHDOG, kWatchdog);
    rtl_.pass(4 * std::uint64_t{kWatchdog} + 400 * static_cast<std::uint64_t>(register_frame_width(config_)));
    expect("STATUS", KAGE_REG_STATUS, KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_INPUT_MASK);
    expect("IRQ", KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    same("STALL", KAGE_STALL_ON_INPUT_MASK,
         read("STALL", KAGE_REG_STALL) & (KAGE_STALL_ON_INPUT_MASK | KAGE_STALL_ON_OUTPUT_MASK));
    rtl_.feed(std::span(words).subspan(first), kNowhere);
    (void)rtl_.finish(kNowhere);
    const std::uint32_t starved = read("STARVED", KAGE_REG_STARVED);
    if (starved < kWatchdog) throw Wrong{fmt::format("STARVED: expected at least {}, got {}", kWatchdog, starved)};
  }

  RtlCore& rtl_;
  const Config& config_;
  std::span<const KnownFrame> frames_;
  std::uint32_t count_ = 0;   // of frames that have ended
  std::uint32_t errors_ = 0;  // of them with an error
  std::uint32_t blocked_ = 0;
};

}  // namespace

KnownFrame known_frame(const Config& config, std::vector<std::uint32_t> words) {
  KnownFrame f;
  f.words = std::move(words);
  const auto golden = make_golden(config);
  const LineSink sink = [&f](int, std::span<const std::uint8_t> line) {
    f.lines.emplace_back(line.begin(), line.end());
  };
  golden->feed(f.words, sink);
  f.end = golden->finish(sink);
  return f;
}

std::optional<std::string> wrong_register(RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames) {
  try {
    Checker(rtl, config, frames).all();
  } catch (const Wrong& w) {
    return w.what;
  }
  return std::nullopt;
}

}  // namespace kage::cosim
