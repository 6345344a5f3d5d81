// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "types.hpp"

namespace kage::hls {

constexpr int share_bits(int shade_frac) { return shade_frac > 7 ? shade_frac + 1 : 8; }

/// One channel of a pixel, and what a TP or a RESOLVE does with it.
template <int FRAC>
struct PixelBlendIn {
  hw::u<8> under;                 ///< the pixel's colour
  hw::u<8> over;                  ///< the span's, of TP
  hw::u<share_bits(FRAC)> share;  ///< alpha of TP, in 1/255; shade of RESOLVE, in 2^-SHADE_FRAC, at most 1
  hw::u<1> darkens;               ///< RESOLVE
};

struct PixelBlendOut {
  hw::u<8> color;
};

/// The colour that blending or darkening gives, rounded once (docs/stream.md, Blending and Light). The division by 255
/// is v + v / 256, over 256, for any v below 2^16.
template <int FRAC>
void pixel_blend(const PixelBlendIn<FRAC>& in, PixelBlendOut& out) {
  constexpr int kShare = share_bits(FRAC);
  using Share = hw::u<kShare>;
  using Product = hw::u<kShare + 8>;
  const bool darkens = in.darkens == hw::u<1>(1);
  const Share lit = Share(1 << FRAC) - in.share;
  const Share clear = Share(255) - in.share;
  const Share kept = darkens ? lit : clear;
  const Product of_under = Product(in.under) * Product(kept);
  const hw::u<16> of_over = hw::u<16>(in.over) * hw::u<16>(in.share);
  const hw::u<16> rounded = of_over + hw::u<16>(128);
  const Product more = darkens ? Product(1 << (FRAC - 1)) : Product(rounded);
  const Product sum = of_under + more;
  const hw::u<16> v(sum);
  const hw::u<16> upper = v >> 8;
  const hw::u<16> both = v + upper;
  out.color = darkens ? hw::slice<8>(sum, FRAC) : hw::slice<8>(both, 8);
}

}  // namespace kage::hls
