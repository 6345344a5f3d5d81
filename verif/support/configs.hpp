// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kage/config.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// Any legal configuration. MAX_WIDTH is `width` or what X_BITS holds, whichever is less.
inline Config random_config(Random& random, int width = 4096) {
  Config c;
  for (const ParamInfo& p : kParams) {
    int v = random.in(p.min, p.max);
    while (p.allowed != 0 && ((p.allowed >> v) & 1U) == 0) v = random.in(p.min, p.max);
    c.*(p.member) = v;
  }
  if (c.dsf_bits == 0) c.fsf = 0;
  if (c.dsf_bits == 0 || random.chance(0.4)) c.count_bits = 0;
  if (c.count_bits == 0 || random.chance(0.4)) c.class_bits = 1;
  if (c.class_bits == 1) c.lights = 1;
  if (c.smooth == 0) c.color_frac = 0;
  if (c.classic != 0) {  // the paper's segment
    c.z_bits = 15;
    c.z_frac = 0;
    c.face_bits = 7;
    c.dx_bits = 9;
  }
  c.max_width = std::min(width, (1 << c.x_bits) - 1);
  validate(c, "random configuration");
  return c;
}

}  // namespace kage::verif
