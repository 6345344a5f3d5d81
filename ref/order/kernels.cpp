// SPDX-License-Identifier: Apache-2.0
#include "order/kernels.hpp"

#include <cstring>

// The plain fallback: EMU128 knows every operation, SCALAR does not.
#define HWY_DISABLED_TARGETS HWY_SCALAR
#define HWY_BROKEN_EMU128 0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "order/kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kage::order::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kNodes = 64;  // of a block
using DF = hn::CappedTag<float, 16>;
using D8 = hn::CappedTag<std::uint32_t, 8>;

struct Query {
  explicit Query(const SideQuery& q)
      : x(hn::Set(DF(), q.x)),
        y(hn::Set(DF(), q.y)),
        z(hn::Set(DF(), q.z)),
        w(hn::Set(DF(), q.w)),
        threshold(hn::Set(DF(), q.threshold)) {}
  hn::Vec<DF> x, y, z, w, threshold;
};

HWY_INLINE void store_bits(hn::Mask<DF> m, std::size_t first, std::uint64_t* HWY_RESTRICT word) {
  const DF d;
  if (hn::Lanes(d) >= 8) {
    (void)hn::StoreMaskBits(d, m, reinterpret_cast<std::uint8_t*>(word) + first / 8);
  } else {
    std::uint8_t bits[8] = {};
    (void)hn::StoreMaskBits(d, m, bits);
    *word |= std::uint64_t{bits[0]} << first;
  }
}

// Writes which nodes are in front and which are unsure; returns the least distance, if it is asked for.
template <bool kMargin>
HWY_INLINE float test_block(const float* HWY_RESTRICT p, const Query& q, std::uint64_t* HWY_RESTRICT front,
                            std::uint64_t* HWY_RESTRICT unsure) {
  const DF d;
  auto least = hn::Set(d, 3e38F);
  *front = 0;
  *unsure = 0;
  for (std::size_t i = 0; i < kNodes; i += hn::Lanes(d)) {
    auto v = hn::Mul(hn::LoadU(d, p + 3 * kNodes + i), q.w);
    v = hn::MulAdd(hn::LoadU(d, p + i), q.x, v);
    v = hn::MulAdd(hn::LoadU(d, p + kNodes + i), q.y, v);
    v = hn::MulAdd(hn::LoadU(d, p + 2 * kNodes + i), q.z, v);
    const auto size = hn::Abs(v);
    store_bits(hn::Gt(v, hn::Zero(d)), i, front);
    // Not "<=": of a NaN nothing is certain.
    store_bits(hn::Not(hn::Gt(size, q.threshold)), i, unsure);
    if (kMargin) least = hn::Min(least, size);
  }
  return kMargin ? hn::GetLane(hn::MinOfLanes(d, least)) : 0;
}

// From sides as tested to flips. Apart from the tests, so that no word is read while its bytes are still on their way.
void count_flips(std::size_t blocks, const std::uint64_t* HWY_RESTRICT sides, std::uint64_t* HWY_RESTRICT flips,
                 const std::uint64_t* HWY_RESTRICT unsure, SideCounts& counts) {
  for (std::size_t b = 0; b < blocks; ++b) {
    flips[b] = (flips[b] ^ sides[b]) & ~unsure[b];
    counts.flips += static_cast<std::uint64_t>(hwy::PopCount(flips[b]));
    counts.unsure += unsure[b] != 0 ? 1U : 0U;
  }
}

SideCounts TestAll(const float* HWY_RESTRICT planes, std::size_t blocks, const SideQuery& query,
                   const std::uint64_t* HWY_RESTRICT sides, std::uint64_t* HWY_RESTRICT flips,
                   std::uint64_t* HWY_RESTRICT unsure) {
  const Query q(query);
  SideCounts counts;
  counts.blocks = blocks;
  for (std::size_t b = 0; b < blocks; ++b) (void)test_block<false>(planes + b * kNodes * 4, q, flips + b, unsure + b);
  count_flips(blocks, sides, flips, unsure, counts);
  return counts;
}

SideCounts TestBlocks(const float* HWY_RESTRICT planes, std::size_t blocks, const SideQuery& query,
                      const std::uint64_t* HWY_RESTRICT sides, std::uint64_t* HWY_RESTRICT flips,
                      std::uint64_t* HWY_RESTRICT unsure, double path, double* HWY_RESTRICT limits) {
  const Query q(query);
  SideCounts counts;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (limits[b] > path) {
      flips[b] = sides[b];
      unsure[b] = 0;
      continue;
    }
    const float least = test_block<true>(planes + b * kNodes * 4, q, flips + b, unsure + b);
    // Rounded down; not positive where a node is unsure. Infinities and NaNs come with an infinite threshold.
    const double margin = (static_cast<double>(least) - static_cast<double>(query.threshold)) * (1 - 0x1p-20) - 0x1p-41;
    const bool known = margin > 0;
    limits[b] = known ? path + margin : path;
    if (known) counts.margins += margin;
    ++counts.blocks;
  }
  count_flips(blocks, sides, flips, unsure, counts);
  return counts;
}

HWY_INLINE void place_one(const Part& c, std::uint32_t at, const std::uint64_t* HWY_RESTRICT sides,
                          const std::uint64_t* HWY_RESTRICT table, std::uint32_t* HWY_RESTRICT order) {
  const D8 d;
  const hn::Rebind<std::uint8_t, D8> d_bytes;
  const std::uint32_t nodes = c.b & 15U;
  const std::uint32_t shift = c.a & 63U;
  const std::uint64_t* const word = sides + (c.a >> 6U);
  const std::uint64_t bits = word[0] >> shift | (word[1] << 1U) << (63U - shift);
  const std::uint64_t* const entry = table + (c.b >> 4U) + (bits & ((1U << nodes) - 1));
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(entry);
  const auto first = hn::Set(d, c.a);
  for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
    if (i >= nodes) break;
    const auto v = hn::Add(hn::PromoteTo(d, hn::LoadU(d_bytes, bytes + i)), first);
    hn::BlendedStore(v, hn::FirstN(d, nodes - i), d, order + at + i);
  }
}

void PlaceClusters(const Part* HWY_RESTRICT parts, const std::uint32_t* HWY_RESTRICT listed, std::size_t count,
                   const std::uint32_t* HWY_RESTRICT place, const std::uint64_t* HWY_RESTRICT sides,
                   const std::uint64_t* HWY_RESTRICT table, std::uint32_t* HWY_RESTRICT order) {
  for (std::size_t i = 0; i < count; ++i) place_one(parts[listed[i]], place[listed[i]], sides, table, order);
}

void AddTo(std::uint32_t* HWY_RESTRICT values, std::size_t count, std::uint32_t addend) {
  const hn::ScalableTag<std::uint32_t> d;
  const auto a = hn::Set(d, addend);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreU(hn::Add(hn::LoadU(d, values + i), a), d, values + i);
  for (; i < count; ++i) values[i] += addend;
}

}  // namespace kage::order::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kage::order {

HWY_EXPORT(TestAll);
HWY_EXPORT(TestBlocks);
HWY_EXPORT(PlaceClusters);
HWY_EXPORT(AddTo);

SideCounts test_all(const float* planes, std::size_t blocks, const SideQuery& query, const std::uint64_t* sides,
                    std::uint64_t* flips, std::uint64_t* unsure) {
  return HWY_DYNAMIC_DISPATCH(TestAll)(planes, blocks, query, sides, flips, unsure);
}
SideCounts test_blocks(const float* planes, std::size_t blocks, const SideQuery& query, const std::uint64_t* sides,
                       std::uint64_t* flips, std::uint64_t* unsure, double path, double* limits) {
  return HWY_DYNAMIC_DISPATCH(TestBlocks)(planes, blocks, query, sides, flips, unsure, path, limits);
}
void place_clusters(const Part* parts, const std::uint32_t* listed, std::size_t count, const std::uint32_t* place,
                    const std::uint64_t* sides, const std::uint64_t* table, std::uint32_t* order) {
  HWY_DYNAMIC_DISPATCH(PlaceClusters)(parts, listed, count, place, sides, table, order);
}
void add_to(std::uint32_t* values, std::size_t count, std::uint32_t addend) {
  HWY_DYNAMIC_DISPATCH(AddTo)(values, count, addend);
}

}  // namespace kage::order
#endif
