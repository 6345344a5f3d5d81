// SPDX-License-Identifier: Apache-2.0
#include "extremes/order_checks.hpp"

#include <fmt/format.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "geometry/translucent.hpp"

namespace kage::verif {
namespace {

using Number = boost::multiprecision::cpp_rational;
using Point = std::array<Number, 3>;
using Corners = std::array<glm::dvec3, 3>;

Point exact(const glm::dvec3& p) { return {Number(p.x), Number(p.y), Number(p.z)}; }
Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
Number dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Point normal(const Corners& f) {
  const Point d = minus(exact(f[1]), exact(f[0]));
  const Point e = minus(exact(f[2]), exact(f[0]));
  return {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]};
}

/// The value of the node's plane where the ray of pixel (x, y), in pixels from the first one's centre, meets the face's
/// plane, times a positive factor that is the same for all pixels with `side`; linear in x and y.
struct ExactLine {
  Number a, b, c;

  ExactLine(const Camera& camera, const Corners& face, const Corners& node, int side, int width, int height) {
    const Point n = normal(node);
    const Point m = normal(face);
    const auto at = [&](int x, int y) -> Number {
      const Number unit = Number(camera.half_height) * 2 / height;
      const Number ex = (Number(2 * x + 1 - width) / 2) * unit;
      const Number ey = (Number(height - 2 * y - 1) / 2) * unit;
      Point from = exact(camera.eye);
      Point way = exact(camera.forward);
      for (std::size_t i = 0; i < 3; ++i)
        (camera.perspective ? way : from)[i] += ex * exact(camera.right)[i] + ey * exact(camera.up)[i];
      // At from + t way, t = -(m . (from - face)) / (m . way). Times m . way, which against the view is negative where
      // the eye is before the face.
      return -side * (dot(n, minus(from, exact(node[0]))) * dot(m, way) - dot(m, minus(from, exact(face[0]))) * dot(n, way));
    };
    c = at(0, 0);
    a = at(1, 0) - c;
    b = at(0, 1) - c;
  }
};

}  // namespace

bool within_fragment_bound(const OrderBuildStats& s) {
  return s.fragments <= s.faces * (s.faces * s.faces - s.faces + 2) / 2 && s.nodes <= s.fragments;
}

Outcome ways_agree(const OrderTree& tree, const std::vector<Eye>& eyes, const Context& context) {
  const auto recursion = make_order(tree, OrderWay::recursion);
  const auto list = make_order(tree, OrderWay::switching_list);
  const auto fast = make_order(tree, OrderWay::fast);
  Outcome o;
  for (const Eye& eye : eyes) {
    const auto right = recursion->update(eye);
    const auto listed = list->update(eye);
    const auto found = fast->update(eye);
    std::vector<std::uint32_t> order(found.begin(), found.end());
    if (context.planted(Plant::swapped_pair) && order.size() > 1) std::swap(order[0], order[1]);
    if (!std::equal(right.begin(), right.end(), listed.begin(), listed.end()))
      o.fail(fmt::format("step {}: the switching list gives another order", o.items));
    if (!std::equal(right.begin(), right.end(), order.begin(), order.end()))
      o.fail(fmt::format("step {}: the fast way gives another order", o.items));
    if (o.items > 0 && fast->last_step().flips != recursion->last_step().flips)
      o.fail(fmt::format("step {}: another number of nodes has changed sides", o.items));
    ++o.items;
  }
  return o;
}

Outcome cut_line_is_exact(const Camera& camera, const Corners& face, const Corners& node, int width, int height) {
  Outcome o;
  const int side = eye_side(camera, face);
  if (side == 0 || normal(node) == Point{0, 0, 0}) return o;  // no tree has a node without a plane
  const View view(camera, width, height, 24, 100);
  const CutLine line = cut_line(view, camera, face, side, node);
  const ExactLine truth(camera, face, node, side, width, height);
  const Number slope = std::max<Number>(abs(truth.a), abs(truth.b));
  if (slope == 0) return o;
  const auto value = [&](const Number& x, const Number& y) -> Number { return truth.a * x + truth.b * y + truth.c; };
  o.items = 1;
  // Where the line that kage has crosses the picture's border, the true one is so far away.
  const auto cross = [&](const Number& x, const Number& y) {
    if (x < 0 || y < 0 || x > width - 1 || y > height - 1) return;
    const Number off = abs(value(x, y)) / slope * (1 << 15);
    o.measure(off.convert_to<double>(), 1);
  };
  for (const int x : {0, width - 1})
    if (line.b != 0) cross(x, Number(-Number(line.a) * x - line.c) / line.b);
  for (const int y : {0, height - 1})
    if (line.a != 0) cross(Number(-Number(line.b) * y - line.c) / line.a, y);
  // And each corner of the picture lies on the true side, or as near to the true line.
  for (const int x : {0, width - 1})
    for (const int y : {0, height - 1}) {
      const Number v = value(x, y);
      const Number on = Number(line.a) * x + Number(line.b) * y + line.c;
      if ((v >= 0) == (on >= 0)) continue;
      const Number off = abs(v) / slope * (1 << 15);
      o.measure(off.convert_to<double>(), 1);
    }
  return o;
}

}  // namespace kage::verif
