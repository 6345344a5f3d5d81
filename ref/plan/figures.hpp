// SPDX-License-Identifier: Apache-2.0
//
// Figures beside their limits, in reasons that a person reads.
#pragma once

#include <string>

namespace kage::plan {

/// A figure and its limit as text.
struct FigureText {
  std::string value;
  std::string limit;
};

/// Both in as few digits as tell them apart, `digits` at least, so that a reader sees on which side of the limit the
/// figure lies.
FigureText told_apart(double value, double limit, int digits = 3);

}  // namespace kage::plan
