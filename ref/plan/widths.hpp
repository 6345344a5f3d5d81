// SPDX-License-Identifier: Apache-2.0
//
// The least widths that keep the limits: each follows from an inequality, which its reason prints (docs/plan.md,
// docs/numbers.md). Widths are rounded up to steps, so that plans of scenes that are much alike share an RTL model.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kage/plan.hpp"
#include "plan/demand.hpp"

namespace kage::plan {

/// The next step at or above `least`, of X_BITS and Z_FRAC: 8, 11, 12, 15. Past the last: `least`.
int position_step(int least);
/// The next step of Z_BITS, COLOR_FRAC and SHADE_FRAC: a multiple of four.
int four_step(int least);
/// The next step of MAX_WIDTH: the least width at or above `least` that a named configuration has; `least` past the
/// widest.
int width_step(int least);
/// The next step of CLASS_BITS: 4, 8, 11.
int class_step(int least);

/// The least LINEAR_BITS that is not 0.
int least_linear_bits();

/// Bound of a stored depth's error in steps of Z_BITS bits, after `pixels` pixels of a span, in a picture of this size.
/// It is the sum of these:
/// - the rounding of the start and, at every pixel, of the slope: half a step of the fraction, 2^-(Z_FRAC + 1), each,
/// - half a step for the integer part, if there is a fraction,
/// - the rounding of plane and vertices (docs/numbers.md, "Depth").
double depth_error(double pixels, int z_frac, int width, int height);

/// The same as a share of the depth range, which has 2^Z_BITS - 3 steps.
double depth_error_share(double pixels, int z_bits, int z_frac, int width, int height);

/// Bound of a colour's error before its first rounding, in steps of 8 bits, after `pixels` pixels.
double color_error(double pixels, int color_frac);

/// Whole steps by which a pixel may differ from exact arithmetic, if colours differ by `drawn` before their first
/// rounding and shares have `shade_frac` fraction bits.
double shown_error(double drawn, std::span<const ShareGroup> groups, int shade_frac);

/// Bound of the error of a colour to which lights are added one after the other, before it is displayed, in steps of 8
/// bits where the display's curve is steepest.
/// @param lights that are added
/// @param samples of all of them
/// @param pixels of the longest span that changes colour
double linear_error(double lights, double samples, double pixels, int linear_bits, int color_frac);

/// A configuration and why it has its values.
struct Widths {
  Config config;
  std::vector<PlanReason> reasons;  ///< of each parameter that a scene decides
  int color_limit = 1;              ///< as kept
  Most class_error;                 ///< of the classes that were taken
  double z_error = 0;               ///< bound of the depth's error, as a share of the range
};

/// Treatment of a limit that no width is sure to keep.
enum class Unkept : std::uint8_t {
  refuse,  ///< Error
  finest,  ///< the finest width is taken: the limit may be kept all the same, which pictures show
};

/// The widths, which do not depend on the arrangement, for a way to draw shadows.
Widths widths_of(std::span<const PlannedScene> scenes, const Features& features, const WayDemand& way,
                 const UnitDemand* units, const PlanLimits& limits, Unkept unkept);

}  // namespace kage::plan
