// SPDX-License-Identifier: Apache-2.0
#include "shadow/patches.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "order/exact.hpp"
#include "order/filter.hpp"

namespace kage {
namespace {

OrderPoint order_point(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

/// Numbers of caps by cells of their boxes.
class Grid {
 public:
  explicit Grid(std::span<const LightBox> boxes) : boxes_(boxes) {
    all_ = boxes[0];
    for (const LightBox& b : boxes) all_.add(b);
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(boxes.size()))), 1, 1024);
    first_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
    for (const LightBox& b : boxes) each_cell(b, [&](std::size_t c) { ++first_[c + 1]; });
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    caps_.resize(first_.back());
    std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) each_cell(boxes[i], [&](std::size_t c) { caps_[at[c]++] = i; });
  }

  /// Whether some cap whose box overlaps that of cap i satisfies `test`, which may see it more than once.
  template <class Test>
  [[nodiscard]] bool any(std::uint32_t i, Test test) const {
    bool found = false;
    each_cell(boxes_[i], [&](std::size_t c) {
      for (std::uint32_t k = first_[c]; k < first_[c + 1] && !found; ++k)
        found = boxes_[caps_[k]].overlaps(boxes_[i]) && test(caps_[k]);
    });
    return found;
  }

 private:
  template <class See>
  void each_cell(const LightBox& b, See see) const {
    const auto cell = [this](double v, std::size_t axis) {
      const double width = all_.high[axis] - all_.low[axis];
      const double at = width > 0 ? (v - all_.low[axis]) / width * side_ : 0;
      return std::clamp(static_cast<int>(at), 0, side_ - 1);
    };
    for (int y = cell(b.low[1], 1); y <= cell(b.high[1], 1); ++y)
      for (int x = cell(b.low[0], 0); x <= cell(b.high[0], 0); ++x)
        see(static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x));
  }

  std::span<const LightBox> boxes_;
  LightBox all_;
  int side_ = 1;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> caps_;
};

class Patches {
 public:
  Patches(const SceneFrame& frame, const LightPoint& light, const EdgeTable& edges, std::span<const CapFace> caps,
          std::span<const LightBox> boxes)
      : frame_(&frame), light_(&light), edges_(&edges), caps_(caps), grid_(boxes), patch_of_(caps.size(), kNone) {}

  std::vector<std::vector<CapFace>> make() {
    std::vector<std::vector<CapFace>> patches;
    std::vector<std::uint32_t> tried(caps_.size(), kNone);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t seed = 0; seed < caps_.size(); ++seed) {
      if (patch_of_[seed] != kNone) continue;
      const auto patch = static_cast<std::uint32_t>(patches.size());
      patches.emplace_back();
      patch_of_[seed] = patch;
      queue.assign(1, seed);
      const bool alone = !goes_round(caps_[seed]);
      for (std::size_t i = 0; i < queue.size() && !alone; ++i)
        each_neighbour(caps_[queue[i]], [&](std::uint32_t n) {
          if (patch_of_[n] != kNone || tried[n] == patch) return;
          tried[n] = patch;
          if (!goes_round(caps_[n])) return;
          if (grid_.any(n, [&](std::uint32_t o) { return patch_of_[o] == patch && overlap(caps_[n], caps_[o]); }))
            return;
          patch_of_[n] = patch;
          queue.push_back(n);
        });
      std::sort(queue.begin(), queue.end());
      for (const std::uint32_t c : queue) patches.back().push_back(caps_[c]);
    }
    return patches;
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  [[nodiscard]] int turn(std::uint32_t p, std::uint32_t q, std::uint32_t r) const {
    return light_turn(*frame_, *light_, p, q, r);
  }

  // Corner i, in the order in which they go round seen from the light.
  [[nodiscard]] std::uint32_t corner(const CapFace& cap, std::size_t i) const {
    const auto corners = frame_->outline(frame_->polygons[cap.polygon]);
    const std::size_t k = i % corners.size();
    return corners[cap.turned ? corners.size() - 1 - k : k];
  }
  [[nodiscard]] std::size_t size(const CapFace& cap) const { return frame_->polygons[cap.polygon].count; }

  // Whether the cap is convex to the light, with an area that is not 0.
  [[nodiscard]] bool goes_round(const CapFace& cap) const {
    const std::size_t n = size(cap);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = i + 2; k < i + n; ++k) {
        const int t = turn(corner(cap, i), corner(cap, i + 1), corner(cap, k));
        if (t < 0 || (n == 3 && t == 0)) return false;
      }
    return n == 3 || turn(corner(cap, 0), corner(cap, 1), corner(cap, 2)) > 0;
  }

  // Two convex figures lie apart if, and only if, the line of some edge of one has the other on its outer side.
  [[nodiscard]] bool overlap(const CapFace& a, const CapFace& b) const { return !parts(a, b) && !parts(b, a); }

  [[nodiscard]] bool parts(const CapFace& a, const CapFace& b) const {
    for (std::size_t i = 0; i < size(a); ++i) {
      bool outside = true;
      for (std::size_t k = 0; k < size(b) && outside; ++k)
        outside = turn(corner(a, i), corner(a, i + 1), corner(b, k)) <= 0;
      if (outside) return true;
    }
    return false;
  }

  template <class See>
  void each_neighbour(const CapFace& cap, See see) const {
    const Polygon& p = frame_->polygons[cap.polygon];
    for (std::uint32_t k = p.first; k < p.first + p.count; ++k)
      for (const std::uint32_t other : edges_->polygons_at(k)) {
        const auto it = std::lower_bound(caps_.begin(), caps_.end(), other,
                                         [](const CapFace& c, std::uint32_t polygon) { return c.polygon < polygon; });
        if (it != caps_.end() && it->polygon == other) see(static_cast<std::uint32_t>(it - caps_.begin()));
      }
  }

  const SceneFrame* frame_;
  const LightPoint* light_;
  const EdgeTable* edges_;
  std::span<const CapFace> caps_;
  Grid grid_;
  std::vector<std::uint32_t> patch_of_;
};

}  // namespace

int light_turn(const SceneFrame& frame, const LightPoint& light, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
  if (p == q || q == r || r == p) return 0;
  const order::PlanePoints plane{order_point(frame.vertices[p]), order_point(frame.vertices[q]),
                                 order_point(frame.vertices[r])};
  const order::FilterPlane filter(plane.a, plane.b, plane.c);
  if (light.directional) {
    const OrderPoint to = order_point(-light.direction);
    const double s = filter.slope(to);
    if (std::abs(s) > filter.slope_error(to)) return s > 0 ? 1 : -1;
    return order::exact_facing(plane, to);
  }
  const OrderPoint at = order_point(light.position);
  const double s = filter.value(at);
  if (std::abs(s) > filter.error(at)) return s > 0 ? 1 : -1;
  return order::exact_side(plane, at);
}

std::vector<std::vector<CapFace>> make_patches(const SceneFrame& frame, const LightPoint& light, const EdgeTable& edges,
                                               const LightSpace& space, std::span<const CapFace> caps) {
  if (caps.empty()) return {};
  std::vector<LightBox> boxes;
  boxes.reserve(caps.size());
  for (const CapFace& cap : caps) boxes.push_back(space.box(frame.polygons[cap.polygon]));
  return Patches(frame, light, edges, caps, boxes).make();
}

}  // namespace kage
