// SPDX-License-Identifier: Apache-2.0
//
// The fast way (docs/order.md). The order is an array, and each part (parts.hpp) knows where in it its subtree begins.
// A step tests sides in vectors; then either exchanges the two subtrees of each top that flipped, top down, and looks
// flipped clusters up anew; or places all parts again, run by run, which costs the same whatever flipped. Which is
// cheaper, costs measured on this very tree say.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include "order/parts.hpp"
#include "order/sides.hpp"
#include "order/ways.hpp"

namespace kage::order {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

/// Steps after which the blocks' margins are measured again.
constexpr int kMarginAge = 32;

/// Steps after which the cost of an exchange is counted again, flip by flip.
constexpr int kCountAge = 16;

/// Exchanges that should take longer than this are measured: seconds, well above what reading the clock takes.
constexpr double kMeasured = 2e-6;

/// Least of a few runs of `work`.
template <class Work>
double least_seconds(Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    const auto start = Clock::now();
    work();
    best = std::min(best, seconds_since(start));
  }
  return best;
}

/// Seconds on this tree and machine.
struct Costs {
  double rebuild = 0;  ///< all
  double cluster = 0;  ///< looking one up
  double swap = 0;     ///< exchanging two parts,
  double moved = 0;    ///< and for each node that they have
  double scale = 2;    ///< exchanges as they went, against the sum of these three
};

class Fast final : public VisibilityOrder {
 public:
  explicit Fast(const OrderTree::Data& data)
      : data_(data),
        eye_(data),
        parts_(data),
        blocks_((data.nodes() + kBlock - 1) / kBlock),
        sides_(blocks_ + 1),
        flips_(blocks_),
        unsure_(blocks_),
        limits_(blocks_),
        place_(parts_.parts().size() + 1),
        order_(data.nodes()) {
    if (data.nodes() != 0) calibrate();
  }

  void move_to(const Eye& eye) override;

  [[nodiscard]] std::span<const std::uint32_t> order() override {
    return std::span(order_).first(placed_ ? data_.nodes() : 0);
  }

  [[nodiscard]] std::uint64_t bytes() const override {
    return tree_bytes(data_, true) + parts_.bytes() + (sides_.size() + flips_.size() + unsure_.size()) * 8 +
           limits_.size() * sizeof(double) + (place_.size() + order_.size() + spare_.capacity()) * 4 +
           touched_.capacity() * 4;
  }

 private:
  void test(double way);
  void decide_unsure(const EyeSides& eye);
  bool exchange_is_cheaper();
  /// What exchanging costs by costs_, as far as it is not more than `limit`.
  double exchange_cost(double limit);
  void exchange();
  void swap_subtrees(std::uint32_t node, std::uint32_t part);
  void shift_places(std::uint32_t first, std::uint32_t end, std::uint32_t by);
  void rebuild();
  void calibrate();

  [[nodiscard]] bool side(std::uint32_t node) const { return (sides_[node / kBlock] >> (node % kBlock) & 1U) != 0; }

  const OrderTree::Data& data_;
  EyeSides eye_;
  Parts parts_;
  std::size_t blocks_;
  std::vector<std::uint64_t> sides_;  // a bit per node, and a word more
  std::vector<std::uint64_t> flips_;
  std::vector<std::uint64_t> unsure_;
  std::vector<double> limits_;        // by block: length of the eye's way up to which nothing flips
  std::vector<std::uint32_t> place_;  // by part, and one for what does not exist: where in order_ its subtree begins
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> spare_;    // the smaller of two parts that change places
  std::vector<std::uint32_t> touched_;  // clusters, by part
  Costs costs_;
  double path_ = 0;
  double margin_ = std::numeric_limits<double>::infinity();  // mean of the blocks', when last measured,
  int since_margin_ = 0;                                     // so many steps ago
  double flip_cost_ = 0;                                     // of an exchange, by flip, as counted up to now,
  int since_counted_ = 0;                                    // so many steps ago
  bool placed_ = false;
};

void Fast::move_to(const Eye& eye) {
  EyeSides next(data_);
  next.set(eye);
  step_ = {};
  if (data_.nodes() == 0) {
    placed_ = true;
    eye_ = next;
    return;
  }
  const bool same = placed_ && next.eye().perspective == eye_.eye().perspective && next.eye().at == eye_.eye().at;
  if (same) {
    step_.tests = OrderStep::Tests::kBlocks;
    step_.change = OrderStep::Change::kNone;
    step_.why = "the eye has not moved";
    return;
  }
  const double way = placed_ ? next.way_from(eye_) : std::numeric_limits<double>::infinity();
  eye_ = next;
  test(way);
  if (placed_ && step_.flips == 0) {
    step_.change = OrderStep::Change::kNone;
    step_.why = "no side changed";
    return;
  }
  step_.rebuild_cost = costs_.rebuild;
  const bool exchanging = placed_ && exchange_is_cheaper();
  for (std::size_t b = 0; b < blocks_; ++b) sides_[b] ^= flips_[b];
  if (exchanging) {
    exchange();
    step_.change = OrderStep::Change::kExchange;
    step_.why = "exchanging what changed costs less than a rebuild";
  } else {
    rebuild();
    step_.change = OrderStep::Change::kRebuild;
    step_.why = placed_ ? "exchanging what changed costs more than a rebuild" : "there was no order yet";
  }
  placed_ = true;
}

void Fast::test(double way) {
  // Past this length, sums would round off more than EyeSides::way_from allows for.
  if (!(path_ + way < 0x1p9)) {
    path_ = 0;
    std::fill(limits_.begin(), limits_.end(), -1.0);
  } else {
    path_ += way;
  }
  const SideQuery query = eye_.query();
  SideCounts counts;
  // Limits cost a little where they are made, and pay where a block is then left out every third time or more.
  if (!placed_ || way < 2 * margin_ || ++since_margin_ == kMarginAge) {
    since_margin_ = 0;
    counts = test_blocks(data_.blocks.data(), blocks_, query, sides_.data(), flips_.data(), unsure_.data(), path_,
                         limits_.data());
    if (counts.blocks * 2 > blocks_) margin_ = counts.margins / static_cast<double>(counts.blocks);
    step_.tests = OrderStep::Tests::kBlocks;
  } else {
    counts = test_all(data_.blocks.data(), blocks_, query, sides_.data(), flips_.data(), unsure_.data());
    step_.tests = OrderStep::Tests::kAll;
  }
  step_.tested = std::min<std::uint64_t>(counts.blocks * kBlock, data_.nodes());
  step_.flips = counts.flips;
  if (data_.nodes() % kBlock != 0) {  // past the last node
    const std::uint64_t valid = (std::uint64_t{1} << (data_.nodes() % kBlock)) - 1;
    step_.flips -= static_cast<std::uint64_t>(__builtin_popcountll(flips_.back() & ~valid));
    flips_.back() &= valid;
    unsure_.back() &= valid;
  }
  if (counts.unsure != 0) decide_unsure(eye_);
}

void Fast::decide_unsure(const EyeSides& eye) {
  EyeSides exact = eye;
  for (std::size_t b = 0; b < blocks_; ++b)
    for (std::uint64_t left = unsure_[b]; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(left));
      const auto node = static_cast<std::uint32_t>(b * kBlock) + bit;
      ++step_.unsure;
      if (exact.front(node) == side(node)) continue;
      flips_[b] |= std::uint64_t{1} << bit;
      ++step_.flips;
    }
  step_.exact = exact.exact() - eye.exact();
}

bool Fast::exchange_is_cheaper() {
  // By what a flip cost on the average; only if that leaves a doubt, one by one. Every now and then that is done
  // anyway, since the average comes from it.
  const double guess = static_cast<double>(step_.flips) * flip_cost_ * costs_.scale;
  step_.exchange_cost = guess;
  const bool sure = guess * 2 < costs_.rebuild || guess > costs_.rebuild * 1.25;
  if (sure && ++since_counted_ < kCountAge) return guess < costs_.rebuild;
  since_counted_ = 0;
  step_.exchange_cost = costs_.scale * exchange_cost(costs_.rebuild / costs_.scale);
  return step_.exchange_cost < costs_.rebuild;
}

double Fast::exchange_cost(double limit) {
  double cost = 0;
  std::uint64_t flips = 0;
  for (std::size_t b = 0; b < blocks_; ++b) {
    for (std::uint64_t left = flips_[b]; left != 0; left &= left - 1) {
      const auto node = static_cast<std::uint32_t>(b * kBlock) + static_cast<std::uint32_t>(__builtin_ctzll(left));
      const std::uint32_t size = data_.size[node];
      cost += size > kClusterNodes ? costs_.swap + costs_.moved * size : costs_.cluster;
      ++flips;
    }
    if (cost > limit) break;
  }
  flip_cost_ += (cost / static_cast<double>(flips) - flip_cost_) / 4;
  return cost;
}

void Fast::exchange() {
  const bool measured = step_.exchange_cost > kMeasured;
  const auto start = measured ? Clock::now() : Clock::time_point();
  touched_.clear();
  std::uint32_t last = kNoNode;
  for (std::size_t b = 0; b < blocks_; ++b)
    for (std::uint64_t left = flips_[b]; left != 0; left &= left - 1) {
      const auto node = static_cast<std::uint32_t>(b * kBlock) + static_cast<std::uint32_t>(__builtin_ctzll(left));
      const std::uint32_t part = parts_.of(node);
      if (data_.size[node] > kClusterNodes)
        swap_subtrees(node, part);
      else if (part != last)
        touched_.push_back(last = part);
    }
  place_clusters(parts_.parts().data(), touched_.data(), touched_.size(), place_.data(), sides_.data(),
                 parts_.table().data(), order_.data());
  // Misses and mispredictions are not in the calibration. A bit at a time, so that one interrupt changes little.
  if (measured) costs_.scale *= seconds_since(start) > step_.exchange_cost ? 1.05 : 1 / 1.05;
}

// [X][node][Y] becomes [Y][node][X]. X and Y keep their own order, and begin elsewhere.
void Fast::swap_subtrees(std::uint32_t node, std::uint32_t part) {
  const std::uint32_t back_size = parts_.parts()[part].b;
  const std::uint32_t front_size = data_.size[node] - 1 - back_size;
  // The side is the new one: the eye's side is drawn last, and was first up to now.
  const bool front_was_first = side(node);
  const std::uint32_t x = front_was_first ? front_size : back_size;
  const std::uint32_t y = front_was_first ? back_size : front_size;
  std::uint32_t* const order = order_.data() + place_[part];
  if (spare_.size() < std::min(x, y)) spare_.resize(std::min(x, y));
  if (x <= y) {
    std::copy_n(order, x, spare_.data());
    std::memmove(order, order + x + 1, y * sizeof(std::uint32_t));
    std::copy_n(spare_.data(), x, order + y + 1);
  } else {
    std::copy_n(order + x + 1, y, spare_.data());
    std::memmove(order + y + 1, order, x * sizeof(std::uint32_t));
    std::copy_n(spare_.data(), y, order);
  }
  order[y] = node;

  const std::uint32_t front = part + 1;
  const std::uint32_t back = parts_.below(node + 1 + front_size);
  const std::uint32_t end = parts_.below(node + 1 + front_size + back_size);
  const std::uint32_t later = y + 1;          // X begins so much later,
  const std::uint32_t sooner = 0U - (x + 1);  // Y so much sooner
  shift_places(front, back, front_was_first ? later : sooner);
  shift_places(back, end, front_was_first ? sooner : later);
}

void Fast::shift_places(std::uint32_t first, std::uint32_t end, std::uint32_t by) {
  if (end - first > 16)
    add_to(place_.data() + first, end - first, by);
  else
    for (std::uint32_t p = first; p < end; ++p) place_[p] += by;
}

void Fast::rebuild() {
  const Part* const parts = parts_.parts().data();
  std::uint32_t* const place = place_.data();
  std::uint32_t* const order = order_.data();
  place[0] = 0;
  for (const Run& run : parts_.runs()) {
    std::uint32_t at = place[run.part];
    std::uint32_t front = data_.size[run.node];  // nodes of what is still to be placed
    std::uint32_t node = run.node;
    const std::uint32_t end = run.part + run.tops;
    for (std::uint32_t part = run.part; part < end; ++part, ++node) {
      // Masks instead of branches: sides are as good as chance.
      const std::uint32_t back = parts[part].b;
      const std::uint32_t front_last = 0U - static_cast<std::uint32_t>(sides_[node / kBlock] >> (node % kBlock) & 1U);
      front -= back + 1;
      const std::uint32_t behind = front & ~front_last;  // drawn before the back
      const std::uint32_t first = back & front_last;     // drawn before the front
      place[part] = at;
      place[parts[part].a] = at + behind + (1 & ~front_last);
      order[at + behind + first] = node;
      at += first + (1 & front_last);
    }
    place[end] = at;  // the cluster that ends the run
  }
  place_clusters(parts, parts_.clusters().data(), parts_.clusters().size(), place, sides_.data(), parts_.table().data(),
                 order);
}

void Fast::calibrate() {
  // Sides as chance has them, so that a rebuild is measured as it will be.
  std::uint64_t random = 1;
  for (std::size_t b = 0; b < blocks_; ++b) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    sides_[b] = random ^ random >> 29U;
  }
  costs_.rebuild = least_seconds([&] { rebuild(); });
  const std::vector<std::uint32_t>& clusters = parts_.clusters();
  costs_.cluster = 2 * least_seconds([&] {  // as much again for finding them
                     place_clusters(parts_.parts().data(), clusters.data(), clusters.size(), place_.data(),
                                    sides_.data(), parts_.table().data(), order_.data());
                   }) /
                   static_cast<double>(clusters.size());
  flip_cost_ = costs_.cluster;
  if (!parts_.runs().empty()) {
    const auto swap = [&](std::uint32_t node) {
      sides_[node / kBlock] ^= std::uint64_t{1} << (node % kBlock);
      swap_subtrees(node, parts_.of(node));
    };
    const Run& last = parts_.runs().back();
    const std::uint32_t smallest = last.node + last.tops - 1;  // or nearly
    costs_.swap = least_seconds([&] {
                    for (int i = 0; i < 64; ++i) swap(smallest);
                  }) /
                  64;
    costs_.moved = least_seconds([&] { swap(0); }) / data_.size[0];
  }
  std::fill(sides_.begin(), sides_.end(), 0);
}

}  // namespace

std::unique_ptr<VisibilityOrder> make_fast(const OrderTree::Data& data) { return std::make_unique<Fast>(data); }

}  // namespace kage::order
