// SPDX-License-Identifier: Apache-2.0
//
// The camera and the lights of a frame: the file's, or the default ones.
#pragma once

#include <vector>

#include "kage/scene.hpp"
#include "raw.hpp"
#include "working_frame.hpp"

namespace kage::scene {

/// A ball that holds the scene in every frame.
struct Bounds {
  glm::dvec3 center{0, 0, 0};
  double radius = 1;
};

Bounds bounds_of(const std::vector<glm::dvec3>& points);

/// The file's camera, in the working frame, which `world` and `bounds` are in. Throws Error (without a file's name)
/// where its axes do not span a view.
Camera file_camera(const RawCamera& raw, const Affine& world, const Bounds& bounds, const WorkingFrame& frame);

/// Where the file has no camera: on a circle round the up axis (y), from slightly above, all of the ball in view at any
/// size at least as wide as high.
Camera orbit_camera(const Bounds& bounds, int index, int count);

/// The file's light, in the working frame. Where some lights fall off with the square of the distance and others do
/// not, the ratio of their intensities is that in the file's unit: see relative_intensities().
Light file_light(const RawLight& raw, const Affine& world, const WorkingFrame& frame);

/// Scales intensities, by one factor for all, so that a light that falls off has its intensity at distance 1 of the
/// working frame. No factor is above 1.
void relative_intensities(std::vector<Light>& lights, const WorkingFrame& frame);

/// The factor that intensities are scaled by (Scene::load).
double exposure(const std::vector<Light>& lights, const Bounds& bounds);

/// Whether a light may shine on anything in the ball: no if it is black, or its range or cone ends before that. A
/// little further than it does counts, too, and so does one so far that geometry refuses it.
bool may_reach(const Light& light, const Bounds& bounds);

/// Where the file has no light: directional, oblique, from above, at rest while the orbit turns.
Light default_light();

}  // namespace kage::scene
