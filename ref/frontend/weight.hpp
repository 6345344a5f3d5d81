// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contract/derived.hpp"

namespace kage {

/// w modulo 2^DSF_BITS, its sign kept where it fits; 0 if it has no effect.
inline int weight(const Config& config, int w) {
  const auto most = static_cast<int>(derived::most_dsf(config));
  return w < 0 ? -(-w & most) : w & most;
}

}  // namespace kage
