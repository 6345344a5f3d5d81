// SPDX-License-Identifier: Apache-2.0
//
// The blender of the RTL and the generated one, by all inputs that there are: a colour, another, and an alpha; a colour
// and a shade.
#pragma once

#include <cstdint>
#include <string>

namespace kage::rtl {

/// The error that was found, or nothing. `model`: a model of hls_blend_bench.sv.
template <class Model>
std::string wrong_in_blend(Model& model, int shade_frac) {
  for (const bool darkens : {true, false}) {
    const std::uint32_t most = darkens ? std::uint32_t{1} << shade_frac : 255;
    model.darkens_i = darkens ? 1 : 0;
    for (std::uint32_t share = 0; share <= most; ++share) {
      model.share_i = share;
      // RESOLVE does not depend on this colour, so any one will do.
      const std::uint32_t first = darkens ? share * 37 % 256 : 0;
      const std::uint32_t last = darkens ? first : 255;
      for (std::uint32_t over = first; over <= last; ++over) {
        model.over_i = over;
        for (std::uint32_t under = 0; under < 256; ++under) {
          model.under_i = under;
          model.eval();
          if (model.rtl_o != model.kernel_o)
            return std::string(darkens ? "RESOLVE" : "TP") + " under " + std::to_string(under) + ", over " +
                   std::to_string(over) + ", share " + std::to_string(share);
        }
      }
    }
  }
  return {};
}

}  // namespace kage::rtl
