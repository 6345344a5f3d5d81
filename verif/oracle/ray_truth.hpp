// SPDX-License-Identifier: Apache-2.0
//
// The truth about an unsnapped scene by rays, in double precision, through a tree of boxes. It is the surface that a
// pixel's centre sees, and whether a face other than its own stands between it and the light. Nothing of kage's
// geometry goes in. Where the picture differs, the oracle says whether moving every snapped vertex by half a step of
// the snap can make the rays' answer of kage's geometry; if not, the picture is wrong.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oracle/judge.hpp"

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

/// The "face" of a pixel that shows the background.
inline constexpr std::uint32_t kNothing = 0xFFFFFF;

struct RayCount {
  std::uint64_t pixels = 0;
  std::uint64_t lit = 0;       ///< pixels whose surface agrees and is lit
  std::uint64_t shadowed = 0;  ///< pixels whose surface agrees and is in shadow
  std::uint64_t near_surface = 0;
  std::uint64_t near_shadow = 0;
  std::uint64_t wrong_surface = 0;
  std::uint64_t wrong_shadow = 0;
  std::uint64_t wrong_rays = 0;  ///< rays in single precision that more exact ones put right
  std::string first_wrong;

  RayCount& operator+=(const RayCount& o) {
    pixels += o.pixels;
    lit += o.lit;
    shadowed += o.shadowed;
    near_surface += o.near_surface;
    near_shadow += o.near_shadow;
    wrong_surface += o.wrong_surface;
    wrong_shadow += o.wrong_shadow;
    wrong_rays += o.wrong_rays;
    if (first_wrong.empty()) first_wrong = o.first_wrong;
    return *this;
  }
  [[nodiscard]] bool good() const { return wrong_surface == 0 && wrong_shadow == 0; }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} pixels, {} lit, {} shadowed; surfaces near {} wrong {}, shadows near {} wrong {} {}", pixels,
                       lit, shadowed, near_surface, wrong_surface, near_shadow, wrong_shadow, first_wrong);
  }
};

/// A scene's frame for rays: every polygon as a fan of triangles, in a tree of boxes, so that most are passed by
/// quickly.
class RayScene {
 public:
  explicit RayScene(const SceneFrame& f) {
    for (std::uint32_t p = 0; p < f.polygons.size(); ++p) {
      opaque_.push_back(f.triangles[f.polygons[p].triangle].alpha == 255);
      const auto outline = f.outline(f.polygons[p]);
      for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        faces_.push_back({p, {f.vertices[outline[0]], f.vertices[outline[i]], f.vertices[outline[i + 1]]}});
    }
    if (!faces_.empty()) build(0, faces_.size());
  }

  /// The polygon that the line origin + t direction meets first from t = `least` on, and t; kNothing if there is none.
  /// If several are at one t, it is the first.
  [[nodiscard]] std::pair<double, std::uint32_t> nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                         double least) const {
    std::pair<double, std::uint32_t> found{INFINITY, kNothing};
    meet(origin, direction, [&](double t, std::uint32_t face) {
      if (t >= least) found = std::min(found, {t, face});
    });
    return found;
  }

  /// Whether an opaque polygon other than `own` crosses the line at 0 < t < reach.
  [[nodiscard]] bool blocked(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                             std::uint32_t own) const {
    return any(origin, direction,
               [&](double t, std::uint32_t face) { return face != own && opaque_[face] && t > 0 && t < reach; });
  }

  /// Calls hit(t, polygon) for every triangle of a polygon that the line origin + t direction meets, in no order.
  template <typename Hit>
  void meet(const glm::dvec3& origin, const glm::dvec3& direction, Hit&& hit) const {
    any(origin, direction, [&](double t, std::uint32_t face) { return hit(t, face), false; });
  }

  /// Likewise, each triangle by itself, without the tree: to hold the tree against.
  template <typename Hit>
  void meet_each(const glm::dvec3& origin, const glm::dvec3& direction, Hit&& hit) const {
    for (const Face& face : faces_)
      meets(face, origin, direction, [&](double t, std::uint32_t p) { return hit(t, p), false; });
  }

 private:
  static double dot2(const glm::dvec3& v) { return glm::dot(v, v); }

  /// Whether a triangle that the line meets is what is looked for: looks_for(t, polygon). The rest is not asked then.
  template <typename LooksFor>
  bool any(const glm::dvec3& origin, const glm::dvec3& direction, LooksFor&& looks_for) const {
    for (std::size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      if (!node.met_by(origin, direction)) {
        i = node.past;
        continue;
      }
      for (std::size_t k = node.first; k < node.first + node.count; ++k)
        if (meets(faces_[k], origin, direction, looks_for)) return true;
      ++i;
    }
    return false;
  }

  struct Face {
    std::uint32_t polygon = 0;
    std::array<glm::dvec3, 3> corner{};
    [[nodiscard]] glm::dvec3 middle() const { return (corner[0] + corner[1] + corner[2]) / 3.0; }
  };

  /// A ball and a box round faces, both a little too large, so that rounding passes by none. Nodes stand in the order
  /// in which they are visited.
  struct Node {
    glm::dvec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    std::size_t past = 0;              // the next node if the line passes this one by
    std::size_t first = 0, count = 0;  // of its own faces; none if it has nodes below it

    [[nodiscard]] bool met_by(const glm::dvec3& origin, const glm::dvec3& direction) const {
      const glm::dvec3 centre = (low + high) * 0.5;
      const glm::dvec3 to = centre - origin;
      const double d2 = dot2(direction);
      const double along = glm::dot(to, direction);
      const double radius2 = dot2(high - centre);
      if (dot2(to) * d2 - along * along > radius2 * d2 * 1.0001 + 1e-9 * dot2(to) * d2) return false;
      double from = -INFINITY;
      double until = INFINITY;
      for (int k = 0; k < 3; ++k) {
        const double slack = 1e-9 * (std::abs(low[k]) + std::abs(high[k]) + std::abs(origin[k])) + 1e-300;
        const double a = low[k] - slack - origin[k];
        const double b = high[k] + slack - origin[k];
        if (direction[k] == 0) {
          if (a > 0 || b < 0) return false;
          continue;
        }
        from = std::max(from, std::min(a / direction[k], b / direction[k]));
        until = std::min(until, std::max(a / direction[k], b / direction[k]));
      }
      return from <= until;
    }
  };

  /// Whether the line meets the triangle, and looks_for(t, polygon).
  template <typename LooksFor>
  static bool meets(const Face& face, const glm::dvec3& origin, const glm::dvec3& direction, LooksFor&& looks_for) {
    const glm::dvec3 n = glm::cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
    const double nd = glm::dot(n, direction);
    if (nd == 0) return false;
    // Inside if the direction passes all three edges on the same side.
    const auto side = [&](std::size_t a, std::size_t b) {
      return glm::dot(direction, glm::cross(face.corner[a] - origin, face.corner[b] - origin));
    };
    const double s0 = side(0, 1);
    const double s1 = side(1, 2);
    const double s2 = side(2, 0);
    return ((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0)) &&
           looks_for(glm::dot(n, face.corner[0] - origin) / nd, face.polygon);
  }

  /// The node of the faces begin .. end - 1, and those below it: halves by their middles along the longest side.
  void build(std::size_t begin, std::size_t end) {
    constexpr std::size_t kLeaf = 4;
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t i = begin; i < end; ++i)
      for (const glm::dvec3& c : faces_[i].corner)
        for (int k = 0; k < 3; ++k) {
          nodes_[at].low[k] = std::min(nodes_[at].low[k], c[k]);
          nodes_[at].high[k] = std::max(nodes_[at].high[k], c[k]);
        }
    if (end - begin <= kLeaf) {
      nodes_[at].first = begin;
      nodes_[at].count = end - begin;
    } else {
      const glm::dvec3 size = nodes_[at].high - nodes_[at].low;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const std::size_t half = begin + (end - begin) / 2;
      const auto place = [&](std::size_t i) { return faces_.begin() + static_cast<std::ptrdiff_t>(i); };
      std::nth_element(place(begin), place(half), place(end),
                       [axis](const Face& a, const Face& b) { return a.middle()[axis] < b.middle()[axis]; });
      build(begin, half);
      build(half, end);
    }
    nodes_[at].past = nodes_.size();
  }

  std::vector<Face> faces_;
  std::vector<Node> nodes_;
  std::vector<bool> opaque_;  // by polygon
};

/// Whether moving each vertex by half a `step` in x and in y can change which way a polygon faces. A thin face of a
/// polyhedron that the snap alone turned away is not drawn, and may yet be what a ray sees.
inline bool either_way(std::span<const ScreenVertex> outline, std::int64_t step) {
  const std::size_t n = outline.size();
  std::int64_t area = 0;   // twice
  std::int64_t moves = 0;  // twice as far as it can change: by its corners one at a time, and by two that move at once
  for (std::size_t i = 0; i < n; ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[(i + 1) % n];
    const ScreenVertex& c = outline[(i + 2) % n];
    area += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
    moves += (std::abs(std::int64_t{c.x} - a.x) + std::abs(std::int64_t{c.y} - a.y) + step) * step;
  }
  return 2 * std::abs(area) <= moves;
}

/// Whether moving each vertex by half a `step` can bring an edge of a polygon to the centre of pixel (x, y). Where a
/// ray passes a closed body's outline it meets, at one depth, a face that is drawn and one that is turned away.
inline bool at_outline(std::span<const ScreenVertex> outline, int x, int y, std::int64_t step) {
  const std::int64_t px = 256 * std::int64_t{x} + 128;
  const std::int64_t py = 256 * std::int64_t{y} + 128;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[(i + 1) % outline.size()];
    const std::int64_t bx = b.x - std::int64_t{a.x};
    const std::int64_t by = b.y - std::int64_t{a.y};
    const std::int64_t side = bx * (py - a.y) - by * (px - a.x);
    // The edge's vector moves by a whole step, its start by half of one; the last term is both at once.
    const std::int64_t moves =
        (2 * (std::abs(px - a.x) + std::abs(py - a.y)) + std::abs(bx) + std::abs(by) + 2 * step) * step;
    const auto within = [step](std::int64_t p, std::int64_t u, std::int64_t v) {
      return p >= std::min(u, v) - step && p <= std::max(u, v) + step;
    };
    if (2 * std::abs(side) <= moves && within(px, a.x, b.x) && within(py, a.y, b.y)) return true;
  }
  return false;
}

/// Whether moving vertices lets pixel (x, y) show the face, or nothing if it is kNothing. The oracle is at line y.
inline bool possible_face(const Oracle& oracle, const FrameGeometry& g, int x, int y, std::uint32_t face) {
  if (face == kNothing) return oracle.possible_surface(x, -1, Errors::depth_and_snap);
  for (std::uint32_t i = 0; i < g.polygons.size(); ++i) {
    if (g.polygons[i].source != face) continue;
    const auto outline = g.outline(g.polygons[i]);
    if (i >= g.drawn && !either_way(outline, snap_step(g)) && !at_outline(outline, x, y, snap_step(g))) continue;
    if (oracle.possible_surface(x, static_cast<std::int32_t>(i), Errors::depth_and_snap)) return true;
  }
  return false;
}

/// Whether what the ray meets first is kept from the light.
inline bool exact_shadow(const RayScene& rays, const glm::dvec3& origin, const glm::dvec3& direction, double near,
                         const LightPoint& light) {
  const auto [t, face] = rays.nearest(origin, direction, near);
  const glm::dvec3 point = origin + t * direction;
  return rays.blocked(point, light.directional ? -light.direction : light.position - point,
                      light.directional ? INFINITY : 1, face);
}

/// The golden core's pictures of `whole` by what a pixel shows: the number of its polygon, or kNothing, and 0 where it
/// is in shadow.
struct RayPictures {
  std::vector<std::uint32_t> seen;
  std::vector<std::uint32_t> shadow;
};

inline RayPictures ray_pictures(const FrameGeometry& whole, const Config& config) {
  RayPictures pictures;
  FrameGeometry g = whole;
  g.background = kNothing;
  g.shade = 0;
  for (std::uint32_t i = 0; i < g.drawn; ++i) {
    g.polygons[i].lit = true;
    for (unsigned c = 0; c < 3; ++c) g.polygons[i].color[c] = static_cast<std::uint8_t>(i >> (8 * c));
  }
  pictures.seen = draw(g, config);
  g.shade = 1U << config.shade_frac;
  g.background = 0x808080;
  for (std::uint32_t i = 0; i < g.drawn; ++i) g.polygons[i].color = {255, 255, 255};
  pictures.shadow = draw(g, config);
  return pictures;
}

/// The ray through the middle of a pixel. Its direction has length 1 along forward: t is the distance that the near
/// plane is measured in.
struct PixelRay {
  glm::dvec3 origin;
  glm::dvec3 direction;
};

inline PixelRay pixel_ray(const Camera& camera, int x, int y, int width, int height) {
  const double unit = 2 * camera.half_height / height;
  const glm::dvec3 across =
      camera.right * ((x + 0.5 - width / 2.0) * unit) + camera.up * ((height / 2.0 - y - 0.5) * unit);
  return {camera.perspective ? camera.eye : camera.eye + across,
          camera.perspective ? camera.forward + across : camera.forward};
}

/// Compares the golden core's picture of `whole`, made from frame `f`, with rays through `f`, which `rays` follows, at
/// every `step`th pixel of every `step`th line. Where the picture differs, is no near tie, and `exact`, if given, says
/// what the picture says, the rays were wrong.
template <class Rays>
RayCount compare_with_rays(const SceneFrame& f, const FrameGeometry& whole, const Config& config, const Rays& rays,
                           int step = 1, const RayScene* exact = nullptr) {
  const int width = whole.width;
  const int height = whole.height;
  const auto [seen, shadow] = ray_pictures(whole, config);
  const Camera& camera = f.camera;
  Oracle oracle(whole, config);
  RayCount count;
  for (int y = 0; y < height; y += step) {
    oracle.line(y);
    for (int x = 0; x < width; x += step) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      ++count.pixels;
      const auto [origin, direction] = pixel_ray(camera, x, y, width, height);
      const auto [nearest, surface] = rays.nearest(origin, direction, camera.near);
      const auto polygon = seen[at] == kNothing ? -1 : static_cast<std::int32_t>(seen[at]);
      const std::uint32_t shown = polygon < 0 ? kNothing : whole.polygons[static_cast<std::uint32_t>(polygon)].source;
      if (shown != surface) {
        // Both answers must be possible: what the geometry cannot show is no near tie, though the rays' answer is one
        // that it can.
        if (oracle.possible_surface(x, polygon, Errors::depth_and_snap) &&
            possible_face(oracle, whole, x, y, surface)) {
          ++count.near_surface;
        } else if (exact != nullptr && exact->nearest(origin, direction, camera.near).second == shown) {
          ++count.wrong_rays;
        } else {
          ++count.wrong_surface;
          if (count.first_wrong.empty())
            count.first_wrong = fmt::format("({}, {}): face {} for {}", x, y, shown, surface);
        }
        continue;
      }
      // A face seen from its unlit side is not lit anyway: nothing to compare, as the core darkens only what is lit.
      if (polygon < 0 || !whole.polygons[static_cast<std::uint32_t>(polygon)].lit) continue;
      const glm::dvec3 point = origin + nearest * direction;
      const glm::dvec3 to_light = f.lights[0].directional ? -f.lights[0].direction : f.lights[0].position - point;
      const double reach = f.lights[0].directional ? INFINITY : 1;
      const bool blocked = rays.blocked(point, to_light, reach, surface);
      if ((shadow[at] == 0) == blocked) {
        ++(blocked ? count.shadowed : count.lit);
        continue;
      }
      const PossibleShadow possible =
          oracle.possible_shadow(x, static_cast<std::uint32_t>(polygon), Errors::depth_and_snap);
      if (possible.shadowed && possible.lit) {
        ++count.near_shadow;
      } else if (exact != nullptr && exact_shadow(*exact, origin, direction, camera.near, f.lights[0]) != blocked) {
        ++count.wrong_rays;
      } else {
        ++count.wrong_shadow;
        if (count.first_wrong.empty())
          count.first_wrong =
              fmt::format("({}, {}): face {}, shadow {} for {}", x, y, surface, shadow[at] == 0, blocked);
      }
    }
  }
  return count;
}

inline RayCount compare_with_rays(const SceneFrame& f, const FrameGeometry& whole, const Config& config, int step = 1) {
  return compare_with_rays(f, whole, config, RayScene(f), step);
}

inline RayCount compare_with_rays(const SceneFrame& f, int width, int height, int step = 1, Config config = {}) {
  config.max_width = std::max(config.max_width, width);
  return compare_with_rays(f, make_geometry(f, config, width, height), config, step);
}

}  // namespace kage::verif
