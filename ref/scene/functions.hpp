// SPDX-License-Identifier: Apache-2.0
//
// Trigonometric functions whose results do not depend on compiler, libm or machine: only + - * / and sqrt, which IEEE
// 754 rounds correctly everywhere. Errors against the true value are a few units in the last place over the stated
// domains (verif/test/unit/scene/functions.cpp measures them).
#pragma once

namespace kage::portable {

inline constexpr double kPi = 3.14159265358979323846;

/// Sine and cosine. Domain |x| <= 2^20; absolute error below 4e-16. A larger or non-finite x is an error of the caller.
double sin(double x);
double cos(double x);

/// sin(x) / cos(x), same domain.
double tan(double x);

/// Angle of the vector (x, y) in [-pi, pi]; atan2(0, 0) is 0. Relative error below 1e-15.
double atan2(double y, double x);

}  // namespace kage::portable
