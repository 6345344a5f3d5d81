// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "contract/kinds.hpp"
#include "kage/stream.hpp"

namespace kage {

/// Adds a token of the span level to the counts of spans, if it is one; `made` by the front end, or as it came.
inline void count_span(TokenCounts& counts, const Token& t, bool made = false) {
  if (!info_of(t.kind).span) return;
  ++counts.spans;
  if (made) ++counts.made;
  counts.span_pixels += static_cast<std::uint64_t>(std::max(0, t.span.xr - t.span.xl));
}

}  // namespace kage
