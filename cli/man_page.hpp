// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "arguments.hpp"

namespace kage::cli {

/// kage(1), in man's macros, made of the help texts.
std::string man_page(const Program& program);

}  // namespace kage::cli
