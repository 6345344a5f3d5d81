// SPDX-License-Identifier: Apache-2.0
//
// A model: a verilated kage_top, with the driver around it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "Vkage.h"
#include "flow.hpp"
#include "idle.hpp"
#include "params.inc"  // made by build.py: kParamNames, kParamValues, kFault, kBeatWords, kChannels, kMaxWidth, kLanes, kActive
#include "register_bus.hpp"
#include "rtl_model.h"
#include "verilated.h"
#ifdef KAGE_WAVES
#include "verilated_fst_c.h"

/// The errno of what first could not be written of a waveform: 0 for nothing.
inline int wave_error = 0;
#endif

inline thread_local kage_rtl* current = nullptr;  // the model that this thread lets work

inline void put_words(IData& port, const std::uint32_t* words) { port = words[0]; }
inline void put_words(QData& port, const std::uint32_t* words) { port = words[0] | static_cast<QData>(words[1]) << 32; }
template <std::size_t N>
void put_words(VlWide<N>& port, const std::uint32_t* words) {
  for (std::size_t i = 0; i < N; ++i) port[i] = words[i];
}

// Clocks without any movement after which the core counts as idle.
inline constexpr std::uint64_t kIdleClocks = idle_clocks(kMaxWidth, kLanes, kActive);

struct kage_rtl {
  struct Block {
    std::vector<std::uint32_t> words;  // whole beats
    std::vector<std::uint8_t> marks;   // of the words
    bool last;
  };

  struct Size {
    std::uint32_t width, height;
  };

  std::uint64_t initial;  // the seed of registers and memories
  VerilatedContext context;
  std::unique_ptr<Vkage> top;
  Flow input, output;
  Random noise;  // on lines of data and address while their valid is 0
  RegisterBus bus;

  std::deque<Block> queue;
  std::size_t at = 0;                    // word of queue.front() that is offered next
  std::uint8_t mark = 0;                 // of that word, or of the last one if there is none
  std::vector<std::uint8_t> next_marks;  // of the words that are submitted next
  bool offered = false;

  std::deque<Size> expected;
  std::uint32_t x = 0, y = 0;
  std::vector<std::uint8_t> pixels;
  std::uint64_t pixel_count = 0;
  bool waiting = false;  // a pixel was there but not taken
  std::uint32_t waiting_value = 0;

  std::uint64_t quiet = 0;
  std::uint64_t clocks = 0;
  kage_rtl_stats stats{};

  int mutant = 0;
  std::string failure;  // the first assertion that failed
  void (*text)(void* user, const char* piece) = nullptr;
  void* text_user = nullptr;

  bool recording = false;
  std::vector<kage_rtl_event> events;
  std::int64_t handshakes = 0;
#ifdef KAGE_WAVES
  std::unique_ptr<VerilatedFstC> fst;
  std::string wave_path;
  std::uint64_t wave_first = 1, wave_last = 0;
#endif

  explicit kage_rtl(std::uint64_t seed) : initial(seed), noise(seed) {
#ifdef KAGE_WAVES
    context.traceEverOn(true);
#endif
    enter();
    context.threads(1);  // else each model starts a thread per processor, which none of its work goes to
    context.fatalOnError(false);
    // Where memory runs out within Verilator's constructor, it erases scopes that are not there yet and crashes. So
    // more than it takes is asked for first: a lack of memory is found here, as std::bad_alloc.
    constexpr std::size_t kRoom = std::size_t{8} << 20;
    ::operator delete(::operator new(kRoom));
    top = std::make_unique<Vkage>(&context, "top");
    idle_inputs();
    top->clk_i = 0;
    top->rst_ni = 0;
    reset(2);
  }
  ~kage_rtl() {
    enter();
    close_wave();
    top->final();
    top.reset();
  }

  // Verilator books failed assertions, and a model's end, to the context of the thread, which is that of the model made
  // last on it. So every call that lets time pass or ends a model begins with this.
  void enter() {
    Verilated::threadContextp(&context);
    current = this;
  }

  void idle_inputs() {
    top->m_axis_tready_i = 0;
    bus.write.drop(KAGE_RTL_NO_ANSWER);
    bus.read.drop(KAGE_RTL_NO_ANSWER);
    bus.drive(*top, noise);
    no_beat();
  }

  // No beat is offered.
  void no_beat() {
    std::uint32_t words[kBeatWords];
    for (std::uint32_t& word : words) word = noise.next();
    put_words(top->s_axis_tdata_i, words);
    top->s_axis_tlast_i = noise.next() & 1;
    top->s_axis_tvalid_i = 0;
  }

  // A clock is two steps. settle(): inputs may have changed since the last edge, and outputs follow them, as a ready
  // may that waits for its valid. The port's values are then those at the edge. tick(): the edge.
  void settle() {
    top->clk_i = 0;
    top->eval();
    if (clocks > 0) dump(clocks - 1, 2 * clocks - 1);
  }
  void tick() {
    top->clk_i = 1;
    top->eval();
    dump(clocks, 2 * clocks);
    context.timeInc(1);
    ++clocks;
  }

#ifdef KAGE_WAVES
  void dump(std::uint64_t clock, std::uint64_t time) {
    if (clock < wave_first || clock > wave_last) return;
    if (!fst) {
      fst = std::make_unique<VerilatedFstC>();
      top->trace(fst.get(), 99);
      fst->open(wave_path.c_str());
    }
    fst->dump(time);
    if (time == 2 * wave_last + 1) close_wave();
  }
  void close_wave() {
    if (fst) fst->close();
    fst.reset();
    wave_last = 0;
    wave_first = 1;
  }
#else
  void dump(std::uint64_t, std::uint64_t) {}
  void close_wave() {}
#endif

  void reset(std::uint32_t clocks) {
    enter();
    queue.clear();
    expected.clear();
    at = 0;
    offered = false;
    waiting = false;
    x = y = 0;
    quiet = 0;
    top->rst_ni = 0;
    for (std::uint32_t i = 0; i < (clocks > 0 ? clocks : 1); ++i) {
      idle_inputs();
      settle();
      tick();
    }
    top->rst_ni = 1;
  }

  void stalls(std::uint32_t input_share, std::uint32_t output_share, std::uint64_t seed) {
    input = Flow(input_share, seed * 2 + 1);
    output = Flow(output_share, seed * 2 + 2);
    noise = Random(~seed);
  }

  // Whether one was expected.
  bool take_pixel(std::uint32_t value) {
    bool first = false;
    bool last = false;
    const bool due = !expected.empty();
    if (!due) {
      ++stats.extra_pixels;
    } else {
      first = x == 0 && y == 0;
      last = x + 1 == expected.front().width;
      if (first != static_cast<bool>(top->m_axis_tuser_o)) ++stats.user_errors;
      if (last != static_cast<bool>(top->m_axis_tlast_o)) ++stats.last_errors;
      if (last) {
        x = 0;
        if (++y == expected.front().height) {
          y = 0;
          expected.pop_front();
        }
      } else {
        ++x;
      }
    }
    for (int c = 0; c < kChannels; ++c) pixels.push_back(static_cast<std::uint8_t>(value >> (8 * c)));
    ++pixel_count;
    ++stats.pixels;
    return due;
  }

  // One clock.
  void clock() {
    drive();
    finish_clock();
  }

  // Lets the streams go on in this clock; afterwards all ports have the values that the edge will see.
  void drive() {
    if (!offered && !queue.empty()) {
      offered = input.next();
      if (offered) {
        const Block& b = queue.front();
        put_words(top->s_axis_tdata_i, b.words.data() + at);
        top->s_axis_tlast_i = b.last && at + kBeatWords == b.words.size() ? 1 : 0;
      }
    }
    if (offered)
      top->s_axis_tvalid_i = 1;
    else
      no_beat();
    bus.drive(*top, noise);
    top->m_axis_tready_i = output.next() ? 1 : 0;
    settle();
  }

  // The edge, and what it passed.
  void finish_clock() {
    const bool ready = top->m_axis_tready_i != 0;
    const bool beat = offered && top->s_axis_tready_o;
    const bool pixel = top->m_axis_tvalid_o;
    const std::uint32_t value = static_cast<std::uint32_t>(top->m_axis_tdata_o);
    const std::uint32_t all = value | static_cast<std::uint32_t>(top->m_axis_tuser_o) << 24 |
                              static_cast<std::uint32_t>(top->m_axis_tlast_o) << 25;
    if (waiting && (!pixel || all != waiting_value)) ++stats.unstable;
    waiting = pixel && !ready;
    waiting_value = all;
    if (!queue.empty()) mark = queue.front().marks[at];
    if (top->s_axis_tready_o && !offered && !queue.empty()) ++stats.starved[mark];
    if (waiting) ++stats.blocked[mark];
    // Pixels that no frame has room for are no progress: a core that never stops sending stands still too.
    const bool due = pixel && ready && take_pixel(value);
    bus.look(*top);
    ++stats.cycles;
    quiet = beat || due ? 0 : quiet + (ready && (offered || queue.empty()) ? 1 : 0);

    tick();

    if (beat) {
      offered = false;
      ++stats.beats;
      at += kBeatWords;
      if (at >= queue.front().words.size()) {
        if (queue.front().last) mark = KAGE_RTL_MARKS - 1;
        queue.pop_front();
        at = 0;
      }
    }
  }

  // An assertion has failed, or the RTL has ended the simulation.
  bool ended() { return context.gotError() || context.gotFinish(); }

  int run(std::uint64_t want, std::uint64_t max_clocks) {
    enter();
    quiet = 0;
    for (std::uint64_t n = 0;; ++n) {
      if (ended()) return KAGE_RTL_ASSERT;
      if (pixel_count >= want) return KAGE_RTL_PIXELS;
      if (quiet >= kIdleClocks) return queue.empty() ? KAGE_RTL_IDLE : KAGE_RTL_STUCK;
      if (n >= max_clocks) return KAGE_RTL_LIMIT;
      clock();
    }
  }

  int run_dry(std::uint64_t max_clocks) {
    enter();
    quiet = 0;
    for (std::uint64_t n = 0;; ++n) {
      if (ended()) return KAGE_RTL_ASSERT;
      if (queue.empty()) return KAGE_RTL_DRY;
      if (quiet >= kIdleClocks) return KAGE_RTL_STUCK;
      if (n >= max_clocks) return KAGE_RTL_LIMIT;
      clock();
    }
  }

  // Until the accesses that have begun come to an end.
  void wait_for_registers() {
    enter();
    for (int n = 0; n < 1000 && (bus.write.open() || bus.read.open()); ++n) {
      clock();
      if (ended()) break;
    }
    for (Access* access : {&bus.write, &bus.read})
      if (access->open()) access->drop(ended() ? KAGE_RTL_ENDED : KAGE_RTL_NO_ANSWER);
  }

  int read(std::uint32_t address, std::uint32_t* value) {
    bus.begin_read(address, {});
    wait_for_registers();
    *value = bus.read.value();
    return bus.read.answer();
  }

  int write(std::uint32_t address, std::uint32_t value) {
    bus.begin_write(address, value, 15, {});
    wait_for_registers();
    return bus.write.answer();
  }

  void access(kage_rtl_access* write, kage_rtl_access* read) {
    if (write != nullptr) bus.begin_write(write->address, write->data, write->strobes, bus.patient(noise));
    if (read != nullptr) {
      AccessTiming timing = bus.patient(noise);
      if (write == nullptr) timing.address = 0;
      bus.begin_read(read->address, timing);
    }
    wait_for_registers();
    if (write != nullptr) write->answer = bus.write.answer();
    if (read == nullptr) return;
    read->answer = bus.read.answer();
    read->data = bus.read.value();
  }
};
