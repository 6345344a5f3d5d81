// SPDX-License-Identifier: Apache-2.0
//
// Rules for a tree and an order, in rational numbers, from vertices, outlines and cuts alone: no arithmetic is shared
// with the library.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <span>
#include <vector>

#include "kage/order.hpp"

namespace kage::verif {

class OrderOracle {
 public:
  using Number = boost::multiprecision::cpp_rational;
  using Point = std::array<Number, 3>;

  explicit OrderOracle(const OrderTree& tree) : tree_(tree) {
    for (const OrderPoint& p : tree.vertices()) vertices_.push_back(exact(p));
    node_of_.resize(tree.fragment_count());
    fragments_of_.resize(tree.face_count());
    for (std::uint32_t v = 0; v < tree.node_count(); ++v)
      for (std::uint32_t f = tree.first_fragment(v); f < tree.first_fragment(v + 1); ++f) {
        node_of_[f] = v;
        fragments_of_[tree.fragment(f).face].push_back(f);
      }
  }

  /// Forgets the last fragment of a face, for tests that must see it missing.
  void lose_fragment(std::uint32_t face) { fragments_of_[face].pop_back(); }

  static Point exact(const OrderPoint& p) { return {Number(p[0]), Number(p[1]), Number(p[2])}; }

  /// A point of a face, not on its outline: its corners' mean by the weights that `weight` gives one after another,
  /// whole numbers above 0.
  template <class Weight>
  Point point_of(std::uint32_t face, Weight weight) const {
    Point sum{0, 0, 0};
    Number weights = 0;
    for (const std::uint32_t c : tree_.face(face).corners) {
      const Number w = weight();
      weights += w;
      for (std::size_t i = 0; i < 3; ++i) sum[i] += w * vertices_[c][i];
    }
    for (Number& x : sum) x /= weights;
    return sum;
  }

  /// Fragments of the face that hold the point, of its plane; -1 if it lies on a cut.
  int fragments_at(const Point& p, std::uint32_t face, std::uint32_t* found = nullptr) const {
    int count = 0;
    for (const std::uint32_t f : fragments_of_[face]) {
      bool in = true;
      for (const OrderFragment::Cut& c : tree_.fragment(f).cuts) {
        const int side = value(tree_.plane(c.node), p).sign();
        if (side == 0) return -1;
        in = in && (side > 0) == c.front;
      }
      if (!in) continue;
      ++count;
      if (found != nullptr) *found = f;
    }
    return count;
  }

  /// Twice the area of a face, and the sum over its fragments, as vectors; the largest distance of a fragment's rounded
  /// vertices from the true ones.
  struct Areas {
    Point face;
    Point fragments;
    double vertex_error = 0;
  };
  Areas areas(std::uint32_t face) const {
    Areas result;
    const OrderFace outline = tree_.face(face);
    std::vector<Point> corners;
    for (const std::uint32_t c : outline.corners) corners.push_back(vertices_[c]);
    result.face = area(corners);
    result.fragments = {0, 0, 0};
    for (const std::uint32_t f : fragments_of_[face]) {
      const OrderFragment fragment = tree_.fragment(f);
      std::vector<Point> points;
      for (std::size_t i = 0; i < fragment.edges.size(); ++i) {
        points.push_back(vertex(outline, fragment, i));
        for (std::size_t k = 0; k < 3; ++k) {
          const Number off = points.back()[k] - Number(fragment.vertices[i][k]);
          result.vertex_error = std::max(result.vertex_error, std::abs(off.convert_to<double>()));
        }
      }
      const Point a = area(points);
      for (std::size_t k = 0; k < 3; ++k) result.fragments[k] += a[k];
    }
    return result;
  }

  /// Follows the ray from `eye` through `target`. Returns how many of the pairs of fragments that it meets are drawn in
  /// the wrong order. Returns -1 if it meets an outline or a cut, where nothing can be said. Returns -2 if a face's
  /// point does not lie in exactly one of its fragments.
  int wrong_pairs(const Eye& eye, const Point& target, std::span<const std::uint32_t> order, int* pairs) const {
    const Point at = exact(eye.at);
    Point way = at;
    if (eye.perspective)
      for (std::size_t i = 0; i < 3; ++i) way[i] = target[i] - at[i];
    const Point& from = eye.perspective ? at : target;
    struct Hit {
      std::size_t place;
      Number distance;
    };
    std::vector<std::size_t> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    std::vector<Hit> hits;
    for (std::uint32_t face = 0; face < tree_.face_count(); ++face) {
      const OrderFace outline = tree_.face(face);
      Point ahead = from;
      for (std::size_t i = 0; i < 3; ++i) ahead[i] += way[i];
      const Number here = value(outline.plane, from);
      const Number there = value(outline.plane, ahead);
      if (here == there) continue;  // edge-on
      const Number distance = here / (here - there);
      if (eye.perspective && distance <= 0) continue;
      Point p = from;
      for (std::size_t i = 0; i < 3; ++i) p[i] += distance * way[i];
      const int in = inside(p, outline);
      if (in < 0) continue;
      if (in == 0) return -1;
      std::uint32_t fragment = 0;
      const int count = fragments_at(p, face, &fragment);
      if (count < 0) return -1;
      if (count != 1) return -2;
      hits.push_back({place[node_of_[fragment]], distance});
    }
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.place < b.place; });
    int wrong = 0;
    for (std::size_t i = 0; i < hits.size(); ++i)
      for (std::size_t j = i + 1; j < hits.size(); ++j) {
        ++*pairs;
        // Only fragments at one distance are of one plane, so of one node.
        if (hits[i].distance < hits[j].distance) ++wrong;
        if (hits[i].place == hits[j].place && hits[i].distance != hits[j].distance) ++wrong;
      }
    return wrong;
  }

 private:
  using Ids = std::array<std::uint32_t, 3>;

  static Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
  static Point cross(const Point& p, const Point& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static Number dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

  [[nodiscard]] Point normal(const Ids& plane) const {
    return cross(minus(vertices_[plane[1]], vertices_[plane[0]]), minus(vertices_[plane[2]], vertices_[plane[0]]));
  }
  [[nodiscard]] Number value(const Ids& plane, const Point& p) const {
    return dot(normal(plane), minus(p, vertices_[plane[0]]));
  }

  /// 1 inside the outline, 0 on it, -1 outside.
  [[nodiscard]] int inside(const Point& p, const OrderFace& face) const {
    const Point n = normal(face.plane);
    int least = 1;
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const Point& a = vertices_[face.corners[i]];
      const Point& b = vertices_[face.corners[(i + 1) % face.corners.size()]];
      least = std::min(least, dot(n, cross(minus(b, a), minus(p, a))).sign());
    }
    return least;
  }

  static Point area(const std::vector<Point>& points) {
    Point sum{0, 0, 0};
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Point c = cross(minus(points[i], points[0]), minus(points[i + 1], points[0]));
      for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k];
    }
    return sum;
  }

  /// The line of an edge: a point and a direction.
  [[nodiscard]] std::pair<Point, Point> line(const OrderFace& face, const OrderFragment& f, std::uint32_t edge) const {
    const auto n = static_cast<std::uint32_t>(face.corners.size());
    if (edge < OrderFragment::kCutEdge) {
      const Point& a = vertices_[face.corners[edge]];
      return {a, minus(vertices_[face.corners[(edge + 1) % n]], a)};
    }
    const Ids plane = tree_.plane(f.cuts[edge - OrderFragment::kCutEdge].node);
    const Point d = cross(normal(face.plane), normal(plane));
    // From the face's first point, in its plane and square to the line, to the cutting plane.
    const Point& a = vertices_[face.plane[0]];
    const Point across = cross(normal(face.plane), d);
    const Number t = -value(plane, a) / dot(normal(plane), across);
    return {{a[0] + t * across[0], a[1] + t * across[1], a[2] + t * across[2]}, d};
  }

  /// Where edge i - 1 and edge i meet.
  [[nodiscard]] Point vertex(const OrderFace& face, const OrderFragment& f, std::size_t i) const {
    const std::uint32_t before = f.edges[(i + f.edges.size() - 1) % f.edges.size()];
    const std::uint32_t after = f.edges[i];
    if (before < OrderFragment::kCutEdge && after < OrderFragment::kCutEdge) return vertices_[face.corners[after]];
    const auto [p, d] = line(face, f, before);
    const auto [q, e] = line(face, f, after);
    // p + t d on the line (q, e): ((p - q) + t d) x e = 0, along the normal.
    const Point n = normal(face.plane);
    const Number t = -dot(n, cross(minus(p, q), e)) / dot(n, cross(d, e));
    return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
  }

  const OrderTree& tree_;
  std::vector<Point> vertices_;
  std::vector<std::uint32_t> node_of_;
  std::vector<std::vector<std::uint32_t>> fragments_of_;
};

}  // namespace kage::verif
