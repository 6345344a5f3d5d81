// SPDX-License-Identifier: Apache-2.0
#include "order/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "kage/error.hpp"
#include "order/baseline.hpp"
#include "order/splitter.hpp"

namespace kage::order {
namespace {

/// Calls of BaselineA that surely fit a stack of 8 MiB.
constexpr std::uint64_t kDeepest = 60'000;

/// Seconds that the processor has worked on this thread.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double least(const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); }

double unit_random(std::uint64_t& state) { return static_cast<double>(next_random(state) >> 11U) * 0x1p-53; }

/// Faces of an order, so that a walk has something to read.
std::uint64_t walk(const TreeData& data, std::span<const std::uint32_t> order) {
  std::uint64_t sum = 0;
  for (const std::uint32_t v : order)
    for (std::uint32_t f = data.first_fragment[v]; f < data.first_fragment[v + std::size_t{1}]; ++f)
      sum = sum * 3 + data.fragments[f].face;
  return sum;
}

std::uint64_t walk(std::span<const BaselineA::Polygon* const> order) {
  std::uint64_t sum = 0;
  for (const BaselineA::Polygon* first : order)
    for (const BaselineA::Polygon* p = first; p != nullptr; p = p->next) sum = sum * 3 + p->face;
  return sum;
}

class Measurement {
 public:
  Measurement(const OrderTree& tree, const MeasureOptions& options)
      : data_(data_of(tree)),
        tree_(tree),
        options_(options),
        a_(data_),
        b_(data_),
        recursion_(make_order(tree, OrderWay::recursion)),
        list_(make_order(tree, OrderWay::switching_list)),
        fast_(make_order(tree, OrderWay::fast)) {}

  Measured run() {
    Measured result;
    for (const double degrees : options_.degrees) result.rows.push_back(row(degrees));
    result.baseline_a_bytes = a_.bytes();
    result.baseline_b_bytes = b_.bytes();
    result.list_bytes = list_->bytes();
    result.fast_bytes = fast_->bytes();
    return result;
  }

 private:
  void say(double degrees) const {
    if (options_.progress) options_.progress(degrees);
  }

  /// Seconds of `step` for all eyes but the first.
  template <class Step>
  double timed(const std::vector<Eye>& eyes, Step step) {
    (void)step(eyes[0]);
    const double start = processor_seconds();
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < eyes.size(); ++i) sum += step(eyes[i]);
    const double seconds = processor_seconds() - start;
    sum_ = sum;
    return seconds;
  }

  MeasureRow row(double degrees) {
    const std::vector<Eye> eyes = eyes_round(tree_, options_, degrees);
    MeasureRow row;
    row.degrees = degrees;
    row.steps = static_cast<int>(eyes.size()) - 1;
    check(eyes, row);
    struct Way {
      WaySeconds* seconds;
      std::function<double(bool with_walk)> run;
    };
    const auto order_of = [&](VisibilityOrder& way, bool with_walk) {
      if (!with_walk) return timed(eyes, [&](const Eye& e) { return way.move_to(e), std::uint64_t{0}; });
      return timed(eyes, [&](const Eye& e) { return walk(data_, way.update(e)); });
    };
    const std::vector<Way> ways{{&row.baseline_a,
                                 [&](bool w) {
                                   return w ? timed(eyes, [&](const Eye& e) { return walk(a_.update(e)); })
                                            : timed(eyes,
                                                    [&](const Eye& e) { return std::uint64_t{a_.update(e)[0]->face}; });
                                 }},
                                {&row.baseline_b,
                                 [&](bool w) {
                                   return w ? timed(eyes, [&](const Eye& e) { return walk(data_, b_.update(e)); })
                                            : timed(eyes, [&](const Eye& e) { return std::uint64_t{b_.update(e)[0]}; });
                                 }},
                                {&row.list, [&](bool w) { return order_of(*list_, w); }},
                                {&row.fast, [&](bool w) { return order_of(*fast_, w); }}};
    std::vector<std::array<std::vector<double>, 2>> seconds(ways.size());
    for (int r = 0; r < options_.repeats; ++r)
      for (std::size_t w = 0; w < ways.size(); ++w)
        for (const bool with_walk : {false, true}) {
          say(degrees);
          seconds[w][with_walk ? 1 : 0].push_back(ways[w].run(with_walk));
        }
    for (std::size_t w = 0; w < ways.size(); ++w) *ways[w].seconds = {least(seconds[w][0]), least(seconds[w][1])};
    return row;
  }

  /// Compares the ways' orders and counts flips in each step, not timed.
  void check(const std::vector<Eye>& eyes, MeasureRow& row) {
    double flips = 0;
    double tested = 0;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      if (i % 16 == 0) say(row.degrees);
      const auto right = recursion_->update(eyes[i]);
      const auto list = list_->update(eyes[i]);
      const auto fast = fast_->update(eyes[i]);
      row.identical = row.identical && std::equal(right.begin(), right.end(), list.begin(), list.end()) &&
                      std::equal(right.begin(), right.end(), fast.begin(), fast.end());
      if (i == 0) continue;
      const OrderStep& step = fast_->last_step();
      flips += static_cast<double>(step.flips);
      tested += static_cast<double>(step.tested);
      row.rebuilds += step.change == OrderStep::Change::rebuild ? 1 : 0;
      row.exchanges += step.change == OrderStep::Change::exchange ? 1 : 0;
      row.unsure += step.unsure;
      row.exact += step.exact;
    }
    const double all = static_cast<double>(row.steps) * data_.nodes();
    row.flips_share = all > 0 ? flips / all : 0;
    row.tested_share = all > 0 ? tested / all : 0;
  }

  const TreeData& data_;
  const OrderTree& tree_;
  const MeasureOptions& options_;
  BaselineA a_;
  BaselineB b_;
  std::unique_ptr<VisibilityOrder> recursion_;
  std::unique_ptr<VisibilityOrder> list_;
  std::unique_ptr<VisibilityOrder> fast_;
  volatile std::uint64_t sum_ = 0;  // keeps the walks
};

}  // namespace

std::vector<Eye> eyes_round(const OrderTree& tree, const MeasureOptions& options, double degrees) {
  const TreeData& d = data_of(tree);
  const Scale back{-d.faces.scale.exponent};
  const auto eye = [&](double x, double y, double z) {
    const double r = 2.5 * d.radius;
    return Eye::point(back({d.centre[0] + r * x, d.centre[1] + r * y, d.centre[2] + r * z}));
  };
  std::vector<Eye> eyes;
  std::uint64_t random = options.seed;
  while (eyes.size() < static_cast<std::size_t>(options.eyes)) {
    if (degrees != MeasureOptions::kRandom) {
      // A circle that no axis and no plane of symmetry has to itself.
      const double angle = 0.3 + static_cast<double>(eyes.size()) * degrees * M_PI / 180;
      eyes.push_back(eye(0.96 * std::cos(angle), 0.28, 0.96 * std::sin(angle)));
      continue;
    }
    const double x = 2 * unit_random(random) - 1;
    const double y = 2 * unit_random(random) - 1;
    const double z = 2 * unit_random(random) - 1;
    const double n = std::sqrt(x * x + y * y + z * z);
    if (n > 0.1 && n < 1) eyes.push_back(eye(x / n, y / n, z / n));
  }
  return eyes;
}

Measured measure(const OrderTree& tree, const MeasureOptions& options) {
  if (tree.node_count() == 0 || options.eyes < 2 || options.repeats < 1) return {};
  if (tree.stats().depth > kDeepest)
    throw Error(fmt::format("the tree is {} nodes deep, the recursion to compare with may go {} deep",
                            tree.stats().depth, kDeepest));
  return Measurement(tree, options).run();
}

}  // namespace kage::order
