// SPDX-License-Identifier: Apache-2.0
#include "extremes/order_checks.hpp"

#include <fmt/format.h>

#include "geometry/translucent.hpp"
#include "oracle/cut_oracle.hpp"

namespace kage::verif {
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
    if (context.injected(Injection::swapped_pair) && order.size() > 1) std::swap(order[0], order[1]);
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

Outcome cut_line_is_exact(const Camera& camera, const std::array<glm::dvec3, 3>& face,
                          const std::array<glm::dvec3, 3>& node, int width, int height, const Context& context) {
  using Number = CutOracle::Number;
  Outcome o;
  const int side = eye_side(camera, face);
  if (side == 0 || CutOracle::normal(node) == CutOracle::Point{0, 0, 0}) return o;  // no tree has such a node
  const View view(camera, width, height, 24, {camera.near, 100});
  CutLine line = cut_line(view, camera, face, side, node);
  if (context.injected(Injection::tilted_plane)) line.a += line.a / 64;
  const CutOracle truth(camera, face, node, side, width, height);
  const Number slope = truth.slope();
  if (slope == 0) return o;
  o.items = 1;
  const auto measure = [&](const Number& x, const Number& y) {
    const Number off = abs(truth.value(x, y)) / slope * (1 << 15);
    o.measure(off.convert_to<double>(), 1);
  };
  // Where the line that kage has crosses the picture's border, the true one is so far away.
  const auto cross = [&](const Number& x, const Number& y) {
    if (x >= 0 && y >= 0 && x <= width - 1 && y <= height - 1) measure(x, y);
  };
  for (const int x : {0, width - 1})
    if (line.b != 0) cross(x, Number(-Number(line.a) * x - line.c) / line.b);
  for (const int y : {0, height - 1})
    if (line.a != 0) cross(Number(-Number(line.b) * y - line.c) / line.a, y);
  // And each corner of the picture lies on the true side, or as near to the true line.
  for (const int x : {0, width - 1})
    for (const int y : {0, height - 1})
      if ((truth.value(x, y) >= 0) != (Number(line.a) * x + Number(line.b) * y + line.c >= 0)) measure(x, y);
  return o;
}

}  // namespace kage::verif
