// SPDX-License-Identifier: Apache-2.0
#include "frontend/band_effect.hpp"

#include <algorithm>

#include "contract/derived.hpp"

namespace kage {

BandEffect::BandEffect(const FrameGeometry& geometry, const Config& config)
    : config_(config),
      width_(geometry.width),
      stride_(static_cast<std::size_t>(geometry.width) + kKernelSlack),
      pyramid_(geometry, config) {
  const std::size_t n = stride_ * kBandLines;
  zb_.resize(n);
  owner_.resize(n);
  if (config.dsf_bits == 0) return;
  receivers_.resize(n);
  dsf_.resize(n);
  flags_.resize(n);
}

void BandEffect::start(int y0, int y1) {
  y0_ = y0;
  y1_ = y1;
  shown_.clear();
  const std::size_t n = stride_ * static_cast<std::size_t>(y1 - y0);
  std::fill_n(zb_.begin(), n, static_cast<std::int32_t>(derived::clear_depth(config_)));
  std::fill_n(owner_.begin(), n, kNobody);
}

std::uint32_t BandEffect::draw(int y, const SpanToken& s) {
  const auto number = static_cast<std::uint32_t>(shown_.size());
  shown_.emplace_back();
  span_op_flat(depth_ramp(config_, s), s.xr - s.xl, row(zb_, y) + s.xl, row(owner_, y) + s.xl, number, {nullptr, 0});
  return number;
}

void BandEffect::end_drawing() {
  for (int y = y0_; y < y1_; ++y) {
    const std::uint32_t* owner = row(owner_, y);
    for (int x = 0; x < width_;) {
      const int from = x;
      const std::uint32_t number = owner[x];
      while (x < width_ && owner[x] == number) ++x;
      if (number != kNobody) shown_[number].add(from, x);
    }
  }
}

void BandEffect::clear_flags() {
  std::fill_n(flags_.begin(), stride_ * static_cast<std::size_t>(y1_ - y0_), std::uint8_t{0});
}

Before BandEffect::count(int y, const SpanToken& s) {
  const Standing standing = pyramid_.standing(y, s);
  if (standing == Standing::behind) return {{}, false};
  if (standing == Standing::before) {
    const std::int32_t* at = row(receivers_, y);
    PixelRange pixels{s.xl, s.xr};
    while (!pixels.none() && at[pixels.first] == 0) ++pixels.first;
    while (!pixels.none() && at[pixels.end - 1] == 0) --pixels.end;
    if (pixels.none()) return {{}, false};
    count_all(y, pixels.first, pixels.end, s.w);
    return {pixels, true};
  }
  Before before = span_count(depth_ramp(config_, s), s.xr - s.xl, row(receivers_, y) + s.xl, row(dsf_, y) + s.xl,
                             static_cast<std::uint8_t>(s.w));
  if (!before.pixels.none()) before.pixels = {before.pixels.first + s.xl, before.pixels.end + s.xl};
  return before;
}

void BandEffect::count_all(int y, int xl, int xr, int w) {
  std::uint8_t* dsf = row(dsf_, y);
  for (int x = xl; x < xr; ++x) dsf[x] = static_cast<std::uint8_t>(dsf[x] + w);
}

bool BandEffect::end_volume(int y, int xl, int xr) {
  return span_flag(xr - xl, row(receivers_, y) + xl, row(dsf_, y) + xl, row(flags_, y) + xl,
                   static_cast<std::uint8_t>(derived::most_dsf(config_)));
}

bool BandEffect::nobody_receives(int y, int xl, int xr) const {
  const std::int32_t* at = row(receivers_, y);
  return std::all_of(at + xl, at + xr, [](std::int32_t z) { return z == 0; });
}

PixelRange BandEffect::before(int y, const SpanToken& s) const {
  PixelRange r = span_before(depth_ramp(config_, s), s.xr - s.xl, row(zb_, y) + s.xl);
  if (!r.none()) r = {r.first + s.xl, r.end + s.xl};
  return r;
}

}  // namespace kage
