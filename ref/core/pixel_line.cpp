// SPDX-License-Identifier: Apache-2.0
#include "core/pixel_line.hpp"

#include <algorithm>

#include "contract/derived.hpp"
#include "number/packed_color.hpp"

namespace kage {
namespace {

constexpr std::uint32_t kLit = 1U << kPackedBits;

static_assert(std::tuple_size_v<decltype(PixelState::counts)> == kGreatest.lights);

/// As a line's depths have it.
std::int32_t clear_depth(const Config& c) { return static_cast<std::int32_t>(derived::clear_depth(c)); }

}  // namespace

PixelLine::PixelLine(const Config& config) : config_(config), dsf_mask_(derived::most_dsf(config)) {
  const auto n = static_cast<std::size_t>(config.max_width) + kKernelSlack;
  zb_.resize(n);
  attr_.resize(n);
  dsf_.resize(n);
  fsf_.resize(n);
  if (derived::has_table(config)) class_.resize(n);
  if (config.linear_bits > 0) linear_.emplace(config, n);
  if (config.count_bits > 0) counts_.assign(static_cast<std::size_t>(config.lights), std::vector<std::uint32_t>(n));
}

void PixelLine::start(int width, std::uint32_t background) {
  width_ = width;
  background_ = background;
  shade_ = 0;
  shares_.clear();
  bias_ = 0;
  shadow_touched_ = false;
  painted_ = false;
  std::fill(zb_.begin(), zb_.end(), clear_depth(config_));
  std::fill(dsf_.begin(), dsf_.end(), 0U);
  std::fill(fsf_.begin(), fsf_.end(), 0U);
  clear_counts();
  if (linear_) linear_->clear();
}

void PixelLine::clear_flags() {
  if (!shadow_touched_) return;
  std::fill_n(dsf_.begin(), width_, 0U);
  std::fill_n(fsf_.begin(), width_, 0U);
  shadow_touched_ = false;
}

void PixelLine::tree(const TreeLine& line) {
  for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
    const auto z = static_cast<std::int32_t>(line.key[x] >> TreeLine::kIndexBits);
    const bool front = z < zb_[x];
    if (linear_) {
      if (front) linear_->cover(x, unpacked_levels(line.attr[x], config_.linear_bits, config_.channels));
      zb_[x] = front ? z : zb_[x];
      continue;
    }
    attr_[x] = front ? static_cast<std::uint32_t>(line.attr[x]) : attr_[x];
    if (front && !class_.empty()) class_[x] = static_cast<std::uint32_t>(line.attr[x] >> kPackedBits);
    zb_[x] = front ? z : zb_[x];
  }
}

// Whether a sample, or without counters the light, does not come to a pixel.
bool PixelLine::in_shadow(std::size_t x, std::uint32_t bias) const {
  return config_.fsf != 0 ? fsf_[x] != 0 : ((dsf_[x] + bias) & dsf_mask_) != 0;
}

// An OP of linear light: the light from everywhere where it covers a pixel, or, behind a RESOLVE, a light's own.
void PixelLine::light(const SpanToken& s) {
  for (int at = s.xl; at < s.xr; ++at) {
    const auto x = static_cast<std::size_t>(at);
    const auto z = static_cast<std::int32_t>(span_depth(config_, s, at));
    if (!linear_->begun()) {
      if (z >= zb_[x]) continue;
      zb_[x] = z;
      linear_->cover(x, span_color(config_, s, at, false));
    } else if (z <= zb_[x] && linear_->serve(x)) {
      const bool counts = !counts_.empty();
      linear_->add(x, span_levels(config_, s, at), counts ? counts_[0][x] : in_shadow(x, linear_->bias()) ? 1 : 0);
      if (counts) counts_[0][x] = 0;
      dsf_[x] = fsf_[x] = 0;
    }
  }
}

void PixelLine::op(const SpanToken& s) {
  if (linear_) return light(s);
  const DepthRamp ramp = depth_ramp(config_, s);
  const std::uint32_t lit = s.normal_class != 0 ? kLit : 0;
  const ClassSpan classes{class_.empty() ? nullptr : class_.data() + s.xl, static_cast<std::uint32_t>(s.normal_class)};
  if (config_.smooth == 0) {
    const std::uint32_t color = packed_color(s.color, config_.channels);
    span_op_flat(ramp, s.xr - s.xl, zb_.data() + s.xl, attr_.data() + s.xl, color | lit, classes);
    return;
  }
  span_op_smooth(ramp, s.xr - s.xl, zb_.data() + s.xl, attr_.data() + s.xl, lit, color_ramps(s).data(),
                 config_.channels, classes);
}

// Without SMOOTH a ramp that does not rise: 8 bits on top of 22, as the kernels have it.
std::array<ColorRamp, 3> PixelLine::color_ramps(const SpanToken& s) const {
  const int spare = config_.smooth == 0 ? 22 : 32 - derived::ramp_bits(config_);
  std::array<ColorRamp, 3> ramps{};
  for (std::size_t c = 0; c < 3; ++c)
    ramps[c] = {static_cast<std::int32_t>(static_cast<std::uint32_t>(s.color[c]) << spare),
                static_cast<std::int32_t>(static_cast<std::uint32_t>(s.dcolor[c]) << spare)};
  return ramps;
}

void PixelLine::sp(const SpanToken& s) {
  shadow_touched_ = true;
  span_sp(depth_ramp(config_, s), s.xr - s.xl, zb_.data() + s.xl, dsf_.data() + s.xl, static_cast<std::uint32_t>(s.w));
}

void PixelLine::nc(int xl, int xr, int w) {
  shadow_touched_ = true;
  for (int x = xl; x < xr; ++x) dsf_[static_cast<std::size_t>(x)] += static_cast<std::uint32_t>(w);
}

void PixelLine::inside(int w) {
  shadow_touched_ = true;
  bias_ += static_cast<std::uint32_t>(w);
}

void PixelLine::ev(int xl, int xr) {
  span_ev(xr - xl, dsf_.data() + xl, fsf_.data() + xl, bias_, dsf_mask_);
  bias_ = 0;
}

void PixelLine::es(int xl, int xr, int light) {
  std::uint32_t* counts = counts_[static_cast<std::size_t>(light)].data() + xl;
  const std::uint32_t most = derived::most_count(config_);
  if (config_.fsf != 0)
    span_es(xr - xl, fsf_.data() + xl, counts, 0, 1, most);
  else
    span_es(xr - xl, dsf_.data() + xl, counts, bias_, dsf_mask_, most);
  bias_ = 0;
  any_count_ = true;
}

void PixelLine::clear_counts() {
  any_count_ = false;
  for (auto& counts : counts_) std::fill(counts.begin(), counts.end(), 0U);
}

// Share of its colour that a pixel keeps in a channel, in steps of 2^-SHADE_FRAC.
std::uint32_t PixelLine::factor(std::size_t x, std::size_t channel) const {
  const std::uint32_t one = derived::whole_share(config_);
  std::uint32_t lost = 0;
  if (!derived::has_table(config_)) {
    if ((attr_[x] & kLit) != 0) lost = counts_[0][x] * shade_;
  } else if (class_[x] != 0) {
    const std::size_t first = (class_[x] - 1) * counts_.size();
    for (std::size_t i = 0; i < counts_.size(); ++i) lost += counts_[i][x] * shares_[first + i][channel];
  }
  return lost < one ? one - lost : 0;
}

void PixelLine::resolve(int samples) {
  if (linear_) {
    linear_->begin(samples, bias_);
    bias_ = 0;
    return;
  }
  if (config_.count_bits > 0)
    resolve_counts();
  else
    resolve_flags();
  bias_ = 0;
  clear_flags();
}

void PixelLine::resolve_flags() {
  const Darkening darkening{derived::whole_share(config_) - shade_, derived::half_share(config_), config_.shade_frac};
  const bool by_fsf = config_.fsf != 0;
  span_resolve(width_, zb_.data(), clear_depth(config_), by_fsf ? fsf_.data() : dsf_.data(), by_fsf ? 0 : bias_,
               by_fsf ? 1 : dsf_mask_, attr_.data(), darkening);
}

void PixelLine::resolve_counts() {
  if (!any_count_) return;
  const std::uint32_t half = derived::half_share(config_);
  const std::int32_t clear = clear_depth(config_);
  for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
    std::uint32_t any = 0;
    for (const auto& counts : counts_) any |= counts[x];
    if (any == 0 || zb_[x] == clear) continue;
    std::uint32_t darkened = attr_[x] & kLit;
    for (unsigned c = 0; c < static_cast<unsigned>(config_.channels); ++c)
      darkened |= (((attr_[x] >> 8 * c & 255U) * factor(x, c) + half) >> config_.shade_frac) << 8 * c;
    attr_[x] = darkened;
  }
  clear_counts();
}

// Linear light as it is displayed, and `background` where there is none.
void PixelLine::show(std::uint32_t background) {
  const std::int32_t clear = clear_depth(config_);
  for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x)
    attr_[x] = zb_[x] == clear ? background : linear_->shown(x);
}

void PixelLine::tp(const SpanToken& s) {
  if (!painted_ && linear_) {
    // The way out has cleared the counters; nobody asks for the flags.
    show(background_);
    clear_flags();
    clear_counts();
    painted_ = true;
  } else if (!painted_) {
    const std::int32_t clear = clear_depth(config_);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x)
      attr_[x] = zb_[x] == clear ? background_ : attr_[x];
    painted_ = true;
  }
  span_tp(depth_ramp(config_, s), s.xr - s.xl, zb_.data() + s.xl, attr_.data() + s.xl, color_ramps(s).data(),
          config_.channels, s.alpha);
}

PixelState PixelLine::state(int x) const {
  const auto i = static_cast<std::size_t>(x);
  PixelState s;
  s.z = static_cast<std::uint32_t>(zb_[i]);
  const bool clear = zb_[i] == clear_depth(config_);
  // A clear pixel's colour and class may be left from earlier lines, so they are never shown.
  if (!clear || painted_)
    s.color = linear_ && !painted_ ? linear_->at(i) : unpacked_levels(attr_[i], 8, config_.channels);
  if (linear_) s.served = linear_->served(i);
  if (!clear && !linear_) s.normal_class = class_.empty() ? (attr_[i] & kLit) / kLit : class_[i];
  s.dsf = dsf_[i] & dsf_mask_;
  s.fsf = fsf_[i];
  for (std::size_t light = 0; light < counts_.size(); ++light) s.counts[light] = counts_[light][i];
  return s;
}

void PixelLine::finish(bool blank, std::span<std::uint8_t> out) {
  const std::int32_t clear = clear_depth(config_);
  const auto width = static_cast<std::size_t>(width_);
  if (linear_ && !painted_ && !blank) show(background_);
  if (blank) std::fill_n(attr_.begin(), width, background_);
  // Painted pixels have the background's colour already where they need it; no depth is below 0.
  line_bytes(width_, zb_.data(), attr_.data(), painted_ || blank ? -1 : clear, background_, config_.channels,
             out.data());
  std::fill_n(zb_.begin(), width, clear);
  clear_flags();
  if (any_count_) clear_counts();
  if (linear_) linear_->clear();
  bias_ = 0;
  painted_ = false;
}

}  // namespace kage
