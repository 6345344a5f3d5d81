// SPDX-License-Identifier: Apache-2.0
//
// Values of each face at each pixel, by a frame's translucent spans.
#pragma once

#include <array>
#include <map>
#include <tuple>
#include <vector>

#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace kage::verif {

inline std::vector<std::uint32_t> words_of(const FrameGeometry& g, const Config& config, int threads = 1) {
  std::vector<std::uint32_t> words;
  make_frame(g, config, 0, words, {.threads = threads, .all_spans = true});
  check_frame(config, words, "front end", 0);
  return words;
}

/// By face, y, x: how often it is drawn there, its depth and its colour.
using FacePixels = std::map<std::tuple<int, int, int>, std::tuple<int, std::int64_t, std::array<std::int64_t, 3>>>;

/// Alphas are the faces' numbers, so a frame has no more than 256 polygons.
inline FacePixels pixels_of_faces(FrameGeometry g, const Config& config) {
  for (ScreenPolygon& p : g.polygons)
    if (p.source != ~0U) p.alpha = static_cast<std::uint8_t>(p.source);
  const auto words = words_of(g, config);
  const Layout layout(config);
  FacePixels pixels;
  int y = 0;
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token);
    if (t.kind == Kind::EOL) ++y;
    if (t.kind != Kind::TP) continue;
    for (int x = t.span.xl; x < t.span.xr; ++x) {
      const std::int64_t on = x - t.span.xl;
      auto& [count, z, color] = pixels[{t.span.alpha, y, x}];
      ++count;
      z = t.span.z + on * t.span.dz;
      for (std::size_t c = 0; c < 3; ++c) color[c] = t.span.color[c] + on * t.span.dcolor[c];
    }
  }
  return pixels;
}

}  // namespace kage::verif
