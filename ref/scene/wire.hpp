// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "raw.hpp"

namespace kage::scene {

/// A RawScene as bytes and back, for the pipe between two processes of one program: no versions, no byte order.
std::vector<std::uint8_t> packed(const RawScene& scene);

/// Throws Error where the bytes are not a packed scene.
RawScene unpacked(const std::vector<std::uint8_t>& bytes);

}  // namespace kage::scene
