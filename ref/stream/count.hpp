// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "contract/kinds.hpp"
#include "kage/stream.hpp"

namespace kage {

/// Adds a token to the counts of spans, if it is one.
inline void count_span(TokenCounts& counts, const Token& t) {
  if (!info_of(t.kind).span) return;
  ++counts.spans;
  counts.span_pixels += static_cast<std::uint64_t>(std::max(0, t.span.xr - t.span.xl));
}

/// Adds a token to its kind's count and, if it is a span, to those of spans. Words and units are the caller's.
inline void count_token(TokenCounts& counts, const Token& t) {
  ++counts.of_kind[static_cast<std::size_t>(t.kind)];
  count_span(counts, t);
}

}  // namespace kage
