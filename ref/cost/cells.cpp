// SPDX-License-Identifier: Apache-2.0
#include "cost/cells.hpp"

#include <algorithm>
#include <bit>

#include "contract/derived.hpp"
#include "cost/cells_fit.hpp"
#include "kage/token.hpp"

namespace kage {
namespace {

double whole(auto v) { return static_cast<double>(v); }

bool banked(const Config& c) { return c.arrangement != 0; }

/// Pixels whose next state is made in a clock.
int lanes_of(const Config& c) { return banked(c) ? c.lanes : c.max_width; }

/// Pixels that leave the line in a clock.
int exit_lanes(const Config& c) { return banked(c) ? c.lanes : 1; }

int groups_of(const Config& c, int lanes) { return (c.max_width + lanes - 1) / lanes; }

/// Bits of the longest token, with padding.
double token_bits(const Config& c) {
  const Layout layout(c);
  return 32.0 * whole(*std::max_element(layout.words.begin(), layout.words.end()));
}

/// Bits of an entry of an expansion unit's segment buffer.
int segment_bits(const Config& c) { return derived::segment_depth_bits(c) + c.dx_bits + c.face_bits; }

}  // namespace

// Terms for the parts of the RTL, in this order. Fixed control, the port, the token and its check, the command with
// depth and colour. Then the lanes, the way out, the table, the units and their tree.
const std::array<CellTerm, kCellTerms> kCellTermInfo{{
    {"one", [](const Config&) { return 1.0; }},
    {"beat_words", [](const Config& c) { return whole(c.beat_words); }},
    {"token_bits", token_bits},
    {"depth_bits", [](const Config& c) { return whole(derived::depth_bits(c)); }},
    {"color_bits", [](const Config& c) { return whole(derived::color_bits(c)); }},
    {"slope_bits", [](const Config& c) { return whole(c.smooth * derived::color_bits(c)); }},
    {"address_bits", [](const Config& c) { return whole(std::bit_width(static_cast<unsigned>(c.max_width))); }},
    {"lanes", [](const Config& c) { return whole(lanes_of(c)); }},
    {"lanes_pixel_bits", [](const Config& c) { return whole(lanes_of(c) * derived::pixel_bits(c)); }},
    {"lanes_depth_bits", [](const Config& c) { return whole(lanes_of(c) * derived::depth_bits(c)); }},
    {"lanes_slope_bits", [](const Config& c) { return whole(lanes_of(c) * c.smooth * derived::color_bits(c)); }},
    {"lanes_counting", [](const Config& c) { return whole(lanes_of(c) * static_cast<int>(c.dsf_bits > 1)); }},
    {"lanes_blended", [](const Config& c) { return whole(lanes_of(c) * c.translucency * c.channels); }},
    {"exit_lanes_bits", [](const Config& c) { return whole(exit_lanes(c) * derived::exit_bits(c)); }},
    {"share_bits",
     [](const Config& c) {
       if (c.dsf_bits == 0) return 0.0;
       const int products = c.count_bits == 0 ? 1 : c.lights * (1 + c.count_bits);
       return whole(c.channels * derived::factor_bits(c) * products);
     }},
    {"units", [](const Config& c) { return whole(c.units); }},
    {"units_bits",
     [](const Config& c) {
       return whole(c.units * (segment_bits(c) + derived::entry_bits(c) + 2 * derived::point_bits(c)));
     }},
}};

// Fixed control, the queues of tokens, the walk of depth and that of colours.
const std::array<CellTerm, kFrontEndTerms> kFrontEndTermInfo{{
    {"one", [](const Config&) { return 1.0; }},
    {"token_bits", token_bits},
    {"plane_bits", [](const Config& c) { return whole(derived::plane_bits(c)); }},
    {"gradients_bits", [](const Config& c) { return whole(derived::gradients_bits(c)); }},
}};

// The display's curve, and the bits of colours in the lanes, with the products of counts.
const std::array<CellTerm, kLinearTerms> kLinearTermInfo{{
    {"channels", [](const Config& c) { return whole(c.channels); }},
    {"lanes_level_bits",
     [](const Config& c) {
       return whole(lanes_of(c) * c.channels * (derived::lane_level_bits(c) + derived::pixel_level_bits(c) - 16));
     }},
}};

Config without_linear(Config config) {
  config.linear_bits = 0;
  return config;
}

namespace {

template <std::size_t N>
void add(Cells& cells, const Config& config, const std::array<CellTerm, N>& terms, const CellFit<N>& fit) {
  for (std::size_t i = 0; i < N; ++i) {
    const double term = terms[i].value(config);
    cells.luts += fit.luts[i] * term;
    cells.flip_flops += fit.flip_flops[i] * term;
  }
}

const CellFit<kCellTerms>& fit_of(const Config& config) { return banked(config) ? kBankedFit : kSystolicFit; }

}  // namespace

Cells estimated_cells(const Config& config) {
  Cells cells;
  add(cells, without_linear(config), kCellTermInfo, fit_of(config));
  if (config.linear_bits > 0) add(cells, config, kLinearTermInfo, kLinearFit);
  if (config.active > 0) add(cells, config, kFrontEndTermInfo, kFrontEndFit);
  cells.bits_per_pixel = derived::pixel_bits(config);
  const auto bits = [&cells](auto words, auto width) {
    cells.ram_bits += static_cast<std::uint64_t>(words) * static_cast<std::uint64_t>(width);
  };
  const int lanes = exit_lanes(config);
  const int groups = groups_of(config, lanes);
  if (banked(config)) bits(groups, lanes * derived::pixel_bits(config));
  bits(2 * groups, lanes * derived::exit_bits(config));
  if (derived::has_table(config)) bits(config.lights << config.class_bits, derived::entry_share_bits(config));
  if (config.units > 0) {
    bits(2 * config.units * derived::most_segments(config), segment_bits(config));
    bits(config.units * (2 << config.face_bits), derived::entry_bits(config));
    bits(groups, lanes * (config.z_bits + derived::pixel_rgb_bits(config) + derived::class_field_bits(config)));
  }
  if (config.active > 0)  // two banks, each a power of two
    bits(2 * std::max(2U, std::bit_ceil(static_cast<unsigned>(config.active))), derived::active_bits(config));
  return cells;
}

CellSpread cell_spread(const Config& config) {
  const auto& fit = fit_of(config);
  CellSpread spread{fit.luts_spread, fit.flip_flops_spread};
  if (config.active > 0) {
    spread.luts = std::max(spread.luts, kFrontEndFit.luts_spread);
    spread.flip_flops = std::max(spread.flip_flops, kFrontEndFit.flip_flops_spread);
  }
  if (config.linear_bits > 0) {
    spread.luts = std::max(spread.luts, kLinearFit.luts_spread);
    spread.flip_flops = std::max(spread.flip_flops, kLinearFit.flip_flops_spread);
  }
  return spread;
}

}  // namespace kage
