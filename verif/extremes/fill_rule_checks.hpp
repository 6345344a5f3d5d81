// SPDX-License-Identifier: Apache-2.0
//
// Rules for the pixels that a polygon covers.
#pragma once

#include "extremes/family.hpp"
#include "extremes/screen.hpp"

namespace kage::verif {

/// Parts against the whole that they make: each pixel of the whole has one owner, by kage and by the oracle.
Outcome parts_are_whole(const std::vector<Outline>& parts, const Outline& whole, int width, int height,
                        const Context& context = {});

/// Whether a polygon has the pixels that the oracle says.
Outcome covers_what_the_oracle_says(const Outline& o, int width, int height, const Context& context = {});

/// Whether a polygon without area has no pixel and changes no word of a frame.
Outcome draws_nothing(const Outline& given, int width, int height, const Context& context = {});

}  // namespace kage::verif
