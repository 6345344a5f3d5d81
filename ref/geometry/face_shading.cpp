// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "contract/derived.hpp"
#include "geometry/facing.hpp"

namespace kage {

glm::dvec3 FaceShading::color_of(const Shaded& face, const SurfacePoint& at) const {
  if (face.unlit) return Lighting::displayed_unlit(at.base, config_->channels == 1);
  std::array<glm::dvec3, kMaxLights> arrive;
  const std::span<glm::dvec3> of_lights = std::span(arrive).first(lighting_->lights());
  const glm::dvec3 towards_eye = face.facing < 0 ? -at.normal : at.normal;
  lighting_->arriving(at.point, towards_eye, face.side.sides, face.side.eye_side, of_lights);
  glm::dvec3 light{0, 0, 0};
  for (const glm::dvec3& one : of_lights) light += one;
  return lighting_->displayed(towards_eye, at.base, light);
}

glm::dvec3 FaceShading::color_at(const Shaded& face, const glm::dvec3& place) const {
  return color_of(face, face.surface.at(place));
}

namespace {

constexpr double kWhiteLight = 256;

}  // namespace

FaceShading::Light FaceShading::light_at(const Shaded& face, const glm::dvec3& place) const {
  const SurfacePoint at = face.surface.at(place);
  Light light(1 + lighting_->lights(), glm::dvec3(0));
  if (face.unlit) {
    light[0] = kWhiteLight * lighting_->shown_of(at.base, glm::dvec3(1));
    return light;
  }
  std::array<glm::dvec3, kMaxLights> arrive;
  const std::span<glm::dvec3> of_lights = std::span(arrive).first(lighting_->lights());
  const glm::dvec3 towards_eye = face.facing < 0 ? -at.normal : at.normal;
  lighting_->arriving(at.point, towards_eye, face.side.sides, face.side.eye_side, of_lights);
  light[0] = kWhiteLight * lighting_->shown_of_ambient(towards_eye, at.base);
  for (std::size_t l = 0; l < of_lights.size(); ++l)
    if (face.before[l] > 0) light[1 + l] = kWhiteLight / face.before[l] * lighting_->shown_of(at.base, of_lights[l]);
  return light;
}

double FaceShading::difference(const Shaded& face, const Light& a, const Light& b) const {
  double most = 0;
  const auto compare = [&](double x, double y) {
    most = std::max(most, 255 * std::abs(srgb_encode(x / kWhiteLight) - srgb_encode(y / kWhiteLight)));
  };
  // A span's colour is at most white at a pixel.
  const auto of = [&](const Light& light, std::size_t l, int c) {
    return std::min(light[1 + l][c], kWhiteLight) * face.before[l];
  };
  for (int c = 0; c < 3; ++c) {
    double all_a = a[0][c];
    double all_b = b[0][c];
    compare(all_a, all_b);
    for (std::size_t l = 0; l < face.before.size(); ++l) {
      compare(a[0][c] + of(a, l, c), b[0][c] + of(b, l, c));
      all_a += of(a, l, c);
      all_b += of(b, l, c);
    }
    compare(all_a, all_b);
  }
  return most;
}

FaceShading::Shaded FaceShading::shade(std::uint32_t index, std::span<ClipPoint> corners) const {
  const Triangle& t = frame_->triangles[frame_->polygons[index].triangle];
  const double facing = facing_of(*frame_, t, normal_of(*frame_, t));
  Shaded s{FaceSide(*frame_, *lights_, index,
                    facing > 0   ? 1
                    : facing < 0 ? -1
                                 : 0),
           FaceSurface(*frame_, index),
           facing,
           t.unlit,
           false,
           false,
           false,
           0,
           {1, 1, 1},
           {0, 0, 0},
           false,
           {},
           false};
  s.linear = config_->linear_bits > 0 && (t.alpha == 255 || config_->translucency == 0);
  if (s.linear)
    for (std::size_t l = 0; l < lighting_->lights(); ++l)
      s.before.push_back(table_->shadows_itself(s.side) ? s.side.count(*lights_, l, 1) : lights_->points_of(l));
  s.lit = !t.unlit && s.side.takes_shadow(*lights_);
  s.classed = s.lit && config_->linear_bits == 0 && (t.alpha == 255 || config_->translucency == 0);
  if (s.classed) {
    const std::uint32_t number = table_->number(s.side);
    s.lit = number > 0;
    s.factor = table_->before_own_shadow(s.side, number);
    if (derived::has_table(*config_)) s.normal_class = number;
  }

  const bool by_place = !t.unlit && lighting_->depends_on_place(s.side.sides, s.side.eye_side);
  s.varies = by_place || !s.surface.alike();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // More corners than a triangle's share one look.
    const bool as_before = i > 0 && !by_place && (corners.size() > 3 || t.shading[i] == t.shading[i - 1]);
    if (as_before)
      corners[i].color = corners[i - 1].color;
    else
      corners[i].color = glm::min(color_of(s, s.surface.corner(i)) * s.factor, glm::dvec3(255));
    s.mean += corners[i].color;
  }
  s.same_color =
      std::all_of(corners.begin(), corners.end(), [&](const ClipPoint& c) { return c.color == corners[0].color; });
  s.mean = s.same_color ? corners[0].color : s.mean / static_cast<double>(corners.size());
  return s;
}

FaceShading::Place FaceShading::place(const Shaded& face, const glm::dvec3& at, const glm::dvec3& color) const {
  Place p{color, table_->loss_at(face.side, face.surface.at(at)), 0};
  p.normal_class = table_->nearest(p.loss);
  const glm::dvec3 asked = color * table_->about_own_shadow(face.side, p.normal_class);
  if (std::max({asked.x, asked.y, asked.z}) <= 255) return p;
  double least = error_of(face, p, p.normal_class).weighed();
  for (std::uint32_t number = 1; number <= table_->classes(); ++number)
    if (const double error = error_of(face, p, number).weighed(); error < least) {
      least = error;
      p.normal_class = number;
    }
  return p;
}

FaceShading::Error FaceShading::error_of(const Shaded& face, const Place& at, std::uint32_t number) const {
  const glm::dvec3 lost = at.color - glm::min(at.color, 255.0 / table_->about_own_shadow(face.side, number));
  return {table_->error_of(face.side, at.loss, number), std::max({lost.x, lost.y, lost.z})};
}

FaceShading::Part FaceShading::part(const Shaded& face, const std::array<const Place*, 3>& corners) const {
  Part p{face.normal_class, {1, 1, 1}, 0};
  if (!face.classed || !face.lit) return p;
  if (face.normal_class > 0) {
    double least = INFINITY;
    for (const Place* of : corners) {
      double sum = 0;
      double more = 0;
      for (const Place* at : corners) {
        const Error error = error_of(face, *at, of->normal_class);
        sum += error.weighed();
        if (of->normal_class != at->normal_class)
          more = std::max(more, error.most() - error_of(face, *at, at->normal_class).most());
      }
      if (sum >= least * (1 - 0x1p-20)) continue;  // the first, but for rounding
      least = sum;
      p.normal_class = of->normal_class;
      p.error = more;
    }
  }
  p.factor = table_->before_own_shadow(face.side, face.normal_class > 0 ? p.normal_class : 1);
  return p;
}

}  // namespace kage
