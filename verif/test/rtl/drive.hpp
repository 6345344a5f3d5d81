// SPDX-License-Identifier: Apache-2.0
//
// A Verilated module alone: its clock, dice, valid/ready sources and sinks that stall at random, and access to ports of
// any width.
//
// A clock of a test: set inputs, settle(), look at outputs, edge(). Registers and memories start at random values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>

#include "verilated.h"

namespace kage::rtl {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits(int n = 64) { return engine_() >> (64 - n); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool percent(int p) { return below(100) < p; }

 private:
  std::mt19937_64 engine_;
};

/// A chance of standing still per clock, from never to nearly always.
inline int stall_percent(Dice& dice) {
  static constexpr int kChoices[] = {0, 0, 10, 50, 90};
  return kChoices[dice.below(5)];
}

template <class Port>
void put(Port& port, std::uint64_t value) {
  port = static_cast<Port>(value);
}
template <std::size_t N>
void put(VlWide<N>& port, std::uint64_t value) {
  for (std::size_t i = 0; i < N; ++i)
    port[i] = i == 0 ? static_cast<EData>(value) : i == 1 ? static_cast<EData>(value >> 32) : 0;
}

/// Set `bits` bits of a port from bit `lsb`.
template <class Port>
void put(Port& port, int lsb, int bits, std::uint64_t value) {
  const std::uint64_t mask = bits == 64 ? ~0ULL : (1ULL << bits) - 1;
  port = static_cast<Port>((static_cast<std::uint64_t>(port) & ~(mask << lsb)) | (value & mask) << lsb);
}
template <std::size_t N>
void put(VlWide<N>& port, int lsb, int bits, std::uint64_t value) {
  for (int i = 0; i < bits; ++i) {
    const auto word = static_cast<std::size_t>((lsb + i) / 32);
    const EData bit = EData{1} << ((lsb + i) % 32);
    port[word] = (value >> i & 1) != 0 ? port[word] | bit : port[word] & ~bit;
  }
}

template <class Port>
std::uint64_t get(const Port& port, int lsb, int bits) {
  return static_cast<std::uint64_t>(port) >> lsb & (bits == 64 ? ~0ULL : (1ULL << bits) - 1);
}
template <std::size_t N>
std::uint64_t get(const VlWide<N>& port, int lsb, int bits) {
  std::uint64_t value = 0;
  for (int i = 0; i < bits; ++i)
    value |= static_cast<std::uint64_t>(port[static_cast<std::size_t>((lsb + i) / 32)] >> ((lsb + i) % 32) & 1) << i;
  return value;
}

/// A module alone, out of reset. `prepare(model)` sets inputs that are to hold during reset too.
template <class Model>
class Bench {
 public:
  explicit Bench(Dice& dice) : Bench(dice, [](Model&) {}) {}
  template <class Prepare>
  Bench(Dice& dice, Prepare prepare) {
    context_.randReset(2);
    context_.randSeed(static_cast<int>(dice.bits(30)) + 1);
    top_ = std::make_unique<Model>(&context_, "top");
    prepare(*top_);
    top_->clk_i = 0;
    if constexpr (requires(Model & m) { m.rst_ni; }) {
      top_->rst_ni = 0;
      settle();
      for (int i = 0; i < 2; ++i) edge();
      top_->rst_ni = 1;
    }
    settle();
  }
  ~Bench() {
    Verilated::threadContextp(&context_);  // a model is taken off its thread's context, which may be another bench's
    top_->final();
    top_.reset();
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  Model* operator->() { return top_.get(); }
  Model& operator*() { return *top_; }
  void settle() { top_->eval(); }
  void edge() {
    top_->clk_i = 1;
    top_->eval();
    top_->clk_i = 0;
    top_->eval();
    ++clocks;
  }

  std::uint64_t clocks = 0;

 private:
  VerilatedContext context_;
  std::unique_ptr<Model> top_;
};

/// Whether a source offers: once it does, it goes on until it was taken.
class Offer {
 public:
  explicit Offer(int stall) : stall_(stall) {}
  bool operator()(Dice& dice, bool has) {
    if (has && !on_) on_ = !dice.percent(stall_);
    return on_ && has;
  }
  void taken() { on_ = false; }

 private:
  int stall_;
  bool on_ = false;
};

}  // namespace kage::rtl
