// SPDX-License-Identifier: Apache-2.0
#include "plan/costs.hpp"

#include "cost/cells.hpp"
#include "cost/line_clocks.hpp"
#include "cost/processors.hpp"
#include "kage/core.hpp"
#include "pipeline/stopwatch.hpp"
#include "stream/token_pieces.hpp"

namespace kage::plan {

std::vector<Config> arrangements_of(const Config& base) {
  std::vector<Config> list;
  for (int beat = 1; beat <= kGreatest.beat_words; beat *= 2) {
    Config c = base;
    c.beat_words = beat;
    c.arrangement = 1;
    for (c.lanes = 1; c.lanes <= kGreatest.lanes; c.lanes *= 2) list.push_back(c);
    if (base.max_width > kMostProcessors) continue;
    c.arrangement = 0;
    c.lanes = Config{}.lanes;
    list.push_back(c);
  }
  return list;
}

std::vector<PlanCandidate> costs_of(std::span<const PlannedScene> scenes, const Config& base, const std::string& way,
                                    bool front_end, const FrameStep& step) {
  std::vector<PlanCandidate> out;
  for (const Config& c : arrangements_of(base)) out.push_back({way, c, {}});
  PlanCost shared;
  // How many polygons it must hold is not known yet: as many as any.
  const int active = front_end ? kGreatest.active : 0;
  Config made_for = base;
  made_for.active = active;
  GoldenCore core(made_for);
  const LineSink nobody = [](int, std::span<const std::uint8_t>) {};
  TokenPieces tokens(made_for);
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    std::vector<LineClockCounter> counters;
    for (const PlanCandidate& c : out) {
      Config with = c.config;
      with.active = active;
      counters.emplace_back(with);
    }
    DrawOptions draw = scenes[s].draw;
    if (front_end) draw.level = Level::polygons;
    SceneFrames frames(scenes[s].scene, made_for, draw);
    SceneFrames by_spans(scenes[s].scene, base, scenes[s].draw);
    for (int i = 0; i < frames.frames(); ++i) {
      step();
      const auto count_words = [&](std::span<const std::uint32_t> words) { shared.words += words.size(); };
      if (front_end) by_spans.frame(i, count_words);
      tokens.start();
      bool begun = false;
      frames.frame(i, [&](std::span<const std::uint32_t> words) {
        if (!front_end) count_words(words);
        for (LineClockCounter& counter : counters)
          if (!begun) counter.begin(i, FrameHeader::read(words));
        begun = true;
        tokens.feed(words, [&](const Token& token) {
          for (LineClockCounter& counter : counters) counter.token(token);
        });
        const Stopwatch watch(shared.golden_seconds);
        core.feed(words, nobody);
      });
      core.finish(nobody);
      for (LineClockCounter& counter : counters) counter.end();
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      const LineClocks& sums = counters[k].sums();
      PlanCost& cost = out[k].cost;
      const int scene = static_cast<int>(s);
      cost.clocks += sums.clocks;
      if (sums.worst.clocks > cost.worst_line) {
        cost.worst_line = sums.worst.clocks;
        cost.worst_at = {scene, sums.worst.frame, sums.worst.line};
      }
      if (sums.need.clocks > cost.needed_line) {
        cost.needed_line = sums.need.clocks;
        cost.needed_at = {scene, sums.need.frame, sums.need.first};
        cost.needed_lines = sums.need.count;
      }
    }
  }
  for (PlanCandidate& c : out) {
    c.cost.words = shared.words;
    c.cost.golden_seconds = shared.golden_seconds;
    estimate_cells(c.cost, c.config);
  }
  return out;
}

void estimate_cells(PlanCost& cost, const Config& config) {
  const Cells cells = estimated_cells(config);
  cost.luts = cells.luts;
  cost.flip_flops = cells.flip_flops;
  cost.luts_off = cell_spread(config).luts;
  cost.ram_bits = cells.ram_bits;
  cost.bits_per_pixel = cells.bits_per_pixel;
}

}  // namespace kage::plan
