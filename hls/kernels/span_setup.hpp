// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "types.hpp"

namespace kage::hls {

/// A plane's values have 24 fraction bits (kPlaneFrac of kage/geometry.hpp).
constexpr int kPlaneFracBits = 24;

/// The plane at a span's first pixel, and the roundings of the configuration.
template <int BITS>
struct SpanSetupIn {
  hw::s<BITS> value;           ///< at the first pixel's centre, in 2^-24
  hw::s<BITS> slope;           ///< to the right, a pixel, in 2^-24
  hw::u<1> single;             ///< the span has one pixel
  hw::s<BITS> start_rounding;  ///< span_rounding(FRAC).start
  hw::s<BITS> step_rounding;   ///< span_rounding(FRAC).step
};

/// The fields of a span's token are the bits from 24 - FRAC on: start[24 - FRAC +: bits], step likewise.
template <int BITS>
struct SpanSetupOut {
  hw::s<BITS> start;  ///< half an LSB included
  hw::s<BITS> step;   ///< 0 for a span of one pixel
};

/// Addends before a value is cut to FRAC fraction bits. Half of the last kept bit rounds to nearest, halves up. A start
/// has half an LSB besides (docs/stream.md, Depth of a span at x), which is 2^23 in 2^-24 whatever FRAC is.
struct SpanRounding {
  std::int32_t start, step;
};
constexpr SpanRounding span_rounding(int frac) {
  const std::int32_t step = frac < kPlaneFracBits ? std::int32_t{1} << (kPlaneFracBits - 1 - frac) : 0;
  return {step + (frac > 0 ? std::int32_t{1} << (kPlaneFracBits - 1) : 0), step};
}

/// Start and step of a depth or a colour along a span (ref/frontend/span_setup.hpp; docs/numbers.md, Depth along a
/// span), each within half of 2^-FRAC. One sum does both roundings:
///   floor((v + r) / 2^s) + h = floor((v + r + h 2^s) / 2^s).
/// For planes whose spans stay within the accumulator, as those of the polygon level do.
template <int BITS>
void span_setup(const SpanSetupIn<BITS>& in, SpanSetupOut<BITS>& out) {
  using Value = hw::s<BITS>;
  const Value step = in.slope + in.step_rounding;
  out.start = in.value + in.start_rounding;
  out.step = in.single == hw::u<1>(1) ? Value(0) : step;
}

}  // namespace kage::hls
