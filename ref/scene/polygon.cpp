// SPDX-License-Identifier: Apache-2.0
//
// Ear clipping, seen along the polygon's mean normal. Convex polygons, nearly all there are, become fans.
#include "polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "number/counted.hpp"
#include "transform.hpp"

namespace kage::scene {
namespace {

// Newell: the area vector of the closed line, whatever its shape.
glm::dvec3 area_vector(const std::vector<glm::dvec3>& p) {
  glm::dvec3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += cross(p[i] - p[0], p[i + 1] - p[0]);
  return sum;
}

class Clipper {
 public:
  explicit Clipper(const std::vector<glm::dvec3>& p) : p_(p), normal_(area_vector(p)), left_(p.size()) {
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = static_cast<std::uint32_t>(i);
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.push_back({at(ear + left_.size() - 1), at(ear), at(ear + 1)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (left_.size() == 3) triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  [[nodiscard]] std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }
  [[nodiscard]] double side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return dot(normal_, cross(p_[b] - p_[a], p_[c] - p_[a]));
  }

  // The first corner that turns the right way with no other inside; failing that (it crosses itself) the first.
  [[nodiscard]] std::size_t find_ear() const {
    for (std::size_t i = 1; i <= left_.size(); ++i)
      if (is_ear(i % left_.size())) return i % left_.size();
    return 1;
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const std::uint32_t a = at(i + left_.size() - 1);
    const std::uint32_t b = at(i);
    const std::uint32_t c = at(i + 1);
    if (!(side(a, b, c) > 0)) return false;
    for (const std::uint32_t v : left_) {
      if (v == a || v == b || v == c || p_[v] == p_[a] || p_[v] == p_[b] || p_[v] == p_[c]) continue;
      if (side(a, b, v) >= 0 && side(b, c, v) >= 0 && side(c, a, v) >= 0) return false;
    }
    return true;
  }

  const std::vector<glm::dvec3>& p_;
  glm::dvec3 normal_;
  std::vector<std::uint32_t> left_;
};

bool is_convex(const std::vector<glm::dvec3>& p) {
  const glm::dvec3 normal = area_vector(p);
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(dot(normal, cross(p[(i + 1) % n] - p[i], p[(i + 2) % n] - p[(i + 1) % n])) > 0)) return false;
  return true;
}

constexpr double kCrossingTolerance = 1e-6;               // of the largest coordinate
constexpr std::size_t kMostPairs = std::size_t{1} << 24;  // of edges that are held against each other

/// A polygon as its mean normal sees it.
class Outline {
 public:
  explicit Outline(const std::vector<glm::dvec3>& p) {
    double largest = 0;
    for (const glm::dvec3& v : p) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    tolerance_ = kCrossingTolerance * largest;
    const glm::dvec3 n = normal(p);
    const glm::dvec3 u = unit(cross(n, std::abs(n.x) < 0.7 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0}), {0, 0, 0});
    const glm::dvec3 v = cross(n, u);
    for (const glm::dvec3& at : p) p_.push_back({dot(u, at - p[0]), dot(v, at - p[0])});
  }

  /// Whether two edges cross that share no corner. They are held against each other where they lie side by side.
  [[nodiscard]] bool crosses() const {
    std::vector<std::size_t> order(p_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto low = [this](std::size_t e) { return std::min(from(e).x, to(e).x); };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double high = std::max(from(order[i]).x, to(order[i]).x);
      for (std::size_t k = i + 1; k < order.size() && low(order[k]) <= high; ++k) {
        if (++pairs > kMostPairs) return false;
        if (cross_each_other(order[i], order[k])) return true;
      }
    }
    return false;
  }

  /// Whether a polygon that turns to one side at all its corners goes round more than once. Each time round, its edges
  /// lead twice from one side to the other.
  [[nodiscard]] bool winds() const {
    int turns = 0;
    double last = 0;
    for (std::size_t i = 0; i < 2 * p_.size(); ++i) {  // the first time round finds `last`
      const double step = to(i % p_.size()).x - from(i % p_.size()).x;
      if (step == 0) continue;
      if (i >= p_.size() && (step > 0) != (last > 0)) ++turns;
      last = step;
    }
    return turns > 2;
  }

 private:
  struct Place {
    double x, y;
  };

  /// Normal of length 1. A figure of eight may have no area; then it is that of the widest corner at its first place.
  static glm::dvec3 normal(const std::vector<glm::dvec3>& p) {
    const auto square = [](const glm::dvec3& v) { return dot(v, v); };
    glm::dvec3 far{0, 0, 0};
    for (const glm::dvec3& at : p)
      if (square(at - p[0]) > square(far)) far = at - p[0];
    const glm::dvec3 mean = area_vector(p);
    if (square(mean) > kCrossingTolerance * square(far) * square(far)) return unit(mean, {0, 0, 1});
    glm::dvec3 widest{0, 0, 0};
    for (const glm::dvec3& at : p)
      if (const glm::dvec3 n = cross(far, at - p[0]); square(n) > square(widest)) widest = n;
    return unit(widest, {0, 0, 1});
  }

  [[nodiscard]] const Place& from(std::size_t edge) const { return p_[edge]; }
  [[nodiscard]] const Place& to(std::size_t edge) const { return p_[edge + 1 == p_.size() ? 0 : edge + 1]; }

  /// 1 and -1 where a place lies to the left and right of an edge's line, 0 where it is too near to tell.
  [[nodiscard]] int side(std::size_t edge, const Place& at) const {
    const double x = to(edge).x - from(edge).x;
    const double y = to(edge).y - from(edge).y;
    const double area = x * (at.y - from(edge).y) - y * (at.x - from(edge).x);
    const double least = tolerance_ * std::sqrt(x * x + y * y);
    return area > least ? 1 : area < -least ? -1 : 0;
  }

  [[nodiscard]] bool cross_each_other(std::size_t a, std::size_t b) const {
    return side(a, from(b)) * side(a, to(b)) < 0 && side(b, from(a)) * side(b, to(a)) < 0;
  }

  std::vector<Place> p_;
  double tolerance_ = 0;
};

}  // namespace

bool crosses_itself(const std::vector<glm::dvec3>& corner) {
  if (corner.size() < 4) return false;
  if (!is_convex(corner)) return Outline(corner).crosses();
  return corner.size() > 4 && Outline(corner).winds();  // four corners are too few to wind twice
}

void note_crossing(std::size_t count, std::vector<std::string>& notes) {
  if (count > 0)
    notes.push_back(counted(count, "face crosses itself, and is", "faces cross themselves, and are") +
                    (count == 1 ? " drawn as some triangles between its corners"
                                : " drawn as some triangles between their corners"));
}

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<glm::dvec3>& corner) {
  // A line that winds more than once would pass as convex from 5 corners on, and its fan be as good as any.
  std::vector<std::array<std::uint32_t, 3>> fan;
  if (corner.size() < 3) return fan;
  if (corner.size() > 3 && !is_convex(corner)) return Clipper(corner).run();
  for (std::uint32_t i = 1; i + 1 < corner.size(); ++i) fan.push_back({0, i, i + 1});
  return fan;
}

}  // namespace kage::scene
