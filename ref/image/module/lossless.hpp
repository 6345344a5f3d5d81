// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace kage::picture_module {

/// Throws Error, with the cause, where OpenImageIO gives less than a file holds: alpha or bits of a palette, a colour
/// that is transparent, more than eight bits of a value. The file's own header is asked, before OpenImageIO reads any
/// of it.
void refuse_lossy_file(const std::filesystem::path& path);

/// Throws Error for a format, by OpenImageIO's name, of which it is not known that two files of different values come
/// out different, and for a Truevision file, which nothing but its reader knows, as refuse_lossy_file() does.
/// unit/image/lossless tries those that are let through.
void refuse_lossy_format(const std::filesystem::path& path, std::string_view format);

}  // namespace kage::picture_module
