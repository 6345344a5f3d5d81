// SPDX-License-Identifier: Apache-2.0
//
// How far the golden core's picture of a frame is from the truth, for one configuration. The RTL gives the same
// picture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "explore/screen_truth.hpp"
#include "kage/config.hpp"
#include "kage/geometry.hpp"
#include "kage/pipeline.hpp"

namespace kage::explore {

/// Steps of the depth range: from the least depth that is drawn to the greatest.
double depth_steps(const Config& config);

/// A picture of opaque faces as a core draws it, with what the core knows of each pixel when its line ends.
struct DrawnFrame {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> face;                  ///< into SceneFrame::polygons, or kNothing
  std::vector<std::uint32_t> z;                     ///< stored depth; all ones: nothing
  std::vector<std::array<std::uint8_t, 8>> counts;  ///< by light: samples in shadow
  std::vector<std::array<std::uint8_t, 3>> color;   ///< of the picture, layers included
};

/// Draws a frame with a configuration.
DrawnFrame draw(const SceneFrame& frame, const Config& config, const DrawOptions& options);

/// The translucent faces, into SceneFrame::polygons, that a configuration draws over each pixel, in their order: those
/// too that are behind what is opaque. None without TRANSLUCENCY.
std::vector<std::vector<std::uint32_t>> draw_layers(const SceneFrame& frame, const Config& config,
                                                    const DrawOptions& options);

/// How a pixel's face and shadow compare with the truth.
enum class PixelFault : std::uint8_t {
  none,
  face,    ///< it shows another face
  shadow,  ///< the right face, with another number of shadowed samples
};
PixelFault fault_of(const TruePixel& truth, const DrawnFrame& drawn, std::size_t pixel);

/// The greatest error of a stored depth where the face is right, as a share of the range.
double depth_error(const ScreenTruth& truth, const DrawnFrame& drawn, const Config& config);

/// Errors of a frame.
struct Accuracy {
  std::uint64_t pixels = 0;         ///< of the picture
  std::uint64_t visible_wrong = 0;  ///< pixels that show another face than the truth
  std::uint64_t shadow_wrong = 0;   ///< pixels that show the right face with another number of shadowed samples
  double z_max = 0;   ///< greatest error of a stored depth where the face is right, as a share of the range
  int color_max = 0;  ///< greatest difference of colour from the finest picture, where face and shadow are right

  Accuracy& operator+=(const Accuracy& o);
  /// Wrong pixels in a million of those compared.
  [[nodiscard]] double wrong_ppm() const { return wrong_ppm(pixels); }
  /// Wrong pixels in a million of `of`, where the comparison ended before it had all of them.
  [[nodiscard]] double wrong_ppm(std::uint64_t of) const;
};

/// Holds a drawn frame against the truth, and its colours against those of `finest`, drawn with the finest fractions.
Accuracy compare(const ScreenTruth& truth, const DrawnFrame& finest, const DrawnFrame& drawn, const Config& config);

}  // namespace kage::explore
