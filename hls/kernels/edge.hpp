// SPDX-License-Identifier: Apache-2.0
//
// An edge on its way down, as the kernels have it: of coordinates with WHOLE integer bits, the sign among them, and
// FRAC fraction bits. A core has 16.8. Narrow ones are for a test that tries all edges there are.
#pragma once

#include "types.hpp"

namespace kage::hls {

template <int WHOLE, int FRAC>
using SubpixelOf = hw::s<WHOLE + FRAC>;  ///< a snapped coordinate, within +-(2^(WHOLE - 1) - 1) pixels
template <int WHOLE>
using LineOf = hw::u<WHOLE - 1>;  ///< of a picture
template <int WHOLE, int FRAC>
using RestOf = hw::u<WHOLE + FRAC>;  ///< a remainder below an edge's height in subpixels

/// An edge at a line that it crosses.
template <int WHOLE, int FRAC>
struct EdgeOf {
  using Pixels = hw::s<WHOLE + 1>;
  using Rest = RestOf<WHOLE, FRAC>;
  Pixels x;        ///< first pixel whose centre lies at or right of the crossing
  Pixels step;     ///< whole pixels from line to line, rounded down
  Rest rest;       ///< remainder of x: 256ths of it do not matter
  Rest rest_step;  ///< remainder of the step
  Rest dy;         ///< height in subpixels: a remainder that reaches it is a pixel
};

using Subpixel = SubpixelOf<16, 8>;
using Line = LineOf<16>;
using Edge = EdgeOf<16, 8>;

}  // namespace kage::hls
