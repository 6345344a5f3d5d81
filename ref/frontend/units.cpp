// SPDX-License-Identifier: Apache-2.0
#include "frontend/units.hpp"

#include <algorithm>
#include <numeric>

namespace kage {
namespace {

bool meet(const UnitNeed& a, const UnitNeed& b) {
  return a.first < b.end && b.first < a.end && a.left < b.right && b.left < a.right;
}

struct Unit {
  std::vector<std::uint32_t> members;
  int faces = 0;
};

/// Most segments of a line of the unit if `extra` joins it: each member's, and blank ones before, between and behind,
/// as often as their length asks for.
int segments_with(const Unit& unit, std::span<const UnitNeed> needs, const UnitNeed& extra, const UnitRoom& room) {
  int sum = extra.segments;
  int members = 1;
  for (const std::uint32_t m : unit.members) {
    if (needs[m].first >= extra.end || extra.first >= needs[m].end) continue;
    sum += needs[m].segments;
    ++members;
  }
  return sum + members + 1 + room.width / room.max_dx;
}

}  // namespace

std::optional<std::vector<int>> assign_all(std::span<const UnitNeed> needs, const UnitRoom& room) {
  std::vector<std::uint32_t> order(needs.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return needs[a].first < needs[b].first; });
  std::vector<int> unit_of(needs.size(), -1);
  std::vector<Unit> units;
  for (const std::uint32_t i : order) {
    const UnitNeed& need = needs[i];
    if (need.end == 0) {  // not to be seen: it asks for nothing
      unit_of[i] = 0;
      continue;
    }
    const auto has_room = [&](const Unit& u) {
      return u.faces + need.faces <= room.faces && segments_with(u, needs, need, room) <= room.segments &&
             std::none_of(u.members.begin(), u.members.end(), [&](std::uint32_t m) { return meet(needs[m], need); });
    };
    auto it = std::find_if(units.begin(), units.end(), has_room);
    if (it == units.end()) {
      if (static_cast<int>(units.size()) == room.units || !has_room(Unit{})) return std::nullopt;
      it = units.insert(units.end(), Unit{});
    }
    it->members.push_back(i);
    it->faces += need.faces;
    unit_of[i] = static_cast<int>(it - units.begin());
  }
  return unit_of;
}

std::vector<int> assign_units(std::span<const UnitNeed> needs, const UnitRoom& room) {
  if (auto all = assign_all(needs, room)) return *all;
  // How many fit: with n they do, with one more they do not. First fit is not monotone, so there may be more such n;
  // bisection finds one, always the same.
  std::vector<int> best;
  std::size_t fits = 0;
  std::size_t too_many = needs.size();
  while (fits + 1 < too_many) {
    const std::size_t n = fits + (too_many - fits) / 2;
    if (auto some = assign_all(needs.first(n), room)) {
      best = std::move(*some);
      fits = n;
    } else {
      too_many = n;
    }
  }
  return best;
}

}  // namespace kage
