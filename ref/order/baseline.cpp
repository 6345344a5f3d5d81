// SPDX-License-Identifier: Apache-2.0
#include "order/baseline.hpp"

#include "order/sides.hpp"

namespace kage::order {
namespace {

/// The order in which [Tanaka 2005] figure 2.4 makes nodes: both subtrees, then the node that combines them.
std::vector<std::uint32_t> build_order(const TreeData& data) {
  std::vector<std::uint32_t> order;  // backwards
  std::vector<std::uint32_t> stack;
  if (data.nodes() != 0) stack.push_back(0);
  while (!stack.empty()) {
    const std::uint32_t v = stack.back();
    stack.pop_back();
    order.push_back(v);
    for (const std::uint32_t c : {data.first_child(v), data.second_child(v)})
      if (c != kNoNode) stack.push_back(c);
  }
  return {order.rbegin(), order.rend()};
}

}  // namespace

BaselineA::Polygon* BaselineA::polygons_of(const TreeData& data, std::uint32_t node) {
  Polygon* root = nullptr;
  for (std::uint32_t f = data.first_fragment[node + std::size_t{1}]; f-- > data.first_fragment[node];) {
    const FragmentRecord& r = data.fragments[f];
    const auto from = data.points.begin() + r.first_edge;
    const auto to = data.points.begin() + data.fragments[f + std::size_t{1}].first_edge;
    polygons_.push_back(std::make_unique<Polygon>(Polygon{node, r.face, std::vector<OrderPoint>(from, to), root}));
    root = polygons_.back().get();
  }
  return root;
}

BaselineA::BaselineA(const TreeData& data) : scale_(data.faces.scale), nodes_(data.nodes()), order_(data.nodes()) {
  for (const std::uint32_t v : build_order(data)) {
    Polygon* const root = polygons_of(data, v);
    const std::array<std::uint32_t, 3> p = data.plane_vertices(v);
    const Faces& f = data.faces;
    const FilterPlane plane(f.scaled[p[0]], f.scaled[p[1]], f.scaled[p[2]]);
    const OrderPoint& n = plane.normal();
    const OrderPoint& o = plane.origin();
    nodes_[v] = std::make_unique<Node>(
        Node{n[0], n[1], n[2], -(n[0] * o[0] + n[1] * o[1] + n[2] * o[2]), root, nullptr, nullptr});
  }
  for (std::uint32_t v = 0; v < data.nodes(); ++v) {
    const auto child = [&](std::uint32_t c) { return c == kNoNode ? nullptr : nodes_[c].get(); };
    nodes_[v]->front_child = child(data.first_child(v));
    nodes_[v]->back_child = child(data.second_child(v));
  }
}

void BaselineA::display(const Node* tree) {
  if (tree == nullptr) return;
  if (tree->a * eye_[0] + tree->b * eye_[1] + tree->c * eye_[2] + tree->d * w_ >= 0) {
    display(tree->back_child);
    *end_++ = tree->root;
    display(tree->front_child);
  } else {
    display(tree->front_child);
    *end_++ = tree->root;
    display(tree->back_child);
  }
}

std::span<const BaselineA::Polygon* const> BaselineA::update(const Eye& eye) {
  eye_ = eye.perspective ? scale_(eye.at) : OrderPoint{-eye.at[0], -eye.at[1], -eye.at[2]};
  w_ = eye.perspective ? 1 : 0;
  end_ = order_.data();
  if (!nodes_.empty()) display(nodes_[0].get());
  return order_;
}

BaselineB::BaselineB(const TreeData& data) : data_(data), order_(data.nodes()), stack_(data.stats.depth + 2) {
  for (std::uint32_t v = 0; v < data.nodes(); ++v) {
    const float* const p = data.blocks.data() + v / kBlock * kBlock * 4 + v % kBlock;
    nodes_.push_back({p[0], p[kBlock], p[2 * kBlock], p[3 * kBlock], data.first_child(v), data.second_child(v)});
  }
}

std::span<const std::uint32_t> BaselineB::update(const Eye& eye) {
  EyeSides sides(data_);
  sides.set(eye);
  const SideQuery q = sides.query();
  std::uint32_t* out = order_.data();
  std::uint32_t* top = stack_.data();
  std::uint32_t v = nodes_.empty() ? kNoNode : 0;
  // The far side first, as deep as it goes; each node waits on the stack for its turn, with its near side.
  for (;;) {
    while (v != kNoNode) {
      const Node& n = nodes_[v];
      const bool front = n.a * q.x + n.b * q.y + n.c * q.z + n.d * q.w > 0;
      *top++ = v << 1U | (front ? 1U : 0U);
      v = front ? n.back : n.front;
    }
    if (top == stack_.data()) break;
    const std::uint32_t entry = *--top;
    *out++ = entry >> 1U;
    const Node& n = nodes_[entry >> 1U];
    v = (entry & 1U) != 0 ? n.front : n.back;
  }
  return order_;
}

}  // namespace kage::order
