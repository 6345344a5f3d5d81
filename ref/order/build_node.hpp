// SPDX-License-Identifier: Apache-2.0
// A tree while it is built.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "order/piece.hpp"

namespace kage::order {

struct BuildNode {
  std::uint32_t face = 0;  ///< whose plane it is
  std::vector<BuildFragment> fragments;
  std::array<BuildNode*, 2> child{};  ///< before the face's plane, behind it
  // Made by the layout.
  std::uint32_t size = 0;
  std::uint32_t shape = 0;
  std::uint32_t number = 0;
  bool reversed = false;
};

struct BuildTree {
  BuildNode* root = nullptr;
  std::vector<std::deque<BuildNode>> nodes;  ///< owns them
};

/// Cuts faces into a tree; counts splits and tests.
BuildTree build_tree(const Faces& faces, const OrderBuildOptions& options, OrderBuildStats& stats);

/// Numbers the nodes and takes all out of them into flat arrays; `data.faces` is there already.
void lay_out(const BuildTree& tree, TreeData& data);

}  // namespace kage::order
