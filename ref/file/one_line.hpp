// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kage {

/// One printable line: control characters become blanks, blanks are joined, and at most `limit` bytes are kept.
std::string one_line(std::string_view text, std::size_t limit = 200);

}  // namespace kage
