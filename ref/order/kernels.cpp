// SPDX-License-Identifier: Apache-2.0
#include "order/kernels.hpp"

#include <array>
#include <cstring>

#ifndef KAGE_ORDER_SET_BITS
#define KAGE_ORDER_SET_BITS
namespace kage::order {

/// For each byte the numbers of the bits that are set in it, a byte each. Highway's Compress() does the same; some
/// releases copy its table to the stack at every use.
constexpr std::array<std::uint64_t, 256> set_bits() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < table.size(); ++byte) {
    unsigned n = 0;
    for (std::uint64_t bit = 0; bit < 8; ++bit)
      if ((byte >> bit & 1U) != 0) table[byte] |= bit << (8 * n++);
  }
  return table;
}
inline constexpr std::array<std::uint64_t, 256> kSetBits = set_bits();

}  // namespace kage::order
#endif

#include "simd/targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "order/kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kage::order::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, kBlock>;

struct Query {
  explicit Query(const SideQuery& q)
      : x(hn::Set(DF(), q.x)),
        y(hn::Set(DF(), q.y)),
        z(hn::Set(DF(), q.z)),
        w(hn::Set(DF(), q.w)),
        threshold(hn::Set(DF(), q.threshold)) {}
  hn::Vec<DF> x, y, z, w, threshold;
};

HWY_INLINE std::uint32_t bits_of(hn::Mask<DF> m) {
  std::uint8_t bytes[8] = {};
  (void)hn::StoreMaskBits(DF(), m, bytes);
  std::uint16_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

// Writes first + i for every bit i of the lowest kBlock that is set, and up to 8 words more. Returns past the last.
HWY_INLINE std::uint32_t* list_bits(std::uint32_t bits, std::uint32_t first, std::uint32_t* HWY_RESTRICT out) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d_bytes;
  for (std::uint32_t i = 0; i < kBlock; i += 8) {
    const std::uint32_t some = bits >> i & 0xffU;
    const auto* const set = reinterpret_cast<const std::uint8_t*>(&kSetBits[some]);
    const auto from = hn::Set(d, first + i);
    for (std::size_t k = 0; k < 8; k += hn::Lanes(d))
      hn::StoreU(hn::Add(hn::PromoteTo(d, hn::LoadU(d_bytes, set + k)), from), d, out + k);
    out += hwy::PopCount(some);
  }
  return out;
}

struct Signs {
  std::uint32_t front = 0;
  std::uint32_t unsure = 0;
  float least = 0;  // distance, if it is asked for
};

template <bool kMargin>
HWY_INLINE Signs test_block(const float* HWY_RESTRICT p, const Query& q) {
  const DF d;
  Signs signs;
  auto least = hn::Set(d, 3e38F);
  for (std::size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
    auto v = hn::Mul(hn::LoadU(d, p + 3 * kBlock + i), q.w);
    v = hn::MulAdd(hn::LoadU(d, p + i), q.x, v);
    v = hn::MulAdd(hn::LoadU(d, p + kBlock + i), q.y, v);
    v = hn::MulAdd(hn::LoadU(d, p + 2 * kBlock + i), q.z, v);
    const auto size = hn::Abs(v);
    signs.front |= bits_of(hn::Gt(v, hn::Zero(d))) << i;
    // Not "<=": of a NaN nothing is certain.
    signs.unsure |= bits_of(hn::Not(hn::Gt(size, q.threshold))) << i;
    if (kMargin) least = hn::Min(least, size);
  }
  if (kMargin) signs.least = hn::GetLane(hn::MinOfLanes(d, least));
  return signs;
}

// Tests blocks, the n-th of `count` being block_of(n).
template <bool kMargin, class BlockOf>
HWY_INLINE SideCounts test(const SideBlocks& to, const SideQuery& query, std::size_t count, double path,
                           BlockOf block_of) {
  const Query q(query);
  const float* const HWY_RESTRICT planes = to.planes;
  std::uint8_t* const HWY_RESTRICT all_sides = to.sides;
  float* const HWY_RESTRICT limits = to.limits;
  std::uint32_t* const HWY_RESTRICT flipped = to.flipped;
  const std::size_t room = to.room;
  const double threshold = query.threshold;
  std::uint64_t flip_count = 0;
  std::uint64_t unsure_count = 0;
  double margins = 0;
  const std::size_t last = (to.nodes - 1) / kBlock;
  const std::uint32_t last_valid = 0xffffU >> (kBlock - 1 - (to.nodes - 1) % kBlock);
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t b = block_of(n);
    const Signs signs = test_block<kMargin>(planes + b * (4 * kBlock), q);
    std::uint16_t sides = 0;
    std::memcpy(&sides, all_sides + std::size_t{2} * b, sizeof sides);
    const std::uint32_t valid = b == last ? last_valid : 0xffffU;
    const std::uint32_t unsure = signs.unsure & valid;
    const std::uint32_t flips = (signs.front ^ sides) & ~signs.unsure & valid;
    sides = static_cast<std::uint16_t>(sides ^ flips);
    std::memcpy(all_sides + std::size_t{2} * b, &sides, sizeof sides);
    if (flip_count <= room) (void)list_bits(flips, b * static_cast<std::uint32_t>(kBlock), flipped + flip_count);
    flip_count += static_cast<std::uint64_t>(hwy::PopCount(flips));
    if (HWY_UNLIKELY(unsure != 0)) {
      const auto bits = static_cast<std::uint16_t>(unsure);
      std::memcpy(to.unsure + std::size_t{2} * b, &bits, sizeof bits);
      to.listed[unsure_count++] = b;
    }
    if (kMargin) {
      // Rounded down; not positive where a node is unsure. Infinities and NaNs come with an infinite threshold.
      const double margin = (static_cast<double>(signs.least) - threshold) * (1 - 0x1p-20) - 0x1p-41;
      const bool known = margin > 0;
      limits[b] = known ? static_cast<float>((path + margin) * (1 - 0x1p-22)) : -1;
      margins += known ? margin : 0;
    }
  }
  return {count, flip_count, unsure_count, margins};
}

SideCounts TestAll(const SideBlocks& to, const SideQuery& query) {
  return test<false>(to, query, (to.nodes + kBlock - 1) / kBlock, 0,
                     [](std::size_t n) { return static_cast<std::uint32_t>(n); });
}

SideCounts TestBlocks(const SideBlocks& to, const SideQuery& query, double path) {
  // First which blocks, without a branch; then those. Their numbers lie where test() lists them again, further on.
  const DF d;
  const std::size_t blocks = (to.nodes + kBlock - 1) / kBlock;
  const auto reached = hn::Set(d, static_cast<float>(path * (1 + 0x1p-22)));
  std::uint32_t* const listed = to.listed;
  std::uint32_t* end = listed;
  for (std::size_t b = 0; b < blocks; b += kBlock) {
    std::uint32_t due = 0;
    for (std::size_t i = 0; i < kBlock; i += hn::Lanes(d))
      due |= bits_of(hn::Le(hn::LoadU(d, to.limits + b + i), reached)) << i;
    end = list_bits(due, static_cast<std::uint32_t>(b), end);
  }
  const auto count = static_cast<std::size_t>(end - listed);
  return test<true>(to, query, count, path, [listed](std::size_t n) { return listed[n]; });
}

}  // namespace kage::order::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kage::order {

HWY_EXPORT(TestAll);
HWY_EXPORT(TestBlocks);

SideCounts test_all(const SideBlocks& to, const SideQuery& query) { return KAGE_DISPATCH(TestAll)(to, query); }
SideCounts test_blocks(const SideBlocks& to, const SideQuery& query, double path) {
  return KAGE_DISPATCH(TestBlocks)(to, query, path);
}

}  // namespace kage::order
#endif
