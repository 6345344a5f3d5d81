// SPDX-License-Identifier: Apache-2.0
// Triangles of convex bodies put together to polygons: what is merged, what is not, and that the surface stays the
// same.
#include "scene/polygons.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "files.hpp"
#include "scene/functions.hpp"
#include "scene/transform.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::scene;
using Outline = std::vector<std::uint32_t>;

namespace {

// A body: triangles, each with corners of its own for shading.
struct Body {
  std::vector<glm::dvec3> points;
  std::vector<Corners> triangles;
  std::vector<Corners> shading_corners;
  std::vector<ShadingVertex> shading;
  std::vector<Surface> surfaces;  // of the first triangles; the others have the usual one

  // A triangle with its own normal, or another at each corner.
  void triangle(const Corners& t, const glm::dvec3& color = {1, 1, 1}, bool smooth = false) {
    const glm::dvec3 n = unit(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]), {0, 0, 0});
    triangles.push_back(t);
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<std::uint32_t>(shading.size());
      shading.push_back({smooth ? unit(n + points[t[i]] * 0.1, n) : n, color});
    }
    shading_corners.push_back(corners);
  }

  // A face as a fan from its corner `from`.
  void face(const Outline& f, const glm::dvec3& color = {1, 1, 1}, bool smooth = false, std::size_t from = 0) {
    const auto at = [&](std::size_t i) { return f[(from + i) % f.size()]; };
    for (std::size_t i = 1; i + 1 < f.size(); ++i) triangle({at(0), at(i), at(i + 1)}, color, smooth);
  }
};

struct Merged {
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> corners;

  [[nodiscard]] Outline outline(const Polygon& p) const {
    return {corners.begin() + p.first, corners.begin() + p.first + p.count};
  }
  // How many polygons have so many corners.
  [[nodiscard]] std::map<std::uint32_t, int> sizes() const {
    std::map<std::uint32_t, int> out;
    for (const Polygon& p : polygons) ++out[p.count];
    return out;
  }
};

Merged merge(const Body& b, bool convex = true, std::uint32_t first = 0) {
  Merged m;
  std::vector<Surface> surfaces = b.surfaces;
  surfaces.resize(b.triangles.size());
  append_polygons(b.points, b.triangles, b.shading_corners, b.shading, surfaces, first, convex, m.polygons, m.corners);
  return m;
}

using Sizes = std::map<std::uint32_t, int>;

// Twice the area, as a vector along the normal.
glm::dvec3 area(const std::vector<glm::dvec3>& points, const Outline& o) {
  glm::dvec3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < o.size(); ++i)
    sum += cross(points[o[i]] - points[o[0]], points[o[i + 1]] - points[o[0]]);
  return sum;
}

// Checks every result: each edge belongs to exactly two polygons, in opposite directions. Each polygon faces away from
// `inside`, is convex, and has the plane of its own largest triangle. The areas add up to the triangles'.
void check_surface(const std::vector<glm::dvec3>& points, const std::vector<Corners>& triangles, const Merged& m,
                   const glm::dvec3& inside, std::uint32_t first = 0) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double whole = 0;
  double parts = 0;
  const auto area_of = [&](const Corners& t) { return length(area(points, {t[0], t[1], t[2]})); };
  for (const Corners& t : triangles) whole += area_of(t);
  std::uint32_t next = 0;
  for (const Polygon& p : m.polygons) {
    CHECK(p.first == next);
    next += p.count;
    const Outline o = m.outline(p);
    CHECK(std::set<std::uint32_t>(o.begin(), o.end()).size() == o.size());
    const glm::dvec3 normal = area(points, o);
    parts += length(normal);
    CHECK(dot(normal, points[o[0]] - inside) > 0);
    for (std::size_t i = 0; i < o.size(); ++i) {
      const std::uint32_t a = o[i];
      const std::uint32_t b = o[(i + 1) % o.size()];
      const std::uint32_t c = o[(i + 2) % o.size()];
      ++edges[{a, b}];
      CHECK(dot(normal, cross(points[b] - points[a], points[c] - points[b])) > -1e-9 * dot(normal, normal));
    }
    const Corners& largest = triangles[p.triangle - first];
    const std::set<std::uint32_t> corners(o.begin(), o.end());
    const glm::dvec3 n = unit(area(points, {largest[0], largest[1], largest[2]}), {0, 0, 0});
    for (const std::uint32_t v : o) CHECK(std::abs(dot(n, points[v] - points[largest[0]])) < 1e-5);
  }
  CHECK(next == m.corners.size());
  CHECK(parts == Approx(whole).epsilon(1e-9));
  for (const auto& [edge, times] : edges) {
    CHECK(times == 1);
    CHECK(edges.count({edge.second, edge.first}) == 1);
  }
}

// Corner i of a box has bit k of i in coordinate k.
const std::vector<Outline> kBoxFaces{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

std::vector<glm::dvec3> box_points() {
  std::vector<glm::dvec3> p;
  for (int i = 0; i < 8; ++i) p.emplace_back((i & 1) != 0 ? 3 : 0, (i & 2) != 0 ? 2 : 0, (i & 4) != 0 ? 1 : 0);
  return p;
}
const glm::dvec3 kBoxMiddle{1.5, 1, 0.5};

// A prism of n sides that stands on y = 0; its points as a file's single precision leaves them.
Body prism(std::uint32_t n, std::size_t from = 0) {
  Body b;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * portable::kPi * i / n;
    const auto x = static_cast<float>(portable::cos(a));
    const auto z = static_cast<float>(-portable::sin(a));
    b.points.emplace_back(x, 0, z);
    b.points.emplace_back(x, 1.3F, z);
  }
  Outline low;
  Outline high;
  for (std::uint32_t i = 0; i < n; ++i) {
    low.insert(low.begin(), 2 * i);
    high.push_back(2 * i + 1);
  }
  b.face(low, {1, 1, 1}, false, from);
  b.face(high, {1, 1, 1}, false, from);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    b.face({2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  return b;
}

}  // namespace

TEST_CASE("a box becomes six quads, whichever way its faces are cut") {
  for (std::size_t from = 0; from < 4; ++from) {
    Body b;
    b.points = box_points();
    for (const Outline& f : kBoxFaces) b.face(f, {1, 1, 1}, false, from);
    const Merged m = merge(b);
    CHECK(m.sizes() == Sizes{{4, 6}});
    check_surface(b.points, b.triangles, m, kBoxMiddle);
    // In the order of their lowest triangle, each from its lowest corner.
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(m.polygons[i].triangle / 2 == i);
      Outline expected = kBoxFaces[i];
      std::rotate(expected.begin(), std::min_element(expected.begin(), expected.end()), expected.end());
      CHECK(m.outline(m.polygons[i]) == expected);
    }
  }
}

TEST_CASE("polygons name triangles of the whole mesh and come after what is there") {
  Body b;
  b.points = box_points();
  for (const Outline& f : kBoxFaces) b.face(f);
  Merged m;
  m.polygons.push_back({0, 3, 7});
  m.corners = {5, 6, 7};
  append_polygons(b.points, b.triangles, b.shading_corners, b.shading, std::vector<Surface>(b.triangles.size()), 100,
                  true, m.polygons, m.corners);
  REQUIRE(m.polygons.size() == 7);
  CHECK(m.polygons[0].triangle == 7);
  for (std::size_t i = 1; i < 7; ++i) {
    CHECK(m.polygons[i].first == 3 + 4 * (i - 1));
    CHECK(m.polygons[i].triangle / 2 == 49 + i);
  }
}

TEST_CASE("a prism becomes two n-gons and n quads") {
  for (const std::uint32_t n : {3U, 5U, 13U, 40U, 124U}) {
    CAPTURE(n);
    const Body b = prism(n, n / 2);
    const Merged m = merge(b);
    Sizes expected{{4, static_cast<int>(n)}};
    expected[n] += 2;
    CHECK(m.sizes() == expected);
    check_surface(b.points, b.triangles, m, {0, 0.6, 0});
    // The plane is the largest triangle's: of a fan, one in its middle.
    const auto area_of = [&](std::uint32_t t) {
      const Corners& c = b.triangles[t];
      return length(area(b.points, {c[0], c[1], c[2]}));
    };
    for (std::uint32_t end = 0; end < 2; ++end)
      for (std::uint32_t t = 0; t < n - 2; ++t) CHECK(area_of(m.polygons[end].triangle) >= area_of(end * (n - 2) + t));
  }
}

TEST_CASE("a face of many triangles, with corners on its edges and within it, becomes one polygon") {
  // A slab whose top is a grid of 6 by 5 cells; its sides take up the corners of the grid, so outlines have collinear
  // ones, and corners within the top are in no outline.
  Body b;
  constexpr std::uint32_t kX = 6;
  constexpr std::uint32_t kZ = 5;
  const auto at = [](std::uint32_t i, std::uint32_t k) { return i * (kZ + 1) + k; };
  for (std::uint32_t i = 0; i <= kX; ++i)
    for (std::uint32_t k = 0; k <= kZ; ++k) b.points.emplace_back(static_cast<float>(i * 0.7), 0, -1.0 * k);
  const auto low = static_cast<std::uint32_t>(b.points.size());
  for (const std::uint32_t v : {at(0, 0), at(kX, 0), at(kX, kZ), at(0, kZ)})
    b.points.push_back(b.points[v] + glm::dvec3{0, -0.5, 0});
  for (std::uint32_t i = 0; i < kX; ++i)
    for (std::uint32_t k = 0; k < kZ; ++k) b.face({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
  // From the lower corner under the last, so that no triangle is flat.
  Outline side{low, low + 1};
  for (std::uint32_t i = kX + 1; i-- > 0;) side.push_back(at(i, 0));
  b.face(side);
  side = {low + 1, low + 2};
  for (std::uint32_t k = kZ + 1; k-- > 0;) side.push_back(at(kX, k));
  b.face(side);
  side = {low + 2, low + 3};
  for (std::uint32_t i = 0; i <= kX; ++i) side.push_back(at(i, kZ));
  b.face(side);
  side = {low + 3, low};
  for (std::uint32_t k = 0; k <= kZ; ++k) side.push_back(at(0, k));
  b.face(side);
  b.face({low + 3, low + 2, low + 1, low});
  const Merged m = merge(b);
  CHECK(m.sizes() == Sizes{{2 * (kX + kZ), 1}, {kX + 3, 2}, {kZ + 3, 2}, {4, 1}});
  check_surface(b.points, b.triangles, m, {2, -0.25, -2});
}

TEST_CASE("colours that differ keep triangles apart") {
  Body b;
  b.points = box_points();
  b.face(kBoxFaces[0], {1, 0, 0});
  b.triangle({1, 3, 7}, {1, 0, 0});
  b.triangle({1, 7, 5}, {1, 0, 1e-9});
  for (std::size_t i = 2; i < 6; ++i) b.face(kBoxFaces[i], {0, 1, 0});
  const Merged m = merge(b);
  CHECK(m.sizes() == Sizes{{3, 2}, {4, 5}});
  check_surface(b.points, b.triangles, m, kBoxMiddle);
}

TEST_CASE("surfaces that differ keep triangles apart") {
  Body b;
  b.points = box_points();
  for (const auto& face : kBoxFaces) b.face(face);
  CHECK(merge(b).sizes() == Sizes{{4, 6}});
  for (const Surface& other :
       {Surface{255, true, Sides::both}, {255, false, Sides::front}, {255, false, Sides::back}}) {
    b.surfaces = {other};
    const Merged m = merge(b);
    CHECK(m.sizes() == Sizes{{3, 2}, {4, 5}});
    check_surface(b.points, b.triangles, m, kBoxMiddle);
    b.surfaces.assign(b.triangles.size(), other);
    CHECK(merge(b).sizes() == Sizes{{4, 6}});
  }
}

TEST_CASE("normals that differ keep triangles apart, rounding does not") {
  for (const bool apart : {false, true}) {
    Body b;
    b.points = box_points();
    for (const Outline& f : kBoxFaces) b.face(f);
    const double lean = apart ? 0.004 : 1e-7;  // of the second triangle's normal
    for (std::size_t i = 3; i < 6; ++i) b.shading[i].normal = unit(b.shading[i].normal + glm::dvec3{0, lean, 0}, {});
    const Merged m = merge(b);
    CHECK(m.sizes() == (apart ? Sizes{{3, 2}, {4, 5}} : Sizes{{4, 6}}));
    check_surface(b.points, b.triangles, m, kBoxMiddle);
  }
}

TEST_CASE("triangles of smooth faces stay triangles") {
  Body b;
  b.points = box_points();
  for (std::size_t i = 0; i < 6; ++i) b.face(kBoxFaces[i], {1, 1, 1}, i < 2);
  const Merged m = merge(b);
  CHECK(m.sizes() == Sizes{{3, 4}, {4, 4}});
  check_surface(b.points, b.triangles, m, kBoxMiddle);
}

TEST_CASE("one corner's normal or colour keeps a triangle apart") {
  for (const std::size_t corner : {3U, 4U, 5U})
    for (const bool color : {false, true}) {
      Body b;
      b.points = box_points();
      for (const Outline& f : kBoxFaces) b.face(f);
      if (color)
        b.shading[corner].color = {1, 1, 0};
      else
        b.shading[corner].normal = unit(b.shading[corner].normal + glm::dvec3{0, 0.1, 0}, {});
      CHECK(merge(b).sizes() == Sizes{{3, 2}, {4, 5}});
    }
}

TEST_CASE("faces that meet at a flat angle are one within the tolerance, two beyond") {
  // A box whose face at x = 3 is folded along the diagonal 1-7: its corner 3 stands in by a share of the box's size.
  for (const double share : {0.5, 2.0}) {
    Body b;
    b.points = box_points();
    b.points[3].x -= share * kPlanarTolerance * std::sqrt(14.0);
    b.triangle({1, 3, 7});
    b.triangle({1, 7, 5});
    for (std::size_t i : {0U, 2U, 4U, 3U, 5U}) b.face(kBoxFaces[i], {1, 1, 1}, false, i == 4 || i == 3 ? 1 : 0);
    const Merged m = merge(b);
    CAPTURE(share);
    CHECK(m.sizes() == (share < 1 ? Sizes{{4, 6}} : Sizes{{3, 2}, {4, 5}}));
    check_surface(b.points, b.triangles, m, kBoxMiddle);
  }
}

TEST_CASE("a part that is not convex keeps its triangles, in their order") {
  Body b;
  b.points = box_points();
  for (const Outline& f : kBoxFaces) b.face(f);
  const Merged m = merge(b, false, 40);
  REQUIRE(m.polygons.size() == 12);
  for (std::uint32_t t = 0; t < 12; ++t) {
    CHECK(m.polygons[t].triangle == 40 + t);
    CHECK(m.outline(m.polygons[t]) == Outline(b.triangles[t].begin(), b.triangles[t].end()));
  }
  check_surface(b.points, b.triangles, m, kBoxMiddle, 40);
}

TEST_CASE("scenes: polygons of plain and mirrored nodes face outward, and of a concave mesh there are none") {
  // A box by two nodes, the second mirrored; and the box with a dent in its top, which is not convex.
  std::vector<float> positions;
  for (const glm::dvec3& p : box_points())
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k]));
  positions.insert(positions.end(), {1.5F, 1, 0.6F});
  std::vector<std::uint16_t> indices;
  for (const Outline& f : kBoxFaces)
    for (const std::size_t i : {0U, 1U, 2U, 0U, 2U, 3U}) indices.push_back(static_cast<std::uint16_t>(f[i]));
  const std::vector<std::uint16_t> dent{4, 5, 8, 5, 7, 8, 7, 6, 8, 6, 4, 8};
  std::vector<std::uint16_t> dented(indices.begin(), indices.begin() + 30);
  dented.insert(dented.end(), dent.begin(), dent.end());
  const test::TempDirectory directory;
  const Scene scene = Scene::load(directory.write(
      "boxes.gltf",
      test::gltf(
          R"("bufferViews": [{"buffer": 0, "byteLength": 108}, {"buffer": 0, "byteOffset": 108, "byteLength": 72},
          {"buffer": 0, "byteOffset": 180, "byteLength": 84}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3"},
          {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
          {"bufferView": 2, "componentType": 5123, "count": 42, "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]},
          {"primitives": [{"attributes": {"POSITION": 0}, "indices": 2}]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "scale": [-1, 2, 1], "translation": [9, 0, 0]}, {"mesh": 1, "translation": [0, 7, 0]}])",
          test::bytes_of(positions) + test::bytes_of(indices) + test::bytes_of(dented))));
  const SceneFrame f = scene.frame(0, 8);
  REQUIRE(f.components.size() == 3);
  const std::array<glm::dvec3, 3> middles{kBoxMiddle, glm::dvec3{7.5, 2, 0.5}, glm::dvec3{1.5, 8, 0.3}};
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    const Component& c = f.components[i];
    CHECK(c.convex == (i < 2));
    CHECK(c.first_polygon == next);
    next += c.polygon_count;
    CHECK(c.polygon_count == (i < 2 ? 6 : 14));
    Merged m;
    std::vector<Corners> triangles;
    for (std::uint32_t t = c.first; t < c.first + c.count; ++t) triangles.push_back(f.triangles[t].vertex);
    for (std::uint32_t p = c.first_polygon; p < c.first_polygon + c.polygon_count; ++p) {
      const auto o = f.outline(f.polygons[p]);
      m.polygons.push_back({static_cast<std::uint32_t>(m.corners.size()), f.polygons[p].count, f.polygons[p].triangle});
      m.corners.insert(m.corners.end(), o.begin(), o.end());
    }
    if (i < 2) {
      CHECK(m.sizes() == Sizes{{4, 6}});
      check_surface(f.vertices, triangles, m, middles[i], c.first);
    } else {
      CHECK(m.sizes() == Sizes{{3, 14}});
    }
  }
  CHECK(next == f.polygons.size());
}
