// SPDX-License-Identifier: Apache-2.0
//
// Several lights and samples, told from one hard shadow at a time: what a core with counters and table must show
// follows from pictures that cores without them make.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "oracle/judge.hpp"

namespace kage::verif {

/// A configuration that has what the frame's lights need, `samples` of each that is no point.
inline Config config_for_lights(const SceneFrame& f, int samples, Config c = {}) {
  const bool area =
      std::any_of(f.lights.begin(), f.lights.end(), [](const Light& l) { return l.shape != LightShape::point; });
  const int most = area ? samples : 1;
  if (most == 1 && f.lights.size() == 1) return c;
  c.shade_frac = 16;
  while (most >> c.count_bits > 0) ++c.count_bits;
  if (f.lights.size() == 1) return c;
  c.lights = static_cast<int>(f.lights.size());
  c.class_bits = 9;
  return c;
}

/// The volumes of one light sample, as the only ones.
inline FrameGeometry only_sample(const FrameGeometry& g, std::uint32_t sample) {
  FrameGeometry one = g;
  one.volumes.clear();
  one.volume_faces.clear();
  one.near_edges.clear();
  one.shares.clear();
  one.sample_light = {0};
  for (ShadowVolume v : g.volumes) {
    if (v.sample != sample) continue;
    const auto faces = std::span(g.volume_faces).subspan(v.first_face, v.face_count);
    const auto edges = std::span(g.near_edges).subspan(v.first_near, v.near_count);
    v.sample = 0;
    v.first_face = static_cast<std::uint32_t>(one.volume_faces.size());
    v.first_near = static_cast<std::uint32_t>(one.near_edges.size());
    one.volume_faces.insert(one.volume_faces.end(), faces.begin(), faces.end());
    one.near_edges.insert(one.near_edges.end(), edges.begin(), edges.end());
    one.volumes.push_back(v);
  }
  return one;
}

/// `c` without counters and table: for one sample.
inline Config for_one_sample(Config c) {
  c.count_bits = 0;
  c.lights = c.class_bits = 1;
  return c;
}

/// For each pixel, whether the sample's volumes cover the surface that is seen there, by a core for one light.
inline std::vector<std::uint8_t> sample_shadow(const FrameGeometry& g, const Config& config, std::uint32_t sample) {
  Config c = for_one_sample(config);
  c.smooth = c.color_frac = 0;
  FrameGeometry one = only_sample(g, sample);
  one.shade = 1U << c.shade_frac;
  one.background = 0x808080;
  for (std::uint32_t i = 0; i < one.drawn; ++i) {
    one.polygons[i].color = {255, 255, 255};
    one.polygons[i].lit = true;
  }
  std::vector<std::uint8_t> shadowed;
  for (const std::uint32_t p : draw(one, c)) shadowed.push_back(p == 0 ? 1 : 0);
  return shadowed;
}

/// For each pixel and light, how many of the light's samples are shadowed.
inline std::vector<std::array<std::uint32_t, 8>> shadow_counts(const FrameGeometry& g, const Config& config) {
  std::vector<std::array<std::uint32_t, 8>> counts(static_cast<std::size_t>(g.width) *
                                                   static_cast<std::size_t>(g.height));
  for (std::uint32_t s = 0; s < g.sample_light.size(); ++s) {
    const auto shadowed = sample_shadow(g, config, s);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i][g.sample_light[s]] += shadowed[i];
  }
  return counts;
}

/// For each pixel, the index of the polygon that it shows, or ~0.
inline std::vector<std::uint32_t> seen_polygons(const FrameGeometry& g, const Config& config) {
  Config c = for_one_sample(config);
  c.smooth = c.color_frac = 0;
  FrameGeometry h = only_sample(g, ~0U);
  h.background = 0xFFFFFF;
  for (std::uint32_t i = 0; i < h.drawn; ++i)
    for (unsigned k = 0; k < 3; ++k) h.polygons[i].color[k] = static_cast<std::uint8_t>(i >> (8 * k));
  std::vector<std::uint32_t> seen = draw(h, c);
  for (std::uint32_t& p : seen)
    if (p == 0xFFFFFF) p = ~0U;
  return seen;
}

/// The class of a pixel that shows a polygon: of a diced one by the sides of its cuts on which the pixel lies.
inline std::uint32_t class_at(const FrameGeometry& g, const Config& config, const ScreenPolygon& p, int x, int y) {
  if (config.smooth == 0 || p.shade_cut < 0) return p.normal_class;
  std::int32_t at = p.shade_cut;
  while (at >= 0) {
    const ShadeCut& cut = g.shade_cuts[static_cast<std::size_t>(at)];
    at = cut.line.a * x + cut.line.b * y + cut.line.c >= 0 ? cut.front : cut.behind;
  }
  const std::int32_t number = ~at;
  return g.shades[static_cast<std::size_t>(number)].normal_class;
}

/// The picture as docs/stream.md has it, from pictures without any counter or table: colours without shadow, the
/// polygon of each pixel, and the shadow of each sample by itself.
inline std::vector<std::uint32_t> expected_picture(const FrameGeometry& g, const Config& config) {
  FrameGeometry plain = only_sample(g, ~0U);
  const auto unshadowed = draw(plain, for_one_sample(config));
  const auto seen = seen_polygons(g, config);
  const auto counts = shadow_counts(g, config);
  std::vector<std::uint32_t> picture = unshadowed;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (seen[i] == ~0U) continue;
    const ScreenPolygon& p = g.polygons[seen[i]];
    const std::size_t width = static_cast<std::size_t>(g.width);
    const std::uint32_t of_class = class_at(g, config, p, static_cast<int>(i % width), static_cast<int>(i / width));
    if (config.class_bits > 1 ? of_class == 0 : !p.lit) continue;
    picture[i] = 0;
    for (unsigned c = 0; c < 3; ++c) {
      std::int64_t keep = std::int64_t{1} << config.shade_frac;
      for (std::size_t l = 0; l < static_cast<std::size_t>(config.lights); ++l)
        keep -= std::int64_t{counts[i][l]} *
                (config.class_bits > 1 ? g.shares[(of_class - 1) * static_cast<std::size_t>(config.lights) + l][c]
                                       : g.shade);
      keep = std::max<std::int64_t>(keep, 0);
      const std::int64_t v = unshadowed[i] >> (8 * c) & 255U;
      picture[i] |=
          static_cast<std::uint32_t>((v * keep + (std::int64_t{1} << (config.shade_frac - 1))) >> config.shade_frac)
          << (8 * c);
    }
  }
  return picture;
}

}  // namespace kage::verif
