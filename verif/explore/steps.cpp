// SPDX-License-Identifier: Apache-2.0
#include "explore/steps.hpp"

#include <algorithm>
#include <cstdlib>

namespace kage::explore {
namespace {

/// How much further apart the colours of two pixels are, in the channel where that is most.
int excess(const DrawnFrame& finest, const DrawnFrame& drawn, std::size_t a, std::size_t b) {
  int most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto apart = [&](const DrawnFrame& f) { return std::abs(f.color[a][c] - f.color[b][c]); };
    most = std::max(most, apart(drawn) - apart(finest));
  }
  return most;
}

}  // namespace

Steps& Steps::operator+=(const Steps& o) {
  seen += o.seen;
  most = std::max(most, o.most);
  return *this;
}

Steps steps_of(const DrawnFrame& finest, const DrawnFrame& drawn) {
  Steps out;
  const auto width = static_cast<std::size_t>(drawn.width);
  const auto height = static_cast<std::size_t>(drawn.height);
  const auto compare = [&](std::size_t a, std::size_t b) {
    const std::uint32_t face = drawn.face[a];
    if (drawn.face[b] != face || finest.face[a] != face || finest.face[b] != face) return;
    const int off = excess(finest, drawn, a, b);
    out.most = std::max(out.most, off);
    if (off >= kLeastStep) ++out.seen;
  };
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t at = y * width + x;
      if (x + 1 < width) compare(at, at + 1);
      if (y + 1 < height) compare(at, at + width);
    }
  return out;
}

}  // namespace kage::explore
