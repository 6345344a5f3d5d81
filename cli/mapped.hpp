// SPDX-License-Identifier: Apache-2.0
//
// A stream file is mapped. If another program shortens it, the lost pages read as zeros from guard_mapped() on, and are
// counted. The run then ends as with any bad file: one line, exit 2, and no file left.
#pragma once

#include <string>

namespace kage::cli {

/// To be called before the file is opened, for each file of a run.
void guard_mapped(const std::string& name);

/// The error of the guarded files, if pages have been lost; otherwise empty.
std::string lost_mapped();

/// Throws Error if pages have been lost. To be called after words were read and before anything is made of them.
void check_mapped();

}  // namespace kage::cli
