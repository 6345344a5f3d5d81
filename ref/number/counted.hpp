// SPDX-License-Identifier: Apache-2.0
//
// Counts with what they are counts of, for lines that a person reads.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace kage {

/// "1 texture is", "2 textures are".
template <std::integral Count>
std::string counted(Count count, std::string_view singular, std::string_view plural) {
  return std::to_string(count) + " " + std::string(count == 1 ? singular : plural);
}

/// "1 frame", "2 frames".
template <std::integral Count>
std::string counted(Count count, const std::string& what) {
  return counted(count, what, what + "s");
}

}  // namespace kage
