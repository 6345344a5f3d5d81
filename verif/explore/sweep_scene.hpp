// SPDX-License-Identifier: Apache-2.0
//
// The frames of a scene with the truth about them, each made once and kept for all configurations of a sweep. The truth
// is the oracle's answers, those of exact rays, the picture with everything at its finest, and the effect of each
// source of error alone. For several threads at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "explore/accuracy.hpp"
#include "explore/error_map.hpp"
#include "explore/screen_truth.hpp"
#include "explore/sweep_points.hpp"
#include "kage/pipeline.hpp"

namespace kage::explore {

/// Sources of a picture's error. The law is that of a light table, which takes shares of a colour that is made for the
/// display, in place of adding light after light.
enum class ErrorSource : std::uint8_t { snapping, depth, color, shading, samples, classes, law, order };
inline constexpr std::array kErrorSources{ErrorSource::snapping, ErrorSource::depth,   ErrorSource::color,
                                          ErrorSource::shading,  ErrorSource::samples, ErrorSource::classes,
                                          ErrorSource::law,      ErrorSource::order};
std::string_view name_of(ErrorSource source);

/// Answers of exact rays through the unsnapped scene at a pixel.
struct RayPixel {
  int x = 0;
  int y = 0;
  std::uint32_t face = kNothing;  ///< opaque
  /// By light, how many of its samples are kept from the pixel; -1: it is not to be compared. The reason is that
  /// nothing was asked, there is no such light, or all of its samples are on the other side of the face than the eye.
  std::array<int, 8> counts{-1, -1, -1, -1, -1, -1, -1, -1};
  /// Translucent faces before it, back to front. None if two are at one distance, where either order is right.
  std::vector<std::uint32_t> layers;
};

/// Light of a pixel, by the model of light and rays (verif/oracle/light_reference.hpp).
struct LightPixel {
  int x = 0;
  int y = 0;
  std::uint32_t face = kNothing;  ///< opaque, with nothing translucent before it
  glm::dvec3 color{0, 0, 0};      ///< 0 .. 255 a channel, not rounded
  bool shadowed = false;          ///< some light that would arrive is kept out
};

/// Light of pixels that are spread evenly over a picture.
struct LightTruth {
  int step = 1;  ///< how far they are apart, across and down
  std::vector<LightPixel> pixels;
};

class SweepScene {
 public:
  /// `draw` has the number of frames, at least 1, the threads that work on one, and the scene's name. `base` has the
  /// size by which its needs are told. `step` is called now and then, by several threads, and what it throws goes
  /// through.
  SweepScene(std::shared_ptr<const Scene> scene, const DrawOptions& draw, const SweepPoint& base,
             std::function<void()> step);
  ~SweepScene();
  SweepScene(const SweepScene&) = delete;
  SweepScene& operator=(const SweepScene&) = delete;

  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] int frames() const;
  [[nodiscard]] const SceneFrame& frame(int index) const;
  [[nodiscard]] const std::shared_ptr<const Scene>& scene() const;
  /// SHA-256 of all that decides the frames' pictures: faces with their colours and alpha, lights, cameras. Another
  /// file of the same name, or the same with another --alpha, is another scene.
  [[nodiscard]] const std::string& identity() const;
  /// Features that its frames ask for. More than one sample: some light is soft.
  [[nodiscard]] const Needs& needs() const;
  [[nodiscard]] DrawOptions draw_options(const SweepPoint& point) const;

  /// The point with everything that changes a picture at its finest: 8 bits of snapped positions, the widest depth and
  /// colour, the most samples, shadows light after light, exact order.
  [[nodiscard]] SweepPoint finest(const SweepPoint& point) const;
  /// The finest point by the given point's own law: with the most classes and the widest shares of a table where the
  /// point has no LINEAR_BITS. All sources but the law itself are held against it, for their parameters are those of
  /// one law.
  [[nodiscard]] SweepPoint finest_of_law(const SweepPoint& point) const;
  /// The finest of its law but for one source, which is as the point has it.
  [[nodiscard]] SweepPoint alone(const SweepPoint& point, ErrorSource source) const;
  /// How many samples each light of a frame has.
  [[nodiscard]] std::vector<int> light_samples(int index, const SweepPoint& point) const;

  /// The oracle's answers for a snap of so many bits, with the samples of the point.
  std::shared_ptr<const ScreenTruth> truth(int index, const SweepPoint& point, int sub_bits);
  std::shared_ptr<const DrawnFrame> finest_picture(int index, const SweepPoint& point);
  /// Rays at pixels that are spread evenly over the picture: all of them, or as many as seconds allow. Lights, with the
  /// samples of the point, are asked at fewer of these pixels where there are many.
  std::shared_ptr<const std::vector<RayPixel>> rays(int index, const SweepPoint& point);
  /// The truth of light at pixels that are spread evenly over a picture of the point's size, as many as seconds allow.
  /// It is the same for all looks: each area light is 255 samples, worked out one by one. Background is left out, and
  /// so are pixels with something translucent before them.
  std::shared_ptr<const LightTruth> light(int index, const SweepPoint& point);
  /// Errors of the picture of alone(point, source) against the finest one of the point's law, the law's own against the
  /// finest of all. The map is not kept.
  ErrorMap map_of(int index, const SweepPoint& point, ErrorSource source);
  /// The sums over that, kept.
  std::shared_ptr<const PictureError> error_of(int index, const SweepPoint& point, ErrorSource source);

  /// Drops all that is kept of a frame, which no other thread works on.
  void forget(int index);

 private:
  std::shared_ptr<const DrawnFrame> kept_picture(int index, const SweepPoint& point);
  [[nodiscard]] SweepPoint alone_in_one_pattern(const SweepPoint& point, ErrorSource source) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::explore
