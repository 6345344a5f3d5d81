// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace kage {

/// Bytes that opening a picture takes, by the file's own header. Only readers that decode the picture before they give
/// its size take some: GIF, JPEG 2000, and JPEG that is progressive or has several scans. All other files give 0. The
/// number is rather too large than too small.
std::uint64_t bytes_of_opening(const std::filesystem::path& path);

}  // namespace kage
