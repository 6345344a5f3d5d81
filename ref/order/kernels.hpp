// SPDX-License-Identifier: Apache-2.0
//
// Tests of sides, compiled for every instruction set that Highway knows for this machine and chosen once at run time.
// Floats differ in the last bits between instruction sets (fused or not); no answer depends on them, since what is not
// certain is said to be unsure.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kage::order {

inline constexpr std::size_t kBlock = 16;  ///< nodes that are tested together

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
  std::uint64_t unsure = 0;  ///< blocks with nodes that the test cannot tell
  double margins = 0;        ///< sum over the blocks tested
};

/// Arrays that a test reads and writes. Those by block have room for kBlock more.
struct SideBlocks {
  const float* planes = nullptr;  ///< by block: x of the normals of its nodes, y of them, z, offsets; kBlock each
  std::uint32_t nodes = 0;
  std::uint8_t* sides = nullptr;     ///< a bit per node, by block two bytes; what is certain is brought up to date
  std::uint8_t* unsure = nullptr;    ///< the same; written for blocks that are listed
  float* limits = nullptr;           ///< by block; above all numbers past the last
  std::uint32_t* listed = nullptr;   ///< blocks with unsure nodes, ascending
  std::uint32_t* flipped = nullptr;  ///< nodes whose side changed, ascending, as far as there is room
  std::size_t room = 0;              ///< and for kBlock more
};

/// Tests all nodes.
SideCounts test_all(const SideBlocks& to, const SideQuery& query);

/// Tests only blocks with limits[b] <= path, whose limit becomes path plus how far the eye may go before a plane of
/// theirs can change its side.
SideCounts test_blocks(const SideBlocks& to, const SideQuery& query, double path);

}  // namespace kage::order
