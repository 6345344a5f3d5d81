// SPDX-License-Identifier: Apache-2.0
//
// The ways side by side, for `kage order` and verif/bench. All run in turn in one process over the same eyes. A time is
// the thread's processor time from the eye's coordinates to the finished order, summed over all eyes but the first. It
// is the least of the repeats: what else the machine does only adds to it.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kage/order.hpp"

namespace kage::order {

struct MeasureOptions {
  std::uint64_t seed = 1;
  int eyes = 200;
  int repeats = 5;
  std::vector<double> degrees{0, 0.1, 1, 10, 100, kRandom};
  static constexpr double kRandom = -1;          ///< eyes anywhere on the sphere
  std::function<void(double degrees)> progress;  ///< before each step angle, and now and then
};

/// Seconds for all steps; `walk`: with a walk over the faces of all fragments in the order.
struct WaySeconds {
  double order = 0;
  double walk = 0;
};

struct MeasureRow {
  double degrees = 0;
  int steps = 0;
  WaySeconds baseline_a;
  WaySeconds baseline_b;
  WaySeconds list;  ///< order: the list relinked
  WaySeconds fast;
  double flips_share = 0;   ///< mean of nodes that changed sides
  double tested_share = 0;  ///< mean of nodes that the fast way tested
  int rebuilds = 0;         ///< steps in which the fast way rebuilt
  int exchanges = 0;        ///< steps in which it exchanged
  std::uint64_t unsure = 0;
  std::uint64_t exact = 0;
  bool identical = true;  ///< recursion, switching list and fast way, after every step
};

struct Measured {
  std::vector<MeasureRow> rows;
  std::uint64_t baseline_a_bytes = 0;
  std::uint64_t baseline_b_bytes = 0;
  std::uint64_t list_bytes = 0;  ///< tree counted
  std::uint64_t fast_bytes = 0;  ///< tree counted
};

/// Eyes on a circle round the mesh, `degrees` apart, or at random, at 2.5 radii from its middle.
std::vector<Eye> eyes_round(const OrderTree& tree, const MeasureOptions& options, double degrees);

Measured measure(const OrderTree& tree, const MeasureOptions& options);

}  // namespace kage::order
