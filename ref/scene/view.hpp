// SPDX-License-Identifier: Apache-2.0
//
// The camera and the lights of a frame: the file's, or the default ones.
#pragma once

#include <vector>

#include "kage/scene.hpp"
#include "raw.hpp"

namespace kage::scene {

/// A ball that holds the scene in every frame.
struct Bounds {
  glm::dvec3 center{0, 0, 0};
  double radius = 1;
};

Bounds bounds_of(const std::vector<glm::dvec3>& points);

/// The file's camera. Throws Error (without a file's name) where its axes do not span a view.
Camera file_camera(const RawCamera& raw, const Affine& world, const Bounds& bounds);

/// Where the file has no camera: on a circle round the up axis (y), from slightly above, all of the ball in view at any
/// size at least as wide as high.
Camera orbit_camera(const Bounds& bounds, int index, int count);

Light file_light(const RawLight& raw, const Affine& world);

/// The factor that intensities are scaled by (Scene::load).
double exposure(const std::vector<Light>& lights, const Bounds& bounds);

/// Where the file has no light: directional, oblique, from above, at rest while the orbit turns.
Light default_light();

}  // namespace kage::scene
