// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kage::scene {

/// One printable line: control characters become blanks, blanks are joined, and at most `limit` bytes are kept.
std::string one_line(std::string_view text, std::size_t limit = 200);

/// Another library's message as part of one of ours: one line, without the full stop at its end.
std::string cause_of(std::string_view message);

}  // namespace kage::scene
