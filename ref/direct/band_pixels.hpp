// SPDX-License-Identifier: Apache-2.0
//
// The pixels of a band of lines: what Band hands to it is drawn at once, and becomes no words. Each line has the golden
// core's PixelLine, so that a token does here what it does there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pixel_line.hpp"
#include "frontend/depth_pyramid.hpp"
#include "frontend/frame_plan.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"

namespace kage {

class BandPixels {
 public:
  /// The frame goes to no compare tree (Config::units 0).
  explicit BandPixels(const FramePlan& frame);

  /// Bytes of the line that is the n-th of the band.
  [[nodiscard]] std::span<const std::uint8_t> line(int n) const {
    return std::span(bytes_).subspan(static_cast<std::size_t>(n) * line_bytes_, line_bytes_);
  }
  [[nodiscard]] int first_line() const { return y0_; }
  [[nodiscard]] int end_line() const { return y1_; }
  /// Whether anything opaque or translucent came.
  [[nodiscard]] bool drawn() const { return drawn_; }

  // ---- what Band calls

  /// Spans that count at no pixel need not come.
  static constexpr bool kSkips = true;

  struct Role {};

  void start(int y0, int y1);
  void end(const BandWork& work);

  [[nodiscard]] static Role opaque(std::uint32_t /*polygon*/) { return {}; }
  [[nodiscard]] static Role lit(std::size_t /*pass*/, std::uint32_t /*polygon*/) { return {}; }
  [[nodiscard]] static Role translucent(std::uint32_t /*fragment*/, std::uint32_t /*n*/) { return {}; }
  [[nodiscard]] static Role face(std::uint32_t /*number*/, std::uint32_t /*volume*/) { return {}; }
  [[nodiscard]] static Role last_face(std::uint32_t /*number*/, std::uint32_t /*volume*/) { return {}; }
  [[nodiscard]] static bool made(const Role& /*role*/) { return false; }
  [[nodiscard]] static bool wants_made() { return false; }
  static void polygon(const Role& /*role*/) {}

  void op(int y, const Role& /*role*/, const SpanToken& s) {
    drawn_ = true;
    at(y).op(s);
  }
  void tp(int y, const Role& /*role*/, const SpanToken& s) {
    drawn_ = true;
    resolve_shadows(y);
    at(y).tp(s);
  }
  bool sp(int y, const Role& /*role*/, std::uint32_t /*volume*/, const SpanToken& s) {
    const Standing standing = pyramid_.standing(y, s);
    if (standing == Standing::behind) return false;
    shadows_[index(y)] = true;
    if (standing == Standing::before)
      at(y).nc(s.xl, s.xr, s.w);
    else
      at(y).sp(s);
    return true;
  }
  void near(int y, std::uint32_t /*volume*/, int xl, int xr, int w) {
    shadows_[index(y)] = true;
    at(y).nc(xl, xr, w);
  }
  void ev(int y, std::uint32_t /*volume*/, int xl, int xr) { at(y).ev(xl, xr); }
  void es(int y, int xl, int xr, int light) { at(y).es(xl, xr, light); }
  void resolve(int y, int samples) { at(y).resolve(samples); }

  /// All opaque spans have come.
  void end_opaque();
  /// Whether no span of a face counts at any pixel of the band.
  [[nodiscard]] bool hides(const ScreenPolygon& face) const { return pyramid_.hides(face); }

 private:
  [[nodiscard]] std::size_t index(int y) const { return static_cast<std::size_t>(y - y0_); }
  PixelLine& at(int y) { return lines_[index(y)]; }

  /// RESOLVE, where a line has had shadow tokens; with linear light Band says when.
  void resolve_shadows(int y) {
    if (!shadows_[index(y)]) return;
    shadows_[index(y)] = false;
    if (!linear_) at(y).resolve();
  }

  bool has_shadows_;
  bool linear_;
  int y0_ = 0;
  int y1_ = 0;
  bool drawn_ = false;
  std::size_t line_bytes_;
  std::vector<std::uint8_t> bytes_;
  std::vector<PixelLine> lines_;
  std::array<bool, kBandLines> shadows_{};  // shadow tokens have come, and no RESOLVE
  DepthPyramid pyramid_;
};

}  // namespace kage
