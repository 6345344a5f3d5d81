// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace kage::scene {

/// Decode RFC 4648 base64, with or without padding; nothing if a character or the length is wrong.
std::optional<std::vector<std::uint8_t>> base64_decode(std::string_view text);

}  // namespace kage::scene
