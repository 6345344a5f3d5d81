// SPDX-License-Identifier: Apache-2.0
// The estimate of a core's cells against what yosys counted of the cores in constraints/cells.json.
#include "cost/cells.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "contract/config_text.hpp"
#include "kage/config.hpp"
#include "test/support/catch.hpp"

using namespace kage;

TEST_CASE("every core that was measured is within the stated spread, and some core is near it") {
  std::ifstream file(std::string(KAGE_SOURCE_DIR) + "/constraints/cells.json");
  REQUIRE(file);
  double luts = 0;
  double flip_flops = 0;
  int cores = 0;
  for (const auto& row : nlohmann::json::parse(file)) {
    std::string text = "LANES: 4\n";
    for (const auto& [name, value] : row["core"].items())
      if (name != "LANES") text += name + ": " + std::to_string(value.get<int>()) + "\n";
    Config config = config_from_text(text, "cells.json");
    config.lanes = row["core"].value("LANES", Config{}.lanes);
    const Cells cells = estimated_cells(config);
    const CellSpread spread = cell_spread(config);
    const double off = std::abs(cells.luts / row["luts"].get<double>() - 1);
    const double ff_off = std::abs(cells.flip_flops / row["flip_flops"].get<double>() - 1);
    CAPTURE(text, cells.luts, row["luts"].get<int>(), cells.flip_flops, row["flip_flops"].get<int>());
    CHECK(off <= spread.luts);
    CHECK(ff_off <= spread.flip_flops);
    luts = std::max(luts, off / spread.luts);
    flip_flops = std::max(flip_flops, ff_off / spread.flip_flops);
    ++cores;
  }
  CHECK(cores >= 100);
  CHECK(luts > 0.8);
  CHECK(flip_flops > 0.7);
}

TEST_CASE("RAM and bits of a pixel, counted by hand") {
  Config c;  // 24 bits of depth, 24 of colour, lit, DSF, FSF; 4 lanes, 640 pixels
  CHECK(estimated_cells(c).bits_per_pixel == 51);
  // The line, and two lines of the way out: colour, covered, dark.
  CHECK(estimated_cells(c).ram_bits == 640 * 51 + 2 * 640 * 26);
  c.max_width = 641;  // 161 groups of 4
  CHECK(estimated_cells(c).ram_bits == 644 * 51 + 2 * 644 * 26);
  c.arrangement = 0;  // pixels keep themselves
  CHECK(estimated_cells(c).ram_bits == std::uint64_t{2} * 641 * 26);
  c = {};
  c.count_bits = 4;
  c.lights = 2;
  c.class_bits = 6;  // 64 classes of 3 shares of 9 bits, for each light
  CHECK(estimated_cells(c).bits_per_pixel == 24 + 24 + 6 + 2 + 8);
  CHECK(estimated_cells(c).ram_bits == 640 * 64 + 2 * 640 * (24 + 1 + 6 + 8) + 2 * 64 * 27);
  c = {};
  c.units = 2;
  // Segments: depth 37, length 9, face 7; entries: index 8, lit, dz 37, colour 24; the tree's line: depth, colour, lit.
  CHECK(estimated_cells(c).ram_bits == 640 * 51 + 2 * 640 * 26 + 2 * 256 * 53 + 2 * 256 * 70 + 640 * 49);
}

TEST_CASE("no estimate falls where a parameter rises") {
  Config base =
      config_from_text("LANES: 4\nSMOOTH: 1\nCOLOR_FRAC: 4\nCOUNT_BITS: 2\nCLASS_BITS: 4\nLIGHTS: 2\n", "base");
  const auto at_least = [&](const Config& more) {
    const Cells a = estimated_cells(base);
    const Cells b = estimated_cells(more);
    CHECK(b.luts >= a.luts);
    CHECK(b.flip_flops >= a.flip_flops);
    CHECK(b.ram_bits >= a.ram_bits);
    CHECK(b.bits_per_pixel >= a.bits_per_pixel);
  };
  for (const ParamInfo& p : kParams) {
    if (p.member == &Config::arrangement || p.member == &Config::classic || p.member == &Config::linear_bits) continue;
    Config more = base;
    const int step = p.allowed == 0 ? 1 : more.*(p.member);
    more.*(p.member) = std::min(p.max, more.*(p.member) + std::max(step, 1));
    CAPTURE(p.name);
    at_least(more);
  }
  base = config_from_text("LANES: 4\nSMOOTH: 1\nCOLOR_FRAC: 12\nCOUNT_BITS: 2\n", "base");  // linear light has no table
  for (const int bits : {10, 12, 14}) {
    Config more = base;
    more.linear_bits = bits;
    at_least(more);
    base = more;
  }
}
