// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "order/build_node.hpp"
#include "order/data.hpp"

namespace kage {

void OrderTree::Data::derive() {
  using order::kBlock;
  OrderPoint low{1, 1, 1};
  OrderPoint high{-1, -1, -1};
  for (const std::uint32_t c : faces.corners)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], faces.scaled[c][i]);
      high[i] = std::max(high[i], faces.scaled[c][i]);
    }
  for (std::size_t i = 0; i < 3; ++i) centre[i] = (low[i] + high[i]) / 2;
  radius = 0;
  for (std::size_t i = 0; i < 3; ++i) radius += (high[i] - low[i]) * (high[i] - low[i]);
  radius = std::sqrt(radius) / 2 * (1 + 0x1p-30) + 0x1p-30;

  blocks.assign((nodes() + kBlock - 1) / kBlock * kBlock * 4, 0.0F);
  for (std::uint32_t v = 0; v < nodes(); ++v) {
    const std::array<std::uint32_t, 3> p = plane_vertices(v);
    const order::FilterPlane f(faces.scaled[p[0]], faces.scaled[p[1]], faces.scaled[p[2]]);
    const OrderPoint& n = f.normal();
    const OrderPoint& w = f.weight();
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    // A normal whose rounding could turn it further than docs/order.md allows stays 0: the vector test is never sure.
    if (!(length > 0x1p-400) || !((w[0] + w[1] + w[2]) * 0x1p-50 < length * 0x1p-30)) continue;
    float* const at = blocks.data() + v / kBlock * kBlock * 4 + v % kBlock;
    double offset = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i * kBlock] = static_cast<float>(n[i] / length);
      offset -= n[i] / length * (f.origin()[i] - centre[i]);
    }
    at[3 * kBlock] = static_cast<float>(offset);
  }
  if (nodes() == 0) return;
  float* const last = blocks.data() + blocks.size() - 4 * kBlock;
  const std::size_t used = (nodes() - 1) % kBlock + 1;
  for (std::size_t i = 0; i < 4; ++i)
    std::fill(last + i * kBlock + used, last + (i + 1) * kBlock, last[i * kBlock + used - 1]);
}

OrderTree::OrderTree(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
OrderTree::~OrderTree() = default;
OrderTree::OrderTree(OrderTree&&) noexcept = default;
OrderTree& OrderTree::operator=(OrderTree&&) noexcept = default;

OrderTree OrderTree::build(const OrderMesh& mesh, const OrderBuildOptions& options) {
  auto data = std::make_unique<Data>();
  data->faces = order::make_faces(mesh, data->stats);
  order::lay_out(order::build_tree(data->faces, options, data->stats), *data);
  data->derive();
  return OrderTree(std::move(data));
}

std::uint32_t OrderTree::node_count() const { return data_->nodes(); }
std::uint32_t OrderTree::subtree_size(std::uint32_t node) const { return data_->size[node]; }
std::uint32_t OrderTree::front(std::uint32_t node) const { return data_->first_child(node); }
std::uint32_t OrderTree::back(std::uint32_t node) const { return data_->second_child(node); }
std::array<std::uint32_t, 3> OrderTree::plane(std::uint32_t node) const { return data_->plane_vertices(node); }
std::uint32_t OrderTree::first_fragment(std::uint32_t node) const { return data_->first_fragment[node]; }
std::uint32_t OrderTree::fragment_count() const { return static_cast<std::uint32_t>(data_->fragments.size() - 1); }

OrderFragment OrderTree::fragment(std::uint32_t fragment) const {
  const order::FragmentRecord& f = data_->fragments[fragment];
  const order::FragmentRecord& end = data_->fragments[fragment + std::size_t{1}];
  return {f.face, std::span(data_->cuts).subspan(f.first_cut, end.first_cut - f.first_cut),
          std::span(data_->edges).subspan(f.first_edge, end.first_edge - f.first_edge),
          std::span(data_->points).subspan(f.first_edge, end.first_edge - f.first_edge)};
}

std::uint32_t OrderTree::face_count() const { return static_cast<std::uint32_t>(data_->faces.faces.size()); }

OrderFace OrderTree::face(std::uint32_t face) const {
  const order::Face& f = data_->faces.faces[face];
  return {f.polygon, std::span(data_->faces.corners).subspan(f.first, f.count), f.plane};
}

const std::vector<OrderPoint>& OrderTree::vertices() const { return data_->faces.vertices; }
const OrderBuildStats& OrderTree::stats() const { return data_->stats; }

}  // namespace kage
