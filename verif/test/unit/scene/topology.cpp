// SPDX-License-Identifier: Apache-2.0
// Known solids, and each way in which a mesh can fail to be closed or convex.
#include "scene/topology.hpp"

#include <cmath>
#include <random>

#include "scene/functions.hpp"
#include "scene/transform.hpp"
#include "test/support/catch.hpp"

using namespace kage::scene;
using Points = std::vector<glm::dvec3>;
using Triangles = std::vector<Corners>;
using Kind = Reason::Kind;

namespace {

struct Solid {
  Points points;
  Triangles triangles;
};

Topology run(const Solid& s, std::uint64_t budget = kSceneBudget) { return analyse(s.points, s.triangles, budget); }

// Corner i of a box has bit k of i in coordinate k.
Solid box(const glm::dvec3& size = {1, 1, 1}) {
  Solid s;
  for (int i = 0; i < 8; ++i)
    s.points.emplace_back((i & 1) != 0 ? size.x : 0, (i & 2) != 0 ? size.y : 0, (i & 4) != 0 ? size.z : 0);
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    s.triangles.push_back({q[0], q[1], q[2]});
    s.triangles.push_back({q[0], q[2], q[3]});
  }
  return s;
}

// A closed tube round the y axis: outer radius 2, tube radius 1.
Solid torus(std::uint32_t n, std::uint32_t m) {
  namespace p = kage::portable;
  Solid s;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < m; ++k) {
      const double a = 2 * p::kPi * i / n;
      const double b = 2 * p::kPi * k / m;
      const double r = 2 + p::cos(b);
      s.points.emplace_back(r * p::cos(a), p::sin(b), -r * p::sin(a));
      const std::uint32_t j = (i + 1) % n;
      const std::uint32_t l = (k + 1) % m;
      s.triangles.push_back({i * m + k, j * m + k, j * m + l});
      s.triangles.push_back({i * m + k, j * m + l, i * m + l});
    }
  return s;
}

// A ball of n rings.
Solid ball(std::uint32_t n) {
  namespace p = kage::portable;
  Solid s;
  s.points.emplace_back(0, -1, 0);
  for (std::uint32_t i = 1; i < n; ++i)
    for (std::uint32_t k = 0; k < 2 * n; ++k) {
      const double a = p::kPi * i / n;
      const double b = p::kPi * k / n;
      s.points.emplace_back(p::sin(a) * p::cos(b), -p::cos(a), -p::sin(a) * p::sin(b));
    }
  s.points.emplace_back(0, 1, 0);
  const auto at = [&](std::uint32_t ring, std::uint32_t k) { return 1 + ring * 2 * n + k % (2 * n); };
  const auto top = static_cast<std::uint32_t>(s.points.size() - 1);
  for (std::uint32_t k = 0; k < 2 * n; ++k) {
    s.triangles.push_back({0, at(0, k + 1), at(0, k)});
    for (std::uint32_t r = 0; r + 2 < n; ++r) {
      s.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k + 1)});
      s.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r + 1, k)});
    }
    s.triangles.push_back({top, at(n - 2, k), at(n - 2, k + 1)});
  }
  return s;
}

// A pyramid on its tip, whose upper side is a bowl: n by n cells of z = depth (x^2 + y^2).
Solid bowl(std::uint32_t n, double depth) {
  Solid s;
  const auto at = [n](std::uint32_t i, std::uint32_t k) { return i * (n + 1) + k; };
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t k = 0; k <= n; ++k) {
      const double x = static_cast<double>(i) / n - 0.5;
      const double y = static_cast<double>(k) / n - 0.5;
      s.points.emplace_back(x, y, depth * (x * x + y * y));
    }
  s.points.emplace_back(0, 0, -1);
  const auto tip = static_cast<std::uint32_t>(s.points.size() - 1);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < n; ++k) {
      s.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      s.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
    s.triangles.push_back({tip, at(i + 1, 0), at(i, 0)});
    s.triangles.push_back({tip, at(i, n), at(i + 1, n)});
    s.triangles.push_back({tip, at(0, i), at(0, i + 1)});
    s.triangles.push_back({tip, at(n, i + 1), at(n, i)});
  }
  return s;
}

// Signed volume of the triangles as the analysis would have them.
double volume(const Solid& s, const Topology& t) {
  double v = 0;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    Corners c = s.triangles[i];
    if (t.reversed[i]) std::swap(c[1], c[2]);
    v += dot(s.points[c[0]], cross(s.points[c[1]], s.points[c[2]])) / 6;
  }
  return v;
}

}  // namespace

TEST_CASE("welding numbers positions in order of appearance, and -0 is 0") {
  Points unique;
  const std::vector<float> p{1, 2, 3, 0, 0, 0, 1, 2, 3, -0.0f, 0, -0.0f, 1, 2, 3.0000002f};
  CHECK(weld(p, unique) == std::vector<std::uint32_t>{0, 1, 0, 1, 2});
  CHECK(unique.size() == 3);
  CHECK_FALSE(std::signbit(unique[1].x));
}

TEST_CASE("a box is closed and convex") {
  const Topology t = run(box());
  REQUIRE(t.components.size() == 1);
  CHECK(t.components[0].count == 12);
  CHECK(t.components[0].closed);
  CHECK(t.components[0].convex);
  CHECK(t.components[0].reason.kind == Kind::kNone);
  CHECK(t.turned + t.inside_out == 0);
}

TEST_CASE("a box without a face names an edge of the hole") {
  Solid s = box();
  s.triangles.resize(11);
  const Topology t = run(s);
  CHECK_FALSE(t.components[0].closed);
  CHECK_FALSE(t.components[0].convex);
  CHECK(t.components[0].reason.text(100, 0) == "edge 104-106 belongs to one face only");
}

TEST_CASE("a box inside out is turned, one with a few faces turned is repaired") {
  Solid s = box();
  for (Corners& c : s.triangles) std::swap(c[0], c[1]);
  Topology t = run(s);
  CHECK(t.components[0].convex);
  CHECK(t.inside_out == 1);
  CHECK(volume(s, t) == Approx(1));

  s = box();
  for (const std::size_t i : {0u, 5u, 7u}) std::swap(s.triangles[i][0], s.triangles[i][1]);
  t = run(s);
  CHECK(t.components[0].convex);
  CHECK(t.turned == 3);
  CHECK(volume(s, t) == Approx(1));
}

TEST_CASE("an open mesh keeps its winding, whatever it is") {
  Solid s = box();
  s.triangles.resize(11);
  std::swap(s.triangles[3][0], s.triangles[3][1]);
  const Topology t = run(s);
  for (const bool r : t.reversed) CHECK_FALSE(r);
}

TEST_CASE("a Klein bottle is closed by its edges, but nothing is its outside") {
  // A grid of 4 by 4 whose second pair of sides is joined the wrong way round.
  Solid s;
  const std::uint32_t n = 5;
  std::mt19937 random(3);
  for (std::uint32_t i = 0; i < n * n; ++i) {
    const auto x = static_cast<double>(random() % 997);
    const auto y = static_cast<double>(random() % 991);
    s.points.emplace_back(x, y, static_cast<double>(random() % 983));
  }
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i < n ? i * n + k % n : (n - k % n) % n; };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      s.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      s.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  const Topology t = run(s);
  REQUIRE(t.components.size() == 1);
  CHECK_FALSE(t.components[0].closed);
  CHECK(t.components[0].reason.kind == Kind::kNoOrientation);
  for (const bool r : t.reversed) CHECK_FALSE(r);
}

TEST_CASE("three faces at an edge, and the two sides of one") {
  Solid s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  s.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  CHECK(run(s).components[0].reason.text(0, 0) == "edge 0-1 belongs to 3 faces");
  s.triangles = {{0, 1, 2}, {2, 1, 0}};
  CHECK(run(s).components[0].reason.text(0, 0) == "its volume is 0");
}

TEST_CASE("components: by shared edges, not by shared vertices, and in order of their first triangle") {
  Solid s = box();
  const Solid other = box();
  for (const glm::dvec3& p : other.points) s.points.push_back(p + glm::dvec3{5, 0, 0});
  Triangles mixed;
  for (std::size_t i = 0; i < 12; ++i) {
    Corners c = other.triangles[i];
    for (std::uint32_t& v : c) v += 8;
    mixed.push_back(c);
    mixed.push_back(s.triangles[i]);
  }
  s.triangles = mixed;
  // A third touches the first box at one vertex only.
  s.points.emplace_back(-1, 0, 0);
  s.points.emplace_back(0, -1, 0);
  s.triangles.push_back({0, 16, 17});
  const Topology t = run(s);
  REQUIRE(t.components.size() == 3);
  CHECK(t.order[0] == 0);
  CHECK(t.order[1] == 2);
  CHECK(t.components[1].first == 12);
  CHECK(t.order[12] == 1);
  CHECK(t.components[0].convex);
  CHECK(t.components[1].convex);
  CHECK(t.components[2].reason.kind == Kind::kOneFace);
}

TEST_CASE("a torus is closed, and its hollow edges are seen") {
  const Solid s = torus(24, 12);
  const Topology t = run(s);
  CHECK(t.components[0].closed);
  CHECK(t.components[0].reason.kind == Kind::kConcaveEdge);
  CHECK(volume(s, t) > 0);
}

TEST_CASE("a finely cut ball is convex") {
  CHECK(run(ball(3)).components[0].convex);
  CHECK(run(ball(70)).components[0].convex);
}

TEST_CASE("a hollow too finely cut for its edges to show is found all the same") {
  const Topology coarse = run(bowl(4, 1e-4));
  CHECK(coarse.components[0].reason.kind == Kind::kConcaveEdge);
  const Topology fine = run(bowl(40, 1e-4));
  CHECK(fine.components[0].closed);
  CHECK(fine.components[0].reason.kind == Kind::kOutside);
  CHECK(run(bowl(40, 1e-7)).components[0].convex);
}

TEST_CASE("the tolerance for convexity is a millionth of the size") {
  // The upper face of a box is cut along the diagonal 2-7; its two ends sink, or rise.
  for (const double sink : {-1e-3, -1e-7, 0.0, 1e-7, 1e-5}) {
    Solid s = box();
    s.points[2].y -= sink;
    s.points[7].y -= sink;
    const MeshComponent c = run(s).components[0];
    INFO(sink);
    CHECK(c.closed);
    CHECK(c.convex == (sink < 1e-6));
    if (!c.convex) CHECK(c.reason.text(0, 0) == "edge 2-7 is hollow");
  }
  CHECK(run(box({1, 1e-5, 1})).components[0].convex);
}

TEST_CASE("a star wound twice round its inside is not convex") {
  // A double pyramid over a line that winds twice: pentagram {5/2}. All its dihedral angles bulge.
  namespace p = kage::portable;
  Solid s;
  for (int i = 0; i < 5; ++i) s.points.emplace_back(p::cos(4 * p::kPi * i / 5), 0, -p::sin(4 * p::kPi * i / 5));
  s.points.emplace_back(0, 1, 0);
  s.points.emplace_back(0, -1, 0);
  for (std::uint32_t i = 0; i < 5; ++i) {
    s.triangles.push_back({i, (i + 1) % 5, 5});
    s.triangles.push_back({(i + 1) % 5, i, 6});
  }
  const Topology t = run(s);
  CHECK(t.components[0].closed);
  CHECK_FALSE(t.components[0].convex);
}

TEST_CASE("what is too large to be tested is not convex, for that reason") {
  const Solid s = ball(20);
  CHECK(run(s, 1000).components[0].reason.kind == Kind::kLarge);
  CHECK(run(s, 2'000'000).components[0].convex);
  std::uint64_t budget = 2'000'000;
  (void)analyse(s.points, s.triangles, budget);
  CHECK(budget == 2'000'000 - s.points.size() * s.triangles.size());
}

TEST_CASE("a ball rounded to floats stays convex, far from the origin too") {
  for (const float far : {0.0f, 3.0f}) {
    Solid s = ball(8);
    for (glm::dvec3& q : s.points)
      q = {static_cast<float>(q.x) + far, static_cast<float>(q.y) + far, static_cast<float>(q.z) - far};
    INFO(far);
    CHECK(run(s).components[0].convex);
  }
}
