// SPDX-License-Identifier: Apache-2.0
//
// Meaning of a broken link for the person before the board, and the remedy: one line each.
#pragma once

#include <string>

#include "board/link.hpp"

namespace kage::board {

/// "/dev/ttyUSB0: the board was reset while it played frame 3: press no button, check its supply, and run again".
/// `doing` follows "while it": "played frame 3".
std::string advice(LinkFailure failure, const std::string& port, const std::string& doing);

}  // namespace kage::board
