// SPDX-License-Identifier: Apache-2.0
//
// Names and sentences from elsewhere in lines that a person reads, or gives to a shell.
#pragma once

#include <string>

namespace kage {

/// `text` as a shell reads it back.
std::string quoted(const std::string& text);

/// A name or a sentence from elsewhere, for a line that a person reads: without its control characters. A line break
/// in it would begin a line of its own, which may be a command to whatever reads the output.
std::string shown(const std::string& text);

}  // namespace kage
