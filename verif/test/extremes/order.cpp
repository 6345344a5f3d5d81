// SPDX-License-Identifier: Apache-2.0
// Families 14 and 36 to 38: fragments partition their faces, eyes on planes, coplanar and cyclic polygons, and the
// order against exact rays.
#include "kage/order.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "extremes/order_checks.hpp"
#include "extremes/orders.hpp"
#include "geometry/order_mesh.hpp"
#include "oracle/order_oracle.hpp"
#include "stimulus/order_meshes.hpp"
#include "stimulus/shapes.hpp"
#include "test/extremes/hold.hpp"

namespace kage::verif {
namespace {

struct Named {
  const char* name;
  OrderMesh mesh;
};

std::vector<Named> meshes(Random& random) {
  return {{"crossing", crossing_triangles(random, 14)}, {"lattice", lattice_triangles(random, 30)},
          {"panes", lattice_panes(random, 20)},         {"nearly coplanar", nearly_coplanar(random, 10)},
          {"ball", bumpy_ball(random, 6, 8)},           {"soft ball", bumpy_ball(random, 5, 7, 1e-15)}};
}

bool within_bound(const OrderTree& tree) { return within_fragment_bound(tree.stats()); }

OrderMesh joined(const std::vector<OrderMesh>& parts) {
  OrderMesh all;
  for (const OrderMesh& m : parts)
    for (const OrderMesh::Polygon& p : m.polygons) {
      std::vector<OrderPoint> points;
      for (std::uint32_t i = 0; i < p.count; ++i) points.push_back(m.vertices[m.corners[p.first + i]]);
      add_polygon(all, points);
    }
  return all;
}

struct RayCount {
  int rays = 0;
  int pairs = 0;
  int nothing_said = 0;
  int wrong = 0;
};

/// A random point of a face, not on its outline.
OrderOracle::Point point_on(const OrderOracle& oracle, Random& random, std::uint32_t face) {
  return oracle.point_of(face, [&random] { return random.in(1, 1000); });
}

/// Rays from some eyes through random points of random faces.
RayCount follow_rays(const OrderTree& tree, Random& random, int eyes, int rays) {
  RayCount count;
  if (tree.face_count() == 0) return count;
  const OrderOracle oracle(tree);
  std::vector<std::unique_ptr<VisibilityOrder>> ways;
  for (const OrderWay way : {OrderWay::recursion, OrderWay::switching_list, OrderWay::fast})
    ways.push_back(make_order(tree, way));
  for (int i = 0; i < eyes; ++i) {
    Eye eye = random_eye(random);
    if (random.chance(0.3)) {  // a vertex, so on the planes of many nodes
      const auto& v =
          tree.vertices()[static_cast<std::size_t>(random.in(0, static_cast<int>(tree.vertices().size()) - 1))];
      eye = Eye::point(v);
    }
    const auto order = ways[0]->update(eye);
    for (const auto& way : ways) {
      const auto found = way->update(eye);
      if (!std::equal(order.begin(), order.end(), found.begin(), found.end())) ++count.wrong;
    }
    for (int r = 0; r < rays; ++r) {
      const auto face = static_cast<std::uint32_t>(random.in(0, static_cast<int>(tree.face_count()) - 1));
      const OrderOracle::Point target = point_on(oracle, random, face);
      if (eye.perspective && target == OrderOracle::exact(eye.at)) continue;
      const int wrong = oracle.wrong_pairs(eye, target, order, &count.pairs);
      if (wrong == -1)
        ++count.nothing_said;
      else
        ++count.rays;
      if (wrong > 0 || wrong == -2) ++count.wrong;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("family 14: fragments partition their face, in rational numbers") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::uint64_t splits = 0;
  for (const Named& m : meshes(random)) {
    CAPTURE(m.name);
    const OrderTree tree = OrderTree::build(m.mesh);
    splits += tree.stats().splits;
    const OrderOracle oracle(tree);
    for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
      const OrderOracle::Areas a = oracle.areas(face);
      REQUIRE(a.face == a.fragments);
      CHECK(a.vertex_error < 1e-9);
      for (int i = 0; i < 20; ++i) {
        const int count = oracle.fragments_at(point_on(oracle, random, face), face);
        REQUIRE((count == 1 || count == -1));
      }
    }
  }
  CHECK(splits > 200);
  cases_hold<PartitionCase>(20);
}

TEST_CASE("family 36: the eye on nodes' planes, on several at once", "[simd]") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int round = 0; round < 5; ++round) {
    const OrderTree tree = OrderTree::build(round % 2 == 0 ? lattice_panes(random, 30) : lattice_triangles(random, 30));
    const auto recursion = make_order(tree, OrderWay::recursion);
    const auto list = make_order(tree, OrderWay::switching_list);
    const auto fast = make_order(tree, OrderWay::fast);
    int exact = 0;
    for (int i = 0; i < 400; ++i) {
      // Lattice points lie on many planes at once; lattice directions along many.
      Eye eye = Eye::point(lattice_point(random, 3));
      if (i % 4 == 1) eye = Eye::parallel({0, 0, i % 8 == 1 ? 1.0 : -1.0});
      if (i % 4 == 2) eye = Eye::parallel({1, static_cast<double>(random.in(-1, 1)), 0});
      if (i % 4 == 3)  // a hair beside one
        for (double& x : eye.at) x = std::nextafter(x, random.chance(0.5) ? 10 : -10);
      const auto right = recursion->update(eye);
      const auto listed = list->update(eye);
      const auto found = fast->update(eye);
      REQUIRE(std::equal(right.begin(), right.end(), listed.begin(), listed.end()));
      REQUIRE(std::equal(right.begin(), right.end(), found.begin(), found.end()));
      exact += fast->last_step().exact != 0 ? 1 : 0;
    }
    CHECK(exact > 100);
    CHECK(follow_rays(tree, random, 10, 10).wrong == 0);
  }
  // On its plane a node counts as seen from its front, so its back is drawn first.
  OrderMesh mesh;
  for (const double x : {0.0, 1.0, -1.0}) add_polygon(mesh, {{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
  const OrderTree tree = OrderTree::build(mesh);
  REQUIRE(tree.node_count() == 3);
  const OrderPoint on = tree.vertices()[tree.plane(0)[0]];
  for (const OrderWay way : {OrderWay::recursion, OrderWay::switching_list, OrderWay::fast}) {
    const auto made = make_order(tree, way);
    const auto order = made->update(Eye::point({on[0], 7, 7}));
    const auto place = [&](std::uint32_t v) { return std::find(order.begin(), order.end(), v) - order.begin(); };
    CHECK(place(tree.front(0)) > place(0));
    if (tree.back(0) != kNoNode) CHECK(place(tree.back(0)) < place(0));
  }
}

TEST_CASE("family 37: coplanar polygons and duplicates share a node, in the order of the mesh") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  // In one plane that no axis is square to, of either facing, overlapping or the very same.
  OrderMesh mesh;
  for (int i = 0; i < 1000; ++i) {
    std::vector<OrderPoint> points;
    for (int k = 0; k < 3; ++k) {
      const OrderPoint p = lattice_point(random, 8);
      points.push_back({p[0], p[1], p[0] - 3 * p[1] + 5});
    }
    if (i % 10 == 9) {
      points.clear();
      for (std::uint32_t k = 3; k > 0; --k) points.push_back(mesh.vertices[mesh.vertices.size() - k]);
      if (i % 20 == 9) std::reverse(points.begin(), points.end());
    }
    add_polygon(mesh, points);
  }
  const OrderTree tree = OrderTree::build(mesh);
  CHECK(tree.node_count() == 1);
  CHECK(tree.stats().splits == 0);
  CHECK(tree.fragment_count() == tree.face_count());
  CHECK(tree.face_count() + tree.stats().flat == 1000);
  for (std::uint32_t f = 1; f < tree.fragment_count(); ++f)
    if (tree.fragment(f - 1).face >= tree.fragment(f).face) FAIL_CHECK("fragment " << f);
}

TEST_CASE("family 37: nearly coplanar polygons are told apart, and the build ends within its bound") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  for (int round = 0; round < 10; ++round) {
    const OrderTree tree = OrderTree::build(nearly_coplanar(random, 30));
    CAPTURE(tree.node_count(), tree.fragment_count());
    CHECK(within_bound(tree));
    CHECK(tree.node_count() > 1);
    CHECK(tree.stats().exact_tests > 0);
  }
  // As many fragments as can be: planes in general position through one another.
  for (int n = 1; n <= 6; ++n)
    for (int round = 0; round < 20; ++round) CHECK(within_bound(OrderTree::build(crossing_triangles(random, n))));
  CHECK(within_bound(OrderTree::build(crossing_triangles(random, 120))));
  CHECK(within_bound(OrderTree::build(lattice_triangles(random, 300))));
}

TEST_CASE("family 37: three panes that overlap in a circle are cut", "[simd]") {
  Random random(test_seed(5));
  OrderMesh mesh;
  // Each over the next at one end, under the one before at the other.
  add_polygon(mesh, {{-3, -1, 0.5}, {3, -1, -0.5}, {3, -0.5, -0.5}, {-3, -0.5, 0.5}});
  add_polygon(mesh, {{1, -3, 0.5}, {1.5, -3, 0.5}, {-0.5, 3, -0.5}, {-1, 3, -0.5}});
  add_polygon(mesh, {{-2.5, -2.5, -0.5}, {-2, -2.5, -0.5}, {1.5, 3, 0.5}, {1, 3, 0.5}});
  const OrderTree tree = OrderTree::build(mesh);
  CHECK(within_bound(tree));
  CHECK(tree.stats().splits >= 1);
  const RayCount count = follow_rays(tree, random, 50, 30);
  CHECK(count.wrong == 0);
  CHECK(count.pairs > 100);
}

TEST_CASE("family 37: faces next to nothing wide cut others where their planes are, in all ways to the order") {
  Random random(test_seed(371));
  CAPTURE(test_seed(371));
  SceneFrame f;
  for (unsigned i = 0; i < 2; ++i)
    add_glass(f, raw_sphere_solid(4 + i), {0, 0, 0}, glm::dvec3(0.3 + 0.25 * i), Turn{}, {1, 1, 1}, 100);
  add_glass(f, box_solid(), {0.9, 0, 0.2}, glm::dvec3(0.5), Turn{}, {1, 1, 1}, 100);
  const OrderTree tree = OrderTree::build(order_mesh(f));
  CHECK(tree.stats().flat == 0);
  int slivers = 0;
  for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
    const auto& c = tree.face(face).plane;
    double least = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      double length = 0;
      for (std::size_t i = 0; i < 3; ++i)
        length += std::pow(tree.vertices()[c[k]][i] - tree.vertices()[c[(k + 1) % 3]][i], 2);
      least = std::min(least, std::sqrt(length));
    }
    slivers += least < 1e-15 ? 1 : 0;
  }
  CHECK(slivers >= 2 * (4 + 5));
  CHECK(tree.stats().exact_tests > 0);
  const RayCount count = follow_rays(tree, random, 8, 10);
  CHECK(count.wrong == 0);
  CHECK(count.rays > 15);
  CHECK(count.pairs > 150);
}

TEST_CASE("family 38: exact rays meet no two fragments in the wrong order") {
  Random random(test_seed(6));
  CAPTURE(test_seed(6));
  int pairs = 0;
  for (int round = 0; round < 2; ++round)
    for (const Named& m : meshes(random)) {
      CAPTURE(m.name, round);
      const OrderTree tree = OrderTree::build(m.mesh);
      const RayCount count = follow_rays(tree, random, 9, 8);
      CHECK(count.wrong == 0);
      CHECK(count.rays > 30);
      pairs += count.pairs;
    }
  CHECK(pairs > 700);
  cases_hold<RaysCase>(5);
  const OrderTree both = OrderTree::build(joined({lattice_panes(random, 15), crossing_triangles(random, 8)}));
  CHECK(follow_rays(both, random, 20, 20).wrong == 0);
}

TEST_CASE("the oracle says no to a wrong order") {
  Random random(test_seed(7));
  const OrderTree tree = OrderTree::build(lattice_panes(random, 20));
  const OrderOracle oracle(tree);
  const auto way = make_order(tree, OrderWay::fast);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const Eye eye = Eye::point(random_point(random, 10));
    const auto order = way->update(eye);
    const std::vector<std::uint32_t> reversed(order.rbegin(), order.rend());
    int pairs = 0;
    if (oracle.wrong_pairs(eye, point_on(oracle, random, static_cast<std::uint32_t>(i) % tree.face_count()), reversed,
                           &pairs) > 0)
      ++found;
  }
  CHECK(found > 30);
}

}  // namespace kage::verif
