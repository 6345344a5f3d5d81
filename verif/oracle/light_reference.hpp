// SPDX-License-Identifier: Apache-2.0
//
// The picture that kage's stated model of light asks for (docs/lights.md, "What a light sends where"), worked out at
// each pixel by itself in double precision. Each light, and each point of an area light, is there or hidden by rays;
// what arrives is added in linear light and encoded once. The scene goes in as it is loaded: places, normals, colours,
// lights. Nothing of kage's geometry, shading or tables does. Points of an area light are the caller's: those that kage
// samples, so that only their light is judged, or a grid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "kage/scene.hpp"
#include "oracle/ray_truth.hpp"

namespace kage::verif {

/// Ambient light, from everywhere and some more from above: constants of the model.
inline constexpr double kReferenceAmbient = 0.20;
inline constexpr double kReferenceSky = 0.08;

/// The sRGB transfer function of IEC 61966-2-1, as the standard has it.
inline double reference_encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// The light that one point of a light sends to a surface, linear: color, fall-off, range, cone and cosine.
inline glm::dvec3 reference_arrives(const Light& light, const LightPoint& at, const glm::dvec3& point,
                                    const glm::dvec3& normal) {
  if (at.directional) return light.color * std::max(0.0, -glm::dot(at.direction, normal));
  const glm::dvec3 to = at.position - point;
  const double d = std::sqrt(glm::dot(to, to));
  if (!(d > 0)) return glm::dvec3(0);
  double share = std::max(0.0, glm::dot(to, normal) / d);
  if (light.falls_off) {
    share /= d * d;
    if (light.range > 0) share *= std::clamp(1 - std::pow(d / light.range, 4), 0.0, 1.0);
  }
  if (light.spot) {
    const double cosine = -glm::dot(to, light.direction) / d;
    const double t = (cosine - light.outer_cosine) / std::max(0.001, light.inner_cosine - light.outer_cosine);
    share *= std::pow(std::clamp(t, 0.0, 1.0), 2);
  }
  return light.color * share;
}

/// Points that stand for a light in a reference: one, or a grid over its area.
/// @param side an area light has side * side of them; a ball has them over the disc that `from` sees
inline std::vector<LightPoint> reference_points(const Light& light, int side, const glm::dvec3& from) {
  std::vector<LightPoint> points;
  const LightPoint& middle = light;
  if (light.shape == LightShape::point || light.directional || side < 2) return {middle};
  glm::dvec3 u = light.axis_u;
  glm::dvec3 v = light.axis_v;
  if (light.shape == LightShape::sphere) {
    const double radius = light.axis_u.x;
    const glm::dvec3 to = light.position - from;
    const glm::dvec3 other = std::abs(to.x) < std::abs(to.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    u = glm::normalize(glm::cross(to, other)) * radius;
    v = glm::normalize(glm::cross(to, u)) * radius;
  }
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      LightPoint p = middle;
      const double a = (i + 0.5) / side;
      const double b = (k + 0.5) / side;
      if (light.shape == LightShape::rectangle) {
        p.position += u * (2 * a - 1) + v * (2 * b - 1);
      } else {
        const double turn = 2 * M_PI * (b + 0.5 * (i % 2) / side);
        p.position += u * (std::sqrt(a) * std::cos(turn)) + v * (std::sqrt(a) * std::sin(turn));
      }
      points.push_back(p);
    }
  return points;
}

/// A pixel of the reference.
struct ReferencePixel {
  std::uint32_t face = kNothing;  ///< of SceneFrame::polygons: what is seen
  glm::dvec3 color{0, 0, 0};      ///< displayed, 0 .. 255 a channel, not rounded
  std::vector<bool> hidden;       ///< each point of each light in turn: light of it would arrive, and is kept out
  bool shadowed = false;          ///< some point is hidden
  bool tie = false;               ///< a ray beside this one finds another face, or other points hidden
};

/// Refers to the frame and the rays.
template <class Rays>
class LightReference {
 public:
  /// Points of each light.
  using Points = std::vector<std::vector<LightPoint>>;

  /// `points`: of each of the frame's lights, those that shine: reference_points(), or kage's samples.
  LightReference(const SceneFrame& f, const Rays& rays, Points points, int width, int height)
      : f_(&f), rays_(&rays), points_(std::move(points)), width_(width), height_(height) {}

  /// The middle of a pixel.
  [[nodiscard]] ReferencePixel pixel(int x, int y) const { return along(pixel_ray(f_->camera, x, y, width_, height_)); }

  /// Likewise, and whether rays `off` of a pixel to each side of it see the same face and the same points of lights.
  [[nodiscard]] ReferencePixel pixel_with_ties(int x, int y, double off) const {
    ReferencePixel p = pixel(x, y);
    for (const auto& [dx, dy] : {std::pair{-off, -off}, {off, -off}, {-off, off}, {off, off}}) {
      const ReferencePixel q = along(moved(x, y, dx, dy));
      p.tie = q.face != p.face || q.hidden != p.hidden;
      if (p.tie) break;
    }
    return p;
  }

 private:
  [[nodiscard]] PixelRay moved(int x, int y, double dx, double dy) const {
    const PixelRay here = pixel_ray(f_->camera, x, y, width_, height_);
    const PixelRay right = pixel_ray(f_->camera, x + 1, y, width_, height_);
    const PixelRay down = pixel_ray(f_->camera, x, y + 1, width_, height_);
    return {here.origin + dx * (right.origin - here.origin) + dy * (down.origin - here.origin),
            here.direction + dx * (right.direction - here.direction) + dy * (down.direction - here.direction)};
  }

  /// Base colour and normal of a face at a point of it, the normal on the side of the eye.
  struct Surface {
    glm::dvec3 base;
    glm::dvec3 normal;
    glm::dvec3 of_plane;
  };

  [[nodiscard]] Surface surface(std::uint32_t face, const glm::dvec3& point, const glm::dvec3& direction) const {
    const Polygon& p = f_->polygons[face];
    const Triangle& t = f_->triangles[p.triangle];
    const glm::dvec3 a = f_->vertices[t.vertex[0]];
    const glm::dvec3 u = f_->vertices[t.vertex[1]] - a;
    const glm::dvec3 v = f_->vertices[t.vertex[2]] - a;
    glm::dvec3 n = glm::cross(u, v);
    const double nn = glm::dot(n, n);
    std::array<double, 3> part{1, 0, 0};  // a face of more corners looks alike at all of them
    if (p.count == 3 && nn > 0) {
      part[1] = glm::dot(glm::cross(point - a, v), n) / nn;
      part[2] = glm::dot(glm::cross(u, point - a), n) / nn;
      part[0] = 1 - part[1] - part[2];
    }
    Surface s{{0, 0, 0}, {0, 0, 0}, n / std::sqrt(nn)};
    for (std::size_t i = 0; i < 3; ++i) {
      s.base += f_->shading[t.shading[i]].color * part[i];
      s.normal += f_->shading[t.shading[i]].normal * part[i];
    }
    if (glm::dot(s.of_plane, direction) > 0) {
      s.of_plane = -s.of_plane;
      s.normal = -s.normal;
    }
    s.normal = glm::normalize(s.normal);
    return s;
  }

  [[nodiscard]] ReferencePixel along(const PixelRay& ray) const {
    ReferencePixel p;
    const auto [t, face] = rays_->nearest(ray.origin, ray.direction, f_->camera.near);
    p.face = face;
    if (face == kNothing) return p;
    const glm::dvec3 point = ray.origin + t * ray.direction;
    const Surface s = surface(face, point, ray.direction);
    if (f_->triangles[f_->polygons[face].triangle].unlit) {
      p.color = encoded(s.base);
      return p;
    }
    const double dark = kReferenceAmbient + kReferenceSky * 0.5 * (1 + glm::dot(s.normal, f_->camera.up));
    glm::dvec3 sum(dark);
    for (std::size_t l = 0; l < f_->lights.size(); ++l)
      for (const LightPoint& at : points_[l]) {
        const glm::dvec3 to = at.directional ? -at.direction : at.position - point;
        const bool before = glm::dot(to, s.of_plane) > 0;  // else the face has its back to it
        const glm::dvec3 arrives = reference_arrives(f_->lights[l], at, point, s.normal) * (1 - kReferenceAmbient) /
                                   static_cast<double>(points_[l].size());
        const bool shines = before && std::max({arrives.x, arrives.y, arrives.z}) > 0;
        p.hidden.push_back(shines && rays_->blocked(point, to, at.directional ? INFINITY : 1, face));
        p.shadowed = p.shadowed || p.hidden.back();
        if (shines && !p.hidden.back()) sum += arrives;
      }
    p.color = encoded(s.base * sum);
    return p;
  }

  static glm::dvec3 encoded(const glm::dvec3& linear) {
    return 255.0 * glm::dvec3(reference_encode(linear.x), reference_encode(linear.y), reference_encode(linear.z));
  }

  const SceneFrame* f_;
  const Rays* rays_;
  Points points_;
  int width_, height_;
};

/// How far a picture's colours are from the reference, in steps of 1/255, over pixels where the reference sees a face.
/// A picture that shows another face there is that far off, too; ties are left out.
struct LightError {
  std::uint64_t pixels = 0;    ///< that are compared: no background
  std::uint64_t shadowed = 0;  ///< of these, in some shadow
  std::uint64_t ties = 0;      ///< that are not compared
  double sum = 0;              ///< over the channels of those in shadow
  double worst = 0;            ///< of these
  double beyond = 0;           ///< the same sum without the half step that rounding to 8 bits may take
  double lit_sum = 0;          ///< over the channels of the others
  double lit_worst = 0;        ///< of these
  double squares = 0;          ///< over the channels of all

  [[nodiscard]] double mean() const { return shadowed > 0 ? sum / (3 * static_cast<double>(shadowed)) : 0; }
  /// The same without rounding to 8 bits.
  [[nodiscard]] double mean_beyond() const { return shadowed > 0 ? beyond / (3 * static_cast<double>(shadowed)) : 0; }
  [[nodiscard]] double lit_mean() const {
    return pixels > shadowed ? lit_sum / (3 * static_cast<double>(pixels - shadowed)) : 0;
  }
  /// Peak signal to noise ratio in dB.
  [[nodiscard]] double psnr() const {
    return squares > 0 ? 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(pixels) / squares) : INFINITY;
  }
};

/// The reference's picture, line by line. A snap moves what a pixel shows by half a subpixel of 1/256 pixel at most in
/// x and in y; rays `off` of a pixel around it tell where that may matter.
template <class Rays>
std::vector<ReferencePixel> reference_picture(const LightReference<Rays>& reference, int width, int height,
                                              double off = 1.0 / 128) {
  std::vector<ReferencePixel> picture;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) picture.push_back(reference.pixel_with_ties(x, y, off));
  return picture;
}

/// Holds a picture of RGB words (red in the lowest byte), line by line, against the reference's.
inline LightError compare_light(const std::vector<std::uint32_t>& picture,
                                const std::vector<ReferencePixel>& reference) {
  LightError e;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const ReferencePixel& p = reference[i];
    if (p.tie) ++e.ties;
    if (p.tie || p.face == kNothing) continue;
    ++e.pixels;
    e.shadowed += p.shadowed ? 1 : 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::abs((picture[i] >> (8 * k) & 255U) - p.color[k]);
      (p.shadowed ? e.sum : e.lit_sum) += d;
      if (p.shadowed) e.beyond += std::max(0.0, d - 0.5);
      double& worst = p.shadowed ? e.worst : e.lit_worst;
      worst = std::max(worst, d);
      e.squares += d * d;
    }
  }
  return e;
}

}  // namespace kage::verif
