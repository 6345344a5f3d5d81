// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace kage::picture_plugin {

/// The largest value that a Netpbm file's values can have, "none" of a PFM; nothing if the file is of another format.
/// Throws Error for what OpenImageIO takes for something else: values above the largest, words that are no number, a
/// second picture, and factors of a PFM, by which it multiplies.
std::optional<std::string> largest_of_pnm(const std::filesystem::path& path);

}  // namespace kage::picture_plugin
