// SPDX-License-Identifier: Apache-2.0
//
// Baselines that the ways are measured against, for measuring only. Their side tests are plain doubles and floats, so a
// node whose plane nearly holds the eye may be taken for the wrong side.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "order/data.hpp"

namespace kage::order {

/// A: [Tanaka 2005] figures 2.3 to 2.5. Nodes with their polygons, each from the heap as the build makes them, walked
/// by a function that calls itself.
class BaselineA {
 public:
  struct Polygon {
    std::uint32_t node = 0;
    std::uint32_t face = 0;
    std::vector<OrderPoint> vertices;
    Polygon* next = nullptr;  // in the same plane
  };
  struct Node {
    double a, b, c, d;  // the plane
    Polygon* root;      // the polygons in it
    Node* front_child;
    Node* back_child;
  };
  static constexpr std::string_view kNodeText =
      "struct Node { double a, b, c, d; Polygon* root; Node* front_child; Node* back_child; }";

  explicit BaselineA(const TreeData& data);

  /// Polygons back to front; those of one plane by their first.
  std::span<const Polygon* const> update(const Eye& eye);

  [[nodiscard]] std::uint64_t bytes() const { return nodes_.size() * sizeof(Node); }

 private:
  void display(const Node* tree);
  [[nodiscard]] Polygon* polygons_of(const TreeData& data, std::uint32_t node);

  Scale scale_;
  std::vector<std::unique_ptr<Node>> nodes_;  // by number
  std::vector<std::unique_ptr<Polygon>> polygons_;
  std::vector<const Polygon*> order_;
  const Polygon** end_ = nullptr;
  OrderPoint eye_{};
  double w_ = 1;
};

/// B: recursion over nodes in preorder, 24 bytes each, floats, with a stack of its own.
class BaselineB {
 public:
  struct Node {
    float a, b, c, d;
    std::uint32_t front;
    std::uint32_t back;
  };
  explicit BaselineB(const TreeData& data);
  std::span<const std::uint32_t> update(const Eye& eye);
  [[nodiscard]] std::uint64_t bytes() const { return nodes_.size() * sizeof(Node); }

 private:
  const TreeData& data_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> stack_;
};

}  // namespace kage::order
