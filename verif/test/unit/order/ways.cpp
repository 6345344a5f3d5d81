// SPDX-License-Identifier: Apache-2.0
// Every way gives the order of the full traversal, after every step, whatever the eye does.
#include "order/ways.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "kage/error.hpp"
#include "kage/order.hpp"
#include "stimulus/order_meshes.hpp"
#include "test/support/catch.hpp"
#include "test/support/guarded_new.hpp"
#include "test/support/order_shapes.hpp"
#include "test/support/simd.hpp"

namespace kage::verif {
namespace {

std::unique_ptr<VisibilityOrder> order_of(const ShapedTree& tree, OrderWay way) {
  switch (way) {
    case OrderWay::recursion:
      return order::make_recursion(tree.data);
    case OrderWay::switching_list:
      return order::make_switching_list(tree.data);
    default:
      return order::make_fast(tree.data);
  }
}

bool same(std::span<const std::uint32_t> p, std::span<const std::uint32_t> q) {
  return std::equal(p.begin(), p.end(), q.begin(), q.end());
}

/// An eye that wanders, swings to and fro, jumps, stands still, and changes to parallel view and back.
class Wanderer {
 public:
  explicit Wanderer(Random& random) : random_(random) { jump(); }

  Eye next() {
    if (left_-- == 0) {
      left_ = random_.in(1, 60);
      how_ = random_.in(0, 5);
      step_ = random_point(random_, std::pow(10.0, random_.in(-6, 0)));
      if (how_ == 5) eye_ = random_eye(random_);
    }
    const double sign = how_ == 1 && left_ % 2 == 0 ? -1 : 1;
    if (how_ <= 1)
      for (std::size_t i = 0; i < 3; ++i) eye_.at[i] += sign * step_[i];
    if (how_ == 2) jump();
    if (how_ == 3) eye_ = random_eye(random_);
    for (const double x : eye_.at)
      if (std::abs(x) > 1e3) jump();
    if (eye_.at == OrderPoint{0, 0, 0}) jump();  // as a direction it is none
    return eye_;
  }

 private:
  void jump() { eye_ = Eye::point(random_point(random_, 3)); }
  Random& random_;
  Eye eye_;
  OrderPoint step_{};
  int how_ = 0;
  int left_ = 0;
};

/// Steps in which the orders were not the same.
int differing_steps(const OrderTree& tree, Random& random, int steps, std::set<OrderStep::Change>& changes,
                    std::set<OrderStep::Tests>& tests) {
  const auto recursion = make_order(tree, OrderWay::recursion);
  const auto list = make_order(tree, OrderWay::switching_list);
  const auto fast = make_order(tree, OrderWay::fast);
  CHECK(recursion->order().empty());
  CHECK(list->order().empty());
  CHECK(fast->order().empty());
  Wanderer eyes(random);
  int differing = 0;
  for (int i = 0; i < steps; ++i) {
    const Eye eye = eyes.next();
    const auto right = recursion->update(eye);
    if (!same(right, list->update(eye)) || !same(right, fast->update(eye))) ++differing;
    changes.insert(fast->last_step().change);
    tests.insert(fast->last_step().tests);
    if (i > 0 && fast->last_step().flips != recursion->last_step().flips) ++differing;
  }
  return differing;
}

/// Whether an order has each node once, as that for any eye must.
bool is_permutation(std::span<const std::uint32_t> order, std::uint32_t nodes) {
  std::vector<std::uint32_t> sorted(order.begin(), order.end());
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < nodes; ++i)
    if (i >= sorted.size() || sorted[i] != i) return false;
  return sorted.size() == nodes;
}

}  // namespace

TEST_CASE("family 35: one order from all ways over wandering, swinging and jumping eyes") {
  Random random(test_seed());
  CAPTURE(test_seed());
  // KAGE_ORDER_STEPS=1000000: the long run of tools/order-steps.
  const char* env = std::getenv("KAGE_ORDER_STEPS");
  const int all = env != nullptr ? std::atoi(env) : 20'000;
  std::set<OrderStep::Change> changes;
  std::set<OrderStep::Tests> tests;
  struct Case {
    const char* name;
    OrderMesh mesh;
    int share;  // of the steps, in thousandths
  };
  const std::vector<Case> cases{
      {"one triangle", crossing_triangles(random, 1), 20},   {"crossing", crossing_triangles(random, 20), 330},
      {"lattice", lattice_triangles(random, 40), 250},       {"panes", lattice_panes(random, 40), 250},
      {"nearly coplanar", nearly_coplanar(random, 20), 100}, {"ball", bumpy_ball(random, 12, 24), 49},
      {"large ball", bumpy_ball(random, 50, 100), 1}};
  int steps = 0;
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const OrderTree tree = OrderTree::build(c.mesh);
    CAPTURE(tree.node_count());
    const int n = std::max(40, static_cast<int>(std::int64_t{all} * c.share / 1000));
    CHECK(differing_steps(tree, random, n, changes, tests) == 0);
    steps += n;
  }
  CHECK(steps >= all);
  if (env != nullptr) std::printf("%d steps, the same order from all ways\n", steps);
  // All that the fast way can do was done.
  CHECK(changes.size() == 3);
  CHECK(tests.size() == 2);
}

TEST_CASE("every instruction set gives the same order") {
  Random random(test_seed(2));
  const OrderTree tree = OrderTree::build(bumpy_ball(random, 20, 30));
  const auto recursion = make_order(tree, OrderWay::recursion);
  on_every_target([&](const simd::Target& target) {
    const auto fast = make_order(tree, OrderWay::fast);
    Wanderer eyes(random);
    CAPTURE(target.name);
    for (int i = 0; i < 300; ++i) {
      const Eye eye = eyes.next();
      REQUIRE(same(fast->update(eye), recursion->update(eye)));
    }
  });
}

TEST_CASE("trees of 0 to 48 nodes, of any shape, on every instruction set, in guarded memory") {
  Random random(test_seed(9));
  CAPTURE(test_seed(9));
  const std::uint64_t before = GuardedNew::given();
  int largest_back = 0;
  on_every_target([&](const simd::Target& target) {
    for (int nodes = 0; nodes <= kMostSize; ++nodes)
      for (int round = 0; round < 6; ++round) {
        const OrderShape shape = random_shape(random, static_cast<std::uint32_t>(nodes));
        const auto tree = tree_of_shape(random, shape);
        if (nodes > 1) largest_back = std::max(largest_back, nodes - 1 - static_cast<int>(shape[1]));
        CAPTURE(target.name, nodes, round);
        const auto recursion = order_of(*tree, OrderWay::recursion);
        const GuardedNew guarded(kEdges[round % 2]);
        const auto fast = order_of(*tree, OrderWay::fast);
        int differing = 0;
        for (int i = 0; i < 12; ++i) {
          const Eye eye = Eye::point({random.in(-1, nodes) + 0.5 * random.in(0, 1), 0.3, 0.4});
          differing += same(recursion->update(eye), fast->update(eye)) ? 0 : 1;
        }
        REQUIRE(differing == 0);
      }
  });
  CHECK(largest_back == 23);
  CHECK(GuardedNew::gave_more_than(before + std::uint64_t{49} * 6 * 10));
}

TEST_CASE("soups of 16 to 34 triangles on every instruction set, in guarded memory") {
  Random random(test_seed(10));
  CAPTURE(test_seed(10));
  std::set<std::uint32_t> backs;  // sizes of the roots' second children
  on_every_target([&](const simd::Target& target) {
    for (int round = 0; round < 80; ++round) {
      const OrderTree tree = OrderTree::build(loose_triangles(random, random.in(16, 34)));
      CAPTURE(target.name, round, tree.node_count());
      if (tree.front(0) != kNoNode && tree.back(0) != kNoNode)
        backs.insert(std::min(tree.subtree_size(tree.front(0)), tree.subtree_size(tree.back(0))));
      const auto recursion = make_order(tree, OrderWay::recursion);
      const GuardedNew guarded(kEdges[round % 2]);
      const auto fast = make_order(tree, OrderWay::fast);
      int differing = 0;
      for (int i = 0; i < 20; ++i) {
        const Eye eye = random_eye(random);
        differing += same(recursion->update(eye), fast->update(eye)) ? 0 : 1;
      }
      REQUIRE(differing == 0);
    }
  });
  // Larger than a vector of 4, of 8 and of 16, and not.
  for (std::uint32_t back = 3; back <= 17; ++back) {
    CAPTURE(back);
    CHECK(backs.count(back) == 1);
  }
}

TEST_CASE("the order is that of the tree: what the eye's plane hides comes first") {
  Random random(test_seed(3));
  const OrderTree tree = OrderTree::build(lattice_triangles(random, 30));
  const auto fast = make_order(tree, OrderWay::fast);
  for (int i = 0; i < 200; ++i) {
    const auto order = fast->update(random_eye(random));
    REQUIRE(is_permutation(order, tree.node_count()));
    std::vector<std::size_t> place(tree.node_count());
    for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = k;
    for (std::uint32_t v = 0; v < tree.node_count(); ++v) {
      const std::uint32_t front = tree.front(v);
      const std::uint32_t back = tree.back(v);
      if (front == kNoNode) continue;
      // All of one side before the node, all of the other after it.
      int wrong = 0;
      const bool front_later = place[front] > place[v];
      for (std::uint32_t c = front; c < front + tree.subtree_size(front); ++c)
        wrong += (place[c] > place[v]) == front_later ? 0 : 1;
      for (std::uint32_t c = back; back != kNoNode && c < back + tree.subtree_size(back); ++c)
        wrong += (place[c] < place[v]) == front_later ? 0 : 1;
      REQUIRE(wrong == 0);
    }
  }
}

TEST_CASE("a step says what it did, and standing still costs no tests") {
  Random random(test_seed(4));
  const OrderTree tree = OrderTree::build(bumpy_ball(random, 40, 80));
  const auto fast = make_order(tree, OrderWay::fast);
  fast->move_to(Eye::point({4, 0.3, 0.2}));
  CHECK(fast->last_step().change == OrderStep::Change::rebuild);
  CHECK(fast->last_step().tested == tree.node_count());
  fast->move_to(Eye::point({4, 0.3, 0.2}));
  CHECK(fast->last_step().change == OrderStep::Change::none);
  CHECK(fast->last_step().tested == 0);
  fast->move_to(Eye::point({4, 0.3001, 0.2}));
  CHECK(fast->last_step().tested < tree.node_count());
  for (int i = 0; i < 50; ++i) {
    fast->move_to(Eye::point(random_point(random, 5)));
    const OrderStep& s = fast->last_step();
    CHECK(!s.why.empty());
    CHECK(s.flips > 0);
    CHECK(s.change != OrderStep::Change::none);
    CHECK(s.rebuild_cost > 0);
    CHECK((s.change == OrderStep::Change::exchange) == (s.exchange_cost < s.rebuild_cost));
  }
}

TEST_CASE("after a long way, a plane crossed by tiny steps is still seen to be crossed") {
  // How far the eye may go is kept in floats; where the way is long they are coarse, and must err to the safe side.
  Random random(test_seed(7));
  const OrderTree tree = OrderTree::build(bumpy_ball(random, 12, 24));
  const auto fast = make_order(tree, OrderWay::fast);
  const auto recursion = make_order(tree, OrderWay::recursion);
  std::uint64_t flips = 0;
  int skipped = 0;
  int differing = 0;
  for (int round = 0; round < 40; ++round) {
    // Beside a face, from a little behind its plane to as little before it.
    const std::uint32_t node = static_cast<std::uint32_t>(random.in(0, static_cast<int>(tree.node_count()) - 1));
    const std::array<std::uint32_t, 3> plane = tree.plane(node);
    const OrderPoint& a = tree.vertices()[plane[0]];
    const OrderPoint& b = tree.vertices()[plane[1]];
    const double step = std::pow(10.0, random.in(-7, -3));
    for (int i = -20; i < 20; ++i) {
      OrderPoint eye;
      for (std::size_t k = 0; k < 3; ++k) eye[k] = a[k] + 0.7 * (a[k] - b[k]) + (i + 0.5) * step * a[k];
      if (!same(fast->update(Eye::point(eye)), recursion->update(Eye::point(eye)))) ++differing;
      if (i == -20) continue;
      flips += recursion->last_step().flips;
      skipped += fast->last_step().tested < tree.node_count() ? 1 : 0;
    }
  }
  CHECK(differing == 0);
  CHECK(flips >= 40);
  CHECK(skipped > 1000);
}

TEST_CASE("eyes that are none are refused, and the order stays") {
  Random random(test_seed(5));
  const OrderTree tree = OrderTree::build(crossing_triangles(random, 10));
  for (const OrderWay way : {OrderWay::recursion, OrderWay::switching_list, OrderWay::fast}) {
    const auto order = make_order(tree, way);
    const auto before = order->update(Eye::point({1, 2, 3}));
    const std::vector<std::uint32_t> kept(before.begin(), before.end());
    CHECK_THROWS_AS(order->move_to(Eye::point({0, std::nan(""), 0})), Error);
    CHECK_THROWS_AS(order->move_to(Eye::parallel({0, INFINITY, 0})), Error);
    CHECK_THROWS_AS(order->move_to(Eye::parallel({0, 0, 0})), Error);
    CHECK(same(order->order(), kept));
    // Far beyond what the scaled numbers hold, and the smallest there are.
    const auto reference = make_order(tree, OrderWay::recursion);
    for (const Eye& eye : {Eye::point({1e308, -1e308, 1e300}), Eye::point({5e-324, 0, 0}),
                           Eye::parallel({5e-324, 0, 0}), Eye::parallel({1e308, 1e308, -1e308})})
      CHECK(same(order->update(eye), reference->update(eye)));
  }
}

TEST_CASE("memory: tree and order take no more than the paper's nodes") {
  Random random(test_seed(6));
  const OrderTree tree = OrderTree::build(bumpy_ball(random, 50, 100));
  const auto fast = make_order(tree, OrderWay::fast);
  for (int i = 0; i < 100; ++i) fast->move_to(Eye::point(random_point(random, 5)));
  CHECK(fast->bytes() <= std::uint64_t{56} * tree.node_count());  // BaselineA::Node
}

TEST_CASE("a chain of 100000 nodes") {
  // Each triangle before the last: no build would make such a tree of them.
  constexpr std::uint32_t kNodes = 100'000;
  Random random(test_seed(8));
  const auto tree = tree_of_shape(random, chain_shape(kNodes));
  for (const OrderWay way : {OrderWay::recursion, OrderWay::switching_list, OrderWay::fast}) {
    const auto order = order_of(*tree, way);
    for (const double x : {-1.0, 2.0 * kNodes, 500.5, -1.0, 99'999.0}) {
      const auto found = order->update(Eye::point({x, 0.2, 0.2}));
      REQUIRE(found.size() == kNodes);
      // Farthest first on either side; a plane with the eye in it may count for either.
      std::size_t wrong = 0;
      for (std::size_t i = 1; i < found.size(); ++i) {
        const double d = tree->x[found[i - 1]] - x;
        const double e = tree->x[found[i]] - x;
        if (d != 0 && e != 0 && (d > 0) == (e > 0) && std::abs(e) > std::abs(d)) ++wrong;
      }
      CHECK(wrong == 0);
    }
  }
}

}  // namespace kage::verif
