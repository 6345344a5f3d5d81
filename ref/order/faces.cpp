// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "kage/error.hpp"
#include "order/data.hpp"

namespace kage::order {
namespace {

/// A node's plane is a face and a bit.
constexpr std::size_t kMostFaces = 0x7fffffff;

using Corners = std::vector<std::uint32_t>;

class Maker {
 public:
  Maker(const OrderMesh& mesh, OrderBuildStats& stats) : mesh_(mesh), stats_(stats) {}

  Faces run() {
    if (mesh_.polygons.size() > kMostFaces || mesh_.vertices.size() >= kNoNode)
      throw Error(
          fmt::format("{} polygons over {} vertices are more than fit", mesh_.polygons.size(), mesh_.vertices.size()));
    out_.vertices = mesh_.vertices;
    for (std::size_t i = 0; i < mesh_.polygons.size(); ++i) add(static_cast<std::uint32_t>(i));
    if (out_.faces.size() > kMostFaces || out_.corners.size() >= kNoNode)
      throw Error(fmt::format("{} triangles are more than fit", out_.faces.size()));
    // Vertices that no face has may be anything.
    std::vector<bool> used(out_.vertices.size());
    for (const std::uint32_t c : out_.corners) used[c] = true;
    for (std::size_t v = 0; v < used.size(); ++v)
      if (!used[v]) out_.vertices[v] = {0, 0, 0};
    out_.derive();
    stats_.polygons = mesh_.polygons.size();
    stats_.faces = out_.faces.size();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const OrderPoint& at(std::uint32_t v) const { return mesh_.vertices[v]; }
  [[nodiscard]] PlanePoints points(const std::array<std::uint32_t, 3>& p) const {
    return {at(p[0]), at(p[1]), at(p[2])};
  }

  void add(std::uint32_t polygon) {
    const OrderMesh::Polygon& p = mesh_.polygons[polygon];
    const auto fail = [&](const std::string& why) { throw Error(fmt::format("polygon {}: {}", polygon, why)); };
    if (p.count < 3) fail(fmt::format("{} corners", p.count));
    if (p.first > mesh_.corners.size() || p.count > mesh_.corners.size() - p.first)
      fail(fmt::format("corners {} .. {} of {}", p.first, std::uint64_t{p.first} + p.count - 1, mesh_.corners.size()));
    Corners corners;
    for (std::uint32_t i = 0; i < p.count; ++i) {
      const std::uint32_t v = mesh_.corners[p.first + i];
      if (v >= mesh_.vertices.size()) fail(fmt::format("vertex {} of {}", v, mesh_.vertices.size()));
      for (const double x : at(v))
        if (!std::isfinite(x)) fail(fmt::format("vertex {} is not finite", v));
      if (corners.empty() || at(corners.back()) != at(v)) corners.push_back(v);
    }
    while (corners.size() > 1 && at(corners.front()) == at(corners.back())) corners.pop_back();

    std::array<std::uint32_t, 3> plane{};
    if (!find_plane(corners, plane)) {
      ++stats_.flat;
      return;
    }
    if (is_plane(corners, plane)) {
      if (corners.size() > 3 && !turn_outward(corners, plane)) fail("is not convex");
      push(polygon, corners, plane);
      return;
    }
    ++stats_.bent;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Corners triangle{corners[0], corners[i], corners[i + 1]};
      if (find_plane(triangle, plane)) push(polygon, triangle, plane);
    }
  }

  /// The largest triangle from the first corner by doubles, else, should those be wrong, any that has area.
  bool find_plane(const Corners& c, std::array<std::uint32_t, 3>& plane) const {
    if (c.size() < 3) return false;
    const Scale scale = scale_of(std::array<OrderPoint, 3>{at(c[0]), at(c[1]), at(c[2])});
    double best = -1;
    for (std::size_t i = 1; i + 1 < c.size(); ++i) {
      const FilterPlane f(scale(at(c[0])), scale(at(c[i])), scale(at(c[i + 1])));
      const OrderPoint& n = f.normal();
      const double area = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
      if (area > best) {
        best = area;
        plane = {c[0], c[i], c[i + 1]};
      }
    }
    if (best >= 0 && has_area(plane)) return true;
    for (std::size_t i = 1; i + 1 < c.size(); ++i) {
      plane = {c[0], c[i], c[i + 1]};
      if (has_area(plane)) return true;
    }
    return false;
  }

  [[nodiscard]] bool has_area(const std::array<std::uint32_t, 3>& p) const {
    const Scale scale = scale_of(std::array<OrderPoint, 3>{at(p[0]), at(p[1]), at(p[2])});
    const FilterPlane f(scale(at(p[0])), scale(at(p[1])), scale(at(p[2])));
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs(f.normal()[i]) > 0x1p-49 * f.weight()[i] + kTiny) return true;
    const std::array<int, 3> s = exact_turn(at(p[0]), at(p[1]), at(p[2]));
    return s[0] != 0 || s[1] != 0 || s[2] != 0;
  }

  [[nodiscard]] bool is_plane(const Corners& c, const std::array<std::uint32_t, 3>& plane) const {
    for (const std::uint32_t v : c)
      if (v != plane[0] && v != plane[1] && v != plane[2] && exact_side(points(plane), at(v)) != 0) return false;
    return true;
  }

  /// Whether the outline is convex and goes round once; turns the plane so that its front sees it counter-clockwise.
  [[nodiscard]] bool turn_outward(const Corners& c, std::array<std::uint32_t, 3>& plane) const {
    const std::array<int, 3> normal = exact_turn(at(plane[0]), at(plane[1]), at(plane[2]));
    std::size_t axis = 0;
    while (normal[axis] == 0) ++axis;
    int turning = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
      const OrderPoint& p = at(c[i]);
      const OrderPoint& q = at(c[(i + 1) % c.size()]);
      const OrderPoint& r = at(c[(i + 2) % c.size()]);
      const int s = exact_turn(p, q, r)[axis];
      if (s == 0 && (p < q) != (q < r)) return false;  // straight back
      if (s == 0) continue;
      if (turning == -s) return false;
      turning = s;
    }
    // Once round, the edges' direction changes from right to left and back once.
    const std::size_t x = (axis + 1) % 3;
    const std::size_t y = (axis + 2) % 3;
    int changes = 0;
    bool last = rightwards(at(c.back()), at(c[0]), x, y);
    for (std::size_t i = 0; i < c.size(); ++i) {
      const bool now = rightwards(at(c[i]), at(c[(i + 1) % c.size()]), x, y);
      if (now != last) ++changes;
      last = now;
    }
    if (turning != normal[axis]) std::swap(plane[1], plane[2]);
    return turning != 0 && changes == 2;
  }

  static bool rightwards(const OrderPoint& p, const OrderPoint& q, std::size_t x, std::size_t y) {
    return q[x] > p[x] || (q[x] == p[x] && q[y] > p[y]);
  }

  void push(std::uint32_t polygon, const Corners& c, const std::array<std::uint32_t, 3>& plane) {
    out_.faces.push_back(
        {polygon, static_cast<std::uint32_t>(out_.corners.size()), static_cast<std::uint32_t>(c.size()), plane});
    out_.corners.insert(out_.corners.end(), c.begin(), c.end());
  }

  const OrderMesh& mesh_;
  OrderBuildStats& stats_;
  Faces out_;
};

}  // namespace

Faces make_faces(const OrderMesh& mesh, OrderBuildStats& stats) { return Maker(mesh, stats).run(); }

}  // namespace kage::order
