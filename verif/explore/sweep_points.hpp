// SPDX-License-Identifier: Apache-2.0
//
// Points that a sweep measures: configurations of the core, and looks, that differ from a base in one thing, in all, or
// in every combination of some (docs/sweep.md, "Axes").
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage::explore {

/// A configuration, and how a picture is drawn with it.
struct SweepPoint {
  std::string axis = "base";  ///< what makes it another than the base: an axis, "corner", "grid"
  std::string value = {};     ///< as a person writes it: "24", "320x240", "Z_BITS=12 SAMPLES=4"
  Config config;              ///< legal, and wide enough for the picture
  int width = 320;
  int height = 240;
  Look look;  ///< with Look::fit, so that what the configuration lacks is left out of the picture
};

/// All that decides a point's pictures, words and core, as text: two points with the same text are one.
std::string text_of(const SweepPoint& point);

/// How many samples a soft light has with this configuration: one where COUNT_BITS is too small, as Look::fit has it.
int samples_of(const SweepPoint& point);

/// An axis, and the values on it that are measured.
struct SweepAxis {
  std::string name;
  std::vector<std::string> values;
};

/// The names of all axes: the core's parameters, SUB_BITS, SAMPLES, CLASSES, MAX_SHADING, ORDER and SIZE.
std::vector<std::string> axis_names();

/// Reads "Z_BITS=12,16,20". Throws Error that names the axis, or says that there is none of the name. Values are read
/// by with().
SweepAxis parse_axis(const std::string& text);

/// The point with another value of an axis. Values that the new one needs go with it: SAMPLES raises COUNT_BITS,
/// COLOR_FRAC and MAX_SHADING set SMOOTH, SIZE raises MAX_WIDTH, LINEAR_BITS gives up the table. Values that lose their
/// ground are given up, as all of the shadows with DSF_BITS 0. Throws Error where the value is none of the axis.
SweepPoint with(const SweepPoint& base, std::string_view axis, const std::string& value);

/// Each value of each axis alone about the base, which is the first.
std::vector<SweepPoint> alone(const SweepPoint& base, std::span<const SweepAxis> axes);

/// Adds an axis; the values of one that is there already go to it.
void add_axis(std::vector<SweepAxis>& axes, SweepAxis axis);

/// Combinations of values.
struct Grid {
  std::vector<SweepPoint> points;
  std::size_t left_out = 0;  ///< combinations whose values exclude each other: a later one changed an earlier one
  std::string example = {};  ///< the first of those, and why
};

/// Every combination of values of axes, each named once, that has all the values it names. Throws Error where none has,
/// and where a value is none of its axis.
Grid grid(const SweepPoint& base, std::span<const SweepAxis> axes);

/// Some 60 points: each axis alone about the base as far as a scene with these needs shows it, and the corners.
std::vector<SweepPoint> default_points(const SweepPoint& base, const Needs& needs);

/// Points with several samples once more for each of `seeds` - 1 further seeds of the samples' pattern. In a scene
/// without soft lights, which has no pattern, it is the same picture again.
std::vector<SweepPoint> with_seeds(std::vector<SweepPoint> points, int seeds);

/// The core's features and its arrangement as text, but no widths. Points with the same text have clocks that differ
/// only as their words and groups of lanes do.
std::string features_text(const Config& config);

}  // namespace kage::explore
