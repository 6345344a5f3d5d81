// SPDX-License-Identifier: Apache-2.0
//
// pixel_blend of one configuration, whose parameter the compiler is told: -DSHADE_FRAC=8.
#include "kernels/pixel_blend.hpp"

namespace kage::hls {

extern "C" void hls_pixel_blend(const PixelBlendIn<SHADE_FRAC>& __restrict in, PixelBlendOut& __restrict out) {
  pixel_blend<SHADE_FRAC>(in, out);
}

}  // namespace kage::hls
