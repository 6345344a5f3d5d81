// SPDX-License-Identifier: Apache-2.0
//
// The files that this run of the program reads, which none of its outputs may replace.
#pragma once

#include <filesystem>

namespace kage {

/// From now on no TempFile takes the place of `path`, whatever name it is given or was given before: it throws Error.
/// A name of no file is none. A program that lives on after its run need not call it: nothing takes a file back.
void keep_input(const std::filesystem::path& path);

/// Whether `path` is such a file, by any name.
bool is_input(const std::filesystem::path& path);

}  // namespace kage
