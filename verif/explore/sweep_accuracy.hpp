// SPDX-License-Identifier: Apache-2.0
//
// Errors in the pictures of a sweep's point, by the oracle, by rays, and against the finest picture.
#pragma once

#include <cstdint>
#include <optional>

#include "explore/accuracy.hpp"
#include "explore/steps.hpp"
#include "explore/sweep_scene.hpp"
#include "kage/image.hpp"

namespace kage::explore {

/// How far light is from the truth, in steps of 255 over all channels: pixels in some shadow, and others.
struct LightErrors {
  std::uint64_t pixels = 0;  ///< that show the face that a ray meets
  std::uint64_t shadowed = 0;
  double shadow_sum = 0;
  double shadow_worst = 0;
  double lit_sum = 0;
  double lit_worst = 0;
  double squares = 0;

  LightErrors& operator+=(const LightErrors& o);
  /// Root mean square over all channels.
  [[nodiscard]] double rms() const;
};

/// Errors of light in a picture that was drawn as `drawn`. Pixels that show another face are passed over.
LightErrors light_errors(const LightTruth& truth, const DrawnFrame& drawn);

/// The same as a map: each pixel that was asked stands for those round it.
ErrorMap light_map(const LightTruth& truth, const DrawnFrame& drawn);

/// Errors over all frames of a point.
struct PointAccuracy {
  PictureError by_truth;         ///< over error_map()
  double z_error_max_lsb = 0;    ///< of a stored depth against the exact one of the point's own snap
  std::uint64_t ray_pixels = 0;  ///< that rays were asked about; 0: they cannot be (Look::cull)
  std::uint64_t ray_visible_wrong = 0;
  std::uint64_t ray_shadow_pixels = 0;  ///< of these, lit pixels with a light that can be compared
  std::uint64_t ray_shadow_wrong = 0;   ///< of these, with another number of shadowed samples of some light
  double ray_shadow_share = 0;          ///< sum over them of how far a light's share in shadow is off, at most
  std::uint64_t ray_layer_pixels = 0;   ///< pixels with two layers or more that picture and rays have
  std::uint64_t ray_layers_wrong = 0;   ///< of these, whose order is another
  PictureError all;                     ///< against the finest picture
  LightErrors light;                    ///< against SweepScene::light(); no pixels with Look::cull
  LightErrors finest_light;             ///< the finest picture's, which no width mends
  Steps steps;                          ///< besides those of the finest picture
  double flip = 0;                      ///< sum over the frames of the mean of FLIP; only if asked for

  PointAccuracy& operator+=(const PointAccuracy& o);
};

/// Errors of a point's frame that was drawn as `drawn`. Faces and shadows are held against the oracle of the finest
/// snap, with as many samples, and colours against the finest picture. Gross errors are found by the oracle of the
/// point's own snap.
ErrorMap error_map(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn);

/// The colours of a drawn frame.
Image image_of(const DrawnFrame& drawn);

/// Measures a frame of a point that was drawn as `drawn`.
PointAccuracy accuracy_of(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn, bool flip);

/// Error of a soft light's samples at straight edges: how far their share beyond an edge is from the share of the
/// light's area, over edges at all places and of all directions. It is that of the frame's worst light. None: no light
/// is soft.
struct SoftShare {
  double rms = 0;
  double worst = 0;
};
std::optional<SoftShare> soft_share(const SceneFrame& frame, const SweepPoint& point);

/// PSNR from PictureError::squares, in dB; none if all colours are equal.
std::optional<double> psnr(double squares, std::uint64_t pixels);

}  // namespace kage::explore
