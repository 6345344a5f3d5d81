// SPDX-License-Identifier: Apache-2.0
#include "cosim/register_clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "cosim/register_frames.hpp"
#include "kage/registers.h"

namespace kage::cosim {
namespace {

constexpr std::uint64_t kPatience = 20000;  // clocks that no event here takes to come
constexpr std::uint64_t kRound = 4;         // clocks before an event, and behind it, that are tried
// From the first clock of an access on: what is read is as it is then, what is written is there so many clocks later.
constexpr std::uint64_t kWriteClocks = 2;
constexpr std::uint32_t kBite = 40;  // clocks without progress

/// Something that interrupts, and how it is brought about. `begin` always takes as many clocks, and so does the event
/// from there on; `end` brings the core to rest.
struct Event {
  const char* name;
  std::uint32_t bit;      // in IRQ
  const char* counter;    // that counts it; none for the watchdog
  std::uint32_t address;  // of that
  std::function<void()> begin;
  std::function<void()> end;
};

class ClockChecker {
 public:
  ClockChecker(const RegisterPort& port, const Event& event) : port_(port), rtl_(port.rtl()), event_(event) {}

  void all() {
    port_.write("CONTROL", KAGE_REG_CONTROL, event_.bit);
    const std::uint64_t when = clocks();
    const std::uint64_t first = when > kRound ? when - kRound : 0;
    for (std::uint64_t clock = first; clock <= when + kRound; ++clock) {
      reads(clock, when);
      clears(clock, when);
    }
    port_.write("IRQ", KAGE_REG_IRQ, ~0U);
    port_.write("CONTROL", KAGE_REG_CONTROL, 0);
  }

 private:
  /// Clocks from `begin` until the pin is high.
  std::uint64_t clocks() {
    port_.write("IRQ", KAGE_REG_IRQ, ~0U);
    event_.begin();
    std::uint64_t n = 0;
    for (; !rtl_.interrupt(); ++n) {
      if (n == kPatience) throw WrongRegister{fmt::format("irq, {}: it does not come", event_.name)};
      rtl_.pass(1);
    }
    event_.end();
    return n;
  }

  [[nodiscard]] std::string at(const char* what, std::uint64_t clock, std::uint64_t when) const {
    const bool before = clock < when;
    const std::uint64_t apart = before ? when - clock : clock - when;
    return fmt::format("{} {} {} {} {}", what, apart, apart == 1 ? "clock" : "clocks", before ? "before" : "behind",
                       event_.name);
  }

  void reads(std::uint64_t clock, std::uint64_t when) {
    const std::uint32_t there = clock >= when ? 1 : 0;
    port_.write("IRQ", KAGE_REG_IRQ, ~0U);
    event_.begin();
    rtl_.pass(clock);
    RegisterPort::same(at("IRQ, read", clock, when), there * event_.bit,
                       port_.read_at_once("IRQ", KAGE_REG_IRQ) & event_.bit);
    event_.end();
    if (event_.counter == nullptr) return;
    const std::uint32_t count = port_.read(event_.counter, event_.address);
    event_.begin();
    rtl_.pass(clock);
    RegisterPort::same(at(fmt::format("{}, read", event_.counter).c_str(), clock, when), count + there,
                       port_.read_at_once(event_.counter, event_.address));
    event_.end();
  }

  // The event before has left its bit.
  void clears(std::uint64_t clock, std::uint64_t when) {
    event_.begin();
    event_.end();
    event_.begin();
    rtl_.pass(clock);
    port_.write_at_once("IRQ", KAGE_REG_IRQ, event_.bit);
    event_.end();
    RegisterPort::same(at("IRQ, cleared", clock + kWriteClocks, when), clock + kWriteClocks <= when ? event_.bit : 0,
                       port_.read("IRQ", KAGE_REG_IRQ) & event_.bit);
  }

  const RegisterPort& port_;
  RtlCore& rtl_;
  const Event& event_;
};

}  // namespace

void check_clocks(const RegisterPort& port, const Config& config) {
  RtlCore& rtl = port.rtl();
  const auto finish = [&] { (void)rtl.finish(kNowhere); };
  // The stalls begin anew with each frame, so all take the same clocks.
  const auto frame = [&rtl](std::vector<std::uint32_t> words) {
    return [&rtl, words = std::move(words)] {
      rtl.hold_output(false);
      rtl.feed(words, kNowhere);
      rtl.end_input();
    };
  };
  const Event ended{"the end of a frame", KAGE_IRQ_FRAME_END_MASK, "FRAMES",
                    KAGE_REG_FRAMES,      frame(one_line(config)), finish};
  ClockChecker(port, ended).all();

  const Event error{"an error", KAGE_IRQ_ERROR_MASK, "ERRORS", KAGE_REG_ERRORS, frame(early_end(config)), finish};
  ClockChecker(port, error).all();

  // A frame stands still, and the watchdog bites anew each time that its limit is written.
  const FrameInParts still = eight_lines(config);
  rtl.feed(std::span(still.words).first(still.first + 1), kNowhere);
  rtl.pass(kPatience);
  const Event bite{"the watchdog's bite",
                   KAGE_IRQ_WATCHDOG_MASK,
                   nullptr,
                   0,
                   [&] { port.write_at_once("WATCHDOG", KAGE_REG_WATCHDOG, kBite); },
                   [&] { rtl.pass(std::uint64_t{2} * kBite); }};
  ClockChecker(port, bite).all();
  port.write("WATCHDOG", KAGE_REG_WATCHDOG, 0);
  rtl.feed(std::span(still.words).subspan(still.first + 1), kNowhere);
  finish();
}

}  // namespace kage::cosim
