// SPDX-License-Identifier: Apache-2.0
#include "cost/token_clocks.hpp"

#include <algorithm>

#include "contract/kinds.hpp"

namespace kage {

void PhaseCounter::token(const Token& t) {
  const auto words = static_cast<std::uint64_t>(layout_.words[static_cast<std::size_t>(t.kind)]);
  const auto beat = static_cast<std::uint64_t>(config_.beat_words);
  std::uint64_t clocks = std::max<std::uint64_t>(1, (words + beat - 1) / beat);
  // Groups of lanes, which the banked arrangement works on in turn; in the systolic one a token enters every clock.
  const auto groups = [&](int xl, int xr) {
    return static_cast<std::uint64_t>(
        config_.arrangement == 0 || xl == xr ? 1 : (xr - 1) / config_.lanes - xl / config_.lanes + 1);
  };
  const Phase phase = phase_of(t.kind);
  PhaseSums::Sum& sum = sums_.of[static_cast<std::size_t>(phase)];
  if (info_of(t.kind).line_clocks) {
    clocks = groups(0, width_);
  } else if (info_of(t.kind).range) {
    clocks = std::max(clocks, groups(t.span.xl, t.span.xr));
    sum.pixels += static_cast<std::uint64_t>(t.span.xr - t.span.xl);
  }
  const auto width = static_cast<std::uint64_t>(width_);
  const std::uint64_t waited = waits_;
  if (t.kind == Kind::RESOLVE) resolved_ = true;
  if (t.kind == Kind::SEG) segments_ += clocks;
  if (t.kind == Kind::TREE) {
    // The tree begins a line once the one before has begun to leave its buffer; systolic there is no buffer, see below.
    const std::uint64_t line = width + kBetweenTreeLines;
    const std::uint64_t since = had_tree_ ? since_tree_ : 0;
    if (config_.arrangement != 0 && since < line) waits_ += line - since;
    had_tree_ = tree_here_ = true;
  }
  if (t.kind == Kind::TP && !blends_) {
    blends_ = true;
    // docs/rtl.md, "Clocks": a line whose colours come back before its TPs.
    constexpr std::uint64_t kColorsBack = 32;
    waits_ = groups(0, width_);
    if (config_.linear_bits > 0 || (config_.count_bits > 0 && resolved_))
      waits_ += width + std::max(width, config_.arrangement == 0 ? width : 2 * groups(0, width_)) + kColorsBack;
  }
  ++sum.tokens;
  sum.clocks += clocks;
  line_ += clocks;
  since_tree_ = t.kind == Kind::TREE ? clocks : since_tree_ + clocks + waits_ - waited;
  if (t.kind != Kind::EOL) return;
  if (line_ < width) sums_.video += width - line_;
  // Systolic, a line's SEGs may all wait for the half of a unit's buffer that the line before is read from.
  const bool waits_for_half = tree_here_ && config_.arrangement == 0;
  lines_.push_back(std::max(line_ + waits_, width + (waits_for_half ? segments_ : 0)));
  line_ = waits_ = segments_ = 0;
  resolved_ = blends_ = tree_here_ = false;
}

std::uint64_t worst_window(std::span<const std::uint64_t> lines, std::size_t count) {
  std::uint64_t window = 0;
  std::uint64_t worst = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    window += lines[i];
    if (i >= count) window -= lines[i - count];
    worst = std::max(worst, window);
  }
  return worst;
}

}  // namespace kage
