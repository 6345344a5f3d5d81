// SPDX-License-Identifier: Apache-2.0
// Data of a tree.
#pragma once

#include <cstdint>
#include <new>
#include <string>
#include <vector>

#include "kage/order.hpp"
#include "order/exact.hpp"
#include "order/filter.hpp"
#include "order/kernels.hpp"

namespace kage::order {

/// A convex plane polygon over vertices.
struct Face {
  std::uint32_t polygon = 0;
  std::uint32_t first = 0;  ///< of its corners
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> plane{};  ///< three corners not on a line
};

/// The mesh as it is built from: corners checked, polygons plane and convex and not flat.
struct Faces {
  std::vector<OrderPoint> vertices;
  std::vector<OrderPoint> scaled;  ///< by `scale`
  Scale scale;
  Grid grid;
  std::vector<std::uint32_t> corners;
  std::vector<Face> faces;

  /// Computes scale, grid and scaled from `vertices`.
  void derive() {
    scale = scale_of(vertices);
    grid = grid_of(vertices);
    scaled.clear();
    scaled.reserve(vertices.size());
    for (const OrderPoint& p : vertices) scaled.push_back(scale(p));
  }
  [[nodiscard]] std::uint32_t corner(const Face& f, std::uint32_t i) const {
    return corners[f.first + (i < f.count ? i : i - f.count)];
  }
  [[nodiscard]] PlanePoints plane(const Face& f) const {
    return {vertices[f.plane[0]], vertices[f.plane[1]], vertices[f.plane[2]]};
  }
  [[nodiscard]] FilterPlane filter(const Face& f) const {
    return {scaled[f.plane[0]], scaled[f.plane[1]], scaled[f.plane[2]]};
  }
};

/// Throws Error naming the polygon. Counts polygons, flat, bent and faces.
Faces make_faces(const OrderMesh& mesh, OrderBuildStats& stats);

struct FragmentRecord {
  std::uint32_t face = 0;
  std::uint32_t first_cut = 0;
  std::uint32_t first_edge = 0;
};

/// Vectors that begin where a cache line does.
template <class T>
struct LineAllocator {
  using value_type = T;
  LineAllocator() = default;
  template <class U>
  explicit LineAllocator(const LineAllocator<U>& /*other*/) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t /*n*/) { ::operator delete(p, kLine); }
  bool operator==(const LineAllocator& /*other*/) const { return true; }

 private:
  static constexpr std::align_val_t kLine{64};
};

}  // namespace kage::order

namespace kage {

struct OrderTree::Data {
  order::Faces faces;
  // By node, in preorder.
  std::vector<std::uint32_t> size;            // of the subtree
  std::vector<std::uint32_t> plane;           // face * 2 + whether the plane is turned round
  std::vector<std::uint32_t> first_fragment;  // and the number of fragments
  // By fragment, and one past the last.
  std::vector<order::FragmentRecord> fragments;
  std::vector<OrderFragment::Cut> cuts;
  std::vector<std::uint32_t> edges;
  std::vector<OrderPoint> points;
  OrderBuildStats stats;

  // Made of the above: unit normals and offsets for the vector tests, in blocks of kBlock nodes, a of all, b of all, c,
  // d. Past the last node, its plane again.
  std::vector<float, order::LineAllocator<float>> blocks;
  OrderPoint centre{};  // that offsets are from, scaled
  double radius = 0;    // of the mesh about it, scaled; no offset is larger

  [[nodiscard]] std::uint32_t nodes() const { return static_cast<std::uint32_t>(size.size()); }
  [[nodiscard]] std::uint32_t first_child(std::uint32_t v) const { return size[v] > 1 ? v + 1 : kNoNode; }
  [[nodiscard]] std::uint32_t second_child(std::uint32_t v) const {
    return size[v] > 1 && 1 + size[v + 1] < size[v] ? v + 1 + size[v + 1] : kNoNode;
  }
  [[nodiscard]] std::array<std::uint32_t, 3> plane_vertices(std::uint32_t v) const {
    std::array<std::uint32_t, 3> p = faces.faces[plane[v] >> 1U].plane;
    if ((plane[v] & 1U) != 0) std::swap(p[1], p[2]);
    return p;
  }

  /// Makes `blocks`, `centre`, `radius`.
  void derive();
};

/// The library's way into a tree.
struct OrderTreeInside {
  using Data = OrderTree::Data;
  static const Data& of(const OrderTree& tree) { return *tree.data_; }
};

namespace order {

using TreeData = OrderTreeInside::Data;
inline const TreeData& data_of(const OrderTree& tree) { return OrderTreeInside::of(tree); }

}  // namespace order
}  // namespace kage
