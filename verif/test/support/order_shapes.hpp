// SPDX-License-Identifier: Apache-2.0
//
// Trees of any shape for tests of the ways to the order. A build chooses the shape on its own; here it is given.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "order/data.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// Subtree sizes in preorder, the larger child first, as OrderTree numbers its nodes.
using OrderShape = std::vector<std::uint32_t>;

/// A shape of n nodes by chance: even, as a chain, and all between.
inline void append_shape(Random& random, std::uint32_t n, OrderShape& shape) {
  if (n == 0) return;
  shape.push_back(n);
  const std::uint32_t half = (n - 1) / 2;  // the most that the smaller child can have
  const auto chance = [&] { return static_cast<std::uint32_t>(random.in(0, static_cast<int>(half))); };
  std::uint32_t small = chance();
  if (random.chance(0.4)) small = half;
  if (random.chance(0.2)) small = 0;
  append_shape(random, n - 1 - small, shape);
  append_shape(random, small, shape);
}
inline OrderShape random_shape(Random& random, std::uint32_t n) {
  OrderShape shape;
  append_shape(random, n, shape);
  return shape;
}

/// n nodes, each with one child.
inline OrderShape chain_shape(std::uint32_t n) {
  OrderShape shape;
  for (; n != 0; --n) shape.push_back(n);
  return shape;
}

/// The order by the definition: the subtree on the other side of a node's plane, the node, the subtree on the eye's
/// side. In sides[v]: whether the eye is before the plane of v, where its first child lies.
inline void append_order(const OrderShape& shape, const std::vector<bool>& sides, std::uint32_t v, std::uint32_t n,
                         std::vector<std::uint32_t>& order) {
  if (n == 0) return;
  const std::uint32_t first = n > 1 ? shape[v + 1] : 0;
  const auto child = [&](bool is_first) {
    append_order(shape, sides, is_first ? v + 1 : v + 1 + first, is_first ? first : n - 1 - first, order);
  };
  child(!sides[v]);
  order.push_back(v);
  child(sides[v]);
}
inline std::vector<std::uint32_t> order_of_shape(const OrderShape& shape, const std::vector<bool>& sides) {
  std::vector<std::uint32_t> order;
  append_order(shape, sides, 0, static_cast<std::uint32_t>(shape.size()), order);
  return order;
}

/// A tree of a given shape. Not copied: the ways to the order keep its address.
struct ShapedTree {
  order::TreeData data;
  std::vector<double> x;  ///< of each node's plane
};

/// Triangles in the planes x = 0, 1, 2, ..., so that any tree over them is one that a build could make. The nodes of a
/// first child lie before its parent's plane, those of a second behind it; by chance that is where x is larger or
/// where it is smaller.
inline std::unique_ptr<const ShapedTree> tree_of_shape(Random& random, const OrderShape& shape) {
  auto tree = std::make_unique<ShapedTree>();
  order::TreeData& d = tree->data;
  const auto n = static_cast<std::uint32_t>(shape.size());
  tree->x.resize(n);
  d.size = shape;
  d.plane.resize(n);
  struct Part {
    std::uint32_t node, nodes;
    double low;  // the least x of its planes
  };
  std::vector<Part> parts{{0, n, 0}};
  while (!parts.empty()) {
    const Part p = parts.back();
    parts.pop_back();
    if (p.nodes == 0) continue;
    const std::uint32_t first = p.nodes > 1 ? shape[p.node + 1] : 0;
    const std::uint32_t second = p.nodes - 1 - first;
    const bool first_below = random.chance(0.5);
    const double x = p.low + (first_below ? first : second);
    tree->x[p.node] = x;
    d.plane[p.node] = 2 * p.node + (first_below ? 1 : 0);
    parts.push_back({p.node + 1, first, first_below ? p.low : x + 1});
    parts.push_back({p.node + 1 + first, second, first_below ? x + 1 : p.low});
  }
  for (std::uint32_t v = 0; v < n; ++v) {
    const std::uint32_t c = 3 * v;
    for (const OrderPoint& p :
         {OrderPoint{tree->x[v], 0, 0}, OrderPoint{tree->x[v], 1, 0}, OrderPoint{tree->x[v], 0, 1}})
      d.faces.vertices.push_back(p);
    d.faces.corners.insert(d.faces.corners.end(), {c, c + 1, c + 2});
    d.faces.faces.push_back({v, c, 3, {c, c + 1, c + 2}});
    d.first_fragment.push_back(v);
    d.fragments.push_back({v, 0, c});
    d.edges.insert(d.edges.end(), {0, 1, 2});
  }
  d.first_fragment.push_back(n);
  d.fragments.push_back({0, 0, 3 * n});
  d.points = d.faces.vertices;
  d.faces.derive();
  d.derive();
  return tree;
}

}  // namespace kage::verif
