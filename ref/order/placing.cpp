// SPDX-License-Identifier: Apache-2.0
#include "order/placing.hpp"

#include <algorithm>
#include <cstring>

#include "simd/targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "order/placing.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kage::order::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D8 = hn::CappedTag<std::uint32_t, 8>;
using D16 = hn::CappedTag<std::uint32_t, kPlacingSlack>;

/// Parts that begin below `node`.
HWY_INLINE std::uint32_t parts_below(const Starts* HWY_RESTRICT starts, std::uint32_t node) {
  const Starts& s = starts[node / 64];
  const std::uint64_t low = s.bits & ((std::uint64_t{1} << (node % 64)) - 1);
  return static_cast<std::uint32_t>(s.before + static_cast<std::uint64_t>(hwy::PopCount(low)));
}

/// 0, or all ones if the eye is before the node's plane.
HWY_INLINE std::uint32_t front_mask(const std::uint8_t* HWY_RESTRICT sides, std::uint32_t node) {
  return 0U - (static_cast<std::uint32_t>(sides[node / 8]) >> (node % 8) & 1U);
}

HWY_INLINE void place_cluster(const Placing& to, std::uint32_t part) {
  const D8 d;
  const hn::Rebind<std::uint8_t, D8> d_bytes;
  const Part c = to.parts[part];
  const std::uint32_t nodes = c.b & 15U;
  std::uint16_t word = 0;  // up to 7 bits from any of 8
  std::memcpy(&word, to.sides + c.a / 8, sizeof word);
  const std::uint32_t bits = (static_cast<std::uint32_t>(word) >> (c.a % 8)) & ((1U << nodes) - 1);
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(to.table + (c.b >> 4U) + bits);
  const auto first = hn::Set(d, c.a);
  std::uint32_t* const order = to.order + to.place[part];
  for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
    if (i >= nodes) break;
    const auto v = hn::Add(hn::PromoteTo(d, hn::LoadU(d_bytes, bytes + i)), first);
    hn::BlendedStore(v, hn::FirstN(d, nodes - i), d, order + i);
  }
}

void PlaceClusters(const Placing& to, const std::uint32_t* HWY_RESTRICT listed, std::size_t count) {
  const Placing kept = to;  // a copy that no store can change
  for (std::size_t i = 0; i < count; ++i) place_cluster(kept, listed[i]);
}

/// Adds `first` to values[begin .. middle - 1] and `second` from there to end - 1. In whole vectors from an address
/// that is a multiple of theirs, so that what a store has just written is read as it was written.
HWY_INLINE void add_to(std::uint32_t* HWY_RESTRICT values, std::size_t begin, std::size_t middle, std::size_t end,
                       std::uint32_t first, std::uint32_t second) {
  const D16 d;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, first);
  const auto other = hn::Set(d, second);
  const auto some = [&](std::size_t i) {
    const auto up_to = [&](std::size_t n) { return hn::FirstN(d, n < i ? 0 : std::min(n - i, lanes)); };
    const auto addends = hn::IfThenElse(up_to(middle), one, other);
    const auto inside = hn::IfThenZeroElse(up_to(begin), hn::IfThenElseZero(up_to(end), addends));
    hn::Store(hn::Add(hn::Load(d, values + i), inside), d, values + i);
  };
  std::size_t i = begin - begin % lanes;
  some(i);
  for (i += lanes; i + lanes <= middle; i += lanes) hn::Store(hn::Add(hn::Load(d, values + i), one), d, values + i);
  for (; i < end; i += lanes) some(i);
}

/// memmove of words; may read past the end. It begins at the end that is not overwritten first, without a branch on
/// which end that is. The rest that fills no whole vector is read before and written after all else.
HWY_INLINE void move_words(std::uint32_t* to, const std::uint32_t* from, std::size_t count) {
  const D16 d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto rest = static_cast<std::ptrdiff_t>(count) % lanes;
  const auto whole = static_cast<std::ptrdiff_t>(count) - rest;
  const auto last = hn::LoadU(d, from + whole);
  const bool up = to > from;
  const std::ptrdiff_t step = up ? -lanes : lanes;
  std::ptrdiff_t i = up ? whole - lanes : 0;
  for (std::ptrdiff_t left = whole; left != 0; left -= lanes, i += step) hn::StoreU(hn::LoadU(d, from + i), d, to + i);
  hn::BlendedStore(last, hn::FirstN(d, static_cast<std::size_t>(rest)), d, to + whole);
}

// [front][node][back] becomes [back][node][front], or the reverse. Both keep their own order, and begin elsewhere. The
// back is never the larger.
HWY_INLINE void swap_subtrees(const Placing& to, std::uint32_t node) {
  const D16 d;
  const std::uint32_t part = parts_below(to.starts, node + 1) - 1;
  const std::uint32_t nodes = to.size[node];
  const std::uint32_t end = parts_below(to.starts, node + nodes);
  const Part p = to.parts[part];
  const std::uint32_t back_part = std::min(p.a, end);
  const std::uint32_t back = p.b - 1;
  const std::uint32_t front = nodes - 1 - back;
  // The side is the new one: the eye's side is drawn last, and was first up to now.
  const std::uint32_t front_first = front_mask(to.sides, node);
  std::uint32_t* const order = to.order + to.place[part];
  std::uint32_t* const low = order;               // the back's place, when it comes first,
  std::uint32_t* const high = order + front + 1;  // and when it comes last
  const std::uint32_t* const back_from = front_first != 0 ? high : low;
  std::uint32_t* const back_to = front_first != 0 ? low : high;
  const std::uint32_t* const front_from = front_first != 0 ? order : order + back + 1;
  std::uint32_t* const front_to = front_first != 0 ? order + back + 1 : order;
  if (back <= hn::Lanes(d)) {
    const auto kept = hn::LoadU(d, back_from);
    move_words(front_to, front_from, front);
    hn::BlendedStore(kept, hn::FirstN(d, back), d, back_to);
  } else {
    move_words(to.spare, back_from, back);
    move_words(front_to, front_from, front);
    move_words(back_to, to.spare, back);
  }
  order[front_first != 0 ? back : front] = node;
  // Where the front was first it begins so much later, the back so much sooner; or the reverse.
  add_to(to.place, part + 1, back_part, end, ((back + 1) ^ ~front_first) - ~front_first,
         ((front + 1) ^ front_first) - front_first);
}

void Exchange(const Placing& to, std::uint32_t* HWY_RESTRICT flipped, std::size_t count) {
  // Tops are moved to the beginning of the list, clusters looked up where they are now and then moved with the rest.
  // No branch depends on which is which.
  constexpr std::size_t kSome = 64;
  std::uint32_t clusters[kSome + 1];
  std::size_t tops = 0;
  std::uint32_t last = 0xffffffff;
  for (std::size_t from = 0; from < count; from += kSome) {
    std::size_t found = 0;
    const std::size_t some_end = std::min(count, from + kSome);
    for (std::size_t i = from; i < some_end; ++i) {
      const std::uint32_t node = flipped[i];
      const std::uint32_t part = parts_below(to.starts, node + 1) - 1;
      const bool top = to.size[node] > kClusterNodes;
      flipped[tops] = node;
      tops += top ? 1 : 0;
      clusters[found] = part;
      found += !top && part != last ? 1 : 0;
      last = part;
    }
    PlaceClusters(to, clusters, found);
  }
  for (std::size_t i = 0; i < tops; ++i) swap_subtrees(to, flipped[i]);
}

void PlaceAll(const Placing& to, const Run* HWY_RESTRICT runs, std::size_t run_count,
              const std::uint32_t* HWY_RESTRICT clusters, std::size_t cluster_count) {
  constexpr std::size_t kWindow = 57;  // sides that a word surely holds from any bit of its first byte
  std::uint32_t* const HWY_RESTRICT place = to.place;
  std::uint32_t* const HWY_RESTRICT order = to.order;
  place[0] = 0;
  for (std::size_t r = 0; r < run_count; ++r) {
    const Run run = runs[r];
    const Part* const HWY_RESTRICT parts = to.parts + run.part;
    std::size_t at = place[run.part];
    std::size_t front = std::size_t{to.size[run.node]} + 1;  // nodes of the first child, and one
    std::size_t i = 0;
    while (i < run.tops) {
      const std::size_t node = run.node + i;
      std::uint64_t window = 0;
      std::memcpy(&window, to.sides + node / 8, sizeof window);
      window >>= node % 8;
      for (const std::size_t end = std::min<std::size_t>(run.tops, i + kWindow); i < end; ++i) {
        // Masks instead of branches: sides are as good as chance. One of the two is 0, the other a child and the node.
        const std::size_t back = parts[i].b;  // and one here, too
        const std::size_t front_last = std::size_t{0} - (window & 1U);
        window >>= 1U;
        front -= back;
        const std::size_t before_front = back & front_last;
        const std::size_t before_back = front & ~front_last;
        place[run.part + i] = static_cast<std::uint32_t>(at);
        place[parts[i].a] = static_cast<std::uint32_t>(at + before_back);
        order[at + before_front + before_back - 1] = static_cast<std::uint32_t>(run.node + i);
        at += before_front;
      }
    }
    place[run.part + run.tops] = static_cast<std::uint32_t>(at);  // the cluster that ends the run
  }
  PlaceClusters(to, clusters, cluster_count);
}

}  // namespace kage::order::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kage::order {

HWY_EXPORT(PlaceAll);
HWY_EXPORT(PlaceClusters);
HWY_EXPORT(Exchange);

void place_all(const Placing& to, const Run* runs, std::size_t run_count, const std::uint32_t* clusters,
               std::size_t cluster_count) {
  KAGE_DISPATCH(PlaceAll)(to, runs, run_count, clusters, cluster_count);
}
void place_clusters(const Placing& to, const std::uint32_t* listed, std::size_t count) {
  KAGE_DISPATCH(PlaceClusters)(to, listed, count);
}
void exchange(const Placing& to, std::uint32_t* flipped, std::size_t count) {
  KAGE_DISPATCH(Exchange)(to, flipped, count);
}

}  // namespace kage::order
#endif
