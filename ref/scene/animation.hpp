// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "raw.hpp"
#include "working_frame.hpp"

namespace kage::scene {

/// Value of a track of a node's place at a time: before the first key the first, after the last the last. Rotations
/// come normalised, as x, y, z, w; linear ones turn by slerp, cubic ones as glTF says.
std::array<double, 4> sample(const RawTrack& track, double time);

/// Weights of the morph targets of a node's mesh at a time.
std::vector<double> morph_weights(const RawScene& scene, std::uint32_t node, double time);

/// Object-to-world map of every node at a time, in the working frame.
std::vector<Affine> pose(const RawScene& scene, double time, const WorkingFrame& frame = {});

/// Time of the last key of all tracks, at least the start.
double end_time(const RawScene& scene);

}  // namespace kage::scene
