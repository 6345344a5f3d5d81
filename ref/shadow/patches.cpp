// SPDX-License-Identifier: Apache-2.0
#include "shadow/patches.hpp"

#include <algorithm>
#include <cmath>

#include "shadow/light_corners.hpp"

namespace kage {
namespace {

/// The caps of a patch by cells of their boxes.
class Grid {
 public:
  explicit Grid(std::span<const LightBox> boxes) : boxes_(boxes) {
    LightBox all = boxes[0];
    for (const LightBox& b : boxes) all.add(b);
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(boxes.size()))), 1, 1024);
    // Wide boxes lie in many cells of a fine grid: without this they could take all memory.
    while (fill(all) > kEntriesOfBox * boxes.size()) side_ /= 2;
    first_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
    for (const Cells& c : cells_) each_cell(c, [&](std::size_t n) { ++first_[n + 1]; });
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    caps_.resize(first_.back());
    count_.assign(first_.size() - 1, 0);
  }

  void add(std::uint32_t i) {
    each_cell(cells_[i], [&](std::size_t n) { caps_[first_[n] + count_[n]++] = i; });
  }

  /// Forget all in the cells of cap i.
  void clear(std::uint32_t i) {
    each_cell(cells_[i], [&](std::size_t n) { count_[n] = 0; });
  }

  /// Whether some cap that was added, and whose box overlaps that of cap i, satisfies `test`, which sees it once.
  template <class Test>
  [[nodiscard]] bool any(std::uint32_t i, Test test) const {
    const Cells& own = cells_[i];
    for (int y = own.y0; y <= own.y1; ++y)
      for (int x = own.x0; x <= own.x1; ++x) {
        const std::size_t n = number(x, y);
        for (std::uint32_t k = first_[n]; k < first_[n] + count_[n]; ++k) {
          const std::uint32_t o = caps_[k];
          // Two boxes are tested in the first cell that both have.
          if (x != std::max(own.x0, cells_[o].x0) || y != std::max(own.y0, cells_[o].y0)) continue;
          if (boxes_[o].overlaps(boxes_[i]) && test(o)) return true;
        }
      }
    return false;
  }

 private:
  /// On average. With side_ 1 a box has one.
  static constexpr std::uint64_t kEntriesOfBox = 16;

  /// From the first to the last.
  struct Cells {
    std::int16_t x0, y0, x1, y1;
  };

  /// Sets the cells of all boxes, which `all` holds; how many entries that makes.
  std::uint64_t fill(const LightBox& all) {
    const auto cell = [&](double v, std::size_t axis) {
      const double width = all.high[axis] - all.low[axis];
      const double at = width > 0 ? (v - all.low[axis]) / width * side_ : 0;
      return static_cast<std::int16_t>(std::clamp(static_cast<int>(at), 0, side_ - 1));
    };
    cells_.clear();
    cells_.reserve(boxes_.size());
    std::uint64_t entries = 0;
    for (const LightBox& b : boxes_) {
      const Cells c{cell(b.low[0], 0), cell(b.low[1], 1), cell(b.high[0], 0), cell(b.high[1], 1)};
      entries += static_cast<std::uint64_t>(c.x1 - c.x0 + 1) * static_cast<std::uint64_t>(c.y1 - c.y0 + 1);
      cells_.push_back(c);
    }
    return entries;
  }

  [[nodiscard]] std::size_t number(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }

  template <class See>
  void each_cell(const Cells& c, See see) const {
    for (int y = c.y0; y <= c.y1; ++y)
      for (int x = c.x0; x <= c.x1; ++x) see(number(x, y));
  }

  std::span<const LightBox> boxes_;
  int side_ = 1;
  std::vector<Cells> cells_;
  std::vector<std::uint32_t> first_;  // room for all caps of a cell, in caps_
  std::vector<std::uint32_t> count_;
  std::vector<std::uint32_t> caps_;
};

class Patches {
 public:
  Patches(const SceneFrame& frame, const LightPoint& light, const EdgeTable& edges, std::span<const CapFace> caps,
          std::span<const LightBox> boxes)
      : frame_(&frame),
        edges_(&edges),
        caps_(caps),
        corners_(frame, light, caps),
        grid_(boxes),
        taken_(caps.size(), 0),
        goes_round_(caps.size(), kUnknown) {
    const auto [least, most] = std::ranges::minmax(caps, {}, &CapFace::polygon);
    first_polygon_ = least.polygon;
    cap_of_.assign(most.polygon - least.polygon + 1, kNone);
    for (std::uint32_t i = 0; i < caps.size(); ++i) cap_of_[caps[i].polygon - first_polygon_] = i;
  }

  std::vector<std::vector<CapFace>> make() {
    std::vector<std::vector<CapFace>> patches;
    std::vector<std::uint32_t> tried(caps_.size(), kNone);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t seed = 0; seed < caps_.size(); ++seed) {
      if (taken_[seed] != 0) continue;
      const auto patch = static_cast<std::uint32_t>(patches.size());
      patches.emplace_back();
      taken_[seed] = 1;
      grid_.add(seed);
      queue.assign(1, seed);
      const bool alone = !goes_round(seed);
      for (std::size_t i = 0; i < queue.size() && !alone; ++i)
        each_neighbour(caps_[queue[i]], [&](std::uint32_t n) {
          if (taken_[n] != 0 || tried[n] == patch) return;
          tried[n] = patch;
          if (!goes_round(n)) return;
          if (grid_.any(n, [&](std::uint32_t o) { return overlap(n, o); })) return;
          taken_[n] = 1;
          grid_.add(n);
          queue.push_back(n);
        });
      std::sort(queue.begin(), queue.end());
      patches.back().reserve(queue.size());
      for (const std::uint32_t c : queue) {
        patches.back().push_back(caps_[c]);
        grid_.clear(c);
      }
    }
    return patches;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr std::int8_t kUnknown = -1;

  // Whether the cap is convex to the light, with an area that is not 0.
  [[nodiscard]] bool goes_round(std::uint32_t cap) {
    std::int8_t& known = goes_round_[cap];
    if (known == kUnknown) known = find_round(cap) ? 1 : 0;
    return known != 0;
  }

  [[nodiscard]] bool find_round(std::uint32_t cap) const {
    const std::uint32_t n = corners_.size(cap);
    if (corners_.turn(corners_.corner(cap, 0), corners_.corner(cap, 1), corners_.corner(cap, 2)) <= 0) return false;
    if (n == 3) return true;
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t k = i + 2; k < i + n; ++k)
        if (corners_.turn(corners_.corner(cap, i), corners_.corner(cap, i + 1), corners_.corner(cap, k)) < 0)
          return false;
    return true;
  }

  // Two convex figures lie apart if, and only if, the line of some edge of one has the other on its outer side.
  [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const {
    return !surely_parts(a, b) && !surely_parts(b, a) && !parts(a, b) && !parts(b, a);
  }

  // A quick test that decides most pairs, with fewer branches for the processor to guess than parts() has.
  [[nodiscard]] bool surely_parts(std::uint32_t a, std::uint32_t b) const {
    for (std::uint32_t i = 0; i < corners_.size(a); ++i) {
      bool outside = true;
      for (std::uint32_t k = 0; k < corners_.size(b); ++k)
        outside &= corners_.surely_not_left(corners_.corner(a, i), corners_.corner(a, i + 1), corners_.corner(b, k));
      if (outside) return true;
    }
    return false;
  }

  [[nodiscard]] bool parts(std::uint32_t a, std::uint32_t b) const {
    for (std::uint32_t i = 0; i < corners_.size(a); ++i) {
      bool outside = true;
      for (std::uint32_t k = 0; k < corners_.size(b) && outside; ++k)
        outside = corners_.turn(corners_.corner(a, i), corners_.corner(a, i + 1), corners_.corner(b, k)) <= 0;
      if (outside) return true;
    }
    return false;
  }

  template <class See>
  void each_neighbour(const CapFace& cap, See see) const {
    const Polygon& p = frame_->polygons[cap.polygon];
    for (std::uint32_t k = p.first; k < p.first + p.count; ++k)
      for (const std::uint32_t other : edges_->polygons_at(k)) {
        // Below the first the difference wraps to what is past the last.
        const std::uint32_t i = other - first_polygon_;
        if (i < cap_of_.size() && cap_of_[i] != kNone) see(cap_of_[i]);
      }
  }

  const SceneFrame* frame_;
  const EdgeTable* edges_;
  std::span<const CapFace> caps_;
  LightCorners corners_;
  Grid grid_;
  std::uint32_t first_polygon_ = 0;
  std::vector<std::uint32_t> cap_of_;    // of polygons from that on
  std::vector<std::int8_t> taken_;       // of each cap whether a patch has it
  std::vector<std::int8_t> goes_round_;  // of each cap, if it is known
};

}  // namespace

std::vector<std::vector<CapFace>> make_patches(const SceneFrame& frame, const LightPoint& light, const EdgeTable& edges,
                                               const LightSpace& space, std::span<const CapFace> caps) {
  if (caps.empty()) return {};
  std::vector<LightBox> boxes;
  boxes.reserve(caps.size());
  for (const CapFace& cap : caps) boxes.push_back(space.box(frame.polygons[cap.polygon]));
  return Patches(frame, light, edges, caps, boxes).make();
}

}  // namespace kage
