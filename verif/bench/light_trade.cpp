// SPDX-License-Identifier: Apache-2.0
// Steps to the truth of light, with their gains and costs (docs/trade.md): two tables in Markdown. 320x240; errors in
// steps of 255 over pixels and channels in some shadow, against each light worked out at each pixel
// (verif/oracle/light_reference.hpp). Clocks are by design and look-up tables estimated, of a core of 8 lanes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "bench/light_steps.hpp"
#include "cost/cells.hpp"
#include "image/flip_metric.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr std::array<std::string_view, 7> kScenes{
    "sun", "lamp", "three-lamps", "three-suns", "three-spots", "table-and-window", "office"};

/// A scene by a step, faces being diced or not.
struct Row {
  std::string scene;
  std::string_view step;
  bool diced;
  LightError error;
  double flip;
  Cells cells;
  std::uint64_t words;
  std::uint64_t clocks;
};

Config plain() {
  Config c;
  c.shade_frac = 16;
  c.lanes = 8;
  c.max_width = 1280;
  return c;
}

/// The picture, and the reference's rounded; what has no reference is the same in both.
std::array<Image, 2> both(const std::vector<std::uint32_t>& picture, const std::vector<ReferencePixel>& reference) {
  std::array<Image, 2> out{Image(kWidth, kHeight, 3), Image(kWidth, kHeight, 3)};
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const auto shown = static_cast<std::uint8_t>(picture[i] >> (8 * c));
      const bool judged = reference[i].face != kNothing && !reference[i].tie;
      out[0].data[3 * i + static_cast<std::size_t>(c)] = shown;
      out[1].data[3 * i + static_cast<std::size_t>(c)] =
          judged ? static_cast<std::uint8_t>(std::lround(reference[i].color[c])) : shown;
    }
  return out;
}

std::vector<Row> rows_of(const LitScene& lit) {
  std::vector<Row> rows;
  const JudgedFrame of(Scene::from(lit.parts), kWidth, kHeight);
  for (const bool diced : {false, true})
    for (const LightStep& s : kLightSteps) {
      const std::optional<Config> c = config_of(s, of.drawn, plain());
      if (!c) continue;
      Look look;
      look.darkening = s.darkening;
      if (!diced) look.max_shading = 0;
      const TakenFrame t = taken(of, *c, look);
      const auto [picture, truth] = both(t.picture, of.reference);
      rows.push_back(
          {lit.name, s.name, diced, t.error, flip_metric(truth, picture).mean, estimated_cells(*c), t.words, t.clocks});
    }
  return rows;
}

void print_row(const std::vector<std::string>& cells) { fmt::print("| {} |\n", fmt::join(cells, " | ")); }

void print_head(const std::vector<std::string>& cells) {
  print_row(cells);
  std::string rule = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) rule += "---|";
  fmt::print("{}\n", rule);
}

/// Mean and worst of each step with dicing, a column for each scene.
void print_steps(const std::vector<std::vector<Row>>& all) {
  std::vector<std::string> head{"mean, worst"};
  for (const auto& rows : all) head.push_back(rows.front().scene);
  print_head(head);
  for (const LightStep& s : kLightSteps) {
    std::vector<std::string> cells{std::string(s.name)};
    for (const auto& rows : all) {
      std::string text = "-";
      for (const Row& r : rows)
        if (r.diced && r.step == s.name) text = fmt::format("{:.2f}, {:.1f}", r.error.mean(), r.error.worst);
      cells.push_back(text);
    }
    print_row(cells);
  }
}

void print_all(const std::vector<std::vector<Row>>& all) {
  print_head({"scene", "step", "diced", "mean", "worst", "dB", "FLIP", "bits a pixel", "LUTs", "words", "clocks"});
  for (const auto& rows : all)
    for (const Row& r : rows)
      print_row({r.scene, std::string(r.step), r.diced ? "yes" : "no", fmt::format("{:.2f}", r.error.mean()),
                 fmt::format("{:.1f}", r.error.worst), fmt::format("{:.1f}", r.error.psnr()),
                 fmt::format("{:.4f}", r.flip), std::to_string(r.cells.bits_per_pixel),
                 fmt::format("{:.0f}~", r.cells.luts), std::to_string(r.words), std::to_string(r.clocks)});
}

}  // namespace

int main() {
  std::vector<std::vector<Row>> all;
  const std::vector<LitScene> scenes = lit_scenes();
  for (const std::string_view name : kScenes)
    for (const LitScene& lit : scenes)
      if (lit.name == name) all.push_back(rows_of(lit));
  print_steps(all);
  fmt::print("\n");
  print_all(all);
}
