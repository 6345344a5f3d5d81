// SPDX-License-Identifier: Apache-2.0
//
// Frames drawn from geometry to pixels, without words between.
#pragma once

#include <functional>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Whether draw_frame() draws for a configuration: one with a compare tree is drawn by words.
[[nodiscard]] inline bool draws(const Config& config) { return config.units == 0; }

/// Draws a frame: the pixels of make_frame()'s words in a GoldenCore, bit for bit. Throws Error as make_frame(), and
/// where lines are longer than MAX_WIDTH.
/// @param geometry made for this configuration
/// @param config one that it draws for
/// @param threads at most; 0: one per processor. No pixel depends on it
/// @param start called before anything is drawn; what it throws goes through
/// @param sink gets the lines from the top; what it throws goes through
/// @return whether anything covers the centre of a pixel
bool draw_frame(const FrameGeometry& geometry, const Config& config, int threads, const std::function<void()>& start,
                const LineSink& sink);

}  // namespace kage
