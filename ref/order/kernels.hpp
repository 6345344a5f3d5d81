// SPDX-License-Identifier: Apache-2.0
//
// Inner loops over nodes, compiled for every instruction set that Highway knows for this machine and chosen once at run
// time. Floats differ in the last bits between instruction sets (fused or not); no answer depends on them, since what is
// not certain is said to be unsure.
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

/// A subtree of up to kClusterNodes nodes.
struct Cluster {
  std::uint32_t first = 0;  ///< node; the others follow
  std::uint32_t shape = 0;  ///< nodes + 16 * where the shape's orders begin in the table
};
inline constexpr std::uint32_t kClusterNodes = 6;

/// Writes the nodes of `count` clusters in order. `place[i]`: where in `order` cluster i begins. An entry of `table` is
/// the order of a shape for the sides of its nodes (bit k: the k-th), a byte per node. `sides` may be read a word past
/// its end, `order` kClusterNodes elements.
void place_clusters(const Cluster* clusters, std::size_t count, const std::uint32_t* place, const std::uint64_t* sides,
                    const std::uint64_t* table, std::uint32_t* order);

/// The same for those listed.
void place_some(const Cluster* clusters, const std::uint32_t* listed, std::size_t count, const std::uint32_t* place,
                const std::uint64_t* sides, const std::uint64_t* table, std::uint32_t* order);

/// Adds to each.
void add_to(std::uint32_t* values, std::size_t count, std::uint32_t addend);

}  // namespace kage::order
