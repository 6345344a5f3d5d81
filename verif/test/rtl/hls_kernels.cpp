// SPDX-License-Identifier: Apache-2.0
// The modules that hls/tool makes, against the kernels that they are made of: the same bits in the same order whatever
// stalls, and a result a clock, the stated number of clocks behind its input, where nothing does.
#include <array>
#include <cstdlib>
#include <deque>
#include <utility>

#include "Vhls_edge_setup.h"
#include "Vhls_edge_step.h"
#include "Vhls_plane_step.h"
#include "Vhls_segment_make.h"
#include "Vhls_span_setup.h"
#include "bench.hpp"
#include "kernels/edge_setup.hpp"
#include "kernels/edge_step.hpp"
#include "kernels/plane_step.hpp"
#include "kernels/segment_make.hpp"
#include "kernels/span_setup.hpp"

using namespace kage::rtl;
using namespace kage::hls;

namespace {

long vectors() {
  const char* asked = std::getenv("KAGE_HLS_VECTORS");
  return asked != nullptr ? std::strtol(asked, nullptr, 10) : 100000;
}

/// Puts one value of the kernel's In on its port.
template <class Port, int N, bool S>
void drive(Port& port, hw::Int<N, S>& field, std::uint64_t bits) {
  field = hw::Int<N, S>(bits);
  put(port, 0, N, bits);
}

/// A number of any size, or near 0, or near its type's ends.
std::uint64_t number(Dice& dice) {
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

/// Runs `count` inputs through a module. `offer(model)` makes an input, puts it on the ports and gives what the kernel
/// makes of it as an array; `result(model)` reads the output ports as the same array.
template <class Model, class Offer_, class Result>
void same(std::uint64_t stages, Offer_ offer, Result result) {
  const auto run = [&](Dice& dice, int in_stall, int out_stall) {
    Bench<Model> top(dice);
    std::deque<std::pair<decltype(result(*top)), std::uint64_t>> wanted;
    auto next = offer(dice, *top);
    bool offered = false;
    long got = 0;
    while (got < vectors() / 8) {
      if (!offered && !dice.percent(in_stall)) offered = true;
      top->in_valid_i = offered ? 1 : 0;
      top->out_ready_i = dice.percent(out_stall) ? 0 : 1;
      top.settle();
      if (top->out_valid_o != 0 && top->out_ready_i != 0) {
        REQUIRE(!wanted.empty());
        if (result(*top) != wanted.front().first) FAIL("result " << got << " is another");
        const std::uint64_t clocks = top.clocks - wanted.front().second;
        if (in_stall + out_stall == 0 && clocks != stages) FAIL("after " << clocks << " clocks, not " << stages);
        wanted.pop_front();
        ++got;
      }
      const bool taken = offered && top->in_ready_o != 0;
      if (taken) wanted.emplace_back(next, top.clocks);
      top.edge();
      if (taken) {
        next = offer(dice, *top);
        offered = false;
      }
      REQUIRE(wanted.size() <= stages);
    }
  };
  each_seed(4, [&](Dice& dice) {
    run(dice, 0, 0);
    run(dice, stall_percent(dice), stall_percent(dice));
  });
}

template <int N, bool S>
std::uint64_t bits_of(const hw::Int<N, S>& v) {
  return static_cast<std::uint64_t>(hw::value(v)) & (N == 64 ? ~0ULL : (1ULL << N) - 1);
}

}  // namespace

TEST_CASE("hls_edge_setup does what its kernel does", "[hls_kernels]") {
  same<Vhls_edge_setup>(
      KAGE_CLOCKS_hls_edge_setup,
      [](Dice& dice, Vhls_edge_setup& m) {
        EdgeSetupIn in;
        drive(m.top_x_i, in.top_x, number(dice));
        drive(m.top_y_i, in.top_y, number(dice));
        drive(m.bottom_x_i, in.bottom_x, number(dice));
        drive(m.bottom_y_i, in.bottom_y, number(dice));
        drive(m.line_i, in.line, number(dice));
        Edge out;
        edge_setup(in, out);
        return std::array{bits_of(out.x), bits_of(out.step), bits_of(out.rest), bits_of(out.rest_step),
                          bits_of(out.dy)};
      },
      [](Vhls_edge_setup& m) {
        return std::array<std::uint64_t, 5>{m.x_o, m.step_o, m.rest_o, m.rest_step_o, m.dy_o};
      });
}

TEST_CASE("hls_edge_step does what its kernel does", "[hls_kernels]") {
  same<Vhls_edge_step>(
      KAGE_CLOCKS_hls_edge_step,
      [](Dice& dice, Vhls_edge_step& m) {
        Edge in;
        drive(m.x_i, in.x, number(dice));
        drive(m.step_i, in.step, number(dice));
        drive(m.rest_i, in.rest, number(dice));
        drive(m.rest_step_i, in.rest_step, number(dice));
        drive(m.dy_i, in.dy, number(dice));
        Edge out;
        edge_step(in, out);
        return std::array{bits_of(out.x), bits_of(out.step), bits_of(out.rest), bits_of(out.rest_step),
                          bits_of(out.dy)};
      },
      [](Vhls_edge_step& m) {
        return std::array<std::uint64_t, 5>{m.x_o, m.step_o, m.rest_o, m.rest_step_o, m.dy_o};
      });
}

TEST_CASE("hls_plane_step does what its kernel does", "[hls_kernels]") {
  same<Vhls_plane_step>(
      KAGE_CLOCKS_hls_plane_step,
      [](Dice& dice, Vhls_plane_step& m) {
        PlaneStepIn<54> in;
        drive(m.value_i, in.value, number(dice));
        drive(m.right_i, in.right, number(dice));
        drive(m.down_i, in.down, number(dice));
        drive(m.move_i, in.move, number(dice));
        PlaneStepOut<54> out;
        plane_step(in, out);
        return std::array{bits_of(out.value)};
      },
      [](Vhls_plane_step& m) { return std::array<std::uint64_t, 1>{m.value_o}; });
}

TEST_CASE("hls_span_setup does what its kernel does", "[hls_kernels]") {
  same<Vhls_span_setup>(
      KAGE_CLOCKS_hls_span_setup,
      [](Dice& dice, Vhls_span_setup& m) {
        SpanSetupIn<54> in;
        drive(m.value_i, in.value, number(dice));
        drive(m.slope_i, in.slope, number(dice));
        drive(m.single_i, in.single, number(dice));
        drive(m.start_rounding_i, in.start_rounding, number(dice));
        drive(m.step_rounding_i, in.step_rounding, number(dice));
        SpanSetupOut<54> out;
        span_setup(in, out);
        return std::array{bits_of(out.start), bits_of(out.step)};
      },
      [](Vhls_span_setup& m) {
        return std::array<std::uint64_t, 2>{m.start_o, m.step_o};
      });
}

TEST_CASE("hls_segment_make does what its kernel does", "[hls_kernels]") {
  same<Vhls_segment_make>(
      KAGE_CLOCKS_hls_segment_make,
      [](Dice& dice, Vhls_segment_make& m) {
        SegmentMakeIn<15, 46> in;
        drive(m.at_i, in.at, number(dice));
        drive(m.end_i, in.end, number(dice));
        drive(m.depth_i, in.depth, number(dice));
        drive(m.step_i, in.step, number(dice));
        SegmentMakeOut<15, 15, 46> out;
        segment_make(in, out);
        return std::array{bits_of(out.sync), bits_of(out.dx), bits_of(out.last), bits_of(out.at), bits_of(out.depth)};
      },
      [](Vhls_segment_make& m) {
        return std::array<std::uint64_t, 5>{m.sync_o, m.dx_o, m.last_o, m.at_o, m.depth_o};
      });
}
