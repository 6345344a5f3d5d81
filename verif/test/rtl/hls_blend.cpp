// SPDX-License-Identifier: Apache-2.0
// The generated blender is that of kage_pixel_next.svh, for all inputs (hls_blend.hpp), with each SHADE_FRAC of the
// named configurations.
#include "hls_blend.hpp"

#include <string>

#include "Vhls_blend12.h"
#include "Vhls_blend16.h"
#include "Vhls_blend8.h"
#include "bench.hpp"

using namespace kage::rtl;

TEST_CASE("hls_pixel_blend is the blender of kage_pixel_next.svh", "[hls_blend]") {
  Vhls_blend8 model8;
  Vhls_blend12 model12;
  Vhls_blend16 model16;
  for (const std::string& wrong :
       {wrong_in_blend(model8, 8), wrong_in_blend(model12, 12), wrong_in_blend(model16, 16)}) {
    INFO(wrong);
    REQUIRE(wrong.empty());
  }
}
