// SPDX-License-Identifier: Apache-2.0
//
// PNG files by libpng alone, for installations without the picture plugin.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "image/picture.hpp"

namespace kage {

/// Whether a file begins as PNG files do. Throws Error with the cause where it cannot be opened.
bool is_png(const std::filesystem::path& path);

/// Opens a PNG file as open_picture() does. The values come as the file has them: 8 or 16 bits a sample, a palette as
/// its colours, fewer bits spread over 8, a transparent colour as alpha. Notes that only the picture plugin makes are
/// "". Throws Error that names the file, also where libpng's lines would take more than `max_bytes` of memory.
std::unique_ptr<PictureReader> open_png(const std::filesystem::path& path, int part,
                                        std::optional<std::uint64_t> max_bytes = {});

}  // namespace kage
