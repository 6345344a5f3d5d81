// SPDX-License-Identifier: Apache-2.0
// The visibility order's vector kernels, each alone, against the same computed node by node. Every instruction set
// takes trees of 0 to 48 nodes and some larger, in guarded memory of exactly the size that the kernels' headers ask
// for.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "order/kernels.hpp"
#include "order/parts.hpp"
#include "order/placing.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/guarded.hpp"
#include "test/support/order_shapes.hpp"
#include "test/support/simd.hpp"

namespace kage::verif {
namespace {

using order::kBlock;

/// Planes, sides and limits by chance. Coordinates are small whole numbers, so floats make no rounding errors, and
/// every instruction set must answer alike.
struct SideCase {
  SideCase(Random& random, int node_count) : nodes(static_cast<std::uint32_t>(node_count)) {
    blocks = (nodes + kBlock - 1) / kBlock;
    planes.resize(blocks * 4 * kBlock);
    for (std::size_t b = 0; b < blocks; ++b)
      for (std::size_t axis = 0; axis < 4; ++axis)
        for (std::size_t k = 0; k < kBlock; ++k) {
          const bool inside = b * kBlock + k < nodes;  // past the last node, its plane again
          float& at = planes[b * 4 * kBlock + axis * kBlock + k];
          at = inside ? static_cast<float>(random.in(-3, 3)) : planes[b * 4 * kBlock + axis * kBlock + k - 1];
        }
    for (std::size_t i = 0; i < 2 * blocks; ++i) sides.push_back(static_cast<std::uint8_t>(random.in(0, 255)));
    for (std::size_t b = 0; b < blocks; ++b) limits.push_back(static_cast<float>(random.in(0, 4)));
    limits.resize(blocks + kBlock, INFINITY);
    query = {static_cast<float>(random.in(-2, 2)), static_cast<float>(random.in(-2, 2)),
             static_cast<float>(random.in(-2, 2)), static_cast<float>(random.in(0, 1)),
             random.chance(0.5) ? 0.0F : 2.5F};
    room = random.chance(0.3) ? static_cast<std::size_t>(random.in(0, 5)) : nodes;
  }

  [[nodiscard]] float value(std::size_t node) const {
    const float* const p = &planes[node / kBlock * 4 * kBlock + node % kBlock];
    return p[0] * query.x + p[kBlock] * query.y + p[2 * kBlock] * query.z + p[3 * kBlock] * query.w;
  }

  std::uint32_t nodes;
  std::size_t blocks = 0;
  std::vector<float> planes;
  std::vector<std::uint8_t> sides;
  std::vector<float> limits;
  order::SideQuery query;
  std::size_t room = 0;
};

/// `some`: only blocks whose limit is reached, by a way of 2.
void check_sides(Random& random, int nodes, Edge edge, bool some) {
  constexpr double kWay = 2;
  const SideCase c(random, nodes);
  Guarded<float> planes(std::span<const float>(c.planes), edge);
  Guarded<std::uint8_t> sides(std::span<const std::uint8_t>(c.sides), edge);
  Guarded<std::uint8_t> unsure(2 * c.blocks, edge);
  Guarded<float> limits(std::span<const float>(c.limits), edge);
  Guarded<std::uint32_t> listed(c.blocks + kBlock, edge);
  Guarded<std::uint32_t> flipped(c.room + kBlock, edge);
  const order::SideBlocks to{planes.data(), c.nodes,       sides.data(),   unsure.data(),
                             limits.data(), listed.data(), flipped.data(), c.room};
  const order::SideCounts counts = some ? order::test_blocks(to, c.query, kWay) : order::test_all(to, c.query);

  std::vector<std::uint8_t> right = c.sides;
  std::vector<std::uint32_t> flips, unsure_blocks;
  std::uint64_t tested = 0;
  for (std::size_t b = 0; b < c.blocks; ++b) {
    if (some && !(static_cast<double>(c.limits[b]) <= kWay)) {
      REQUIRE(limits[b] == c.limits[b]);
      continue;
    }
    ++tested;
    float least = INFINITY;
    std::uint32_t unsure_bits = 0;
    for (std::size_t n = b * kBlock; n < std::min<std::size_t>(c.nodes, (b + 1) * kBlock); ++n) {
      const float v = c.value(n);
      const auto bit = static_cast<std::uint8_t>(1U << (n % 8));
      least = std::min(least, std::abs(v));
      if (!(std::abs(v) > c.query.threshold)) {
        unsure_bits |= 1U << (n % kBlock);
      } else if ((v > 0) != ((right[n / 8] & bit) != 0)) {
        right[n / 8] ^= bit;
        flips.push_back(static_cast<std::uint32_t>(n));
      }
    }
    if (unsure_bits != 0) {
      unsure_blocks.push_back(static_cast<std::uint32_t>(b));
      REQUIRE((unsure[2 * b] | unsure[2 * b + 1] << 8) == static_cast<int>(unsure_bits));
    }
    if (!some) continue;
    // Never beyond how far the eye may go, and hardly less.
    const double margin = static_cast<double>(least) - static_cast<double>(c.query.threshold);
    if (unsure_bits != 0) {
      REQUIRE(limits[b] < 0);
    } else {
      REQUIRE(static_cast<double>(limits[b]) <= kWay + margin);
      REQUIRE(static_cast<double>(limits[b]) > (kWay + margin) * (1 - 1e-5));
    }
  }
  REQUIRE(counts.blocks == tested);
  REQUIRE(counts.flips == flips.size());
  REQUIRE(counts.unsure == unsure_blocks.size());
  REQUIRE(std::equal(right.begin(), right.end(), sides.begin(), sides.end()));
  REQUIRE(std::equal(unsure_blocks.begin(), unsure_blocks.end(), listed.begin()));
  REQUIRE(std::equal(flips.begin(), flips.begin() + static_cast<std::ptrdiff_t>(std::min(flips.size(), c.room)),
                     flipped.begin()));
}

/// The arrays that the kernels of placing.hpp work on, each as long as it has to be.
class PlacingCase {
 public:
  PlacingCase(const order::TreeData& data, Edge edge)
      : parts_(data),
        nodes_(data.nodes()),
        size(std::span<const std::uint32_t>(data.size), edge),
        parts(std::span<const order::Part>(parts_.parts()), edge),
        starts(std::span<const order::Starts>(parts_.starts()), edge),
        table(std::span<const std::uint64_t>(parts_.table()), edge),
        runs(std::span<const order::Run>(parts_.runs()), edge),
        clusters(std::span<const std::uint32_t>(parts_.clusters()), edge),
        sides((nodes_ + 7) / 8 + 8, edge),
        place(parts.size() + 1 + order::kPlacingSlack, edge, 64),
        order(nodes_ + order::kPlacingSlack, edge),
        spare(parts_.largest_back() + order::kPlacingSlack, edge) {}

  void set_sides(const std::vector<bool>& front) {
    std::fill(sides.begin(), sides.end(), std::uint8_t{0});
    for (std::size_t v = 0; v < nodes_; ++v)
      if (front[v]) sides[v / 8] |= static_cast<std::uint8_t>(1U << (v % 8));
  }
  [[nodiscard]] order::Placing placing() {
    return {size.data(),  parts.data(), starts.data(), table.data(),
            sides.data(), place.data(), order.data(),  spare.data()};
  }
  void place_all() { order::place_all(placing(), runs.data(), runs.size(), clusters.data(), clusters.size()); }
  void place_clusters() { order::place_clusters(placing(), clusters.data(), clusters.size()); }
  bool holds(const std::vector<std::uint32_t>& right) {
    return std::equal(right.begin(), right.end(), order.begin(), order.begin() + nodes_);
  }

 private:
  order::Parts parts_;
  std::uint32_t nodes_;

 public:
  Guarded<std::uint32_t> size;
  Guarded<order::Part> parts;
  Guarded<order::Starts> starts;
  Guarded<std::uint64_t> table;
  Guarded<order::Run> runs;
  Guarded<std::uint32_t> clusters;
  Guarded<std::uint8_t> sides;
  Guarded<std::uint32_t> place, order, spare;
};

void check_placing(Random& random, int nodes, Edge edge) {
  const OrderShape shape = random_shape(random, static_cast<std::uint32_t>(nodes));
  order::TreeData data;
  data.size = shape;
  PlacingCase c(data, edge);
  std::vector<bool> front(shape.size());
  for (auto&& side : front) side = random.chance(0.5);
  c.set_sides(front);
  c.place_all();
  REQUIRE(c.holds(order_of_shape(shape, front)));
  for (int step = 0; step < 6; ++step) {
    const double share = random.chance(0.3) ? 1.0 : random.real(0, 0.4);
    std::vector<std::uint32_t> flips;
    for (std::uint32_t v = 0; v < shape.size(); ++v)
      if (random.chance(share)) flips.push_back(v);
    for (const std::uint32_t v : flips) front[v] = !front[v];
    c.set_sides(front);
    Guarded<std::uint32_t> flipped(std::span<const std::uint32_t>(flips), edge);
    order::exchange(c.placing(), flipped.data(), flipped.size());
    REQUIRE(c.holds(order_of_shape(shape, front)));
  }
  // Clusters alone: what stands in their places does not matter.
  for (std::size_t i = 0; i < c.clusters.size(); ++i) {
    const order::Part& part = c.parts[c.clusters[i]];
    std::fill_n(c.order.begin() + c.place[c.clusters[i]], part.b & 15U, 0xffffffffU);
  }
  c.place_clusters();
  REQUIRE(c.holds(order_of_shape(shape, front)));
}

/// Calls test(nodes, edge) on every target.
template <class Test>
void sweep(int rounds, Test test) {
  on_every_target([&](const simd::Target& target) {
    for (const Edge edge : kEdges)
      for (int nodes = 0; nodes <= kMostSize; ++nodes)
        for (int round = 0; round < rounds; ++round) {
          CAPTURE(target.name, nodes, round, edge == Edge::kEnd);
          test(nodes, edge);
        }
  });
}

}  // namespace

TEST_CASE("tests of sides: all nodes, and the blocks whose limit is reached") {
  Random random(test_seed());
  CAPTURE(test_seed());
  sweep(6, [&](int nodes, Edge edge) {
    check_sides(random, nodes, edge, false);
    check_sides(random, nodes, edge, true);
  });
  on_every_target([&](const simd::Target& target) {
    CAPTURE(target.name);
    for (int round = 0; round < 60; ++round) check_sides(random, random.in(49, 700), kEdges[round % 2], round % 3 != 0);
  });
}

TEST_CASE("placing: all parts, exchanges, clusters") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  sweep(6, [&](int nodes, Edge edge) { check_placing(random, nodes, edge); });
  on_every_target([&](const simd::Target& target) {
    CAPTURE(target.name);
    for (int round = 0; round < 60; ++round) check_placing(random, random.in(49, 700), kEdges[round % 2]);
  });
}

}  // namespace kage::verif
