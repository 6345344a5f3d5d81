// SPDX-License-Identifier: Apache-2.0
#include "topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

#include "transform.hpp"

namespace kage::scene {
namespace {

// One triangle's use of an edge; `forward`: from lo to hi.
struct Use {
  std::uint32_t lo;
  std::uint32_t hi;
  std::uint32_t triangle;
  bool forward;
};

std::vector<Use> sorted_uses(const std::vector<Corners>& triangles) {
  std::vector<Use> uses;
  uses.reserve(triangles.size() * 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k];
      const std::uint32_t b = triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), a < b});
    }
  std::sort(uses.begin(), uses.end(), [](const Use& p, const Use& q) {
    return std::tie(p.lo, p.hi, p.triangle, p.forward) < std::tie(q.lo, q.hi, q.triangle, q.forward);
  });
  return uses;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t t) {
  while (parent[t] != t) t = parent[t] = parent[parent[t]];
  return t;
}

// The edges of one component, as ranges of the sorted uses.
struct Range {
  std::size_t begin;
  std::size_t end;
};

class Analysis {
 public:
  Analysis(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles, std::uint64_t& budget)
      : positions_(positions), triangles_(triangles), budget_(budget), uses_(sorted_uses(triangles)) {}

  Topology run() {
    split();
    result_.reversed.assign(triangles_.size(), false);
    seen_.assign(triangles_.size(), false);
    for (std::size_t i = 0; i < result_.components.size(); ++i) {
      MeshComponent& c = result_.components[i];
      c.reason = open_edge(edges_[i]);
      if (c.reason.kind == Reason::Kind::kNone) c.reason = orient(c, edges_[i]);
      if (c.reason.kind == Reason::Kind::kNone) c.reason = turn_outward(c);
      if (c.reason.kind != Reason::Kind::kNone) {
        for (std::uint32_t t = c.first; t < c.first + c.count; ++t) result_.reversed[result_.order[t]] = false;
        continue;
      }
      c.closed = true;
      c.reason = test_convexity(c, edges_[i]);
      c.convex = c.reason.kind == Reason::Kind::kNone;
    }
    return std::move(result_);
  }

 private:
  void split();
  [[nodiscard]] Reason open_edge(const std::vector<Range>& edges) const;
  Reason orient(const MeshComponent& c, const std::vector<Range>& edges);
  Reason turn_outward(const MeshComponent& c);
  Reason test_convexity(const MeshComponent& c, const std::vector<Range>& edges);
  [[nodiscard]] Corners oriented(std::uint32_t triangle) const {
    const Corners& t = triangles_[triangle];
    return result_.reversed[triangle] ? Corners{t[0], t[2], t[1]} : t;
  }

  const std::vector<glm::dvec3>& positions_;
  const std::vector<Corners>& triangles_;
  std::uint64_t& budget_;
  std::vector<Use> uses_;
  std::vector<std::vector<Range>> edges_;  // by component
  std::vector<bool> seen_;
  Topology result_;
};

void Analysis::split() {
  const std::size_t n = triangles_.size();
  std::vector<std::uint32_t> parent(n);
  std::iota(parent.begin(), parent.end(), 0u);
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < uses_.size();) {
    std::size_t j = i + 1;
    for (; j < uses_.size() && uses_[j].lo == uses_[i].lo && uses_[j].hi == uses_[i].hi; ++j) {
      const std::uint32_t p = root(parent, uses_[i].triangle);
      const std::uint32_t q = root(parent, uses_[j].triangle);
      parent[std::max(p, q)] = std::min(p, q);  // the root is the component's first triangle
    }
    ranges.push_back({i, j});
    i = j;
  }
  std::vector<std::uint32_t> number(n);
  for (std::uint32_t t = 0; t < n; ++t) {
    const std::uint32_t r = root(parent, t);
    if (r == t) {
      number[t] = static_cast<std::uint32_t>(result_.components.size());
      result_.components.emplace_back();
    } else {
      number[t] = number[r];
    }
    ++result_.components[number[t]].count;
  }
  std::uint32_t first = 0;
  for (MeshComponent& c : result_.components) {
    c.first = first;
    first += c.count;
  }
  result_.order.resize(n);
  std::vector<std::uint32_t> next(result_.components.size(), 0);
  for (std::uint32_t t = 0; t < n; ++t) result_.order[result_.components[number[t]].first + next[number[t]]++] = t;
  edges_.resize(result_.components.size());
  for (const Range& r : ranges) edges_[number[uses_[r.begin].triangle]].push_back(r);
}

Reason Analysis::open_edge(const std::vector<Range>& edges) const {
  for (const Range& r : edges) {
    const Use& u = uses_[r.begin];
    const auto faces = static_cast<std::uint32_t>(r.end - r.begin);
    if (faces == 1) return {Reason::Kind::kOneFace, u.lo, u.hi, 1};
    if (faces > 2) return {Reason::Kind::kManyFaces, u.lo, u.hi, faces};
  }
  return {};
}

// Give all triangles the orientation of the first, spreading over shared edges.
Reason Analysis::orient(const MeshComponent& c, const std::vector<Range>& edges) {
  bool consistent = true;
  for (const Range& r : edges) consistent = consistent && uses_[r.begin].forward != uses_[r.begin + 1].forward;
  if (consistent) return {};

  struct Neighbour {
    std::uint32_t from;
    std::uint32_t to;
    bool opposite;  // their windings disagree
    std::size_t use;
  };
  std::vector<Neighbour> neighbours;
  for (const Range& r : edges) {
    const Use& p = uses_[r.begin];
    const Use& q = uses_[r.begin + 1];
    neighbours.push_back({p.triangle, q.triangle, p.forward == q.forward, r.begin});
    neighbours.push_back({q.triangle, p.triangle, p.forward == q.forward, r.begin});
  }
  std::sort(neighbours.begin(), neighbours.end(),
            [](const Neighbour& p, const Neighbour& q) { return std::tie(p.from, p.use) < std::tie(q.from, q.use); });
  std::vector<std::uint32_t> stack{result_.order[c.first]};
  seen_[stack.back()] = true;
  std::uint32_t turned = 0;
  while (!stack.empty()) {
    const std::uint32_t t = stack.back();
    stack.pop_back();
    auto it = std::lower_bound(neighbours.begin(), neighbours.end(), t,
                               [](const Neighbour& p, std::uint32_t value) { return p.from < value; });
    for (; it != neighbours.end() && it->from == t; ++it) {
      const bool wanted = result_.reversed[t] != it->opposite;
      if (!seen_[it->to]) {
        seen_[it->to] = true;
        result_.reversed[it->to] = wanted;
        turned += wanted ? 1 : 0;
        stack.push_back(it->to);
      } else if (result_.reversed[it->to] != wanted) {
        return {Reason::Kind::kNoOrientation, uses_[it->use].lo, uses_[it->use].hi, 0};
      }
    }
  }
  result_.turned += std::min(turned, c.count - turned);
  return {};
}

Reason Analysis::turn_outward(const MeshComponent& c) {
  const glm::dvec3 origin = positions_[triangles_[result_.order[c.first]][0]];
  double volume = 0;  // six times the volume
  double gross = 0;
  for (std::uint32_t i = c.first; i < c.first + c.count; ++i) {
    const Corners t = oriented(result_.order[i]);
    const double v = dot(positions_[t[0]] - origin, cross(positions_[t[1]] - origin, positions_[t[2]] - origin));
    volume += v;
    gross += std::abs(v);
  }
  // If the true sum is 0, rounding leaves far less than this share of its terms.
  if (!(std::abs(volume) > 1e-12 * gross)) return {Reason::Kind::kFlat, 0, 0, 0};
  if (volume < 0) {
    ++result_.inside_out;
    for (std::uint32_t i = c.first; i < c.first + c.count; ++i)
      result_.reversed[result_.order[i]] = !result_.reversed[result_.order[i]];
  }
  return {};
}

Reason Analysis::test_convexity(const MeshComponent& c, const std::vector<Range>& edges) {
  std::vector<Corners> triangles;
  for (std::uint32_t i = c.first; i < c.first + c.count; ++i) triangles.push_back(oriented(result_.order[i]));
  // result_.order is ascending within a component: a triangle's place is found by search.
  const auto begin = result_.order.begin() + c.first;
  const auto place = [&](std::uint32_t t) {
    return static_cast<std::uint32_t>(std::lower_bound(begin, begin + c.count, t) - begin);
  };
  std::vector<SharedEdge> shared;
  for (const Range& r : edges) {
    const Use& u = uses_[r.begin];
    shared.push_back({u.lo, u.hi, {place(u.triangle), place(uses_[r.begin + 1].triangle)}});
  }
  return convexity(positions_, triangles, shared, budget_);
}

}  // namespace

std::string Reason::text(std::uint32_t first_vertex, std::uint32_t first_triangle) const {
  const std::string edge = "edge " + std::to_string(first_vertex + a) + "-" + std::to_string(first_vertex + b);
  switch (kind) {
    case Kind::kNone:
      return "";
    case Kind::kOneFace:
      return edge + " belongs to one face only";
    case Kind::kManyFaces:
      return edge + " belongs to " + std::to_string(n) + " faces";
    case Kind::kNoOrientation:
      return "at " + edge + " the faces cannot all face outward";
    case Kind::kFlat:
      return "its volume is 0";
    case Kind::kConcaveEdge:
      return edge + " is hollow";
    case Kind::kOutside:
      return "vertex " + std::to_string(first_vertex + a) + " lies outside the plane of triangle " +
             std::to_string(first_triangle + n);
    case Kind::kLarge:
      return "too large to be tested for convexity";
    case Kind::kWound:
      return "it surrounds its inside more than once";
    case Kind::kMoved:
      return "a skin or morph targets move its vertices";
  }
  return "";
}

std::vector<std::uint32_t> weld(const std::vector<float>& positions, std::vector<glm::dvec3>& unique) {
  const std::size_t n = positions.size() / 3;
  std::size_t capacity = 16;
  while (capacity < 2 * n) capacity *= 2;
  constexpr std::uint32_t kEmpty = 0xffffffffu;
  std::vector<std::uint32_t> table(capacity, kEmpty);
  std::vector<std::uint32_t> number(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    std::array<float, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = positions[3 * i + k] + 0.0f;  // -0 becomes 0
      std::uint32_t bits = 0;
      std::memcpy(&bits, &p[k], sizeof bits);
      hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
      hash ^= hash >> 32;
    }
    const glm::dvec3 wanted{p[0], p[1], p[2]};
    std::size_t slot = hash & (capacity - 1);
    const auto same = [&wanted](const glm::dvec3& q) { return q.x == wanted.x && q.y == wanted.y && q.z == wanted.z; };
    while (table[slot] != kEmpty && !same(unique[table[slot]])) slot = (slot + 1) & (capacity - 1);
    if (table[slot] == kEmpty) {
      table[slot] = static_cast<std::uint32_t>(unique.size());
      unique.push_back(wanted);
    }
    number[i] = table[slot];
  }
  return number;
}

Topology analyse(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles,
                 std::uint64_t& budget) {
  return Analysis(positions, triangles, budget).run();
}

}  // namespace kage::scene
