// SPDX-License-Identifier: Apache-2.0
//
// Standard input, output and error.
#pragma once

#include <string>

namespace kage::cli {

/// Opens those of standard input, output and error that are closed on /dev/null: else a file of results would get their
/// number, and with it the text meant for a person. Writing to standard output then fails, as it does without this;
/// text written to standard error is lost.
void open_standard_files();

/// Writes to standard error. Where that cannot be, nobody is there to be told.
void say(const std::string& text);

}  // namespace kage::cli
