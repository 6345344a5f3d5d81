// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "file/one_line.hpp"

namespace kage::scene {

using kage::one_line;

/// Another library's message as part of one of ours: one line, without the full stop at its end.
std::string cause_of(std::string_view message);

}  // namespace kage::scene
