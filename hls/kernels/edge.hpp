// SPDX-License-Identifier: Apache-2.0
//
// An edge on its way down, as the kernels have it.
#pragma once

#include "types.hpp"

namespace kage::hls {

using Subpixel = hw::s<24>;  ///< a snapped coordinate, 16.8, within +-(2^15 - 1) pixels
using Line = hw::u<15>;      ///< of a picture

constexpr int kRestBits = 24;
using Rest = hw::u<kRestBits>;  ///< a remainder below an edge's height in subpixels

/// An edge at a line that it crosses.
struct Edge {
  using Pixels = hw::s<17>;
  Pixels x;        ///< first pixel whose centre lies at or right of the crossing
  Pixels step;     ///< whole pixels from line to line, rounded down
  Rest rest;       ///< remainder of x: 256ths of it do not matter
  Rest rest_step;  ///< remainder of the step
  Rest dy;         ///< height in subpixels: a remainder that reaches it is a pixel
};

}  // namespace kage::hls
