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
  if (random.chance(0.4)) c.count_bits = 0;
  if (random.chance(0.4)) c.class_bits = 1;
  if (random.chance(0.4)) c.active = random.in(0, 6);
  if (random.chance(0.7)) {
    c.linear_bits = 0;
  } else if (c.linear_bits > 0) {
    c.dsf_bits = std::max(c.dsf_bits, 1);
    c.smooth = c.lights = c.class_bits = 1;
  }
  c.max_width = width;
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(c)) rule.repair(c);
  validate(c, "random configuration");
  return c;
}

}  // namespace kage::verif
