// SPDX-License-Identifier: Apache-2.0
//
// The tree cut in two for the fast way. Subtrees of up to kClusterNodes nodes that lie in no other such subtree are
// clusters: their order is looked up, by shape and sides. The nodes above are the top; in preorder, a subtree's top
// nodes are consecutive, and so are its clusters.
#pragma once

#include <cstdint>
#include <vector>

#include "order/data.hpp"
#include "order/kernels.hpp"

namespace kage::order {

struct Top {
  std::uint32_t node = 0;
  std::uint32_t front = 0;  ///< part that begins with the child: a top node's number, tops + a cluster's, or none
  std::uint32_t back = 0;
  std::uint32_t front_size = 0;
  std::uint32_t back_size = 0;
};

class Clusters {
 public:
  explicit Clusters(const OrderTree::Data& data);

  [[nodiscard]] const std::vector<Top>& tops() const { return tops_; }
  [[nodiscard]] const std::vector<Cluster>& clusters() const { return clusters_; }
  [[nodiscard]] const std::vector<std::uint64_t>& table() const { return table_; }

  /// Parts have places: tops, clusters, and one for what does not exist.
  [[nodiscard]] std::size_t parts() const { return tops_.size() + clusters_.size() + 1; }

  [[nodiscard]] bool is_top(std::uint32_t node) const { return (top_[node / kBlock] >> (node % kBlock) & 1U) != 0; }
  /// Number of top nodes below `node`, and of clusters that begin below it.
  [[nodiscard]] std::uint32_t tops_below(std::uint32_t node) const { return below(top_, tops_before_, node); }
  [[nodiscard]] std::uint32_t clusters_below(std::uint32_t node) const { return below(start_, starts_before_, node); }

  [[nodiscard]] std::uint64_t bytes() const;

 private:
  static std::uint32_t below(const std::vector<std::uint64_t>& bits, const std::vector<std::uint32_t>& before,
                             std::uint32_t node) {
    const std::uint64_t low = bits[node / kBlock] & ((std::uint64_t{1} << (node % kBlock)) - 1);
    return before[node / kBlock] + static_cast<std::uint32_t>(__builtin_popcountll(low));
  }
  void mark(const OrderTree::Data& data);
  [[nodiscard]] std::uint32_t shape_entry(const OrderTree::Data& data, std::uint32_t first,
                                          std::vector<std::pair<std::uint32_t, std::uint32_t>>& known);

  std::vector<Top> tops_;
  std::vector<Cluster> clusters_;
  std::vector<std::uint64_t> table_;
  std::vector<std::uint64_t> top_;    // a bit per node, and one more
  std::vector<std::uint64_t> start_;  // of clusters
  std::vector<std::uint32_t> tops_before_;
  std::vector<std::uint32_t> starts_before_;
};

}  // namespace kage::order
