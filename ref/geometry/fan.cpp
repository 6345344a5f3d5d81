// SPDX-License-Identifier: Apache-2.0
#include "geometry/fan.hpp"

namespace kage {
namespace {

/// Whether two corners, on one line with `from`, lie on the same side of it.
bool same_side(const ScreenVertex& from, const ScreenVertex& a, const ScreenVertex& b) {
  return (std::int64_t{a.x} - from.x) * (std::int64_t{b.x} - from.x) +
             (std::int64_t{a.y} - from.y) * (std::int64_t{b.y} - from.y) >
         0;
}

/// The other corners, as `apex` sees them, turn one way (`sign`, 1 or -1) and through less than a whole turn: so do the
/// triangles, each beside the one before it. A corner that lies on `apex` has no direction and is passed over, because
/// it would hide a step back between those beside it.
bool turns_one_way(std::span<const ScreenVertex> outline, std::size_t apex, int sign) {
  const ScreenVertex& from = outline[apex];
  const ScreenVertex* first = nullptr;
  const ScreenVertex* last = nullptr;
  bool second_half = false;  // of the turn that begins at `first`
  for (std::size_t i = 1; i < outline.size(); ++i) {
    const ScreenVertex& to = outline[(apex + i) % outline.size()];
    if (to == from) continue;
    if (first == nullptr) {
      first = last = &to;
      continue;
    }
    if (sign * twice_area(from, *last, to) < 0) return false;
    const std::int64_t turn = sign * twice_area(from, *first, to);
    const bool beyond = turn < 0 || (turn == 0 && !same_side(from, *first, to));
    if (second_half && !beyond) return false;  // back, or a whole turn
    second_half = beyond;
    last = &to;
  }
  return true;
}

}  // namespace

std::optional<std::size_t> fan_corner(std::span<const ScreenVertex> outline) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (turns_one_way(outline, i, 1) || turns_one_way(outline, i, -1)) return i;
  return {};
}

}  // namespace kage
