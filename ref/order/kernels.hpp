// SPDX-License-Identifier: Apache-2.0
//
// Inner loops over nodes, compiled for every instruction set that Highway knows for this machine and chosen once at run
// time. Floats differ in the last bits between instruction sets (fused or not); no answer depends on them, since what
// is not certain is said to be unsure.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kage::order {

struct SideQuery {
  float x = 0;
  float y = 0;
  float z = 0;
  float w = 1;          ///< factor of the planes' offsets
  float threshold = 0;  ///< a sign is certain above it
};

struct SideCounts {
  std::uint64_t blocks = 0;  ///< tested
  std::uint64_t flips = 0;
  std::uint64_t unsure = 0;
  double margins = 0;  ///< sum over the blocks tested
};

/// Tests `blocks` blocks of 64 planes. flips[b]: nodes that are certainly on the other side than `sides` says;
/// unsure[b]: nodes that the test cannot tell.
SideCounts test_all(const float* planes, std::size_t blocks, const SideQuery& query, const std::uint64_t* sides,
                    std::uint64_t* flips, std::uint64_t* unsure);

/// The same, but only of blocks with limits[b] <= path, whose limit becomes path plus how far the eye may go before a
/// plane of theirs can change its side; in others nothing flips.
SideCounts test_blocks(const float* planes, std::size_t blocks, const SideQuery& query, const std::uint64_t* sides,
                       std::uint64_t* flips, std::uint64_t* unsure, double path, double* limits);

/// A piece of the tree (parts.hpp). Of a top node: the part that its second child begins, and that child's nodes. Of a
/// cluster: its first node, and nodes + 16 * where the orders of its shape begin in the table.
struct Part {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};
inline constexpr std::uint32_t kClusterNodes = 7;  ///< below 8: an order is a word, and shapes take four bits a node

/// Writes the nodes of the listed clusters in order. `place[p]`: where in `order` part p begins. An entry of `table` is
/// the order of a shape for the sides of its nodes (bit k: the k-th), a byte per node. `sides` may be read a word past
/// its end.
void place_clusters(const Part* parts, const std::uint32_t* listed, std::size_t count, const std::uint32_t* place,
                    const std::uint64_t* sides, const std::uint64_t* table, std::uint32_t* order);

/// Adds to each.
void add_to(std::uint32_t* values, std::size_t count, std::uint32_t addend);

}  // namespace kage::order
