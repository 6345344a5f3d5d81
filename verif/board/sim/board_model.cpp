// SPDX-License-Identifier: Apache-2.0
// A board's model as Verilator makes it, behind the functions of board_model.h: its crystal, the host's end of the
// serial line bit by bit, and the wires of its screen, each at its own times.
#include "board_model.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <deque>
#include <memory>
#include <string>

#include "Vboard.h"
#include "verilated.h"

namespace {

constexpr std::uint64_t kNever = ~std::uint64_t{0};

// Text that the model prints, which is the message of a broken rule. One model runs at a time in a thread.
thread_local std::string said;

}  // namespace

void kage_board_printf(const char* format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  said += text;
}

struct kage_board {
  VerilatedContext context;
  std::unique_ptr<Vboard> top;
  std::string stop;

  std::uint64_t crystal = 0;  // its next edge

  // The host's line: a bit every `bit` picoseconds, 8N1.
  std::uint64_t bit = 0;
  std::deque<std::uint8_t> out;
  std::uint64_t out_at = kNever;  // the next bit's beginning
  int out_bit = 0;
  std::deque<std::uint8_t> in;
  std::uint64_t in_at = kNever;  // the middle of the next bit to look at
  int in_bit = 0;
  unsigned in_byte = 0;
  bool tx = true;

  kage_board_video video = nullptr;
  void* video_context = nullptr;
  std::uint64_t video_start = 0;  // the first edge, which begins bit 0
  std::uint64_t video_bit = 0;
  std::uint64_t video_at = kNever;  // the middle of the next bit
  unsigned wires = 0;

  [[nodiscard]] std::uint64_t now() const { return context.time(); }

  // The text of the last line, without the simulator's decoration.
  void stopped() {
    if (!stop.empty()) return;
    while (!said.empty() && said.back() == '\n') said.pop_back();
    stop = said.empty() ? "the simulation stopped" : said.substr(said.rfind('\n') + 1);
  }

  void line_out() {
    if (out_at != now()) return;
    if (out_bit == 10) {
      out.pop_front();
      out_bit = 0;
      if (out.empty()) {
        out_at = kNever;
        return;
      }
    }
    top->rx_i = out_bit == 0 ? 0 : out_bit == 9 ? 1 : out.front() >> (out_bit - 1) & 1;
    ++out_bit;
    out_at = now() + bit;
  }

  void line_in() {
    if (in_at == now()) {
      if (in_bit == 0) in_byte = 0;
      if (in_bit >= 1 && in_bit <= 8) in_byte |= static_cast<unsigned>(top->tx_o) << (in_bit - 1);
      if (in_bit == 9) {
        if (top->tx_o) in.push_back(static_cast<std::uint8_t>(in_byte));
        in_at = kNever;
      } else {
        ++in_bit;
        in_at = now() + bit;
      }
    }
    if (in_at == kNever && tx && !top->tx_o) {
      in_bit = 0;
      in_at = now() + bit / 2;
    }
    tx = top->tx_o;
  }

  // The middle of bit `video_bit`. bits_o bits take periods_o periods of the crystal, which need not be a whole number
  // of picoseconds a bit: reckoned from the start, so that no rounding adds up.
  [[nodiscard]] std::uint64_t middle() const {
    return video_start + (2 * video_bit + 1) * KAGE_CRYSTAL_PS * top->periods_o / top->bits_o;
  }

  // The bits' times are found by the first edge of any wire.
  void screen() {
    if (video == nullptr) return;
    if (top->wires_o != wires) {
      wires = top->wires_o;
      if (video_at == kNever) {
        video_start = now();
        video_bit = 0;
        video_at = middle();
      }
    }
    if (video_at == now()) {
      video(video_context, wires);
      ++video_bit;
      video_at = middle();
    }
  }

  // To the next moment at which something happens, at most to `limit`.
  void step(std::uint64_t limit) {
    std::uint64_t next = std::min({limit, crystal, out_at, in_at, video_at});
    if (top->eventsPending()) next = std::min(next, top->nextTimeSlot());
    context.time(next);
    if (crystal == next) {
      top->clk_i = !top->clk_i;
      crystal += KAGE_CRYSTAL_PS;
    }
    line_out();
    top->eval();
    if (context.gotFinish()) stopped();
    line_in();
    screen();
  }
};

// In place of Verilator's own, which end the process.
void vl_finish(const char*, int, const char*) VL_MT_UNSAFE { Verilated::threadContextp()->gotFinish(true); }
void vl_stop(const char*, int, const char*) VL_MT_UNSAFE { Verilated::threadContextp()->gotFinish(true); }
void vl_fatal(const char*, int, const char*, const char* message) VL_MT_UNSAFE {
  if (message != nullptr && *message != '\0') said += std::string(message) + "\n";
  Verilated::threadContextp()->gotFinish(true);
}

namespace {

kage_board* open(unsigned seed, unsigned baud) {
  auto board = std::make_unique<kage_board>();
  said.clear();
  board->context.randReset(2);
  board->context.randSeed(static_cast<int>(seed % 0x3fffffff) + 1);
  board->context.assertOn(true);
  Verilated::threadContextp(&board->context);
  board->top = std::make_unique<Vboard>(&board->context, "board");
  board->bit = (1'000'000'000'000ull + (baud != 0 ? baud : KAGE_BAUD) / 2) / (baud != 0 ? baud : KAGE_BAUD);
  board->crystal = KAGE_CRYSTAL_PS;
  board->top->clk_i = 0;
  board->top->rx_i = 1;
  board->top->button_ni = 1;
  board->top->eval();
  return board.release();
}

void close(kage_board* board) {
  Verilated::threadContextp(&board->context);
  board->top->final();
  delete board;
}

std::uint64_t now(const kage_board* board) { return board->now(); }

void send(kage_board* board, const std::uint8_t* bytes, std::size_t count) {
  board->out.insert(board->out.end(), bytes, bytes + count);
  if (board->out_at == kNever && !board->out.empty()) board->out_at = board->now() + 1;
}

std::size_t sending(const kage_board* board) { return board->out.size(); }

std::size_t receive(kage_board* board, std::uint8_t* bytes, std::size_t room, std::uint64_t deadline) {
  Verilated::threadContextp(&board->context);
  while (board->in.empty() && board->now() < deadline && board->stop.empty()) board->step(deadline);
  const std::size_t count = std::min(room, board->in.size());
  std::copy_n(board->in.begin(), count, bytes);
  board->in.erase(board->in.begin(), board->in.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

void button(kage_board* board, int pressed) { board->top->button_ni = pressed == 0; }

void tap(kage_board* board, std::uint64_t picoseconds) {
  Verilated::threadContextp(&board->context);
  const std::uint64_t end = board->now() + picoseconds;
  button(board, 1);
  while (board->now() < end && board->stop.empty()) board->step(end);
  button(board, 0);
}

void video(kage_board* board, kage_board_video function, void* context) {
  board->video = function;
  board->video_context = context;
  board->video_at = kNever;
}

std::uint32_t leds(const kage_board* board) { return board->top->led_o; }

const char* stopped(const kage_board* board) { return board->stop.c_str(); }

constexpr kage_board_functions kFunctions{KAGE_BOARD_ABI, open,   close, now,   send, sending,
                                          receive,        button, tap,   video, leds, stopped};

}  // namespace

extern "C" __attribute__((visibility("default"))) const kage_board_functions* kage_board_model(void) {
  return &kFunctions;
}
