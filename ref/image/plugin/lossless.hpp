// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace kage::picture_plugin {

/// Throws Error, with the cause, where OpenImageIO gives less than a file holds: alpha or bits of a palette, a colour
/// that is transparent, more than eight bits of a value. The file's own header is asked, before OpenImageIO reads any
/// of it.
void refuse_lossy_file(const std::filesystem::path& path);

/// Throws Error unless the format, by OpenImageIO's name, is one that is known to give different pictures for files of
/// different values; unit/image/lossless tries these formats. A Truevision file has no mark at its beginning, so only
/// here is it checked as refuse_lossy_file() checks others.
void refuse_lossy_format(const std::filesystem::path& path, std::string_view format);

}  // namespace kage::picture_plugin
