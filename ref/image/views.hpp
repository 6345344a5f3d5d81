// SPDX-License-Identifier: Apache-2.0
//
// Pictures of any type as people look at them: 8 bits, three channels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "image/picture.hpp"
#include "kage/diff.hpp"

namespace kage {

/// The channels that are shown: the first three that are not alpha, or the first one of fewer, three times.
std::array<std::size_t, 3> colour_channels(const Picture& picture);

/// The first three channels without alpha, or the first one as grey; values outside 0 .. 1 are cut to it.
Image view_of(const Picture& picture);

/// How a pixel came out.
enum class PixelVerdict : std::uint8_t { same, tolerated, different, nan, left_out };

/// A pixel of DiffViews::heat. `steps` is the largest distance of its values, `background` (0 .. 255) how bright A is.
void paint(Image& heat, std::size_t pixel, PixelVerdict verdict, std::uint64_t steps, int background);

/// Draws a frame three pixels outside each region, so that a lone pixel in a large picture is found.
void frame_regions(Image& heat, const std::vector<DiffResult::Region>& regions,
                   const std::array<std::uint8_t, 3>& color = {0, 160, 160});

/// Pixels that OpenImageIO's perceptual measure (Yee's, at its defaults for luminance and field of view) tells apart
/// within `box`. Integers count as sRGB where the file says so, all else as linear. Nothing if there is a value that is
/// not finite.
std::optional<std::uint64_t> perceptual_pixels(const Picture& a, const Picture& b, const Box& box);

}  // namespace kage
