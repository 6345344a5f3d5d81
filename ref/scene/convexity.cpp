// SPDX-License-Identifier: Apache-2.0
//
// A closed, connected surface that faces outward bounds a convex body exactly if no vertex lies outside the plane of a
// face and it goes round its inside once. Edges are looked at first: nearly every surface that is not convex has a
// hollow edge, which costs one distance to see. They do not suffice: in a finely cut shallow dent each edge is within
// the tolerance.
#include <algorithm>
#include <cmath>

#include "topology.hpp"
#include "transform.hpp"

namespace kage::scene {
namespace {

struct Plane {
  glm::dvec3 normal{0, 0, 0};  // 0: the face has no area, so no plane
  glm::dvec3 point{0, 0, 0};
  [[nodiscard]] double distance(const glm::dvec3& p) const { return dot(normal, p - point); }
};

Plane plane_of(const std::vector<glm::dvec3>& positions, const Corners& t) {
  const glm::dvec3& a = positions[t[0]];
  return {unit(cross(positions[t[1]] - a, positions[t[2]] - a), {0, 0, 0}), a};
}

std::uint32_t third(const Corners& t, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t v : t)
    if (v != a && v != b) return v;
  return t[0];
}

std::vector<std::uint32_t> vertices_of(const std::vector<Corners>& triangles) {
  std::vector<std::uint32_t> v;
  for (const Corners& t : triangles) v.insert(v.end(), t.begin(), t.end());
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
  return v;
}

// Follow a ray from the middle of the body through the middle of its largest face: it must meet no other face. With all
// vertices inside all planes every face is seen from within, so two faces on the ray mean two layers.
bool wound_once(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles,
                const glm::dvec3& middle) {
  std::size_t largest = 0;
  double area = -1;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Corners& t = triangles[i];
    const double a = length(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]));
    if (a > area) {
      area = a;
      largest = i;
    }
  }
  const Corners& l = triangles[largest];
  const glm::dvec3 ray = (positions[l[0]] + positions[l[1]] + positions[l[2]]) / 3.0 - middle;
  std::size_t met = 0;
  for (const Corners& t : triangles) {
    const glm::dvec3 p = positions[t[0]] - middle;
    const glm::dvec3 q = positions[t[1]] - middle;
    const glm::dvec3 r = positions[t[2]] - middle;
    if (dot(ray, cross(p, q)) > 0 && dot(ray, cross(q, r)) > 0 && dot(ray, cross(r, p)) > 0) ++met;
  }
  return met <= 1;
}

}  // namespace

Reason convexity(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles,
                 const std::vector<SharedEdge>& edges, std::uint64_t& budget) {
  const std::vector<std::uint32_t> vertices = vertices_of(triangles);
  SpaceBox box;
  for (const std::uint32_t v : vertices) box.add(positions[v]);
  const double tolerance = kConvexTolerance * box.diagonal();

  std::vector<Plane> planes;
  planes.reserve(triangles.size());
  for (const Corners& t : triangles) planes.push_back(plane_of(positions, t));
  for (const SharedEdge& e : edges)
    for (std::size_t side = 0; side < 2; ++side) {
      const Corners& other = triangles[e.triangle[1 - side]];
      if (planes[e.triangle[side]].distance(positions[third(other, e.a, e.b)]) > tolerance)
        return {Reason::Kind::kConcaveEdge, e.a, e.b, 0};
    }

  const std::uint64_t work = static_cast<std::uint64_t>(triangles.size()) * vertices.size();
  if (work > std::min(budget, kComponentBudget)) return {Reason::Kind::kLarge, 0, 0, 0};
  budget -= work;
  // By coordinate, relative to the middle of the box, so that the compiler makes vectors of the inner loop.
  const glm::dvec3 middle = (box.low + box.high) * 0.5;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  glm::dvec3 sum{0, 0, 0};
  for (const std::uint32_t v : vertices) {
    const glm::dvec3 p = positions[v] - middle;
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    sum += p;
  }
  for (std::size_t f = 0; f < planes.size(); ++f) {
    const glm::dvec3 n = planes[f].normal;
    const double limit = dot(n, planes[f].point - middle) + tolerance;
    const auto outside = [&](std::size_t i) { return n.x * x[i] + n.y * y[i] + n.z * z[i] > limit; };
    int any = 0;
    for (std::size_t i = 0; i < x.size(); ++i) any |= outside(i) ? 1 : 0;
    if (any == 0) continue;
    std::size_t i = 0;
    while (!outside(i)) ++i;
    return {Reason::Kind::kOutside, vertices[i], 0, static_cast<std::uint32_t>(f)};
  }
  if (!wound_once(positions, triangles, middle + sum / static_cast<double>(vertices.size())))
    return {Reason::Kind::kWound, 0, 0, 0};
  return {};
}

}  // namespace kage::scene
