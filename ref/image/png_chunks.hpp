// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace kage {

/// Notes of a PNG file that OpenImageIO does not tell.
struct PngChunks {
  int bits = 0;                ///< of a stored value, where it is the value's: not with a palette; 0: unknown
  std::string chromaticities;  ///< cHRM, eight numbers in 1/100000
  std::string gamma;           ///< gAMA, in 1/100000: OpenImageIO rounds it
  std::string intent;          ///< sRGB: the rendering intent
  /// All else that says how bright and of which colour a value is, in words: always the same ones, in the same order;
  /// the numbers are "" where the file has none.
  std::vector<std::pair<std::string, std::string>> more{
      {"CICP", ""}, {"number of significant bits", ""}, {"mastering display", ""}, {"content light level", ""}};
  bool profile = false;     ///< it has an ICC profile, which libpng may refuse
  bool animated = false;    ///< more pictures than the first
  bool interlaced = false;  ///< it is there in seven parts, so no line is known before the last part
};

/// Looks at the chunks before the picture. In a file that is no PNG, or a broken one, it takes as many as there are.
PngChunks read_png_chunks(const std::filesystem::path& path);

}  // namespace kage
