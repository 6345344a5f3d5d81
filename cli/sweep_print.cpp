// SPDX-License-Identifier: Apache-2.0
#include "sweep_print.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "json/json_text.hpp"
#include "number/counted.hpp"

namespace kage::cli {
namespace {

/// A number with so many digits behind the point; "-" for null. A half is rounded up, as the page does.
std::string number(const Json& value, int digits) {
  if (value.is_null()) return "-";
  const auto v = value.get<double>();
  return fmt::format("{:.{}f}", digits == 0 ? std::round(v) : v, digits);
}

/// Whether a device was asked for in any row.
bool any_placed(const std::vector<Json>& rows) {
  return std::any_of(rows.begin(), rows.end(),
                     [](const Json& row) { return !row.at("area").at("placed_on").is_null(); });
}

/// Meanings of the columns' names.
std::string legend(bool placed) {
  return fmt::format(
      "# face, shadow: pixels with another face than the oracle's, another number of shadowed samples; gross: by more "
      "than any stated error gives\n"
      "# z LSB/bound: the depth that is furthest off, in units of its last bit, and the bound\n"
      "# light (dB): colours against each light worked out at each pixel; PSNR (dB), FLIP: against the finest picture\n"
      "# ns/px: of the golden core; clk/px: clocks of the RTL; sim fps: frames a second of its model; words: of the "
      "stream, a frame; b/px: bits a pixel\n"
      "{}# docs/sweep.md says how each is measured; --json and --csv have all figures\n",
      placed ? "# MHz: the clock of the placed core; fps: its frames a second\n" : "");
}

std::string line_of(const Json& row, bool placed) {
  const Json& a = row.at("accuracy");
  const Json& light = a.at("light");
  const Json& s = row.at("speed");
  const Json& area = row.at("area");
  const std::string name = fmt::format("{} {}", row.at("axis").get<std::string>(), row.at("value").get<std::string>());
  const std::string clock =
      placed ? fmt::format(" {:>6} {:>7}", number(area.at("fmax_mhz"), 1), number(s.at("frames_per_second"), 1)) : "";
  return fmt::format(
      "{}{:<30} {:>8} {:>7} {:>7} {:>5} {:>13} {:>6} {:>6} {:>6} {:>7} {:>7}{} {:>7} {:>8} {:>6}{} {:>4}{}\n",
      row.at("pareto").get<bool>() ? "*" : " ", name, json_text(a.at("pixels")), json_text(a.at("visible_wrong")),
      json_text(a.at("shadow_wrong")), json_text(a.at("gross_wrong")),
      number(a.at("z_error_max_lsb"), 2) + "/" + number(a.at("z_error_bound_lsb"), 2),
      light.is_null() ? "-" : number(light.at("drawn").at("psnr"), 1),
      a.at("psnr").is_null() ? "equal" : number(a.at("psnr"), 1), number(a.at("flip"), 4),
      number(s.at("golden_ns_per_pixel"), 1), number(s.at("rtl_cycles_per_pixel"), 3),
      s.at("rtl_cycles_from") == "cosim" ? " " : "~", number(s.at("cosim_frames_per_second"), 2),
      number(s.at("words_per_frame"), 0), number(area.at("luts"), 0), area.at("counted").get<bool>() ? " " : "~",
      json_text(area.at("bits_per_pixel")), clock);
}

using Column = std::function<void(const std::string& name, const Json& value)>;

void columns(const std::string& name, const Json& value, const Column& use) {
  if (!value.is_object()) return use(name, value);
  for (const auto& [key, inner] : value.items())
    columns(name.empty() ? key : fmt::format("{}.{}", name, key), inner, use);
}

std::string quoted_csv(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return json_text(value);
  std::string out = "\"";
  for (const char c : value.get<std::string>()) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string sweep_table(const std::vector<Json>& rows) {
  const bool placed = any_placed(rows);
  std::string text = legend(placed);
  std::string scene;
  for (const Json& row : rows) {
    if (scene.empty() || row.at("scene") != scene) {
      scene = row.at("scene").get<std::string>();
      text += fmt::format("# {}: {}; * no other row of its size beats it; ~ foretold or estimated\n", scene,
                          counted(row.at("frames").get<int>(), "frame"));
      text += fmt::format(
          "{:<31} {:>8} {:>7} {:>7} {:>5} {:>13} {:>6} {:>6} {:>6} {:>7} {:>7}  {:>7} {:>8} {:>6}  {:>4}{}\n",
          "# axis value", "pixels", "face", "shadow", "gross", "z LSB/bound", "light", "PSNR", "FLIP", "ns/px",
          "clk/px", "sim fps", "words", "LUTs", "b/px", placed ? "    MHz     fps" : "");
    }
    text += line_of(row, placed);
  }
  return text;
}

std::string sweep_csv(const std::vector<Json>& rows) {
  // A key may be null in one row and hold values in another, so the columns are those of all rows.
  std::vector<std::string> names;
  for (const Json& row : rows)
    columns("", row, [&](const std::string& name, const Json& value) {
      if (!value.is_null() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    });
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  text += '\n';
  for (const Json& row : rows) {
    std::vector<std::string> cells(names.size());
    columns("", row, [&](const std::string& name, const Json& value) {
      const auto at = std::find(names.begin(), names.end(), name);
      if (at != names.end()) cells[static_cast<std::size_t>(at - names.begin())] = quoted_csv(value);
    });
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + cells[i];
    text += '\n';
  }
  return text;
}

}  // namespace kage::cli
