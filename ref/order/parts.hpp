// SPDX-License-Identifier: Apache-2.0
//
// The tree as the fast way has it. Subtrees of up to kClusterNodes nodes that lie in no other such subtree are
// clusters: their order is looked up, by shape and sides. The nodes above are tops. Tops and clusters are parts,
// numbered in preorder, so that a subtree's parts are consecutive. The larger child comes first, and if a child is a
// top then so is the larger: a run is the tops from one to the next first child and so on. Its nodes are consecutive,
// its parts too.
#pragma once

#include <cstdint>
#include <vector>

#include "order/data.hpp"
#include "order/placing.hpp"

namespace kage::order {

class Parts {
 public:
  explicit Parts(const TreeData& data);

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  [[nodiscard]] const std::vector<std::uint32_t>& clusters() const { return clusters_; }  ///< parts that are clusters
  [[nodiscard]] const std::vector<std::uint64_t>& table() const { return table_; }        ///< for Placing
  [[nodiscard]] const std::vector<Starts>& starts() const { return starts_; }
  [[nodiscard]] std::uint32_t largest_back() const { return largest_back_; }  ///< nodes of a top's second child

  [[nodiscard]] std::uint64_t bytes() const;

 private:
  void mark(const TreeData& data);
  /// Number of parts that begin below `node`.
  [[nodiscard]] std::uint32_t below(std::uint32_t node) const {
    const std::uint64_t low = starts_[node / 64].bits & ((std::uint64_t{1} << (node % 64)) - 1);
    return static_cast<std::uint32_t>(starts_[node / 64].before) +
           static_cast<std::uint32_t>(__builtin_popcountll(low));
  }
  std::uint32_t shape_entry(const TreeData& data, std::uint32_t first,
                            std::vector<std::pair<std::uint32_t, std::uint32_t>>& known);

  std::vector<Part> parts_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> clusters_;
  std::vector<std::uint64_t> table_;
  std::vector<Starts> starts_;
  std::uint32_t largest_back_ = 0;
};

}  // namespace kage::order
