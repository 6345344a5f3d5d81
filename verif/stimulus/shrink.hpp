// SPDX-License-Identifier: Apache-2.0
//
// A frame made smaller, as long as it still does what it is wanted for.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kage/config.hpp"

namespace kage::verif {

/// A frame with as few lines, then tokens, then pixels a line as can be found, for which `keeps` is true, as it is for
/// `words`. No single line, token or step of width can go from it any more, unless `more` said that it was enough.
std::vector<std::uint32_t> shrink(const Config& config, std::vector<std::uint32_t> words,
                                  const std::function<bool(const std::vector<std::uint32_t>&)>& keeps,
                                  const std::function<bool()>& more);

}  // namespace kage::verif
