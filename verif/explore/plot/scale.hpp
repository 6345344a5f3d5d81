// SPDX-License-Identifier: Apache-2.0
//
// Where a value lies along an axis, and which values an axis names.
#pragma once

#include <string>
#include <vector>

namespace kage::plot {

/// A number along an axis: 0 is at its beginning, 1 at its end.
class Scale {
 public:
  /// Round about these values, with some room at both ends. There is one at least; by decades all are above 0.
  Scale(const std::vector<double>& values, bool log);

  [[nodiscard]] double at(double value) const;

  /// The values that are written beside it, upwards, `most` of them at most; and all that have a line.
  [[nodiscard]] std::vector<double> labels(int most) const;
  [[nodiscard]] std::vector<double> lines(int most) const;

 private:
  [[nodiscard]] std::vector<double> steps(int most) const;
  [[nodiscard]] std::vector<double> decades(const std::vector<int>& digits) const;

  bool log_;
  double low_ = 0;
  double high_ = 1;
};

/// A value as a person writes it, in as few digits as it has: "20000", "0.05".
std::string number_text(double value);

}  // namespace kage::plot
