// SPDX-License-Identifier: Apache-2.0
//
// What OpenImageIO does not say of a TIFF file, by libtiff, on which its reader stands too.
#pragma once

#include <filesystem>
#include <string>

namespace kage::picture_module {

/// What the values beside the colours of the directory `part` of a TIFF file are, one number each (ExtraSamples); "" if
/// there are none. Throws Error for a directory that OpenImageIO reads with loss, or as zeros: one whose lines cannot
/// be decoded, because they are damaged, cut off, or compressed in a way that libtiff lacks.
std::string check_tiff(const std::filesystem::path& path, int part);

}  // namespace kage::picture_module
