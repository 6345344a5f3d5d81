// SPDX-License-Identifier: Apache-2.0
#include "plan/figures.hpp"

#include <fmt/format.h>

#include <limits>

namespace kage::plan {

FigureText told_apart(double value, double limit, int digits) {
  while (true) {
    FigureText text{fmt::format("{:.{}g}", value, digits), fmt::format("{:.{}g}", limit, digits)};
    if (text.value != text.limit || value == limit || digits >= std::numeric_limits<double>::max_digits10) return text;
    ++digits;
  }
}

}  // namespace kage::plan
