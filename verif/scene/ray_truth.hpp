// SPDX-License-Identifier: Apache-2.0
//
// What rays say of an unsnapped scene, in double precision and by brute force: the surface that a pixel's centre sees,
// and whether a face other than its own stands between it and the light. Pixels whose ray passes an edge, or a second
// surface, closer than the snap and the depth errors reach are left out and counted.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "scene/judge.hpp"

namespace kage::verif {

/// True if the centre of pixel (x, y) lies within `subpixels` of an edge of some volume face, drawn polygon or near
/// cap.
inline bool near_volume_edge(const FrameGeometry& g, int x, int y, double subpixels) {
  const double px = 256.0 * x + 128;
  const double py = 256.0 * y + 128;
  const auto close = [&](const ScreenVertex& a, const ScreenVertex& b) {
    const double ex = b.x - a.x;
    const double ey = b.y - a.y;
    const double n = ex * ex + ey * ey;
    const double t = n > 0 ? std::clamp(((px - a.x) * ex + (py - a.y) * ey) / n, 0.0, 1.0) : 0;
    const double dx = a.x + t * ex - px;
    const double dy = a.y + t * ey - py;
    return dx * dx + dy * dy <= subpixels * subpixels;
  };
  for (const ScreenPolygon& p : g.polygons) {
    const auto outline = g.outline(p);
    for (std::size_t i = 0; i < outline.size(); ++i)
      if (close(outline[i], outline[(i + 1) % outline.size()])) return true;
  }
  for (const NearEdge& e : g.near_edges)
    if (close(e.from, e.to)) return true;
  return false;
}

struct RayCount {
  std::uint64_t pixels = 0;
  std::uint64_t skipped = 0;
  std::uint64_t lit = 0;
  std::uint64_t shadowed = 0;
  std::uint64_t wrong_surface = 0;
  std::uint64_t wrong_shadow = 0;
  std::string first_wrong;

  RayCount& operator+=(const RayCount& o) {
    pixels += o.pixels;
    skipped += o.skipped;
    lit += o.lit;
    shadowed += o.shadowed;
    wrong_surface += o.wrong_surface;
    wrong_shadow += o.wrong_shadow;
    if (first_wrong.empty()) first_wrong = o.first_wrong;
    return *this;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} pixels, {} left out, {} lit, {} shadowed; wrong surfaces {}, wrong shadows {} {}", pixels,
                       skipped, lit, shadowed, wrong_surface, wrong_shadow, first_wrong);
  }
};

/// Where a ray meets a triangle: distance in units of `direction`, and whether it passes within `margin` (share of the
/// triangle) of an edge.
struct RayHit {
  bool hit = false;
  bool doubtful = false;
  double t = 0;
};

inline RayHit meet(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c, double margin) {
  const glm::dvec3 e1 = b - a;
  const glm::dvec3 e2 = c - a;
  const glm::dvec3 n = glm::cross(e1, e2);
  const double along = glm::dot(n, direction);
  RayHit r;
  if (std::abs(along) < 1e-5 * glm::length(n) * glm::length(direction)) {
    // Nearly parallel: doubtful if the ray comes close at all.
    const double off = std::abs(glm::dot(n, origin - a)) / glm::length(n);
    r.doubtful = off < 0.05;
    return r;
  }
  r.t = glm::dot(n, a - origin) / along;
  const glm::dvec3 p = origin + r.t * direction - a;
  const double nn = glm::dot(n, n);
  const double v = glm::dot(glm::cross(p, e2), n) / nn;
  const double w = glm::dot(glm::cross(e1, p), n) / nn;
  const double u = 1 - v - w;
  const double least = std::min({u, v, w});
  r.hit = least >= 0;
  r.doubtful = std::abs(least) < margin;
  return r;
}

inline RayCount compare_with_rays(const SceneFrame& f, int width, int height) {
  const Config config;
  FrameGeometry g = make_geometry(f, config, width, height);
  const std::uint32_t nothing = 0xFFFFFF;
  g.background = nothing;
  g.shade = 0;
  for (std::uint32_t i = 0; i < g.drawn; ++i) {
    g.polygons[i].lit = true;
    for (unsigned c = 0; c < 3; ++c)
      g.polygons[i].color[c] = static_cast<std::uint8_t>(g.polygons[i].triangle >> (8 * c));
  }
  const auto seen = draw(g, config);
  g.shade = 1U << config.shade_frac;
  for (std::uint32_t i = 0; i < g.drawn; ++i) g.polygons[i].color = {255, 255, 255};
  const auto shadow = draw(g, config);

  const Camera& camera = f.camera;
  const double unit = 2 * camera.half_height / height;
  constexpr double kMargin =
      0.02;  // far more than half a subpixel of a 96 pixel wide picture on faces that cover some pixels
  RayCount count;
  std::size_t at = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++at) {
      ++count.pixels;
      const glm::dvec3 across =
          camera.right * ((x + 0.5 - width / 2.0) * unit) + camera.up * ((height / 2.0 - y - 0.5) * unit);
      const glm::dvec3 origin = camera.perspective ? camera.eye : camera.eye + across;
      const glm::dvec3 direction = camera.perspective ? camera.forward + across : camera.forward;
      double nearest = INFINITY;
      double second = INFINITY;
      std::uint32_t surface = nothing;
      bool doubtful = false;
      for (std::uint32_t t = 0; t < f.triangles.size(); ++t) {
        const auto& v = f.triangles[t].vertex;
        const RayHit h = meet(origin, direction, f.vertices[v[0]], f.vertices[v[1]], f.vertices[v[2]], kMargin);
        // direction has length 1 along forward, so t is the distance w.
        if (h.doubtful) doubtful = true;
        if (!h.hit) continue;
        if (std::abs(h.t - camera.near) < 1e-3) doubtful = true;
        if (h.t < camera.near) continue;
        if (h.t < nearest) {
          second = nearest;
          nearest = h.t;
          surface = t;
        } else {
          second = std::min(second, h.t);
        }
      }
      if (doubtful || second < nearest * 1.001) {
        ++count.skipped;
        continue;
      }
      if (seen[at] != surface) {
        ++count.wrong_surface;
        if (count.first_wrong.empty())
          count.first_wrong = fmt::format("({}, {}): triangle {} for {}", x, y, seen[at], surface);
        continue;
      }
      if (surface == nothing) continue;
      const glm::dvec3 point = origin + nearest * direction;
      const glm::dvec3 to_light = f.light.directional ? -f.light.direction : f.light.position - point;
      const double reach = f.light.directional ? INFINITY : 1;
      bool blocked = false;
      for (std::uint32_t t = 0; t < f.triangles.size(); ++t) {
        if (t == surface) continue;
        const auto& v = f.triangles[t].vertex;
        const RayHit h = meet(point, to_light, f.vertices[v[0]], f.vertices[v[1]], f.vertices[v[2]], kMargin);
        const double scale = glm::length(to_light);
        if (h.doubtful) doubtful = true;
        if (h.hit && (std::abs(h.t) * scale < 5e-3 || std::abs(h.t - reach) * scale < 5e-3)) doubtful = true;
        if (h.hit && h.t > 0 && h.t < reach) blocked = true;
      }
      // A face seen from its unlit side is not lit anyway: nothing to compare, as the core darkens only what is lit.
      const auto& own = f.triangles[surface].vertex;
      const glm::dvec3 n =
          glm::normalize(glm::cross(f.vertices[own[1]] - f.vertices[own[0]], f.vertices[own[2]] - f.vertices[own[0]]));
      const double light_side = glm::dot(n, glm::normalize(to_light));
      const bool lit = light_side * -glm::dot(n, direction) > 0;
      if (doubtful || !lit || std::abs(light_side) < 1e-3) {
        ++count.skipped;
        continue;
      }
      ++(blocked ? count.shadowed : count.lit);
      if ((shadow[at] == 0) != blocked) {
        ++count.wrong_shadow;
        if (count.first_wrong.empty())
          count.first_wrong =
              fmt::format("({}, {}): triangle {}, shadow {} for {}", x, y, surface, shadow[at] == 0, blocked);
      }
    }
  return count;
}

}  // namespace kage::verif
