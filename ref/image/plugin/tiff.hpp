// SPDX-License-Identifier: Apache-2.0
//
// Checks of a TIFF file by libtiff, on which OpenImageIO's reader stands: of damage and parts that it passes over.
#pragma once

#include <filesystem>
#include <string>

namespace kage::picture_plugin {

/// ExtraSamples of the directory `part` of a TIFF file: the meaning of each value beside the colours, as a number; ""
/// if there are none. Throws Error for a directory that OpenImageIO reads with loss.
std::string check_tiff_head(const std::filesystem::path& path, int part);

/// Decodes all lines. Throws Error where OpenImageIO takes one for zeros: it is damaged, cut off, or not there.
void check_tiff_lines(const std::filesystem::path& path, int part);

}  // namespace kage::picture_plugin
