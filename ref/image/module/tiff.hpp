// SPDX-License-Identifier: Apache-2.0
//
// What OpenImageIO does not say of a TIFF file, by libtiff, on which its reader stands too.
#pragma once

#include <filesystem>
#include <string>

namespace kage::picture_module {

/// What the values beside the colours of the directory `part` of a TIFF file are, one number each (ExtraSamples); "" if
/// there are none. Throws Error for a directory that OpenImageIO reads with loss.
std::string check_tiff_head(const std::filesystem::path& path, int part);

/// Decodes all lines. Throws Error where OpenImageIO takes one for zeros: it is damaged, cut off, or not there.
void check_tiff_lines(const std::filesystem::path& path, int part);

}  // namespace kage::picture_module
