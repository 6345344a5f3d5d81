// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "vectors/pack.hpp"

namespace kage::cli {

/// The tokens that made a pixel of a pack's frame, a line or two each, for a person.
std::string history_of(const vectors::Pack& pack, const std::string& folder, std::uint64_t frame, int x, int line);

}  // namespace kage::cli
