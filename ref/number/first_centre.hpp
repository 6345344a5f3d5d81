// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kage {

/// First line (or pixel) whose centre is at or past a 16.8 coordinate: ceil(v / 256 - 1/2).
constexpr int first_centre(std::int32_t v) { return (v + 127) >> 8; }

}  // namespace kage
