// SPDX-License-Identifier: Apache-2.0
//
// Holds the golden core's picture of a frame against the oracle, pixel by pixel. Nothing but the stream goes in and
// nothing but pixels comes out: to see which surface a pixel shows, polygons are given their number as colour; to see
// its shadow, all are white.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>

#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "oracle/oracle.hpp"

namespace kage::verif {

struct Judgement {
  std::uint64_t pixels = 0;
  std::uint64_t covered = 0;
  std::uint64_t shadowed = 0;  ///< by the oracle
  std::uint64_t cover_wrong = 0;
  std::uint64_t surface_near = 0;
  std::uint64_t surface_gross = 0;
  std::uint64_t shadow_near = 0;
  std::uint64_t shadow_gross = 0;
  std::string first_gross;

  [[nodiscard]] bool good() const { return cover_wrong == 0 && surface_gross == 0 && shadow_gross == 0; }
  [[nodiscard]] std::string text() const {
    return fmt::format(
        "{} pixels, {} covered, {} shadowed; cover wrong {}; surface near ties {} gross {}; shadow near ties {} "
        "gross {}{}{}",
        pixels, covered, shadowed, cover_wrong, surface_near, surface_gross, shadow_near, shadow_gross,
        first_gross.empty() ? "" : "; first: ", first_gross);
  }
};

/// Pixels of a frame: 24-bit colour each.
inline std::vector<std::uint32_t> draw(const FrameGeometry& g, const Config& config) {
  std::vector<std::uint32_t> words;
  make_frame(g, config, 0, words, {.threads = 1});
  check_frame(config, words, "front end", 0);
  GoldenCore core(config);
  std::vector<std::uint32_t> pixels;
  const FrameStatus status = core.frame(words, [&](int, std::span<const std::uint8_t> p) {
    for (std::size_t i = 0; i < p.size(); i += 3)
      pixels.push_back(p[i] | static_cast<std::uint32_t>(p[i + 1]) << 8 | static_cast<std::uint32_t>(p[i + 2]) << 16);
  });
  if (status.error != ErrorCode::NONE) throw std::runtime_error("the golden core refuses the front end's frame");
  return pixels;
}

/// `config` must be flat and of three channels and hold the frame. `spoil` changes what is drawn and not what the
/// oracle is asked, for tests that must see a difference.
inline Judgement judge(FrameGeometry g, const Config& config, const std::function<void(FrameGeometry&)>& spoil = {}) {
  const auto drawn = [&] {
    FrameGeometry given = g;
    if (spoil) spoil(given);
    return draw(given, config);
  };
  constexpr std::uint32_t kNothing = 0xFFFFFF;
  g.background = kNothing;
  g.shade = 0;
  for (std::uint32_t i = 0; i < g.drawn; ++i) {
    g.polygons[i].lit = true;
    for (unsigned c = 0; c < 3; ++c) g.polygons[i].color[c] = static_cast<std::uint8_t>(i >> (8 * c));
  }
  const auto surfaces = drawn();
  g.shade = 1U << config.shade_frac;
  g.background = 0x808080;
  for (std::uint32_t i = 0; i < g.drawn; ++i) g.polygons[i].color = {255, 255, 255};
  const auto shadows = drawn();

  Judgement j;
  Oracle oracle(g, config);
  std::size_t at = 0;
  for (int y = 0; y < g.height; ++y) {
    oracle.line(y);
    for (int x = 0; x < g.width; ++x, ++at) {
      const OraclePixel truth = oracle.at(x);
      const std::int32_t seen = surfaces[at] == kNothing ? -1 : static_cast<std::int32_t>(surfaces[at]);
      ++j.pixels;
      if (truth.surface >= 0) ++j.covered;
      if (truth.shadowed) ++j.shadowed;
      if ((seen < 0) != (truth.surface < 0)) ++j.cover_wrong;
      const Verdict surface = oracle.judge_surface(x, truth, seen);
      if (surface == Verdict::near_tie) ++j.surface_near;
      if (surface == Verdict::gross) ++j.surface_gross;
      Verdict shadow = Verdict::right;
      if (surface == Verdict::right && truth.surface >= 0) shadow = oracle.judge_shadow(x, truth, shadows[at] == 0);
      if (shadow == Verdict::near_tie) ++j.shadow_near;
      if (shadow == Verdict::gross) ++j.shadow_gross;
      if ((surface == Verdict::gross || shadow == Verdict::gross) && j.first_gross.empty())
        j.first_gross = fmt::format("({}, {}): surface {} for {}, shadow {} for {}", x, y, seen, truth.surface,
                                    shadows[at] == 0, truth.shadowed);
    }
  }
  return j;
}

}  // namespace kage::verif
