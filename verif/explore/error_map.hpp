// SPDX-License-Identifier: Apache-2.0
//
// Errors at each pixel of a picture. The figures of a sweep are sums over these maps, and kage render --error-map shows
// them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "explore/accuracy.hpp"
#include "explore/screen_truth.hpp"
#include "kage/image.hpp"

namespace kage::explore {

struct PixelError {
  bool face = false;          ///< it shows another face
  bool shadow = false;        ///< the right face, and another share of some light's samples in shadow
  bool gross = false;         ///< no stated error excuses it
  std::uint8_t color = 0;     ///< greatest difference of a channel, in steps of 255
  std::uint32_t squares = 0;  ///< sum of squared differences of the channels
  double share = 0;           ///< how far the share in shadow is off, of the light that is off the most; 0 with `face`

  /// Face and shadow are right, and the colour is not.
  [[nodiscard]] bool color_alone() const { return !face && !shadow && color > 0; }
  [[nodiscard]] bool any() const { return face || shadow || gross || color > 0; }
};

struct ErrorMap {
  int width = 0;
  int height = 0;
  std::vector<PixelError> pixels;  ///< line by line
};

/// Sums over maps.
struct PictureError {
  std::uint64_t pixels = 0;
  std::uint64_t visible_wrong = 0;  ///< PixelError::face
  std::uint64_t shadow_wrong = 0;
  std::uint64_t gross_wrong = 0;
  std::uint64_t color_wrong = 0;  ///< PixelError::color_alone()
  double shadow = 0;              ///< of PixelError::share
  double squares = 0;

  PictureError& operator+=(const PictureError& o);
  /// Whether any pixel has an error.
  [[nodiscard]] bool any() const;
};
PictureError sum_of(const ErrorMap& map);

/// Faces and shadows of a picture against the truth, which has as many samples, and its colours against `finest`.
/// `samples` are those of each light.
ErrorMap against_truth(const ScreenTruth& truth, const DrawnFrame& finest, const DrawnFrame& drawn,
                       const std::vector<int>& samples);

/// A picture and how many samples each light has in it, against another.
ErrorMap against_picture(const DrawnFrame& expected, const std::vector<int>& expected_samples, const DrawnFrame& drawn,
                         const std::vector<int>& samples);

// The colours of a map, for people of any colour vision: docs/sweep.md, "Error maps".
inline constexpr std::array<std::uint8_t, 3> kFaceColor{255, 225, 0};
inline constexpr std::array<std::uint8_t, 3> kGrossColor{255, 255, 255};
/// A difference of the share in shadow of 0 .. 1. Each doubling is a step brighter, from 1/255 on.
std::array<std::uint8_t, 3> shadow_color(double share);
/// A difference of colour of 1 .. 255 steps, likewise.
std::array<std::uint8_t, 3> color_color(int steps);

/// How many pixels high and wide a pixel of a map so wide is shown: a lone one is to be seen in a small picture.
int enlargement(int width);

/// The map over the dimmed grey picture, enlarged. Pixels that lie alone are framed, and what is wrong grossly by a
/// thick frame of its own colour.
Image picture_of(const ErrorMap& map, const DrawnFrame& under);

}  // namespace kage::explore
