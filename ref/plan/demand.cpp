// SPDX-License-Identifier: Apache-2.0
#include "plan/demand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "contract/derived.hpp"
#include "contract/kinds.hpp"
#include "kage/frontend.hpp"
#include "stream/token_pieces.hpp"

namespace kage::plan {
namespace {

// The least X_BITS that is legal (rtl/defs/kage.yaml), whatever the width.
constexpr int kLeastXBits = 4;

/// Makes all frames of the scenes. Calls `of_parts` with what each was made of and `of_token` with each token, both
/// with where that is.
template <class OfParts, class OfToken>
void each_frame(std::span<const PlannedScene> scenes, const Config& config, const FrameStep& step, OfParts of_parts,
                OfToken of_token) {
  TokenPieces tokens(config);
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    DrawOptions draw = scenes[s].draw;
    draw.all_spans = true;  // one that was cut to what is seen goes on with the steps of the whole
    SceneFrames frames(scenes[s].scene, config, draw);
    for (int i = 0; i < frames.frames(); ++i) {
      step();
      PlanPlace at{.scene = static_cast<int>(s), .frame = i, .line = 0};
      FrameParts parts;
      tokens.start();
      frames.frame(
          i,
          [&](std::span<const std::uint32_t> words) {
            tokens.feed(words, [&](const Token& token) {
              of_token(token, at);
              if (token.kind == Kind::EOL) ++at.line;
            });
          },
          parts);
      of_parts(parts, PlanPlace{at.scene, at.frame, -1});
    }
  }
}

/// How many of the picture's columns a polygon may have on one line, at most.
int columns(const FrameGeometry& g, const ScreenPolygon& p) {
  std::int32_t least = g.width * 256;
  std::int32_t most = 0;
  for (const ScreenVertex& v : g.outline(p)) {
    least = std::min(least, v.x);
    most = std::max(most, v.x);
  }
  const int first = std::max(0, static_cast<int>(std::floor(least / 256.0)));
  const int end = std::min(g.width, static_cast<int>(std::floor(most / 256.0)) + 1);
  return std::max(0, end - first);
}

}  // namespace

int longest_diced(const FrameGeometry& g) {
  int most = 0;
  for (std::uint32_t i = 0; i < g.drawn; ++i)
    if (g.polygons[i].shade_cut >= 0) most = std::max(most, columns(g, g.polygons[i]));
  return most;
}

namespace {

using GroupKey = std::vector<std::pair<std::uint32_t, int>>;

/// Adds what shadows take in a frame, each group once.
void add_groups(const FrameGeometry& g, const Config& config, const PlanPlace& at, std::set<GroupKey>& seen,
                std::vector<ShareGroup>& out) {
  std::vector<int> samples(static_cast<std::size_t>(config.lights), 0);
  for (const std::uint8_t light : g.sample_light) ++samples[light];
  const auto add = [&](ShareGroup group) {
    GroupKey key;
    for (const Share& s : group.shares) key.emplace_back(s.value, s.samples);
    if (seen.insert(key).second) out.push_back(std::move(group));
  };
  if (g.shares.empty()) {
    add({{{g.shade, std::max(samples[0], 1)}}, at});
    return;
  }
  const auto lights = static_cast<std::size_t>(config.lights);
  for (std::size_t first = 0; first + lights <= g.shares.size(); first += lights)
    for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c) {
      ShareGroup group{{}, at};
      for (std::size_t l = 0; l < lights; ++l)
        if (g.shares[first + l][c] > 0 && samples[l] > 0) group.shares.push_back({g.shares[first + l][c], samples[l]});
      if (!group.shares.empty()) add(std::move(group));
    }
}

void add_geometry(const FrameGeometry& g, const Config& config, const PlanPlace& at, std::set<GroupKey>& seen,
                  WayDemand& out) {
  std::map<std::uint32_t, int> volumes;
  for (const ShadowVolume& v : g.volumes) ++volumes[v.sample];
  for (const auto& [sample, count] : volumes) out.volumes.raise(count, at);
  // A fragment goes on where its face began, whatever lies before it; so does a part of a diced face, but for its
  // colour.
  if (const int most = longest_diced(g); most > 0) out.depth_span.raise(most, at);
  for (const ScreenFragment& f : g.fragments)
    for (std::uint32_t i = f.first_polygon; i < f.first_polygon + f.polygon_count; ++i) {
      const int most = columns(g, g.polygons[i]);
      out.depth_span.raise(most, at);
      if (g.polygons[i].color_planes >= 0) out.color_span.raise(most, at);
    }
  if (config.dsf_bits == 0) return;
  if (config.linear_bits == 0) return add_groups(g, config, at, seen, out.groups);
  out.lights.raise(static_cast<double>(g.passes.size()), at);
  out.lit_samples.raise(std::accumulate(g.passes.begin(), g.passes.end(), 0), at);
}

void add_classes(const SceneFrame& frame, Config config, const Look& look, const PlanPlace& at, WayDemand& out) {
  if (config.dsf_bits == 0 || !derived::has_table(config)) return;
  for (std::size_t i = 0; i < kClassSteps.size(); ++i) {
    config.class_bits = kClassSteps[i];
    const double error = light_demand(frame, config, look).share_error;
    out.class_errors[i].raise(error, at);
    if (error <= 1) return;  // no limit is less: this frame asks for no more classes
  }
}

bool changes_color(const SpanToken& s, int channels) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
    if (s.dcolor[c] != 0) return true;
  return false;
}

}  // namespace

int frames_of(const PlannedScene& scene) {
  return scene.draw.frames > 0 ? scene.draw.frames : scene.scene->frame_count();
}

Features features_of(std::span<const PlannedScene> scenes) {
  Features all;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const PlannedScene& scene = scenes[s];
    const PlanPlace at{.scene = static_cast<int>(s)};
    all.width.raise(scene.draw.width, at);
    all.height.raise(scene.draw.height, at);
    const int frames = frames_of(scene);
    for (int i = 0; i < frames; ++i) {
      const Needs n = needs_of(*scene.scene, scene.scene->frame(i, frames), scene.draw.width, scene.draw.height,
                               scene.draw.look.samples);
      Needs& needs = all.needs;
      needs.width = std::max(needs.width, n.width);
      needs.height = std::max(needs.height, n.height);
      needs.shadows = needs.shadows || n.shadows;
      needs.several_volumes = needs.several_volumes || n.several_volumes;
      needs.smooth = needs.smooth || n.smooth;
      needs.share_error = std::max(needs.share_error, n.share_error);
      needs.color_spread = std::max(needs.color_spread, n.color_spread);
      needs.color = needs.color || n.color;
      needs.translucency = needs.translucency || n.translucency;
      needs.lights = std::max(needs.lights, n.lights);
      needs.samples = std::max(needs.samples, n.samples);
    }
  }
  return all;
}

Config finest(const Features& features, ShadowWay way, int units) {
  const Needs& needs = features.needs;
  const bool linear = way.dsf_bits > 0 && (way.linear || needs.lights > kGreatest.lights);
  Config c;
  c.x_bits = std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(needs.width))), kLeastXBits);
  c.max_width = needs.width;
  c.z_bits = 24;
  c.z_frac = kGreatest.z_frac;
  c.channels = needs.color ? 3 : 1;
  c.smooth = linear || needs.smooth || needs.near_light() ? 1 : 0;
  c.color_frac = c.smooth > 0 ? kGreatest.color_frac : 0;
  c.dsf_bits = way.dsf_bits;
  c.fsf = way.dsf_bits > 0 ? 1 : 0;
  c.shade_frac = kGreatest.shade_frac;
  c.translucency = needs.translucency ? 1 : 0;
  c.units = units;
  if (units > 0) {
    c.face_bits = kGreatest.face_bits;
    c.dx_bits = kGreatest.dx_bits;
    c.seg_bits = kGreatest.seg_bits;
    c.order_bits = kGreatest.order_bits;
  }
  if (linear) c.linear_bits = kGreatest.linear_bits;
  const bool table = !linear && (needs.lights > 1 || needs.light_table());
  if (way.dsf_bits > 0 && (needs.samples > 1 || table)) c.count_bits = kGreatest.count_bits;
  if (way.dsf_bits > 0 && table) {
    c.lights = needs.lights;
    c.class_bits = kGreatest.class_bits;
  }
  validate(c, "plan");
  return c;
}

WayDemand demand_of(std::span<const PlannedScene> scenes, const Features& features, ShadowWay way,
                    const FrameStep& step) {
  WayDemand out;
  out.way = way;
  const Config config = finest(features, way, 0);
  std::set<GroupKey> seen;
  each_frame(
      scenes, config, step,
      [&](const FrameParts& parts, const PlanPlace& at) {
        add_geometry(parts.geometry, config, at, seen, out);
        add_classes(parts.scene, config, scenes[static_cast<std::size_t>(at.scene)].draw.look, at, out);
      },
      [&](const Token& t, const PlanPlace& at) {
        if (!info_of(t.kind).depth) return;
        const int pixels = t.span.xr - t.span.xl;
        out.depth_span.raise(pixels, at);
        if (info_of(t.kind).color && config.smooth > 0 && changes_color(t.span, config.channels))
          out.color_span.raise(pixels, at);
      });
  return out;
}

UnitDemand unit_demand_of(std::span<const PlannedScene> scenes, const Features& features, const FrameStep& step) {
  UnitDemand out;
  const Config config = finest(features, {.dsf_bits = features.needs.shadows ? 1 : 0}, kGreatest.units);
  std::map<int, int> segments;  // of a unit's line at hand
  each_frame(
      scenes, config, step,
      [&](const FrameParts& parts, const PlanPlace& at) {
        out.units.raise(parts.polyhedra.units, at);
        const auto& of = parts.polyhedra.unit_of;
        out.bodies.raise(static_cast<double>(std::count_if(of.begin(), of.end(), [](int u) { return u >= 0; })), at);
        // A body's index is its place among all, those that are not to be seen too.
        for (std::size_t i = 0; i < of.size(); ++i)
          if (of[i] >= 0) out.last_index.raise(static_cast<double>(i), at);
      },
      [&](const Token& t, const PlanPlace& at) {
        if (t.kind == Kind::FACE) out.faces.raise(t.segment.face + 1.0, {at.scene, at.frame, -1});
        if (t.kind != Kind::SEG) return;
        out.dx.raise(t.segment.dx, at);
        int& count = segments[t.segment.unit];
        count = t.segment.sync ? 1 : count + 1;
        out.segments.raise(count, at);
      });
  return out;
}

FrontEndDemand front_end_demand_of(std::span<const PlannedScene> scenes, Config config, const FrameStep& step) {
  config.active = kGreatest.active;
  FrontEndDemand demand;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    DrawOptions draw = scenes[s].draw;
    draw.level = Level::polygons;
    SceneFrames frames(scenes[s].scene, config, draw);
    for (int i = 0; i < frames.frames(); ++i) {
      step();
      FrameParts parts;
      frames.frame(
          i, [](std::span<const std::uint32_t>) {}, parts);
      demand.active.raise(parts.polygons.active, {.scene = static_cast<int>(s), .frame = i, .line = -1});
      demand.left += parts.polygons.of(PolygonWay::active).polygons;
      demand.words += parts.polygons.words;
    }
  }
  return demand;
}

std::string text_of(std::span<const PlannedScene> scenes, const PlanPlace& place) {
  if (place.scene < 0) return "nowhere";
  const PlannedScene& scene = scenes[static_cast<std::size_t>(place.scene)];
  const std::string name = scene.draw.name.empty() ? scene.scene->name() : scene.draw.name;
  return fmt::format("{}frame {}{}", scenes.size() > 1 ? name + ", " : "", place.frame,
                     place.line >= 0 ? fmt::format(", line {}", place.line) : "");
}

}  // namespace kage::plan
