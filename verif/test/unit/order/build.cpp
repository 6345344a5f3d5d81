// SPDX-License-Identifier: Apache-2.0
// Trees: what is taken, what is refused, and that neither threads nor chance change what they must not.
#include <algorithm>
#include <map>

#include "kage/error.hpp"
#include "kage/order.hpp"
#include "order/data.hpp"
#include "stimulus/order_meshes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Catch::Matchers::ContainsSubstring;

OrderMesh one(const std::vector<OrderPoint>& points) {
  OrderMesh mesh;
  add_polygon(mesh, points);
  return mesh;
}

bool identical(const OrderTree& p, const OrderTree& q) {
  const order::TreeData& a = order::data_of(p);
  const order::TreeData& b = order::data_of(q);
  const auto cuts = [](const OrderFragment::Cut& x, const OrderFragment::Cut& y) {
    return x.node == y.node && x.front == y.front;
  };
  const auto fragments = [](const order::FragmentRecord& x, const order::FragmentRecord& y) {
    return x.face == y.face && x.first_cut == y.first_cut && x.first_edge == y.first_edge;
  };
  return a.size == b.size && a.plane == b.plane && a.first_fragment == b.first_fragment && a.edges == b.edges &&
         a.points == b.points && std::equal(a.cuts.begin(), a.cuts.end(), b.cuts.begin(), b.cuts.end(), cuts) &&
         std::equal(a.fragments.begin(), a.fragments.end(), b.fragments.begin(), b.fragments.end(), fragments) &&
         a.stats.exact_tests == b.stats.exact_tests && a.stats.side_tests == b.stats.side_tests;
}

}  // namespace

TEST_CASE("a tree holds what it was given") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const OrderMesh& mesh :
       {crossing_triangles(random, 40), lattice_panes(random, 60), bumpy_ball(random, 10, 15)}) {
    const OrderTree tree = OrderTree::build(mesh);
    const OrderBuildStats& s = tree.stats();
    CHECK(s.polygons == mesh.polygons.size());
    CHECK(s.faces == tree.face_count());
    CHECK(s.nodes == tree.node_count());
    CHECK(s.fragments == tree.fragment_count());
    CHECK(s.fragments == s.faces + s.splits);
    CHECK(tree.subtree_size(0) == tree.node_count());
    std::vector<int> seen(tree.face_count());
    for (std::uint32_t v = 0; v < tree.node_count(); ++v) {
      CHECK(tree.first_fragment(v) < tree.first_fragment(v + 1));
      const std::uint32_t front = tree.front(v);
      const std::uint32_t back = tree.back(v);
      CHECK(tree.subtree_size(v) ==
            1 + (front == kNoNode ? 0 : tree.subtree_size(front)) + (back == kNoNode ? 0 : tree.subtree_size(back)));
      for (std::uint32_t f = tree.first_fragment(v); f < tree.first_fragment(v + 1); ++f) {
        const OrderFragment fragment = tree.fragment(f);
        ++seen[fragment.face];
        CHECK(fragment.vertices.size() == fragment.edges.size());
        CHECK(fragment.vertices.size() >= 3);
        for (const OrderFragment::Cut& c : fragment.cuts) {
          // A cut is above, on the way down to this node.
          CHECK(c.node < v);
          CHECK(v < c.node + tree.subtree_size(c.node));
          const std::uint32_t child = c.front ? tree.front(c.node) : tree.back(c.node);
          CHECK(child <= v);
          CHECK(v < child + tree.subtree_size(child));
        }
        if (fragment.cuts.empty()) CHECK(fragment.vertices.size() == tree.face(fragment.face).corners.size());
      }
    }
    CHECK(std::count(seen.begin(), seen.end(), 0) == 0);
  }
}

TEST_CASE("threads do not change the tree, seeds do") {
  Random random(test_seed(2));
  const OrderMesh mesh = bumpy_ball(random, 60, 90);
  OrderBuildOptions options;
  options.threads = 1;
  const OrderTree tree = OrderTree::build(mesh, options);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    for (int repeat = 0; repeat < 3; ++repeat) CHECK(identical(tree, OrderTree::build(mesh, options)));
  }
  options.seed = 2;
  CHECK(!identical(tree, OrderTree::build(mesh, options)));
}

TEST_CASE("what is no polygon is refused by its number") {
  Random random(test_seed(3));
  const auto refused = [&](const auto& change, const std::string& why) {
    OrderMesh mesh = crossing_triangles(random, 5);
    change(mesh);
    CHECK_THROWS_WITH(OrderTree::build(mesh), ContainsSubstring("polygon 3") && ContainsSubstring(why));
  };
  refused([](OrderMesh& m) { m.vertices[m.corners[10]][1] = std::nan(""); }, "not finite");
  refused([](OrderMesh& m) { m.vertices[m.corners[11]][2] = INFINITY; }, "not finite");
  refused([](OrderMesh& m) { m.corners[9] = 15; }, "vertex 15 of 15");
  refused([](OrderMesh& m) { m.polygons[3].first = 13; }, "corners 13 .. 15 of 15");
  refused([](OrderMesh& m) { m.polygons[3].count = 2; }, "2 corners");
  // Vertices of no polygon are of no account.
  OrderMesh mesh = crossing_triangles(random, 5);
  mesh.vertices.push_back({std::nan(""), 0, 0});
  CHECK(OrderTree::build(mesh).face_count() == 5);

  for (const std::vector<OrderPoint>& points : std::vector<std::vector<OrderPoint>>{
           {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}},                              // dented
           {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}},                              // crossed
           {{0, 0, 1}, {4, 0, 1}, {6, 0, 1}, {4, 0, 1}, {4, 4, 1}},                   // with a spike
           {{2, 0, 0}, {-1, 2, 0}, {-1, -2, 0}, {2, 0, 0}, {-1, 2, 0}, {-1, -2, 0}},  // twice round
           {{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}}})              // a star
    CHECK_THROWS_WITH(OrderTree::build(one(points)), ContainsSubstring("polygon 0: is not convex"));
}

TEST_CASE("polygons without area are left out, bent ones cut, collinear corners kept") {
  OrderMesh mesh;
  add_polygon(mesh, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  add_polygon(mesh, {{0, 0, 0}, {0, 0, 0}, {2, 2, 2}});
  add_polygon(mesh, {{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}});
  add_polygon(mesh, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {0, 2, 0}});  // plane, a corner twice
  add_polygon(mesh, {{0, 0, 5}, {1, 0, 5}, {1, 1, 5.5}, {0, 1, 5}});                      // bent
  const OrderTree tree = OrderTree::build(mesh);
  CHECK(tree.stats().flat == 3);
  CHECK(tree.stats().bent == 1);
  REQUIRE(tree.face_count() == 3);
  CHECK(tree.face(0).polygon == 3);
  CHECK(tree.face(0).corners.size() == 5);
  CHECK(tree.face(1).polygon == 4);
  CHECK(tree.face(2).polygon == 4);
  // Without anything left there is an order too.
  const OrderTree none = OrderTree::build(one({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
  CHECK(none.node_count() == 0);
  for (const OrderWay way : {OrderWay::recursion, OrderWay::switching_list, OrderWay::fast})
    CHECK(make_order(none, way)->update(Eye::point({1, 2, 3})).empty());
  CHECK(OrderTree::build({}).node_count() == 0);
}

TEST_CASE("coordinates as large, as small and as far apart as doubles are") {
  Random random(test_seed(4));
  for (const double size : {1e300, 1e-300, 5e-324}) {
    OrderMesh mesh = lattice_triangles(random, 25);
    for (OrderPoint& p : mesh.vertices)
      for (double& x : p) x *= size;
    OrderMesh plain = mesh;
    for (OrderPoint& p : plain.vertices)
      for (double& x : p) x /= size;
    CAPTURE(size);
    CHECK(OrderTree::build(mesh).node_count() == OrderTree::build(plain).node_count());
  }
  OrderMesh mesh = crossing_triangles(random, 12);
  for (OrderPoint& p : mesh.vertices)
    for (double& x : p) x = std::ldexp(x, random.in(-900, 900));
  const OrderTree tree = OrderTree::build(mesh);
  const auto recursion = make_order(tree, OrderWay::recursion);
  const auto fast = make_order(tree, OrderWay::fast);
  for (int i = 0; i < 50; ++i) {
    OrderPoint eye = random_point(random, 1);
    for (double& x : eye) x = std::ldexp(x, random.in(-900, 900));
    const auto right = recursion->update(Eye::point(eye));
    const auto found = fast->update(Eye::point(eye));
    CHECK(std::equal(right.begin(), right.end(), found.begin(), found.end()));
  }
}

TEST_CASE("a build ends where it is told to") {
  Random random(test_seed(5));
  const OrderMesh mesh = crossing_triangles(random, 60);
  const std::uint64_t fragments = OrderTree::build(mesh).stats().fragments;
  OrderBuildOptions options;
  options.max_fragments = fragments;
  CHECK(OrderTree::build(mesh, options).stats().fragments == fragments);
  for (const std::uint64_t limit : {fragments - 1, std::uint64_t{60}, std::uint64_t{59}, std::uint64_t{0}}) {
    options.max_fragments = limit;
    CHECK_THROWS_WITH(OrderTree::build(mesh, options), ContainsSubstring(std::to_string(limit) + " fragments"));
    CHECK_THROWS_AS(OrderTree::build(mesh, options), TooManyFragments);
  }
  options = {};
  double last = 0;
  int calls = 0;
  int back = 0;
  options.progress = [&](double done) {
    CHECK(done >= 0);
    CHECK(done <= 1);
    back += done < last ? 1 : 0;
    last = done;
    ++calls;
  };
  for (const OrderMesh& m : {bumpy_ball(random, 60, 60), mutually_crossing(random, 60)}) {
    last = 0;
    calls = 0;
    (void)OrderTree::build(m, options);
    CHECK(calls > 20);
    CHECK(back == 0);
    CHECK(last == 1);
  }
  struct Stop {};
  options.progress = [](double) { throw Stop{}; };
  CHECK_THROWS_AS(OrderTree::build(mesh, options), Stop);
}

}  // namespace kage::verif
