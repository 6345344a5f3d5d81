// SPDX-License-Identifier: Apache-2.0
#include "view.hpp"

#include <algorithm>
#include <cmath>

#include "functions.hpp"
#include "kage/error.hpp"

namespace kage::scene {
namespace {

constexpr double kOrbitStart = portable::kPi / 6;  // frame 0 stands to the right of the front, which faces +z
constexpr double kOrbitRise = 0.42;                // height over distance in the plane: looking down by 23 degrees
constexpr double kOrbitHalfHeight = 0.4;           // tangent of half the field of view: 44 degrees in all
constexpr double kMargin = 1.02;

// Near planes of files that give none, in radii of the scene: one tells depths apart where a scene's own size matters.
constexpr double kNearShare = 1.0 / 512;

// Right, up and forward from a direction and a hint of what is up.
void orient(Camera& camera, const glm::dvec3& forward, const glm::dvec3& up) {
  const glm::dvec3 none{0, 0, 0};
  camera.forward = unit(forward, none);
  camera.right = unit(cross(camera.forward, unit(up, none)), none);
  camera.up = cross(camera.right, camera.forward);
  if (camera.forward == none || camera.right == none) throw Error("the camera has no direction");
}

}  // namespace

Bounds bounds_of(const std::vector<glm::dvec3>& points) {
  if (points.empty()) return {};
  SpaceBox box;
  for (const glm::dvec3& p : points) box.add(p);
  Bounds b;
  b.center = box.low + (box.high - box.low) * 0.5;
  double square = 0;
  for (const glm::dvec3& p : points) square = std::max(square, squared(p - b.center));
  b.radius = square > 0 ? std::sqrt(square) : 1;
  return b;
}

Camera file_camera(const RawCamera& raw, const Affine& world, const Bounds& bounds, const WorkingFrame& frame) {
  Camera camera;
  camera.eye = world.point(raw.eye);
  orient(camera, world.vector(raw.forward), world.vector(raw.up));
  camera.perspective = raw.perspective;
  camera.half_height = raw.perspective ? raw.half_height : frame.length(raw.half_height);
  camera.near = raw.near > 0 ? frame.length(raw.near) : bounds.radius * kNearShare;
  camera.far = frame.length(raw.far) > camera.near ? frame.length(raw.far) : 0;
  camera.aspect = raw.aspect;
  return camera;
}

Camera orbit_camera(const Bounds& bounds, int index, int count) {
  const double angle = kOrbitStart + 2 * portable::kPi * index / count;
  const glm::dvec3 out = unit({portable::sin(angle), kOrbitRise, portable::cos(angle)}, {0, 0, 1});
  const double radius = bounds.radius * kMargin;
  // The ball touches the pyramid of view where radius / distance is the sine of half the angle.
  const double sine = kOrbitHalfHeight / std::sqrt(1 + kOrbitHalfHeight * kOrbitHalfHeight);
  const double distance = radius / sine;
  Camera camera;
  camera.eye = bounds.center + out * distance;
  orient(camera, -out, {0, 1, 0});
  camera.perspective = true;
  camera.half_height = kOrbitHalfHeight;
  camera.near = distance - radius;
  camera.far = 0;
  return camera;
}

Light file_light(const RawLight& raw, const Affine& world, const WorkingFrame& frame) {
  Light light = raw.light;
  light.direction = unit(world.vector(raw.light.direction), {0, -1, 0});
  light.position = world.point(raw.light.position);
  light.range = frame.length(light.range);
  light.axis_u = world.vector(raw.light.axis_u);
  light.axis_v = world.vector(raw.light.axis_v);
  if (light.shape == LightShape::sphere) light.axis_u = {length(light.axis_u), 0, 0};
  return light;
}

void relative_intensities(std::vector<Light>& lights, const WorkingFrame& frame) {
  if (frame.exponent == 0) return;
  const auto falling = std::count_if(lights.begin(), lights.end(), [](const Light& l) { return l.falls_off; });
  if (falling == 0 || static_cast<std::size_t>(falling) == lights.size()) return;
  // A distance is 2^exponent times as long in the file. The kind of lights that the scene's size favours stays as it
  // is.
  const bool large = frame.exponent > 0;
  const double factor = std::ldexp(1.0, -2 * std::abs(frame.exponent));
  for (Light& l : lights)
    if (l.falls_off == large) l.color *= factor;
}

double exposure(const std::vector<Light>& lights, const Bounds& bounds) {
  glm::dvec3 sum{0, 0, 0};
  for (const Light& l : lights) {
    // A light in the middle of the scene is judged from a little way off.
    const double distance = std::max(length(l.position - bounds.center), bounds.radius / 16);
    sum += l.falls_off ? l.color / (distance * distance) : l.color;
  }
  const double largest = std::max({sum.x, sum.y, sum.z});
  return largest > 0 && std::isfinite(1 / largest) ? 1 / largest : 1;
}

bool may_reach(const Light& light, const Bounds& bounds) {
  if (light.color == glm::dvec3{0, 0, 0}) return false;
  if (light.directional) return true;
  // Lights that are refused stay, and are.
  if (!is_finite(light.position) || !is_finite(light.color)) return true;
  const double radius = 1.001 * (bounds.radius + length(light.axis_u) + length(light.axis_v));
  const glm::dvec3 out = bounds.center - light.position;
  const double distance = length(out);
  if (!(distance < 0x1p40 * bounds.radius)) return true;
  if (light.falls_off && light.range > 0 && distance - radius >= light.range) return false;
  if (!light.spot || distance <= radius) return true;
  // The ball is seen within this angle from the light.
  const double half = std::asin(radius / distance);
  const double off = std::acos(std::clamp(dot(out, light.direction) / distance, -1.0, 1.0));
  return off - half < std::acos(std::clamp(light.outer_cosine, -1.0, 1.0)) + 0.001;
}

Light default_light() {
  Light light;
  light.directional = true;
  light.direction = glm::dvec3{-3, -6, -2} / 7.0;  // of length 1
  return light;
}

}  // namespace kage::scene
