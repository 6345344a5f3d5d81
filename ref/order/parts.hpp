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
#include "order/kernels.hpp"

namespace kage::order {

struct Run {
  std::uint32_t node = 0;  ///< the first
  std::uint32_t part = 0;  ///< the first
  std::uint32_t tops = 0;
};

class Parts {
 public:
  explicit Parts(const OrderTree::Data& data);

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  [[nodiscard]] const std::vector<std::uint32_t>& clusters() const { return clusters_; }  ///< parts that are clusters
  [[nodiscard]] const std::vector<std::uint64_t>& table() const { return table_; }        ///< for place_clusters()

  /// Number of parts that begin below `node`: its own, if it begins one.
  [[nodiscard]] std::uint32_t below(std::uint32_t node) const {
    const std::uint64_t low = starts_[node / kBlock] & ((std::uint64_t{1} << (node % kBlock)) - 1);
    return before_[node / kBlock] + static_cast<std::uint32_t>(__builtin_popcountll(low));
  }
  /// The part that has it.
  [[nodiscard]] std::uint32_t of(std::uint32_t node) const { return below(node + 1) - 1; }

  [[nodiscard]] std::uint64_t bytes() const;

 private:
  void mark(const OrderTree::Data& data);
  std::uint32_t shape_entry(const OrderTree::Data& data, std::uint32_t first,
                            std::vector<std::pair<std::uint32_t, std::uint32_t>>& known);

  std::vector<Part> parts_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> clusters_;
  std::vector<std::uint64_t> table_;
  std::vector<std::uint64_t> starts_;  // a bit per node that begins a part, and one past the last
  std::vector<std::uint32_t> before_;  // bits set in the words before
};

}  // namespace kage::order
