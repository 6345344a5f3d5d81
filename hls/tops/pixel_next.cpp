// SPDX-License-Identifier: Apache-2.0
//
// pixel_next of one configuration, whose parameters the compiler is told: -DZ_BITS=24 and so on.
#include "kernels/pixel_next.hpp"

namespace kage::hls {

struct Parameters {
  static constexpr int kZBits = Z_BITS;
  static constexpr int kChannels = CHANNELS;
  static constexpr int kDsfBits = DSF_BITS;
  static constexpr int kFsf = FSF;
  static constexpr int kCountBits = COUNT_BITS;
  static constexpr int kLights = LIGHTS;
  static constexpr int kClassBits = CLASS_BITS;
  static constexpr int kTranslucency = TRANSLUCENCY;
  static constexpr int kUnits = UNITS;
};

extern "C" void hls_pixel_next(const PixelNextIn<Parameters>& __restrict in, Pixel<Parameters>& __restrict out) {
  pixel_next<Parameters>(in, out);
}

}  // namespace kage::hls
