// SPDX-License-Identifier: Apache-2.0
#include "order/placing.hpp"

#include <algorithm>
#include <cstring>

// The plain fallback: EMU128 knows every operation, SCALAR does not.
#define HWY_DISABLED_TARGETS HWY_SCALAR
#define HWY_BROKEN_EMU128 0
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
  for (std::size_t i = 0; i < count; ++i) place_cluster(to, listed[i]);
}

/// Adds to each; may read past the end.
HWY_INLINE void add_to(std::uint32_t* values, std::size_t count, std::uint32_t addend) {
  const D16 d;
  const auto a = hn::Set(d, addend);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreU(hn::Add(hn::LoadU(d, values + i), a), d, values + i);
  hn::BlendedStore(hn::Add(hn::LoadU(d, values + i), a), hn::FirstN(d, count - i), d, values + i);
}

/// memmove of words; may read past the end. From the end that is not overwritten first, without a branch on which.
HWY_INLINE void move_words(std::uint32_t* to, const std::uint32_t* from, std::size_t count) {
  const D16 d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const auto rest = static_cast<std::ptrdiff_t>(count) % lanes;
  const bool up = to > from;
  const std::ptrdiff_t step = up ? -lanes : lanes;
  const std::ptrdiff_t shift = to - from;
  const std::uint32_t* p = up ? from + count - lanes : from;
  for (std::size_t n = count / static_cast<std::size_t>(lanes); n != 0; --n, p += step)
    hn::StoreU(hn::LoadU(d, p), d, const_cast<std::uint32_t*>(p) + shift);
  p = up ? from : p;
  hn::BlendedStore(hn::LoadU(d, p), hn::FirstN(d, static_cast<std::size_t>(rest)), d,
                   const_cast<std::uint32_t*>(p) + shift);
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
  const std::uint32_t back = p.b;
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
  add_to(to.place + part + 1, back_part - part - 1, ((back + 1) ^ ~front_first) - ~front_first);
  add_to(to.place + back_part, end - back_part, ((front + 1) ^ front_first) - front_first);
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
  const Part* HWY_RESTRICT parts = to.parts;
  std::uint32_t* HWY_RESTRICT place = to.place;
  std::uint32_t* HWY_RESTRICT order = to.order;
  const std::uint8_t* HWY_RESTRICT sides = to.sides;
  place[0] = 0;
  for (std::size_t r = 0; r < run_count; ++r) {
    const Run run = runs[r];
    std::uint32_t at = place[run.part];
    std::uint32_t front = to.size[run.node];  // nodes of what is still to be placed
    std::uint32_t node = run.node;
    const std::uint32_t end = run.part + run.tops;
    for (std::uint32_t part = run.part; part < end; ++part, ++node) {
      // Masks instead of branches: sides are as good as chance.
      const std::uint32_t back = parts[part].b;
      const std::uint32_t front_last = front_mask(sides, node);
      front -= back + 1;
      const std::uint32_t behind = front & ~front_last;  // drawn before the back
      const std::uint32_t first = back & front_last;     // drawn before the front
      place[part] = at;
      place[parts[part].a] = at + behind + (1 & ~front_last);
      order[at + behind + first] = node;
      at += first + (1 & front_last);
    }
    place[end] = at;  // the cluster that ends the run
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
  HWY_DYNAMIC_DISPATCH(PlaceAll)(to, runs, run_count, clusters, cluster_count);
}
void place_clusters(const Placing& to, const std::uint32_t* listed, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(PlaceClusters)(to, listed, count);
}
void exchange(const Placing& to, std::uint32_t* flipped, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(Exchange)(to, flipped, count);
}

}  // namespace kage::order
#endif
