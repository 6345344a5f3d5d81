// SPDX-License-Identifier: Apache-2.0
#include "geometry/check_input.hpp"

#include <fmt/format.h>

#include <cmath>

#include "contract/derived.hpp"
#include "kage/error.hpp"
#include "kage/light.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

// Largest ratio of a light's distance from the scene to the scene's size. With a light further off, a shadow's sides
// are more than 2^-12 of the scene away from their true place.
constexpr double kFurthestLight = 0x1p40;

void check_light(const Light& l, std::size_t number, const SpaceBox& scene) {
  const auto refuse = [number](const char* why) { throw Error(fmt::format("light {}: {}", number, why)); };
  if (!is_finite(l.color) || l.color.x < 0 || l.color.y < 0 || l.color.z < 0)
    refuse("its colour is negative or not finite");
  if ((l.directional || l.spot) && !(std::abs(squared(l.direction) - 1) < 1e-6))
    refuse("its direction is not of length 1");
  if (l.directional) return;
  if (!is_finite(l.position)) refuse("its position is not finite");
  if (!(l.range >= 0)) refuse("its range is negative or not a number");
  if (l.spot && !(l.inner_cosine <= 1 && l.inner_cosine >= l.outer_cosine && l.outer_cosine >= -1))
    refuse("its cone is not -1 <= outer cosine <= inner cosine <= 1");
  if (l.shape != LightShape::point && (!is_finite(l.axis_u) || !is_finite(l.axis_v))) refuse("its size is not finite");
  const double size = l.shape == LightShape::point ? 0 : length(l.axis_u) + length(l.axis_v);
  const double far = length(l.position - scene.low) + size;
  if (scene.diagonal() > 0 && !(far <= kFurthestLight * scene.diagonal()))
    refuse("it is further from the scene, or larger, than 2^40 times the scene's size: make it directional");
}

}  // namespace

void check_finite(const SceneFrame& frame) {
  SpaceBox box;
  for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
    if (!is_finite(frame.vertices[i])) throw Error(fmt::format("vertex {}: position is not finite", i));
    box.add(frame.vertices[i]);
  }
  const Camera& c = frame.camera;
  if (!is_finite(c.eye) || !is_finite(c.right) || !is_finite(c.up) || !is_finite(c.forward) || !(c.near > 0) ||
      !std::isfinite(c.near) || !(c.half_height > 0) || !std::isfinite(c.half_height))
    throw Error("the camera is not finite, or its near plane or field of view is not positive");
  if (frame.lights.empty() || frame.lights.size() > kMaxLights)
    throw Error(fmt::format("{} lights: there must be 1 .. {}", frame.lights.size(), kMaxLights));
  for (std::size_t i = 0; i < frame.lights.size(); ++i) check_light(frame.lights[i], i, box);
}

static_assert(kMaxSamples == derived::most_count(kGreatest) && kMaxClasses == derived::most_class(kGreatest));

void check_look(const Look& look) {
  if (look.samples < 1 || look.samples > kMaxSamples)
    throw Error(fmt::format("{} samples of a light: there must be 1 .. {}", look.samples, kMaxSamples));
  if (look.classes < 1 || look.classes > kMaxClasses)
    throw Error(fmt::format("{} classes of light: there must be 1 .. {}", look.classes, kMaxClasses));
  if (look.sub_bits < kLeastSubBits || look.sub_bits > kMostSubBits)
    throw Error(
        fmt::format("{} bits of a subpixel: there must be {} .. {}", look.sub_bits, kLeastSubBits, kMostSubBits));
  if (look.max_shading < 0 || look.max_shading > 255)
    throw Error(fmt::format("an error of shading of {}: it must be 0 .. 255", look.max_shading));
  if (look.darkening && !(*look.darkening >= 0 && *look.darkening <= 1)) throw Error("the darkening is not 0 .. 1");
  if (!(look.extrusion >= 1) || !std::isfinite(look.extrusion)) throw Error("the extrusion is not at least 1");
}

}  // namespace kage
