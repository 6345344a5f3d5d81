// SPDX-License-Identifier: Apache-2.0
//
// The fast way (docs/order.md, "The fast way"). The order is an array. Top nodes and clusters know where in it their
// subtrees begin. A step tests sides in vectors; then either exchanges the two parts of each top node that flipped,
// top down, and looks flipped clusters up anew; or places all again in one pass from the root, which costs the same
// whatever flipped. Which is cheaper, costs measured on this very tree say.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include "order/clusters.hpp"
#include "order/sides.hpp"
#include "order/ways.hpp"

namespace kage::order {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

/// Steps after which the blocks' margins are measured again.
constexpr int kMarginAge = 32;

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
  double flip = 0;     ///< finding what a flip concerns
  double cluster = 0;  ///< looking one up
  double swap = 0;     ///< exchanging two parts,
  double moved = 0;    ///< and for each node that they have
  double scale = 2;    ///< exchanges as they went, against the three before
};

class Fast final : public VisibilityOrder {
 public:
  explicit Fast(const OrderTree::Data& data)
      : data_(data), eye_(data), clusters_(data), blocks_((data.nodes() + kBlock - 1) / kBlock), sides_(blocks_ + 1),
        flips_(blocks_), unsure_(blocks_), limits_(blocks_), place_(clusters_.parts()),
        order_(data.nodes() + kClusterNodes) {
    if (data.nodes() != 0) calibrate();
  }

  void move_to(const Eye& eye) override;

  [[nodiscard]] std::span<const std::uint32_t> order() override {
    return std::span(order_).first(placed_ ? data_.nodes() : 0);
  }

  [[nodiscard]] std::uint64_t bytes() const override {
    return tree_bytes(data_, true) + clusters_.bytes() + (sides_.size() + flips_.size() + unsure_.size()) * 8 +
           limits_.size() * sizeof(double) + (place_.size() + order_.size() + spare_.capacity()) * 4 +
           (top_flips_.capacity() + touched_.capacity()) * 4;
  }

 private:
  void test(double way);
  void decide_unsure(const EyeSides& eye);
  /// Lists flipped tops and clusters as long as exchanging is cheaper than a rebuild; whether it is to the end.
  bool collect();
  void exchange();
  void swap_parts(std::uint32_t top);
  void rebuild();
  void calibrate();

  [[nodiscard]] bool side(std::uint32_t node) const { return (sides_[node / kBlock] >> (node % kBlock) & 1U) != 0; }
  std::uint32_t* cluster_places() { return place_.data() + clusters_.tops().size(); }

  const OrderTree::Data& data_;
  EyeSides eye_;
  Clusters clusters_;
  std::size_t blocks_;
  std::vector<std::uint64_t> sides_;  // a bit per node, and a word more
  std::vector<std::uint64_t> flips_;
  std::vector<std::uint64_t> unsure_;
  std::vector<double> limits_;        // by block: length of the eye's way up to which nothing flips
  std::vector<std::uint32_t> place_;  // by part: where in order_ its subtree begins
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> spare_;      // the smaller of two parts that change places
  std::vector<std::uint32_t> top_flips_;  // of this step, top down
  std::vector<std::uint32_t> touched_;    // clusters of this step
  Costs costs_;
  double path_ = 0;
  double margin_ = std::numeric_limits<double>::infinity();  // mean of the blocks', when last measured,
  int since_margin_ = 0;                                     // so many steps ago
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
  const bool exchanging = placed_ && collect();
  for (std::size_t b = 0; b < blocks_; ++b) sides_[b] ^= flips_[b];
  step_.rebuild_cost = costs_.rebuild;
  if (exchanging) {
    const bool measured = step_.exchange_cost > kMeasured;
    const auto start = measured ? Clock::now() : Clock::time_point();
    exchange();
    // Misses and mispredictions are not in the calibration. A bit at a time, so that one interrupt changes little.
    if (measured) costs_.scale *= seconds_since(start) > step_.exchange_cost ? 1.05 : 1 / 1.05;
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
  if (way < 2 * margin_ || ++since_margin_ == kMarginAge) {
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

bool Fast::collect() {
  top_flips_.clear();
  touched_.clear();
  const double per_flip = std::min(costs_.cluster, costs_.swap) / kClusterNodes + costs_.flip;
  step_.exchange_cost = static_cast<double>(step_.flips) * per_flip * costs_.scale;
  if (step_.exchange_cost > costs_.rebuild) return false;  // at the very least so much
  double cost = 0;
  std::uint32_t last = kNoNode;
  for (std::size_t b = 0; b < blocks_; ++b) {
    for (std::uint64_t left = flips_[b]; left != 0; left &= left - 1) {
      const auto node = static_cast<std::uint32_t>(b * kBlock) + static_cast<std::uint32_t>(__builtin_ctzll(left));
      cost += costs_.flip;
      if (clusters_.is_top(node)) {
        const std::uint32_t t = clusters_.tops_below(node);
        const Top& top = clusters_.tops()[t];
        cost += costs_.swap + costs_.moved * (top.front_size + top.back_size);
        top_flips_.push_back(t);
      } else if (const std::uint32_t c = clusters_.clusters_below(node + 1) - 1; c != last) {
        last = c;
        cost += costs_.cluster;
        touched_.push_back(c);
      }
    }
    if (cost * costs_.scale > costs_.rebuild) {
      step_.exchange_cost = cost * costs_.scale;
      return false;
    }
  }
  step_.exchange_cost = cost * costs_.scale;
  return true;
}

void Fast::exchange() {
  for (const std::uint32_t t : top_flips_) swap_parts(t);
  place_some(clusters_.clusters().data(), touched_.data(), touched_.size(), cluster_places(), sides_.data(),
             clusters_.table().data(), order_.data());
}

// [X][node][Y] becomes [Y][node][X]. Subtrees of X and Y keep their own order, and begin elsewhere.
void Fast::swap_parts(std::uint32_t t) {
  const Top& top = clusters_.tops()[t];
  const std::uint32_t at = place_[t];
  // The side is the new one: the eye's side is drawn last, and was first up to now.
  const bool front_was_first = side(top.node);
  const std::uint32_t x = front_was_first ? top.front_size : top.back_size;
  const std::uint32_t y = front_was_first ? top.back_size : top.front_size;
  std::uint32_t* const order = order_.data() + at;
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
  order[y] = top.node;

  const std::uint32_t front = top.node + 1;
  const std::uint32_t back = front + top.front_size;
  const std::uint32_t end = back + top.back_size;
  const auto shift = [&](std::uint32_t first, std::uint32_t past, std::uint32_t by) {
    const std::uint32_t tops = clusters_.tops_below(first);
    add_to(place_.data() + tops, clusters_.tops_below(past) - tops, by);
    const std::uint32_t begin = clusters_.clusters_below(first);
    add_to(cluster_places() + begin, clusters_.clusters_below(past) - begin, by);
  };
  const std::uint32_t later = y + 1;     // X begins so much later,
  const std::uint32_t sooner = 0U - (x + 1);  // Y so much sooner
  shift(front, back, front_was_first ? later : sooner);
  shift(back, end, front_was_first ? sooner : later);
}

void Fast::rebuild() {
  const std::vector<Top>& tops = clusters_.tops();
  std::uint32_t* const place = place_.data();
  std::uint32_t* const order = order_.data();
  place[0] = 0;  // the root's part, be it the first top or the only cluster
  for (std::size_t t = 0; t < tops.size(); ++t) {
    const Top top = tops[t];
    const std::uint32_t at = place[t];
    const std::uint32_t front_last = 0U - static_cast<std::uint32_t>(sides_[top.node / kBlock] >> (top.node % kBlock) & 1U);
    // Masks instead of branches: sides are as good as chance.
    const std::uint32_t before_front = (top.back_size + 1) & front_last;
    const std::uint32_t before_back = (top.front_size + 1) & ~front_last;
    place[top.front] = at + before_front;
    place[top.back] = at + before_back;
    order[at + (before_front | before_back) - 1] = top.node;
  }
  place_clusters(clusters_.clusters().data(), clusters_.clusters().size(), cluster_places(), sides_.data(),
                 clusters_.table().data(), order);
}

void Fast::calibrate() {
  // Sides as chance has them, so that a rebuild is measured as it will be.
  std::uint64_t random = 1;
  for (std::size_t b = 0; b < blocks_; ++b) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    sides_[b] = random ^ random >> 29U;
  }
  costs_.rebuild = least_seconds([&] { rebuild(); });
  const std::size_t count = clusters_.clusters().size();
  touched_.resize(count);
  for (std::size_t c = 0; c < count; ++c) touched_[c] = static_cast<std::uint32_t>(c);
  costs_.cluster = least_seconds([&] { exchange(); }) / static_cast<double>(count);
  costs_.flip = costs_.cluster;  // a few operations on words that lie side by side, much as a look-up
  const std::vector<Top>& tops = clusters_.tops();
  if (!tops.empty()) {
    const auto swapped = [&](std::uint32_t t) {
      sides_[tops[t].node / kBlock] ^= std::uint64_t{1} << (tops[t].node % kBlock);
      swap_parts(t);
    };
    const auto smallest = static_cast<std::uint32_t>(
        std::min_element(tops.begin(), tops.end(),
                         [](const Top& p, const Top& q) {
                           return p.front_size + p.back_size < q.front_size + q.back_size;
                         }) -
        tops.begin());
    costs_.swap = least_seconds([&] {
                    for (int i = 0; i < 64; ++i) swapped(smallest);
                  }) /
                  64;
    costs_.moved = least_seconds([&] { swapped(0); }) / (tops[0].front_size + tops[0].back_size);
  }
  std::fill(sides_.begin(), sides_.end(), 0);
  top_flips_.clear();
  touched_.clear();
}

}  // namespace

std::unique_ptr<VisibilityOrder> make_fast(const OrderTree::Data& data) { return std::make_unique<Fast>(data); }

}  // namespace kage::order
