// SPDX-License-Identifier: Apache-2.0
#include "pipeline/choose.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>

#include "cost/cells.hpp"
#include "cost/line_clocks.hpp"
#include "kage/frontend.hpp"
#include "stream/token_pieces.hpp"

namespace kage {
namespace {

// A later configuration of the list takes the place of an earlier one if it costs a tenth less. Less does not count:
// most people know the first of the list, the costs are of one frame, and the estimate of look-up tables has an error.
// Where two estimates are nearer than that, one in five does not name the smaller core (docs/plan.md, "The estimate of
// cells").
constexpr double kWorthMoving = 0.9;

/// Whether a configuration is ever chosen without its name.
bool for_anybody(const Config& c, const Needs& needs) {
  const bool one_volume_only = c.dsf_bits > 0 && c.fsf == 0;
  return c.arrangement != 0 && c.units == 0 && c.active == 0 &&
         !(needs.shadows && needs.several_volumes && one_volume_only);
}

/// Whether it counts light samples that the scene has not. A table of one light needs a counter of one.
bool counts_in_vain(const Config& c, const Needs& needs) {
  const bool hard = needs.samples == 1 && (needs.lights == 1 || !needs.shadows);
  return hard && c.count_bits > (needs.light_table() ? 1 : 0);
}

/// The named configurations that come into question, in listed order.
std::vector<NamedConfig> in_question(const Needs& needs) {
  std::vector<NamedConfig> list = named_configs();
  std::erase_if(list,
                [&](const NamedConfig& n) { return !for_anybody(n.config, needs) || !lacks(n.config, needs).empty(); });
  const auto vain = [&](const NamedConfig& n) { return counts_in_vain(n.config, needs); };
  if (!std::all_of(list.begin(), list.end(), vain)) std::erase_if(list, vain);
  return list;
}

}  // namespace

std::vector<ChoiceCost> choices(const SceneFrame& first, const Needs& needs, const DrawOptions& draw) {
  // The tokens of a frame depend on how shadows are drawn; their words only on widths.
  using ShadowWay = std::pair<int, bool>;  // DSF_BITS, and whether lights come one after the other
  std::map<ShadowWay, std::vector<ChoiceCost>> ways;
  std::vector<std::pair<ShadowWay, std::size_t>> order;
  for (const NamedConfig& n : in_question(needs)) {
    const ShadowWay way(n.config.dsf_bits, n.config.linear_bits > 0);
    order.emplace_back(way, ways[way].size());
    ways[way].push_back({n, 0, estimated_cells(n.config).luts, approximates(n.config, needs)});
  }
  if (order.size() > 1)
    for (auto& [way, list] : ways) {
      Config config = list[0].named.config;
      config.max_width = std::max(config.max_width, kJudgedWidth);
      config.x_bits = std::max(config.x_bits, static_cast<int>(std::bit_width(unsigned{kJudgedWidth})));
      // An exact order may take long, and hardly changes how many tokens there are: all ways have the same of it.
      Look look = draw.look;
      look.translucent = TranslucentWay::submission;
      const FrameGeometry geometry = make_geometry(first, config, kJudgedWidth, kJudgedHeight, {.look = look});
      std::vector<PhaseCounter> counters;
      for (const ChoiceCost& c : list) counters.emplace_back(c.named.config).start(kJudgedWidth);
      TokenPieces tokens(config);
      make_frame(geometry, config, 0,
                 [&](std::span<const std::uint32_t> words) {
                   tokens.feed(words, [&](const Token& token) {
                     for (PhaseCounter& counter : counters) counter.token(token);
                   });
                 },
                 {.threads = draw.threads});
      for (std::size_t i = 0; i < list.size(); ++i) {
        const auto& lines = counters[i].lines();
        list[i].clocks = std::accumulate(lines.begin(), lines.end(), std::uint64_t{0});
      }
    }
  std::vector<ChoiceCost> all;
  for (const auto& [way, at] : order) all.push_back(ways[way][at]);
  return all;
}

NamedConfig choose_config(const Scene& scene, const DrawOptions& draw) {
  const int frames = draw.frames > 0 ? draw.frames : scene.frame_count();
  const SceneFrame first = scene.frame(0, frames);
  const Needs needs = needs_of_frames(scene, frames, draw.width, draw.height, draw.look.samples);
  std::vector<ChoiceCost> all = choices(first, needs, draw);
  if (all.empty()) return choose_config(needs);
  const auto rough = [](const ChoiceCost& c) { return !c.rough.empty(); };
  if (!std::all_of(all.begin(), all.end(), rough)) std::erase_if(all, rough);
  const ChoiceCost* best = all.data();
  for (const ChoiceCost& c : all)
    if (c.cost() < kWorthMoving * best->cost()) best = &c;
  return best->named;
}

}  // namespace kage
