// SPDX-License-Identifier: Apache-2.0
//
// The pixels of one line, and what spans do to them: the golden counterpart of pixel_next.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/expansion_unit.hpp"
#include "core/linear_light.hpp"
#include "kage/core.hpp"
#include "kage/token.hpp"
#include "kernels/span_kernels.hpp"

namespace kage {

class PixelLine {
 public:
  explicit PixelLine(const Config& config);

  /// A new frame: every pixel is cleared.
  void start(int width, std::uint32_t background);
  void set_shade(std::uint32_t shade) { shade_ = shade; }
  void add_share(const TableToken& entry) { shares_.push_back(entry.share); }  ///< the table's next entry

  void tree(const TreeLine& line);  ///< as OP over the whole line
  /// Where Z < ZB: Z, colour and class are written. Behind a RESOLVE of linear light, where Z <= ZB: a light is added.
  void op(const SpanToken& s);
  void sp(const SpanToken& s);         ///< where Z < ZB: DSF += w
  void nc(int xl, int xr, int w);      ///< DSF += w
  void inside(int w);                  ///< IF: bias += w
  void ev(int xl, int xr);             ///< FSF |= DSF + bias != 0; DSF = 0; bias = 0
  void es(int xl, int xr, int light);  ///< count[light] += FSF; FSF = 0; bias = 0
  /// Darken what is lit and in shadow; DSF = FSF = counts = bias = 0. With linear light: a light's spans follow.
  void resolve(int samples = 0);
  void tp(const SpanToken& s);  ///< where Z < ZB: colour is blended

  /// Depths of the line's pixels.
  [[nodiscard]] std::span<const std::int32_t> depths() const {
    return std::span(zb_).first(static_cast<std::size_t>(width_));
  }
  [[nodiscard]] PixelState state(int x) const;
  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] std::uint32_t bias() const { return bias_ & dsf_mask_; }
  [[nodiscard]] std::uint32_t background() const { return background_; }
  [[nodiscard]] bool painted() const { return painted_; }

  /// The line's pixels as bytes; all state is cleared. `blank`: the line is background whatever was drawn.
  void finish(bool blank, std::span<std::uint8_t> out);

 private:
  [[nodiscard]] std::uint32_t factor(std::size_t x, std::size_t channel) const;
  [[nodiscard]] bool in_shadow(std::size_t x, std::uint32_t bias) const;
  void light(const SpanToken& s);
  void show(std::uint32_t background);
  void resolve_flags();
  void resolve_counts();
  void clear_flags();
  void clear_counts();
  [[nodiscard]] std::array<ColorRamp, 3> color_ramps(const SpanToken& s) const;

  Config config_;
  int width_ = 0;
  std::uint32_t background_ = 0;
  std::uint32_t shade_ = 0;
  std::vector<std::array<std::uint32_t, 3>> shares_;  // the frame's table, by class - 1, then light
  std::uint32_t dsf_mask_ = 0;
  std::uint32_t bias_ = 0;
  bool shadow_touched_ = false;  // a flag of the line may be other than 0
  bool any_count_ = false;       // a counter of the line may be other than 0
  bool painted_ = false;         // translucent spans have come: uncovered pixels have the background's colour
  // A pixel's state, one array a field. Arrays reach past the width by the longest vector, so that kernels need no
  // scalar tail.
  std::vector<std::int32_t> zb_;
  std::vector<std::uint32_t> attr_;   // colour in bits 0-23; without a table lit in bit 24
  std::vector<std::uint32_t> class_;  // with a table only
  std::vector<std::uint32_t> dsf_;
  std::vector<std::uint32_t> fsf_;
  std::vector<std::vector<std::uint32_t>> counts_;  // of each light, with COUNT_BITS only
  std::optional<LinearLight> linear_;               // in place of attr_'s colours, until the line is shown
};

}  // namespace kage
