// SPDX-License-Identifier: Apache-2.0
#include "shadow/world_volume.hpp"

#include <algorithm>
#include <tuple>

namespace kage {

EdgeTable::EdgeTable(const SceneFrame& frame) : half_edges_(frame.corners.size()) {
  struct Half {
    std::uint32_t high;
    std::uint32_t corner;
    std::uint32_t polygon;
    bool falling;
  };
  const auto each = [&frame](auto see) {
    for (const Component& part : frame.components)
      for (std::uint32_t i = part.first_polygon; !part.translucent && i < part.first_polygon + part.polygon_count;
           ++i) {
        const Polygon& p = frame.polygons[i];
        const auto corners = frame.outline(p);
        for (std::uint32_t k = 0; k < p.count; ++k) {
          const std::uint32_t a = corners[k];
          const std::uint32_t b = corners[k + 1 == p.count ? 0 : k + 1];
          see(std::min(a, b), Half{std::max(a, b), p.first + k, i, a > b});
        }
      }
  };
  // By the lesser vertex first, which few edges share, then by the greater one and by corner.
  std::vector<std::uint32_t> at(frame.vertices.size() + 1, 0);
  each([&at](std::uint32_t low, const Half&) { ++at[low + 1]; });
  for (std::size_t v = 1; v < at.size(); ++v) at[v] += at[v - 1];
  std::vector<Half> all(at.back());
  each([&](std::uint32_t low, const Half& h) { all[at[low]++] = h; });
  polygons_.reserve(all.size());
  first_.reserve(all.size() / 2 + 1);
  std::size_t i = 0;
  for (std::size_t v = 0; v + 1 < at.size(); ++v) {
    const std::size_t first = i;
    const std::size_t end = at[v];  // where those of the next begin, now that all are in their places
    std::sort(all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(end),
              [](const Half& p, const Half& q) { return std::tie(p.high, p.corner) < std::tie(q.high, q.corner); });
    for (; i < end; ++i) {
      if (i == first || all[i].high != all[i - 1].high) first_.push_back(static_cast<std::uint32_t>(i));
      half_edges_[all[i].corner] = static_cast<std::uint32_t>(2 * (first_.size() - 1)) + (all[i].falling ? 1 : 0);
      polygons_.push_back(all[i].polygon);
    }
  }
  net_.assign(first_.size(), 0);
  first_.push_back(static_cast<std::uint32_t>(all.size()));
}

void EdgeTable::sides(const SceneFrame& frame, std::span<const CapFace> caps, std::vector<SideEdge>& out) {
  out.clear();
  const auto rising = [this](const CapFace& cap, std::uint32_t corner) {
    return ((half_edges_[corner] & 1U) != 0) == cap.turned;
  };
  for (const CapFace& cap : caps) {
    const Polygon& p = frame.polygons[cap.polygon];
    for (std::uint32_t k = p.first; k < p.first + p.count; ++k) net_[half_edges_[k] >> 1] += rising(cap, k) ? 1 : -1;
  }
  for (const CapFace& cap : caps) {
    const Polygon& p = frame.polygons[cap.polygon];
    const auto corners = frame.outline(p);
    for (std::uint32_t i = 0; i < p.count; ++i) {
      // Corners in the order in which they go round seen from the light.
      const std::uint32_t k = cap.turned ? p.count - 1 - i : i;
      std::int32_t& net = net_[half_edges_[p.first + k] >> 1];
      const bool up = rising(cap, p.first + k);
      if (net == 0 || up != (net > 0)) continue;
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[k + 1 == p.count ? 0 : k + 1];
      out.push_back({cap.polygon, cap.turned ? b : a, cap.turned ? a : b, up ? net : -net});
      net = 0;
    }
  }
}

}  // namespace kage
