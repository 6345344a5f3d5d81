// SPDX-License-Identifier: Apache-2.0
#include "file/meant.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string_view>

namespace kage {
namespace {

/// Letters to insert, leave out, change or swap with the next one to make `a` of `b`.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  std::iota(d[0].begin(), d[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t k = 1; k <= b.size(); ++k) {
      d[i][k] = std::min({d[i - 1][k] + 1, d[i][k - 1] + 1, d[i - 1][k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1)});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        d[i][k] = std::min(d[i][k], d[i - 2][k - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(const std::string& text, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = text.size() < 5 ? 2 : 3;
  for (const std::string& name : names) {
    const bool beginning = text.size() >= 3 && name.rfind(text, 0) == 0;
    const std::size_t d = text == name ? 0 : beginning ? 1 : distance(text, name);
    if (d >= least) continue;
    least = d;
    best = name;
  }
  return best;
}

std::string meant(const std::string& name) { return name.empty() ? "" : " (did you mean " + name + "?)"; }

}  // namespace kage
