// SPDX-License-Identifier: Apache-2.0
#include "geometry/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kage {
namespace {

// Products of a pass over all members and middles add up to this at most; where one pass has more, there is none.
constexpr std::size_t kMostWork = std::size_t{1} << 26U;
constexpr std::size_t kMostPasses = 12;

// Sums of members: with them a set's error is known, and what a member more or less makes of it.
struct Sums {
  double weight = 0;
  double first = 0;
  double second = 0;

  void add(double v, double w) {
    weight += w;
    first += w * v;
    second += w * v * v;
  }
  [[nodiscard]] double error() const { return weight > 0 ? std::max(second - first * first / weight, 0.0) : 0; }
};

// Members of a cluster while clusters are parted: a range of an order of all.
struct Part {
  std::size_t first;
  std::size_t end;
  std::size_t widest;  // the dimension of greatest error
  double error;        // in all dimensions
};

class Parting {
 public:
  explicit Parting(const WeightedVectors& vectors) : v_(&vectors), order_(vectors.count()), before_(vectors.count()) {
    std::iota(order_.begin(), order_.end(), 0U);
    parts_.push_back(measured(0, order_.size()));
  }

  // False if no part is left that has an error.
  bool part() {
    const auto worst =
        std::max_element(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.error < b.error; });
    if (!(worst->error > 0)) return false;
    const Part p = *worst;
    const std::size_t middle = cut(p);
    if (middle == p.first || middle == p.end) return false;
    *worst = measured(p.first, middle);
    parts_.push_back(measured(middle, p.end));
    return true;
  }

  [[nodiscard]] std::size_t parts() const { return parts_.size(); }

  [[nodiscard]] std::vector<std::uint32_t> numbers() const {
    std::vector<std::uint32_t> of(order_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (std::size_t i = parts_[p].first; i < parts_[p].end; ++i) of[order_[i]] = static_cast<std::uint32_t>(p);
    return of;
  }

 private:
  [[nodiscard]] Part measured(std::size_t first, std::size_t end) const {
    Part p{first, end, 0, 0};
    double most = -1;
    for (std::size_t d = 0; d < v_->dimensions; ++d) {
      // Sums of differences from a member, so that equal values have no error.
      const double from = v_->value(order_[first])[d];
      Sums s;
      for (std::size_t i = first; i < end; ++i) s.add(v_->value(order_[i])[d] - from, v_->weight(order_[i])[d]);
      p.error += s.error();
      if (s.error() <= most) continue;
      most = s.error();
      p.widest = d;
    }
    return p;
  }

  // Puts the members of a part in order along its widest dimension: where the two sides' errors there are least.
  std::size_t cut(const Part& p) {
    const auto at = [&](std::uint32_t i) { return v_->value(i)[p.widest]; };
    std::sort(order_.begin() + static_cast<std::ptrdiff_t>(p.first),
              order_.begin() + static_cast<std::ptrdiff_t>(p.end),
              [&](std::uint32_t a, std::uint32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
    const double from = at(order_[p.first]);
    Sums s;
    for (std::size_t i = p.first; i < p.end; ++i) {
      before_[i] = s.error();
      s.add(at(order_[i]) - from, v_->weight(order_[i])[p.widest]);
    }
    s = {};
    double least = INFINITY;
    std::size_t middle = p.first;
    for (std::size_t i = p.end - 1; i > p.first; --i) {
      s.add(at(order_[i]) - from, v_->weight(order_[i])[p.widest]);
      if (at(order_[i]) == at(order_[i - 1]) || before_[i] + s.error() >= least) continue;
      least = before_[i] + s.error();
      middle = i;
    }
    return middle;
  }

  const WeightedVectors* v_;
  std::vector<std::uint32_t> order_;
  std::vector<double> before_;  // of a place in order, the error of what lies before it in its part
  std::vector<Part> parts_;
};

// The means of members. A dimension in which they have no weight keeps the number that it has.
void move_middles(const WeightedVectors& v, const std::vector<std::uint32_t>& of, std::vector<double>& middles) {
  std::vector<double> weight(middles.size(), 0);
  std::vector<double> sum(middles.size(), 0);
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t d = 0; d < v.dimensions; ++d) {
      const std::size_t at = of[i] * v.dimensions + d;
      weight[at] += v.weight(i)[d];
      sum[at] += v.weight(i)[d] * v.value(i)[d];
    }
  for (std::size_t k = 0; k < middles.size(); ++k)
    if (weight[k] > 0) middles[k] = sum[k] / weight[k];
}

}  // namespace

std::uint32_t nearest_middle(const std::vector<double>& middles, std::size_t dimensions, const double* value,
                             const double* weight) {
  double best = INFINITY;
  std::uint32_t number = 0;
  for (std::size_t k = 0; k * dimensions < middles.size(); ++k) {
    double error = 0;
    for (std::size_t d = 0; d < dimensions && error < best; ++d) {
      const double off = value[d] - middles[k * dimensions + d];
      error += weight[d] * (off * off);
    }
    if (error >= best) continue;
    best = error;
    number = static_cast<std::uint32_t>(k);
  }
  return number;
}

Clusters clusters_of(const WeightedVectors& vectors, std::size_t most) {
  Clusters out;
  if (vectors.count() == 0) return out;
  Parting parting(vectors);
  while (parting.parts() < most && parting.part()) continue;
  out.of = parting.numbers();
  out.middles.assign(parting.parts() * vectors.dimensions, 0);
  move_middles(vectors, out.of, out.middles);
  const std::size_t pass = vectors.values.size() * parting.parts();
  const std::size_t passes = std::min(kMostPasses, kMostWork / std::max<std::size_t>(pass, 1));
  for (std::size_t n = 0; n < passes; ++n) {
    bool moved = false;
    for (std::size_t i = 0; i < out.of.size(); ++i) {
      const std::uint32_t k = nearest_middle(out.middles, vectors.dimensions, vectors.value(i), vectors.weight(i));
      moved = moved || k != out.of[i];
      out.of[i] = k;
    }
    if (!moved) break;
    move_middles(vectors, out.of, out.middles);
  }
  return out;
}

}  // namespace kage
