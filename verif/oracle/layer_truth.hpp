// SPDX-License-Identifier: Apache-2.0
//
// The truth about translucent faces, by rays: all faces of the unsnapped scene that a pixel's ray meets, by brute force
// in double precision, sorted by distance and blended. Nothing of kage's geometry, order or core goes in. The picture's
// colours are numbers of faces, so that another order shows.
//
// Where the picture differs, rays a step of the snap away decide, because the snap moves what a pixel sees by less than
// that. If none of them sees what the picture shows, the picture is wrong.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "oracle/judge.hpp"

namespace kage::verif {

struct LayerCount {
  std::uint64_t pixels = 0;
  std::uint64_t layered = 0;  ///< pixels with two translucent layers or more
  std::uint64_t most = 0;     ///< layers of a pixel
  std::uint64_t near = 0;     ///< unlike, but moved vertices can make it so
  std::uint64_t wrong = 0;
  std::string first_wrong;

  LayerCount& operator+=(const LayerCount& o) {
    pixels += o.pixels;
    layered += o.layered;
    most = std::max(most, o.most);
    near += o.near;
    wrong += o.wrong;
    if (first_wrong.empty()) first_wrong = o.first_wrong;
    return *this;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} pixels, {} with layers, at most {}; near {} wrong {}{}{}", pixels, layered, most, near,
                       wrong, first_wrong.empty() ? "" : "; first: ", first_wrong);
  }
};

/// A colour that tells a face from any other.
inline std::array<std::uint8_t, 3> face_color(std::uint32_t face) {
  const std::uint32_t h = (face + 1) * 2654435761U;
  return {static_cast<std::uint8_t>(h >> 8), static_cast<std::uint8_t>(h >> 16), static_cast<std::uint8_t>(h >> 24)};
}

class LayerTruth {
 public:
  /// A face that a ray meets, or would meet if it were larger.
  struct Hit {
    std::uint32_t face;
    std::uint8_t alpha;
    double t;
  };

  /// `step`: snap_step() of the picture.
  LayerTruth(const SceneFrame& f, int width, int height, int step = 1)
      : f_(&f), width_(width), height_(height), step_(step) {
    for (std::uint32_t i = 0; i < f.polygons.size(); ++i) {
      const auto outline = f.outline(f.polygons[i]);
      for (std::size_t k = 1; k + 1 < outline.size(); ++k)
        pieces_.push_back({i, f.triangles[f.polygons[i].triangle].alpha, f.vertices[outline[0]], f.vertices[outline[k]],
                           f.vertices[outline[k + 1]]});
    }
  }

  /// The faces that the ray through a place of the picture, in pixels, meets, and, of `also`, those whose planes it
  /// meets.
  [[nodiscard]] std::vector<Hit> hits(double sx, double sy, const std::vector<std::uint32_t>& also = {}) const {
    const Camera& c = f_->camera;
    const double unit = 2 * c.half_height / height_;
    const glm::dvec3 across = c.right * ((sx - width_ / 2.0) * unit) + c.up * ((height_ / 2.0 - sy) * unit);
    const glm::dvec3 origin = c.perspective ? c.eye : c.eye + across;
    const glm::dvec3 direction = c.perspective ? c.forward + across : c.forward;
    std::vector<Hit> found;
    for (const Piece& p : pieces_) {
      const bool known = !found.empty() && found.back().face == p.face;  // by another of its pieces
      if (known) continue;
      const bool wanted = std::find(also.begin(), also.end(), p.face) != also.end();
      const double t = meet(p, origin, direction, wanted);
      if (t >= c.near) found.push_back({p.face, p.alpha, t});
    }
    return found;
  }

  /// The colour of these, and how many translucent ones are before what is opaque.
  [[nodiscard]] static std::uint32_t color(std::vector<Hit> hits, std::uint32_t background, std::size_t& layers) {
    double opaque = INFINITY;
    std::array<int, 3> color{static_cast<int>(background & 255U), static_cast<int>(background >> 8 & 255U),
                             static_cast<int>(background >> 16)};
    for (const Hit& h : hits)
      if (h.alpha == 255 && h.t < opaque) {
        opaque = h.t;
        color = number(h.face);
      }
    std::erase_if(hits, [&](const Hit& h) { return h.t >= opaque; });
    std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t > b.t; });
    layers = hits.size();
    for (const Hit& h : hits) {
      const auto over = number(h.face);
      for (std::size_t i = 0; i < 3; ++i)
        color[i] = static_cast<int>(std::lround((color[i] * (255 - h.alpha) + over[i] * h.alpha) / 255.0));
    }
    return static_cast<std::uint32_t>(color[0] | color[1] << 8 | color[2] << 16);
  }

  /// Whether moving every vertex by half a step can make pixel (x, y) show `shown`. Moved so, a face gains or loses no
  /// more than the parts within a step of its outline, each face for itself; and depths are those of a place within a
  /// step. Rays at some places meet all faces but those that are thinner than the rays are apart. A face that is seen
  /// nearly edge-on is so thin, and snapped, it may be a step wide. Its part within a step gives its depths, as its
  /// plane may have any there. Where a face is steep, its order among others changes between two such rays; those
  /// through the corners of its part within a step see it at its nearest and its furthest.
  [[nodiscard]] bool possible(int x, int y, std::uint32_t background, std::uint32_t shown) const {
    constexpr int kSide = 5;
    std::vector<glm::dvec2> places;
    for (int i = 0; i < kSide * kSide; ++i) places.emplace_back(place(x, i % kSide), place(y, i / kSide));
    std::vector<std::uint32_t> some;  // faces that some of the rays meet
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::vector<std::uint32_t> faces;
      for (const Hit& h : hits(places[i].x, places[i].y)) faces.push_back(h.face);
      for (const std::uint32_t f : faces)
        if (std::find(some.begin(), some.end(), f) == some.end()) some.push_back(f);
      if (i == 0) all = faces;
      std::erase_if(all, [&](std::uint32_t f) { return std::find(faces.begin(), faces.end(), f) == faces.end(); });
    }
    std::vector<std::uint32_t> unsure;
    for (const std::uint32_t f : some)
      if (std::find(all.begin(), all.end(), f) == all.end()) unsure.push_back(f);
    std::vector<Near> thin = within_a_step(x, y);
    for (const Near& n : thin) places.insert(places.end(), n.corners.begin(), n.corners.end());
    std::erase_if(thin, [&](const Near& n) { return std::find(some.begin(), some.end(), n.face) != some.end(); });
    if (unsure.size() + 2 * thin.size() > 12) return true;
    for (const glm::dvec2& at : places) {
      const std::vector<Hit> everything = hits(at.x, at.y, unsure);
      for (std::uint32_t without = 0; without < 1U << unsure.size(); ++without) {
        std::vector<Hit> left = everything;
        for (std::size_t k = 0; k < unsure.size(); ++k)
          if ((without >> k & 1U) != 0) std::erase_if(left, [&](const Hit& h) { return h.face == unsure[k]; });
        // Each thin face is not there, or at one of its depths: digits to the base of 4.
        for (std::uint32_t way = 0; way < 1U << 2 * thin.size(); ++way) {
          std::vector<Hit> met = left;
          for (std::size_t k = 0; k < thin.size(); ++k)
            if (const std::uint32_t digit = way >> 2 * k & 3U; digit > 0)
              met.push_back({thin[k].face, thin[k].alpha, std::lerp(thin[k].least, thin[k].most, (digit - 1) / 2.0)});
          std::size_t layers = 0;
          if (color(met, background, layers) == shown) return true;
        }
      }
    }
    return false;
  }

 private:
  /// A face within a step of a pixel's centre, with its part there: the least and the greatest distance, and the
  /// corners in pixels. The corners are moved a thousandth of the way to the part's middle, so that a ray there meets
  /// the face.
  struct Near {
    std::uint32_t face;
    std::uint8_t alpha;
    double least;
    double most;
    std::vector<glm::dvec2> corners;
  };

  [[nodiscard]] std::vector<Near> within_a_step(int x, int y) const {
    const Camera& c = f_->camera;
    const double unit = 2 * c.half_height / height_;
    const double step = step_ / 256.0;
    // The area between these sides, to the right of the first and so on, is seen within a step.
    const double left = (x + 0.5 - step - width_ / 2.0) * unit;
    const double right = left + 2 * step * unit;
    const double top = (height_ / 2.0 - (y + 0.5 - step)) * unit;
    const double bottom = top - 2 * step * unit;
    const auto scale = [&c](const glm::dvec3& p) { return c.perspective ? p.z : 1; };
    std::vector<Near> found;
    for (const Piece& piece : pieces_) {
      std::vector<glm::dvec3> part;
      for (const glm::dvec3& v : {piece.a, piece.b, piece.c}) {
        const glm::dvec3 d = v - c.eye;
        part.emplace_back(glm::dot(d, c.right), glm::dot(d, c.up), glm::dot(d, c.forward));
      }
      cut(part, [&](const glm::dvec3& p) { return p.z - c.near; });
      cut(part, [&](const glm::dvec3& p) { return p.x - left * scale(p); });
      cut(part, [&](const glm::dvec3& p) { return right * scale(p) - p.x; });
      cut(part, [&](const glm::dvec3& p) { return top * scale(p) - p.y; });
      cut(part, [&](const glm::dvec3& p) { return p.y - bottom * scale(p); });
      if (part.empty()) continue;
      const auto [least, most] =
          std::minmax_element(part.begin(), part.end(), [](const auto& p, const auto& q) { return p.z < q.z; });
      if (!found.empty() && found.back().face == piece.face) {
        found.back().least = std::min(found.back().least, least->z);
        found.back().most = std::max(found.back().most, most->z);
      } else {
        found.push_back({piece.face, piece.alpha, least->z, most->z, {}});
      }
      std::vector<glm::dvec2> seen;
      glm::dvec2 sum(0);
      for (const glm::dvec3& p : part) {
        seen.emplace_back(width_ / 2.0 + p.x / scale(p) / unit, height_ / 2.0 - p.y / scale(p) / unit);
        sum += seen.back();
      }
      const glm::dvec2 middle = sum / static_cast<double>(seen.size());
      for (const glm::dvec2& p : seen) found.back().corners.push_back(glm::mix(p, middle, 0.001));
    }
    return found;
  }

  /// Keeps the part of a convex outline where `distance` is not below 0.
  template <class Distance>
  static void cut(std::vector<glm::dvec3>& part, const Distance& distance) {
    std::vector<glm::dvec3> rest;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const glm::dvec3& p = part[i];
      const glm::dvec3& q = part[(i + 1) % part.size()];
      const double a = distance(p);
      const double b = distance(q);
      if (a >= 0) rest.push_back(p);
      if ((a >= 0) != (b >= 0)) rest.push_back(p + (q - p) * (a / (a - b)));
    }
    part = std::move(rest);
  }

  struct Piece {
    std::uint32_t face;
    std::uint8_t alpha;
    glm::dvec3 a, b, c;
  };

  // One of five places across a step to either side of the centre of pixel x.
  [[nodiscard]] double place(int x, int i) const { return x + 0.5 + (i - 2) * step_ / 512.0; }

  static std::array<int, 3> number(std::uint32_t face) {
    const auto c = face_color(face);
    return {c[0], c[1], c[2]};
  }

  // The distance, or NaN.
  static double meet(const Piece& p, const glm::dvec3& origin, const glm::dvec3& direction, bool anywhere) {
    const glm::dvec3 n = glm::cross(p.b - p.a, p.c - p.a);
    const double slope = glm::dot(n, direction);
    if (slope == 0) return NAN;
    const double t = glm::dot(n, p.a - origin) / slope;
    const glm::dvec3 at = origin + t * direction;
    const double u = glm::dot(n, glm::cross(p.b - p.a, at - p.a));
    const double v = glm::dot(n, glm::cross(p.c - p.b, at - p.b));
    const double w = glm::dot(n, glm::cross(p.a - p.c, at - p.c));
    return anywhere || (u >= 0 && v >= 0 && w >= 0) ? t : NAN;
  }

  const SceneFrame* f_;
  int width_;
  int height_;
  int step_;  // 1/256 pixel
  std::vector<Piece> pieces_;
};

/// The picture that the golden core makes of `g`, with the faces' numbers for colours and without shadows.
inline std::vector<std::uint32_t> draw_numbers(FrameGeometry g, const Config& config) {
  g.shade = 0;
  for (ScreenPolygon& p : g.polygons)
    if (p.source != ~0U) p.color = face_color(p.source);
  return draw(g, config);
}

/// Compares the golden core's picture of `g`, made from frame `f`, with rays through `f`, at every `step`th pixel of
/// every `step`th line.
inline LayerCount compare_layers(const SceneFrame& f, const FrameGeometry& g, const Config& config, int step = 1) {
  const auto picture = draw_numbers(g, config);
  const LayerTruth truth(f, g.width, g.height, snap_step(g));
  LayerCount count;
  for (int y = 0; y < g.height; y += step)
    for (int x = 0; x < g.width; x += step) {
      const std::uint32_t shown =
          picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(g.width) + static_cast<std::size_t>(x)];
      std::size_t layers = 0;
      const bool same = LayerTruth::color(truth.hits(x + 0.5, y + 0.5), g.background, layers) == shown;
      ++count.pixels;
      count.layered += layers > 1 ? 1 : 0;
      count.most = std::max<std::uint64_t>(count.most, layers);
      if (same) continue;
      const bool near = truth.possible(x, y, g.background, shown);
      ++(near ? count.near : count.wrong);
      if (!near && count.first_wrong.empty()) count.first_wrong = fmt::format("({}, {})", x, y);
    }
  return count;
}

}  // namespace kage::verif
