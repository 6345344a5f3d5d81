// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace kage {

/// Bytes that opening a picture takes, by the file's own header, in formats whose reader decodes the picture before it
/// tells the size: GIF, JPEG 2000, and JPEG that is progressive or has several scans. Of all other files 0. More than
/// is taken rather than less.
std::uint64_t bytes_of_opening(const std::filesystem::path& path);

}  // namespace kage
