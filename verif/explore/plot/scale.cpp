// SPDX-License-Identifier: Apache-2.0
#include "explore/plot/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kage::plot {
namespace {

// Share of the axis that is left free beyond the least and the greatest value.
constexpr double kRoom = 0.05;

const std::vector<int> kDigits{1, 2, 3, 4, 5, 6, 7, 8, 9};  // NOLINT(cert-err58-cpp)

}  // namespace

Scale::Scale(const std::vector<double>& values, bool log) : log_(log) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  low_ = log ? std::log10(*least) : *least;
  high_ = log ? std::log10(*greatest) : *greatest;
  // Values that are all alike, or nearly so, lie in the middle of a stretch that says how large they are.
  const double least_length = log ? 0.3 : std::max(std::abs(high_) * 0.1, 1e-6);
  if (const double lack = least_length - (high_ - low_); lack > 0) {
    low_ -= lack / 2;
    high_ += lack / 2;
  }
  const double room = (high_ - low_) * kRoom;
  low_ -= room;
  high_ += room;
}

double Scale::at(double value) const { return ((log_ ? std::log10(value) : value) - low_) / (high_ - low_); }

std::vector<double> Scale::decades(const std::vector<int>& digits) const {
  std::vector<double> out;
  for (int e = static_cast<int>(std::floor(low_)); e <= static_cast<int>(std::floor(high_)); ++e)
    for (const int d : digits) {
      const double value = d * std::pow(10.0, e);
      if (const double place = at(value); place >= 0 && place <= 1) out.push_back(value);
    }
  return out;
}

std::vector<double> Scale::steps(int most) const {
  const double low = log_ ? std::pow(10.0, low_) : low_;
  const double high = log_ ? std::pow(10.0, high_) : high_;
  const double rough = (high - low) / most;
  const double ten = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * ten;
  for (const double d : {5.0, 2.0, 1.0})
    if (d * ten >= rough) step = d * ten;
  std::vector<double> out;
  for (auto k = static_cast<long>(std::ceil(low / step)); static_cast<double>(k) * step <= high; ++k)
    out.push_back(static_cast<double>(k) * step);
  return out;
}

std::vector<double> Scale::labels(int most) const {
  constexpr std::size_t kFew = 3;
  if (!log_ || decades(kDigits).size() < kFew) return steps(most);
  for (const std::vector<int>& digits : std::vector<std::vector<int>>{kDigits, {1, 2, 3, 5, 7}, {1, 2, 5}, {1, 3}})
    if (auto out = decades(digits); static_cast<int>(out.size()) <= most) return out;
  auto out = decades({1});
  while (static_cast<int>(out.size()) > most) {  // every second
    std::vector<double> fewer;
    for (std::size_t i = 0; i < out.size(); i += 2) fewer.push_back(out[i]);
    out = std::move(fewer);
  }
  return out;
}

std::vector<double> Scale::lines(int most) const {
  return log_ && decades(kDigits).size() >= labels(most).size() ? decades(kDigits) : labels(most);
}

std::string number_text(double value) {
  if (value != 0 && (std::abs(value) < 1e-4 || std::abs(value) >= 1e7)) return fmt::format("{:.3g}", value);
  return fmt::format("{:.10g}", value);
}

}  // namespace kage::plot
