// SPDX-License-Identifier: Apache-2.0
#include "frontend/frame_plan.hpp"

#include <fmt/format.h>

#include "kage/error.hpp"

namespace kage {
namespace {

void check_guard(const FrameGeometry& g) {
  constexpr std::int32_t kLimit = kGuard * 256;
  const auto check = [](const ScreenVertex& v, const char* what, std::size_t i) {
    if (v.x < -kLimit || v.x > kLimit || v.y < -kLimit || v.y > kLimit)
      throw Error(
          fmt::format("{} {}: ({}, {}) / 256 is outside the guard band of +-{} pixels", what, i, v.x, v.y, kGuard));
  };
  for (std::size_t i = 0; i < g.vertices.size(); ++i) check(g.vertices[i], "vertex", i);
  for (std::size_t i = 0; i < g.near_edges.size(); ++i) {
    check(g.near_edges[i].from, "near edge", i);
    check(g.near_edges[i].to, "near edge", i);
  }
}

// Without FSF a sample has one volume, without counters there is one sample.
void check_volumes(const FrameGeometry& g, const Config& config) {
  if (config.dsf_bits == 0) return;
  for (std::size_t i = 1; i < g.volumes.size(); ++i) {
    if (config.count_bits == 0 && g.passes.empty() && g.volumes[i].sample != g.volumes[0].sample)
      throw Error("several light samples need COUNT_BITS, which the configuration lacks");
    if (config.fsf == 0 && g.volumes[i].sample == g.volumes[i - 1].sample)
      throw Error("several shadow volumes need FSF, which the configuration lacks");
  }
}

// Throws Error if the configuration cannot hold the frame.
void check_fits(const FrameGeometry& g, const Config& config) {
  const int widest = (1 << config.x_bits) - 1;
  if (g.width > widest)
    throw Error(
        fmt::format("lines of {} pixels do not fit X_BITS = {}, which holds {}", g.width, config.x_bits, widest));
  check_guard(g);
  check_volumes(g, config);
  if (config.translucency == 0 && !g.fragments.empty())
    throw Error("translucent faces need TRANSLUCENCY, which the configuration lacks");
}

std::vector<LineRange> ranges_of_polygons(const FrameGeometry& g, std::size_t count) {
  std::vector<LineRange> r;
  r.reserve(count);
  for (std::size_t i = 0; i < count; ++i) r.push_back(lines_of(g.outline(g.polygons[i])));
  return r;
}

}  // namespace

FramePlan plan_frame(const FrameGeometry& g, const Config& config, bool all_spans) {
  check_fits(g, config);
  const int bands = (g.height + kBandLines - 1) / kBandLines;
  const auto all = ranges_of_polygons(g, g.polygons.size());
  std::vector<LineRange> faces;
  faces.reserve(g.volume_faces.size());
  for (const VolumeFace& f : g.volume_faces) faces.push_back(all[f.polygon]);
  std::vector<LineRange> edges;
  edges.reserve(g.near_edges.size());
  for (const NearEdge& e : g.near_edges) edges.push_back(lines_of(e.from, e.to));
  TreeLayout tree(g, config);
  std::vector<LineRange> ahead = tree.edge_lines();
  for (LineRange& r : ahead) --r.first, --r.end;
  std::vector<LineRange> fragments;
  fragments.reserve(g.fragments.size());
  for (const ScreenFragment& f : g.fragments) fragments.push_back({f.first_line, f.end_line});
  FramePlan f{&g,
              &config,
              std::move(tree),
              Uses(g, config),
              {},
              {},
              {bands, g.height, std::span(all).first(g.drawn)},
              {bands, g.height, faces},
              {bands, g.height, edges},
              {bands, g.height, ahead},
              {bands, g.height, fragments},
              all_spans,
              std::nullopt};
  f.volume_of_face.resize(g.volume_faces.size());
  f.volume_of_edge.resize(g.near_edges.size());
  for (std::uint32_t v = 0; v < g.volumes.size(); ++v) {
    const ShadowVolume& volume = g.volumes[v];
    std::fill_n(f.volume_of_face.begin() + volume.first_face, volume.face_count, v);
    std::fill_n(f.volume_of_edge.begin() + volume.first_near, volume.near_count, v);
  }
  return f;
}

}  // namespace kage
