// SPDX-License-Identifier: Apache-2.0
//
// Kernels that move nodes in the array, compiled as kernels.hpp's tests are.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kage::order {

/// A piece of the tree (parts.hpp):
/// - a top node: `a` is the part that its second child begins, or one past all parts; `b` is that child's nodes plus 1.
/// - a cluster: `a` is its first node; `b` is its nodes + 16 * the place in the table where its shape's orders begin.
struct Part {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};
inline constexpr std::uint32_t kClusterNodes = 7;  ///< below 8: an order is a word, and shapes take four bits a node

/// Tops whose nodes, and parts, follow one another; a cluster's part is next.
struct Run {
  std::uint32_t node = 0;  ///< the first
  std::uint32_t part = 0;  ///< the first
  std::uint32_t tops = 0;
};

/// 64 nodes: which of them begin a part, and the parts that begin before.
struct Starts {
  std::uint64_t bits = 0;
  std::uint64_t before = 0;
};

inline constexpr std::size_t kPlacingSlack = 16;  ///< words past the end of `place` and `order` that may be read

/// The tree, the sides, and the order that is made of them.
struct Placing {
  const std::uint32_t* size = nullptr;  ///< by node, of the subtree
  const Part* parts = nullptr;
  const Starts* starts = nullptr;  ///< for every 64 nodes, and the end
  /// Orders of shapes for the sides of their nodes (bit k: the k-th), a byte per node.
  const std::uint64_t* table = nullptr;
  const std::uint8_t* sides = nullptr;  ///< a bit per node, and 8 bytes more
  /// By part, and one for what does not exist: where in `order` its subtree begins. On a cache line of its own.
  std::uint32_t* place = nullptr;
  std::uint32_t* order = nullptr;
  std::uint32_t* spare = nullptr;  ///< room for the smaller of two subtrees, and kPlacingSlack
};

/// Places all parts: runs and clusters are those of the tree.
void place_all(const Placing& to, const Run* runs, std::size_t run_count, const std::uint32_t* clusters,
               std::size_t cluster_count);

/// Brings the order up to date where only `flipped` nodes, ascending, have changed sides. Overwrites the list.
void exchange(const Placing& to, std::uint32_t* flipped, std::size_t count);

/// The listed clusters alone.
void place_clusters(const Placing& to, const std::uint32_t* listed, std::size_t count);

}  // namespace kage::order
