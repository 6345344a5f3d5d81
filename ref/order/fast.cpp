// SPDX-License-Identifier: Apache-2.0
//
// The fast way (docs/order.md). The order is an array, and each part (parts.hpp) knows where in it its subtree begins.
// A step tests sides in vectors, which lists the nodes that flipped. Then it takes the cheaper of two ways, by costs
// measured on this very tree. An exchange looks flipped clusters up anew and exchanges the two subtrees of each top
// that flipped, top down. A rebuild places all parts again, run by run, which costs the same whatever flipped.
#include <algorithm>
#include <chrono>
#include <cmath>
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

/// Longest way of the eye after which limits are forgotten: they are floats, and no finer than 2^-18 there.
constexpr double kLongestPath = 64;

class Fast final : public VisibilityOrder {
 public:
  explicit Fast(const TreeData& data)
      : data_(data),
        eye_(data),
        parts_(data),
        blocks_((data.nodes() + kBlock - 1) / kBlock),
        sides_(2 * blocks_ + 8),
        unsure_(2 * blocks_),
        limits_(blocks_ + kBlock, std::numeric_limits<float>::infinity()),
        listed_(blocks_ + kBlock),
        flipped_(data.nodes() / 4 + 2 * kBlock),
        place_(parts_.parts().size() + 1 + kPlacingSlack),
        order_(data.nodes() + kPlacingSlack),
        spare_(parts_.largest_back() + kPlacingSlack) {
    if (data.nodes() != 0) calibrate();
  }

  void move_to(const Eye& eye) override;

  [[nodiscard]] std::span<const std::uint32_t> order() override {
    return std::span(order_).first(placed_ ? data_.nodes() : 0);
  }

  [[nodiscard]] std::uint64_t bytes() const override {
    return tree_bytes(data_, true) + parts_.bytes() + sides_.size() + unsure_.size() +
           (limits_.size() + listed_.size() + flipped_.size() + place_.size() + order_.size() + spare_.size()) * 4;
  }

 private:
  void test(double way);
  void decide_unsure(std::uint64_t blocks);
  bool exchange_is_cheaper();
  /// Cost of an exchange by costs_; counting stops where it exceeds `limit`.
  double exchange_cost(double limit);
  void exchange();
  void rebuild();
  void calibrate();

  /// Flips that can be listed. More are not worth exchanging: at four nodes a flip a rebuild costs less.
  [[nodiscard]] std::size_t room() const { return flipped_.size() - kBlock; }

  [[nodiscard]] Placing placing() {
    return {data_.size.data(), parts_.parts().data(), parts_.starts().data(), parts_.table().data(),
            sides_.data(),     place_.data(),         order_.data(),          spare_.data()};
  }

  const TreeData& data_;
  EyeSides eye_;
  Parts parts_;
  std::size_t blocks_;
  std::vector<std::uint8_t> sides_;     // a bit per node, and a block more
  std::vector<std::uint8_t> unsure_;    // the same, of blocks that are listed
  std::vector<float> limits_;           // by block: length of the eye's way up to which nothing flips
  std::vector<std::uint32_t> listed_;   // blocks
  std::vector<std::uint32_t> flipped_;  // nodes, ascending
  std::vector<std::uint32_t, LineAllocator<std::uint32_t>>
      place_;  // by part, and one for what does not exist: where in order_ its subtree begins
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> spare_;  // the smaller of two subtrees that change places
  Costs costs_;
  double path_ = 2 * kLongestPath;
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
    step_.tests = OrderStep::Tests::blocks;
    step_.change = OrderStep::Change::none;
    step_.why = "the eye has not moved";
    return;
  }
  const double way = placed_ ? next.way_from(eye_) : std::numeric_limits<double>::infinity();
  eye_ = next;
  test(way);
  if (placed_ && step_.flips == 0) {
    step_.change = OrderStep::Change::none;
    step_.why = "no side changed";
    return;
  }
  step_.rebuild_cost = costs_.rebuild;
  if (placed_ && exchange_is_cheaper()) {
    exchange();
    step_.change = OrderStep::Change::exchange;
    step_.why = "exchanging what changed costs less than a rebuild";
  } else {
    rebuild();
    step_.change = OrderStep::Change::rebuild;
    step_.why = placed_ ? "exchanging what changed costs more than a rebuild" : "there was no order yet";
  }
  placed_ = true;
}

void Fast::test(double way) {
  path_ += way;
  // Written !(a <= b) so that NaN resets the limits.
  if (!(path_ <= kLongestPath)) {
    path_ = 0;
    std::fill_n(limits_.begin(), blocks_, -1.0F);
  }
  const SideQuery query = eye_.query();
  const SideBlocks blocks{data_.blocks.data(), data_.nodes(),  sides_.data(),   unsure_.data(),
                          limits_.data(),      listed_.data(), flipped_.data(), room()};
  SideCounts counts;
  // Limits cost as much as a test, and pay where a block is then left out every other time or more.
  if (!placed_ || way < margin_ || ++since_margin_ == kMarginAge) {
    since_margin_ = 0;
    counts = test_blocks(blocks, query, path_);
    if (counts.blocks * 2 > blocks_) margin_ = counts.margins / static_cast<double>(counts.blocks);
    step_.tests = OrderStep::Tests::blocks;
  } else {
    counts = test_all(blocks, query);
    step_.tests = OrderStep::Tests::all;
  }
  step_.tested = std::min<std::uint64_t>(counts.blocks * kBlock, data_.nodes());
  step_.flips = counts.flips;
  if (counts.unsure != 0) decide_unsure(counts.unsure);
}

void Fast::decide_unsure(std::uint64_t blocks) {
  EyeSides exact = eye_;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    const std::size_t b = listed_[i];
    for (std::size_t k = 0; k < kBlock; ++k) {
      const std::size_t byte = 2 * b + k / 8;
      if ((unsure_[byte] >> (k % 8) & 1U) == 0) continue;
      const auto node = static_cast<std::uint32_t>(b * kBlock + k);
      ++step_.unsure;
      if (exact.front(node) == ((sides_[byte] >> (k % 8) & 1U) != 0)) continue;
      sides_[byte] ^= static_cast<std::uint8_t>(1U << (k % 8));
      // The list stays in order.
      if (step_.flips < room()) {
        const auto end = flipped_.begin() + static_cast<std::ptrdiff_t>(step_.flips);
        const auto at = std::lower_bound(flipped_.begin(), end, node);
        std::copy_backward(at, end, end + 1);
        *at = node;
      }
      ++step_.flips;
    }
  }
  step_.exact = exact.exact() - eye_.exact();
}

bool Fast::exchange_is_cheaper() {
  if (step_.flips > room()) {  // not all are listed
    step_.exchange_cost = std::numeric_limits<double>::infinity();
    return false;
  }
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
  std::size_t i = 0;
  for (; i < step_.flips && cost <= limit; ++i) {
    const std::uint32_t size = data_.size[flipped_[i]];
    cost += size > kClusterNodes ? costs_.swap + costs_.moved * size : costs_.cluster;
  }
  flip_cost_ += (cost / static_cast<double>(i) - flip_cost_) / 4;
  return cost;
}

void Fast::exchange() {
  const bool measured = step_.exchange_cost > kMeasured;
  const auto start = measured ? Clock::now() : Clock::time_point();
  order::exchange(placing(), flipped_.data(), step_.flips);
  // Misses and mispredictions are not in the calibration. A bit at a time, so that one interrupt changes little.
  if (measured) costs_.scale *= seconds_since(start) > step_.exchange_cost ? 1.05 : 1 / 1.05;
}

void Fast::rebuild() {
  place_all(placing(), parts_.runs().data(), parts_.runs().size(), parts_.clusters().data(), parts_.clusters().size());
}

void Fast::calibrate() {
  // Sides as chance has them, so that a rebuild is measured as it will be.
  std::uint64_t random = 1;
  for (std::uint8_t& eight : sides_) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    eight = static_cast<std::uint8_t>(random >> 56U);
  }
  costs_.rebuild = least_seconds([&] { rebuild(); });
  const std::vector<std::uint32_t>& clusters = parts_.clusters();
  costs_.cluster = 2 * least_seconds([&] {  // as much again for finding them
                     place_clusters(placing(), clusters.data(), clusters.size());
                   }) /
                   static_cast<double>(clusters.size());
  flip_cost_ = costs_.cluster;
  if (!parts_.runs().empty()) {
    const auto swap = [&](std::uint32_t node) {
      sides_[node / 8] ^= static_cast<std::uint8_t>(1U << (node % 8));
      flipped_[0] = node;
      order::exchange(placing(), flipped_.data(), 1);
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

std::unique_ptr<VisibilityOrder> make_fast(const TreeData& data) { return std::make_unique<Fast>(data); }

}  // namespace kage::order
