// SPDX-License-Identifier: Apache-2.0

/// @file
/// Comparing pictures, and folders of them. docs/diff.md says what each threshold means. All functions throw
/// kage::Error that names the file; that is trouble, and never a verdict.
///
/// Laws, whatever the options: the verdict is symmetric; with no threshold, "same" is equal bits and likes; a wider
/// threshold never turns "same" into "different". The one exception to "equal to itself" is a picture with a NaN.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kage/image.hpp"

namespace kage {

/// Pixels x .. x + width - 1 of lines y .. y + height - 1, counted from the picture's first pixel.
struct Box {
  int x = 0;       ///< its first pixel
  int y = 0;       ///< its first line
  int width = 0;   ///< in pixels
  int height = 0;  ///< in lines
  bool operator==(const Box&) const = default;
};

/// Options of a comparison: the compared values, and the differences that still count as the same. A value is one
/// channel of a pixel. It is the same if its bits are, or if it is within the threshold given; a pixel is the same if
/// all its compared values are.
///
/// Each threshold belongs to one sort of values: `lsb` to integers, `abs` and `ulp` (at most one of them is given) to
/// half, float and double. Error is thrown where a picture holds the other sort. A threshold of 0 is the same as none.
struct DiffOptions {
  std::optional<std::uint64_t> lsb;  ///< integers: |a - b| <= lsb, in steps of the file's type (1/65535 for 16 bits)
  std::optional<double> abs;         ///< floats: |a - b| <= abs, computed in double; +0 and -0 are within any abs > 0
  std::optional<std::uint64_t> ulp;  ///< floats: so many representable numbers further; -0 and +0 are neighbours
  std::optional<std::uint64_t> max_pixels;  ///< so many different pixels are still "same"
  std::optional<double> max_percent;  ///< likewise, of all compared pixels; with both, both hold; with neither, none
  std::optional<Box> region;          ///< only these pixels; Error where they are not all in the picture
  /// If not empty, only pixels that are not 0 in it are compared: one channel, as load_mask() makes it; sizes are
  /// alike.
  Image mask;
  bool ignore_alpha = false;  ///< values of the alpha channel are not compared; pictures still both have one or not
  bool perceptual = false;    ///< compute DiffResult::perceptual_pixels and flip, which takes time
  std::optional<std::uint64_t> max_bytes;  ///< of memory that diff_files() may take; none: half of what there is
  int part = -1;  ///< of files that hold several pictures, the number of the one to compare, from 0
};

/// The FLIP difference of [Andersson 2020] ("LDR-FLIP") over a picture's pixels, 0 (none is seen) to 1 each.
struct FlipNumbers {
  double mean = 0;  ///< over all pixels
  double most = 0;  ///< of any pixel
};

/// Outcome. For pictures that are unlike in a way that no threshold tolerates (size, place, channels, types, colour
/// space) only `same` and `reason` are set, and width is 0.
struct DiffResult {
  /// A value of a picture.
  struct Position {
    int x = 0;        ///< its pixel
    int y = 0;        ///< its line
    int channel = 0;  ///< in the order of the file
  };
  /// The box of differing pixels that lie near each other (in tiles of 8 x 8 pixels that touch), and their number.
  /// Boxes of one comparison may overlap; each pixel is counted in one.
  struct Region {
    Box box;                   ///< round all of them
    std::uint64_t pixels = 0;  ///< that differ
  };
  bool same = false;                   ///< the verdict
  std::string reason;                  ///< why not, in words; empty if same
  int width = 0;                       ///< of both pictures, in pixels
  int height = 0;                      ///< likewise, in lines
  int channels = 0;                    ///< likewise
  bool floats = false;                 ///< some channel is half, float or double
  std::uint64_t compared_pixels = 0;   ///< within region and mask
  std::uint64_t different_pixels = 0;  ///< compared and beyond the threshold, or with a NaN
  std::uint64_t nan_pixels = 0;        ///< pixels with a NaN on either side, compared or not: never tolerated
  // Over all compared values, whatever the thresholds; nothing where no such value was compared.
  std::optional<std::uint64_t> max_lsb;  ///< largest distance of two integers
  std::optional<double> max_abs;         ///< of two floats; infinite if one is
  std::optional<std::uint64_t> max_ulp;  ///< of two floats
  std::optional<Position> first;         ///< first different pixel, line by line, and its first different channel
  std::vector<Region> regions;           ///< of differing pixels, most pixels first, kMaxRegions at most
  std::uint64_t region_count = 0;        ///< all of them
  // Diagnosis only: no verdict ever depends on these.
  std::optional<double> psnr;  ///< dB over all compared values, peak the type's largest or 1.0; nothing if all are
                               ///< equal, or a compared float is not in 0 .. 1
  std::optional<std::uint64_t> perceptual_pixels;  ///< that OpenImageIO's compare_Yee tells apart
  std::optional<FlipNumbers> flip;  ///< of the pictures as DiffViews has them, all of them, taken for sRGB
};

/// Most boxes in DiffResult::regions.
inline constexpr std::size_t kMaxRegions = 64;

/// Pictures of a comparison, 8 bits and three channels, for people to look at. Values beyond 8 bits or outside 0 .. 1
/// are cut to that.
struct DiffViews {
  Image heat;  ///< A dimmed; red, the brighter the further apart, where A and B differ; ochre where a threshold
               ///< tolerates it; pink at a NaN; blue where nothing was compared. Empty if the pictures are unlike
  Image a;     ///< the first picture
  Image b;     ///< the second one
};

/// Compares two picture files. Throws Error where one cannot be read, holds several pictures and `options` name none,
/// or `options` do not go with them, and, before anything is read, where that takes too much memory. Without `views`
/// and `perceptual` a PNG takes that of some lines, whatever its height.
/// @param a of any format whose every bit is compared (docs/diff.md)
/// @param b likewise
/// @param options what is compared, and what is still the same
/// @param views filled if given
/// @return the outcome
DiffResult diff_files(const std::filesystem::path& a, const std::filesystem::path& b, const DiffOptions& options = {},
                      DiffViews* views = nullptr);

/// The same for pictures in memory.
/// @param a the first picture
/// @param b the second one
/// @param options what is compared, and what is still the same
/// @param heat filled if given, as DiffViews::heat
/// @return the outcome
DiffResult diff_images(const Image& a, const Image& b, const DiffOptions& options = {}, Image* heat = nullptr);

/// Makes a mask of a picture of any type. Throws Error if there is a NaN, or no pixel that would count.
/// @param path the picture
/// @param max_bytes of memory that it may take; none: half of what there is
/// @return one channel: 255 where the picture is not 0 in some channel other than alpha (or in alpha, if that is all
/// there is), else 0
Image load_mask(const std::filesystem::path& path, std::optional<std::uint64_t> max_bytes = {});

/// Writes a picture that shows two, one after the other, half a second each, for ever: an animated PNG. Three channels;
/// where sizes are unlike, black fills up the smaller.
/// @param path ends in .png or .apng
/// @param a the first picture; what a program shows that knows no animation
/// @param b the second one
void save_blink(const std::filesystem::path& path, const Image& a, const Image& b);

/// A file's name in one or both of two folders, by '/' from the folder, subfolders included.
struct FolderEntry {
  /// Sort of a file, by its extension, as docs/diff.md lists them.
  enum class Sort : std::uint8_t {
    picture,  ///< compared by diff_files()
    stream,   ///< compared by diff_streams()
    other,    ///< compared byte for byte
  };
  std::string name;         ///< by '/' from the folder
  Sort sort = Sort::other;  ///< what it is
  bool in_a = false;        ///< the first folder has it
  bool in_b = false;        ///< the second one has it
};

/// The files of two folders.
struct FolderPair {
  std::vector<FolderEntry> files;     ///< sorted by name
  std::vector<std::string> left_out;  ///< names of files and folders that are not compared, in either folder
};

/// Matches files by name. Throws Error if a folder cannot be read.
/// @param a the first folder
/// @param b the second one
/// @param exclude patterns that leave out the names that they match, as a whole or by their last part (fnmatch(); '*'
/// takes a '/' too); names that begin with a dot are left out besides
/// @return the files, and what is left out
FolderPair pair_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                        const std::vector<std::string>& exclude = {});

/// Compares two files byte for byte.
/// @param a the first file
/// @param b the second one
/// @return why they are not the same, in words; empty if they are
std::string diff_bytes(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace kage
