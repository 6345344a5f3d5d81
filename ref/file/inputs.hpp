// SPDX-License-Identifier: Apache-2.0
//
// The files that this run of the program reads, which none of its outputs may replace.
#pragma once

#include <filesystem>

namespace kage {

/// From now on no TempFile takes the place of `path`, whatever name it is given or was given before: it throws Error.
/// A name of no file is none. A program that lives on after its run need not call it: nothing takes a file back.
/// Throws Error if expect_output() was told of that file.
void keep_input(const std::filesystem::path& path);

/// The run will write `path`: keep_input() refuses it before the work, where the file's own replacement would only fail
/// at its end. Which files a scene consists of is known once it is read.
void expect_output(const std::filesystem::path& path);

/// Whether `path` is such a file, by any name.
bool is_input(const std::filesystem::path& path);

}  // namespace kage
