// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pragmas.hpp"
#include "types.hpp"

namespace kage::hls {

/// Commands to a pixel, by their kinds (docs/stream.md, Tokens; docs/rtl.md, Commands).
enum PixelCommand {
  kLoad = 1,
  kOut = 2,
  kTree = 5,
  kOpaque = 6,
  kShadow = 7,
  kNearCap = 8,
  kEndVolume = 10,
  kEndSample = 11,
  kResolve = 12,
  kTranslucent = 13,
  kEndLine = 14,
};

constexpr int at_least_one(int bits) { return bits > 0 ? bits : 1; }

/// A pixel's state (docs/stream.md, What a pixel does). A field that the configuration lacks has a bit that stays 0.
template <class P>
struct Pixel {
  hw::u<P::kZBits> z;
  hw::u<8> color[P::kChannels];
  hw::u<at_least_one(P::kDsfBits > 0 ? P::kClassBits : 0)> lit_class;
  hw::u<at_least_one(P::kDsfBits)> dsf;
  hw::u<1> fsf;
  hw::u<at_least_one(P::kCountBits)> count[P::kLights];
};

/// A command, and what the span has at the pixel.
template <class P>
struct PixelNextIn {
  Pixel<P> pixel;
  hw::u<4> kind;                                 ///< a PixelCommand; others leave the pixel
  hw::u<P::kZBits> z;                            ///< the span's depth, or the tree's
  hw::u<8> color[P::kChannels];                  ///< likewise; of kResolve the background
  hw::u<8> blended[P::kChannels];                ///< the pixel's colour blended: pixel_blend
  hw::u<at_least_one(P::kClassBits)> lit_class;  ///< of kOpaque and kTree
  hw::u<at_least_one(P::kDsfBits)> change;       ///< w of kShadow and kNearCap, else the line's bias
  hw::u<3> light;                                ///< of kEndSample
};

/// The pixel behind a command in whose range it lies.
template <class P>
void pixel_next(const PixelNextIn<P>& in, Pixel<P>& out) {
  using Z = hw::u<P::kZBits>;
  using Dsf = hw::u<at_least_one(P::kDsfBits)>;
  using Count = hw::u<at_least_one(P::kCountBits)>;
  constexpr bool kHasLoads = P::kTranslucency > 0 && P::kCountBits > 0;
  const auto is = [&in](int kind) { return in.kind == hw::u<4>(kind); };
  const Z clear_depth((1 << P::kZBits) - 1);
  const Dsf none(0);
  const bool clear = in.pixel.z == clear_depth;
  const bool in_front = in.z < in.pixel.z;
  const bool drawn = in_front && (is(kOpaque) || (P::kUnits > 0 && is(kTree)));
  const Dsf sum = in.pixel.dsf + in.change;
  const bool shadow = P::kDsfBits > 0 && (P::kFsf > 0 ? in.pixel.fsf == hw::u<1>(1) : sum != none);
  const bool darkens = P::kTranslucency > 0 && P::kDsfBits > 0 && P::kCountBits == 0 && is(kResolve) && !clear &&
                       shadow && hw::slice<1>(in.pixel.lit_class, 0) == hw::u<1>(1);
  const bool blends = darkens || (P::kTranslucency > 0 && is(kTranslucent) && in_front);
  const bool resolves = P::kTranslucency > 0 && is(kResolve);
  const bool ends_volume = P::kFsf > 0 && is(kEndVolume);
  const bool ends_sample = P::kCountBits > 0 && is(kEndSample);
  const bool counts = P::kDsfBits > 0 && ((is(kShadow) && in_front) || is(kNearCap));
  const bool ends = is(kEndLine);

  out.z = ends ? clear_depth : drawn ? in.z : in.pixel.z;
  KAGE_HLS_UNROLL
  for (int c = 0; c < P::kChannels; ++c) {
    KAGE_HLS_UNROLLED
    const bool takes = drawn || (kHasLoads && is(kLoad)) || (resolves && clear);
    const hw::u<8> color = takes ? in.color[c] : blends ? in.blended[c] : in.pixel.color[c];
    out.color[c] = ends ? hw::u<8>(0) : color;
  }
  const bool has_class = P::kDsfBits > 0;
  out.lit_class = ends                 ? decltype(out.lit_class)(0)
                  : has_class && drawn ? decltype(out.lit_class)(in.lit_class)
                                       : in.pixel.lit_class;
  const bool dsf_ends = ends || ends_volume || resolves || (P::kFsf == 0 && ends_sample);
  out.dsf = dsf_ends ? none : counts ? sum : in.pixel.dsf;
  const bool fsf_ends = ends || resolves || ends_sample;
  out.fsf = P::kFsf == 0 || fsf_ends ? hw::u<1>(0) : ends_volume && sum != none ? hw::u<1>(1) : in.pixel.fsf;
  KAGE_HLS_UNROLL
  for (int l = 0; l < P::kLights; ++l) {
    KAGE_HLS_UNROLLED
    const Count full((1 << at_least_one(P::kCountBits)) - 1);
    const bool grows =
        ends_sample && shadow && (P::kLights == 1 || in.light == hw::u<3>(l)) && in.pixel.count[l] != full;
    const Count more = in.pixel.count[l] + Count(1);
    const bool empties = ends || (kHasLoads && is(kOut));
    out.count[l] = P::kCountBits == 0 || empties ? Count(0) : grows ? more : in.pixel.count[l];
  }
}

}  // namespace kage::hls
