// SPDX-License-Identifier: Apache-2.0
//
// The pipelines that hls/tool makes, against the kernels that they are made of. For each kernel, `offer(dice, model)`
// makes an input, puts it on the ports and gives the kernel's result as an array. In the same way `result(model)`
// reads the output ports as the same array. The vectors take any bits, not only those that the front end can have.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "drive.hpp"
#include "kernels/edge_setup.hpp"
#include "kernels/edge_step.hpp"
#include "kernels/plane_step.hpp"
#include "kernels/segment_make.hpp"
#include "kernels/span_setup.hpp"

namespace kage::rtl {

/// Puts one value of the kernel's In on its port.
template <class Port, int N, bool S>
void drive(Port& port, hw::Int<N, S>& field, std::uint64_t bits) {
  field = hw::Int<N, S>(bits);
  put(port, 0, N, bits);
}

/// A number of any size, or near 0, or near its type's ends.
inline std::uint64_t number(Dice& dice) {
  const std::uint64_t some = dice.bits() >> dice.below(64);
  switch (dice.below(6)) {
    case 0:
      return ~some;
    case 1:
      return (std::uint64_t{1} << dice.below(64)) - static_cast<std::uint64_t>(dice.below(3));
    default:
      return some;
  }
}

template <int N, bool S>
std::uint64_t bits_of(const hw::Int<N, S>& v) {
  return static_cast<std::uint64_t>(hw::value(v)) & (N == 64 ? ~0ULL : (1ULL << N) - 1);
}

struct EdgeSetupPorts {
  static auto offer(Dice& dice, auto& m) {
    hls::EdgeSetupIn in;
    drive(m.top_x_i, in.top_x, number(dice));
    drive(m.top_y_i, in.top_y, number(dice));
    drive(m.bottom_x_i, in.bottom_x, number(dice));
    drive(m.bottom_y_i, in.bottom_y, number(dice));
    drive(m.line_i, in.line, number(dice));
    hls::Edge out;
    edge_setup(in, out);
    return std::array{bits_of(out.x), bits_of(out.step), bits_of(out.rest), bits_of(out.rest_step), bits_of(out.dy)};
  }
  static auto result(const auto& m) {
    return std::array<std::uint64_t, 5>{m.x_o, m.step_o, m.rest_o, m.rest_step_o, m.dy_o};
  }
};

struct EdgeStepPorts {
  static auto offer(Dice& dice, auto& m) {
    hls::Edge in;
    drive(m.x_i, in.x, number(dice));
    drive(m.step_i, in.step, number(dice));
    drive(m.rest_i, in.rest, number(dice));
    drive(m.rest_step_i, in.rest_step, number(dice));
    drive(m.dy_i, in.dy, number(dice));
    hls::Edge out;
    edge_step(in, out);
    return std::array{bits_of(out.x), bits_of(out.step), bits_of(out.rest), bits_of(out.rest_step), bits_of(out.dy)};
  }
  static auto result(const auto& m) {
    return std::array<std::uint64_t, 5>{m.x_o, m.step_o, m.rest_o, m.rest_step_o, m.dy_o};
  }
};

struct PlaneStepPorts {
  static auto offer(Dice& dice, auto& m) {
    hls::PlaneStepIn<54> in;
    drive(m.value_i, in.value, number(dice));
    drive(m.right_i, in.right, number(dice));
    drive(m.down_i, in.down, number(dice));
    drive(m.move_i, in.move, number(dice));
    hls::PlaneStepOut<54> out;
    plane_step(in, out);
    return std::array{bits_of(out.value)};
  }
  static auto result(const auto& m) { return std::array<std::uint64_t, 1>{m.value_o}; }
};

struct SpanSetupPorts {
  static auto offer(Dice& dice, auto& m) {
    hls::SpanSetupIn<54> in;
    drive(m.value_i, in.value, number(dice));
    drive(m.slope_i, in.slope, number(dice));
    drive(m.single_i, in.single, number(dice));
    drive(m.start_rounding_i, in.start_rounding, number(dice));
    drive(m.step_rounding_i, in.step_rounding, number(dice));
    hls::SpanSetupOut<54> out;
    span_setup(in, out);
    return std::array{bits_of(out.start), bits_of(out.step)};
  }
  static auto result(const auto& m) { return std::array<std::uint64_t, 2>{m.start_o, m.step_o}; }
};

struct SegmentMakePorts {
  static auto offer(Dice& dice, auto& m) {
    hls::SegmentMakeIn<15, 46> in;
    drive(m.at_i, in.at, number(dice));
    drive(m.end_i, in.end, number(dice));
    drive(m.depth_i, in.depth, number(dice));
    drive(m.step_i, in.step, number(dice));
    hls::SegmentMakeOut<15, 15, 46> out;
    segment_make(in, out);
    return std::array{bits_of(out.sync), bits_of(out.dx), bits_of(out.last), bits_of(out.at), bits_of(out.depth)};
  }
  static auto result(const auto& m) {
    return std::array<std::uint64_t, 5>{m.sync_o, m.dx_o, m.last_o, m.at_o, m.depth_o};
  }
};

/// How the sides of a pipeline stand still.
struct Stalls {
  int in = 0, out = 0;  ///< percent of the clocks
  bool waits = false;   ///< the sink is not ready before a result is there

  [[nodiscard]] bool none() const { return in + out == 0 && !waits; }
};

/// The stalls of each round of a test: none, some, and some with a sink that waits.
inline std::array<Stalls, 3> all_stalls(Dice& dice) {
  const auto some = [&dice](bool waits) { return Stalls{stall_percent(dice), stall_percent(dice), waits}; };
  return {Stalls{}, some(false), some(true)};
}

/// Sends `count` inputs through a pipeline of `stages` stages: the same results in the same order whatever stalls, and
/// a result a clock, `stages` clocks behind its input, where nothing does. Gives the error that was found, or nothing.
template <class Ports, class Model>
std::string wrong_in(Bench<Model>& top, Dice& dice, std::uint64_t stages, long count, const Stalls& stalls) {
  std::deque<std::pair<decltype(Ports::result(*top)), std::uint64_t>> wanted;
  auto next = Ports::offer(dice, *top);
  bool offered = false;
  for (long got = 0; got < count;) {
    if (!offered && !dice.percent(stalls.in)) offered = true;
    top->in_valid_i = offered ? 1 : 0;
    top->out_ready_i = dice.percent(stalls.out) || (stalls.waits && top->out_valid_o == 0) ? 0 : 1;
    top.settle();
    if (top->out_valid_o != 0 && top->out_ready_i != 0) {
      if (wanted.empty()) return "result " + std::to_string(got) + " has no input";
      if (Ports::result(*top) != wanted.front().first) return "result " + std::to_string(got) + " is another";
      const std::uint64_t clocks = top.clocks - wanted.front().second;
      if (stalls.none() && clocks != stages)
        return "result " + std::to_string(got) + " comes after " + std::to_string(clocks) + " clocks";
      wanted.pop_front();
      ++got;
    }
    const bool taken = offered && top->in_ready_o != 0;
    if (taken) wanted.emplace_back(next, top.clocks);
    top.edge();
    if (taken) {
      next = Ports::offer(dice, *top);
      offered = false;
    }
    if (wanted.size() > stages) return "more inputs than stages are in it";
    // Both sides stand still nine clocks in ten at most.
    if (top.clocks > 200 * (static_cast<std::uint64_t>(got) + 100)) return "it stands still";
  }
  return {};
}

}  // namespace kage::rtl
