// SPDX-License-Identifier: Apache-2.0
#include "stimulus/coverage.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "contract/derived.hpp"
#include "contract/kinds.hpp"
#include "kernels/span_value.hpp"
#include "number/first_centre.hpp"
#include "stimulus/edge_tie.hpp"

namespace kage::verif {

Coverage::Point Coverage::add(bool there, const std::string& group, const std::string& name) {
  if (!there) return {};
  points_.push_back({group, name, 0});
  return {points_.size() - 1};
}

Coverage::Span Coverage::add_span(bool there, const std::string& kind, bool whole) {
  const bool groups = there && config_.arrangement == 1 && config_.lanes > 1;
  const bool several = groups && config_.max_width > config_.lanes;  // groups in a line
  Span s{};
  s.none = add(there, "span", kind + " of no pixel");
  s.one = add(there, "span", kind + " of one pixel");
  s.whole = add(there && whole, "span", kind + " over the whole line");
  s.at_border = add(several, "span", kind + " begins at a group's border");
  s.in_group = add(groups && config_.max_width > 1, "span", kind + " begins within a group");
  s.ends_at_border = add(several, "span", kind + " ends at a group's border");
  return s;
}

Coverage::Ramp Coverage::add_ramp(bool there, const std::string& group, const std::string& what) {
  Ramp r{};
  r.under = add(there, group, what + " below the least: clamped");
  r.over = add(there, group, what + " past the greatest: clamped");
  const bool slopes = there && config_.max_width > 1;  // a slope shows from the second pixel on
  r.wraps = add(slopes, group, what + " leaves its accumulator: wraps");
  r.level = add(slopes, group, what + " without slope");
  return r;
}

Coverage::Coverage(const Config& config, Level level) : config_(config), golden_(config) {
  const Config& c = config_;
  const Layout layout(c);
  const bool polygons = level == Level::polygons;
  // Whether frames at this level bring it, or the front end makes it.
  const auto comes = [&](std::size_t k) {
    const auto kind = static_cast<Kind>(k);
    return layout.words[k] != 0 && (polygons || kind_of(code_of(kind)) == kind);
  };
  const auto has = [&](Kind k) { return comes(static_cast<std::size_t>(k)); };
  const bool shadows = c.dsf_bits > 0;
  const bool table = derived::has_table(c);
  for (std::size_t k = 0; k < kind_.size(); ++k) kind_[k] = add(comes(k), "token", std::string(kKindNames[k]));
  one_wide_ = add(true, "frame", "one pixel wide");
  widest_ = add(true, "frame", "as wide as can be");
  one_line_ = add(true, "frame", "of one line");
  bare_line_ = add(true, "frame", "a line with nothing on it");
  for (std::size_t k = 0; k < span_.size(); ++k)
    if (kKindInfo[k].range)  // the front end makes IF of an NC over the whole line
      span_[k] = add_span(comes(k), std::string(kKindNames[k]), !polygons || static_cast<Kind>(k) != Kind::NC);
  depth_ = add_ramp(true, "depth", "a span's depth");
  tie_ = add(true, "depth", "OP as deep as what it meets");
  behind_ = add(true, "depth", "OP behind what it meets");
  face_depth_ = add_ramp(c.units > 0, "depth", "a segment's depth");
  color_ = add_ramp(c.smooth != 0, "colour", "a span's colour");
  unlit_ = add(shadows && c.linear_bits == 0, "light", "OP without light");
  light_early_ = add(c.linear_bits > 0, "light", "a light without a volume on its line");
  light_again_ = add(c.linear_bits > 0, "light", "a second light of a line");
  light_tie_ = add(c.linear_bits > 0, "light", "a light finds that it has come");
  light_most_ = add(c.linear_bits > 0, "light", "a light makes a pixel as bright as can be");
  light_few_ = add(c.linear_bits > 0 && c.count_bits > 0, "light", "a light of fewer samples than are counted");
  last_class_ = add(table, "light", "OP of the table's last class");
  shade_none_ = add(has(Kind::SHADE) && !table, "light", "no SHADE");
  shade_zero_ = add(has(Kind::SHADE) && !table, "light", "SHADE of nothing");
  shade_some_ = add(has(Kind::SHADE) && !table, "light", "SHADE of a part");
  shade_most_ = add(has(Kind::SHADE) && !table, "light", "SHADE of all");
  table_none_ = add(table, "light", "no TABLE");
  table_whole_ = add(table, "light", "a table of all classes");
  table_cut_ = add(table && c.lights > 1, "light", "a table that ends within a class");
  share_most_ = add(table, "light", "TABLE with a share of all");
  counter_full_ = add(c.count_bits > 0, "shadow", "RESOLVE finds a full counter");
  black_ = add(table, "shadow", "RESOLVE finds more shadow than light");
  half_sum_ = add(table && half_sum() <= static_cast<std::uint64_t>(c.lights) * derived::most_count(c) << c.shade_frac,
                  "shadow", "RESOLVE finds the highest bit of a sum over the lights, and little else");
  weight_plus_ = add(has(Kind::SP), "shadow", "a weight of 1");
  weight_minus_ = add(has(Kind::SP), "shadow", "a weight of -1");
  weight_other_ = add(has(Kind::SP) && c.dsf_bits > 1, "shadow", "another weight");
  inside_at_ev_ = add(has(Kind::EV), "shadow", "EV finds a pixel inside");
  bias_at_ev_ = add(has(Kind::EV), "shadow", "EV with the eye inside");
  dark_ = add(has(Kind::RESOLVE), "shadow", "RESOLVE finds a pixel in shadow");
  alpha_none_ = add(has(Kind::TP), "blending", "an alpha of 0");
  alpha_some_ = add(has(Kind::TP), "blending", "an alpha between");
  alpha_all_ = add(has(Kind::TP), "blending", "an alpha of 255");
  over_clear_ = add(has(Kind::TP), "blending", "TP over the background");
  over_surface_ = add(has(Kind::TP), "blending", "TP before a surface");
  hidden_ = add(has(Kind::TP), "blending", "TP behind a surface");
  unit_tie_ = add(c.units > 1, "tree", "two units as deep, of one draw index");
  index_tie_ = add(c.units > 1, "tree", "two units as deep, of other draw indices");
  blank_ = add(c.units > 0, "tree", "a blank segment");
  dx_one_ = add(c.units > 0, "tree", "a segment of one pixel");
  dx_most_ = add(c.units > 0 && derived::most_dx(c) <= c.max_width, "tree", "a segment of the greatest length");
  unit_full_ = add(c.units > 0 && derived::most_segments(c) <= c.max_width, "tree",
                   "a line of as many segments as a unit holds");
  last_face_ = add(c.units > 0, "tree", "a face of the last number but the blank one");
  edge_later_ = add(polygons, "polygon", "a later edge");
  edge_last_ = add(polygons, "polygon", "an edge that ends its polygon");
  edge_left_ = add(polygons, "polygon", "an edge left of the line");
  edge_right_ = add(polygons, "polygon", "an edge right of the line");
  edge_tie_ = add(polygons, "polygon", "an edge steps to the border between two pixels");
  of_spans_ = add(polygons, "frame", "at the span level");
  plain_ = add(polygons && c.smooth != 0, "polygon", "one colour without GRADIENT");
  whole_cap_ = add(polygons && has(Kind::NC), "polygon", "NC over the whole line becomes IF");
  made_at_polygon_ = add(polygons, "polygon", "a span made before POLYGON");
  made_at_edge_ = add(polygons, "polygon", "a span made at its second EDGE");
  made_at_span_ = add(polygons, "polygon", "a span made before one that comes");
  made_at_eol_ = add(polygons, "polygon", "a span made before EOL");
  for (std::size_t e = 1; e < error_.size(); ++e) {
    const auto code = static_cast<ErrorCode>(e);
    const bool of_polygons = code == ErrorCode::PLACE || code == ErrorCode::ACTIVE_FULL;
    error_[e] =
        add((!is_of_unit(code) || c.units > 0) && (!of_polygons || polygons), "error", std::string(kErrorNames[e]));
  }
  seen_.resize(points_.size());
  golden_.observe(this);
}

void Coverage::words(std::span<const std::uint32_t> piece) {
  any_words_ = any_words_ || !piece.empty();
  golden_.feed(piece, [](int, std::span<const std::uint8_t>) {});
}

void Coverage::end_frame() {
  if (!any_words_) return;
  (void)golden_.finish([](int, std::span<const std::uint8_t>) {});
  ++frames_;
  for (std::size_t i = 0; i < seen_.size(); ++i) points_[i].frames += seen_[i] ? 1U : 0U;
  seen_.assign(seen_.size(), false);
  any_words_ = false;
}

void Coverage::absorb(const Coverage& other) {
  frames_ += other.frames_;
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].frames += other.points_[i].frames;
}

void Coverage::hit_span(const Span& points, const SpanToken& s, int width) {
  hit(points.none, s.xl == s.xr);
  if (s.xl == s.xr) return;
  hit(points.one, s.xr == s.xl + 1);
  hit(points.whole, s.xl == 0 && s.xr == width);
  hit(points.at_border, s.xl > 0 && s.xl % config_.lanes == 0);
  hit(points.in_group, s.xl % config_.lanes != 0);
  hit(points.ends_at_border, s.xr < width && s.xr % config_.lanes == 0);
}

Coverage::Range Coverage::depth_range() const {
  return {derived::depth_bits(config_), config_.z_frac, 1, derived::most_depth(config_)};
}

Coverage::Range Coverage::color_range() const { return {derived::ramp_bits(config_), config_.color_frac, 0, 255}; }

void Coverage::hit_ramp(const Ramp& points, std::int64_t start, std::int64_t step, int count, const Range& range) {
  if (count == 0) return;
  const std::int64_t limit = std::int64_t{1} << (range.bits - 1);
  const std::int64_t last = start + step * (count - 1);
  hit(points.level, step == 0 && count > 1);
  hit(points.wraps, last < -limit || last >= limit);
  if (last < -limit || last >= limit) return;
  hit(points.under, std::min(start, last) >> range.fraction < range.least);
  hit(points.over, std::max(start, last) >> range.fraction > range.most);
}

void Coverage::header(std::span<const std::uint32_t> words, const LineView& line) {
  hit(one_wide_, line.width() == 1);
  hit(widest_, line.width() == config_.max_width);
  const FrameHeader h = FrameHeader::read(words);
  hit(one_line_, h.height == 1);
  hit(of_spans_, h.level() == Level::spans);
  end_ = h.height;
  state_told_ = shade_ = has_spans_ = volume_ = false;
  lights_ = 0;
  waits_ = 0;
  came_ = {};
  table_.clear();
  faces_.assign(static_cast<std::size_t>(config_.units), {});
  segments_.assign(static_cast<std::size_t>(config_.units), 0);
}

// All that stands before the first line has come.
void Coverage::frame_state() {
  if (state_told_) return;
  state_told_ = true;
  hit(shade_none_, !shade_);
  hit(table_none_, table_.empty());
  hit(table_cut_, table_.size() % static_cast<std::size_t>(config_.lights) != 0);
  hit(table_whole_,
      derived::has_table(config_) && table_.size() == static_cast<std::size_t>(derived::most_class(config_)) *
                                                          static_cast<std::size_t>(config_.lights));
}

void Coverage::came(std::uint32_t /*index*/, const Token& t, std::span<const std::uint32_t> /*words*/) {
  came_ = t.kind;
  if (kind_of(code_of(t.kind)) == t.kind) return;  // before() has it, or what it becomes
  hit(kind_[static_cast<std::size_t>(t.kind)]);
  if (t.kind == Kind::POLYGON) {
    waits_ = 2;
    gradient_ = false;
  }
  if (t.kind == Kind::GRADIENT) gradient_ = true;
  if (t.kind != Kind::EDGE) return;
  hit(edge_later_, waits_ == 0);
  hit(plain_, waits_ == 1 && !gradient_);
  if (waits_ > 0) --waits_;
  hit(edge_last_, t.polygon.last);
  hit(edge_left_, t.polygon.top_x < 0 && t.polygon.bottom_x < 0);
  const int right = golden_.line().width() * 256;
  hit(edge_right_, t.polygon.top_x > right && t.polygon.bottom_x > right);
  const int end = std::min(first_centre(t.polygon.bottom_y), end_);
  for (int y = golden_.line().y() + 1; y < end; ++y) hit(edge_tie_, edge_tie(t.polygon, y));
}

// At the polygon level: the front end makes this token, or makes IF of an NC.
void Coverage::made(Kind kind) {
  hit(whole_cap_, kind == Kind::IF);
  if (!info_of(kind).span) return;
  hit(made_at_polygon_, came_ == Kind::POLYGON);
  hit(made_at_edge_, came_ == Kind::EDGE);
  hit(made_at_span_, info_of(came_).span && came_ != kind);
  hit(made_at_eol_, came_ == Kind::EOL);
}

void Coverage::before(std::uint32_t /*index*/, const Token& t, std::span<const std::uint32_t> /*words*/,
                      const LineView& line) {
  hit(kind_[static_cast<std::size_t>(t.kind)]);
  if (came_ != Kind{} && came_ != t.kind) made(t.kind);
  const std::uint32_t all = derived::whole_share(config_);
  switch (t.kind) {
    case Kind::SHADE:
      shade_ = true;
      hit(t.shade == 0 ? shade_zero_ : t.shade == all ? shade_most_ : shade_some_);
      return;
    case Kind::TABLE:
      table_.push_back(t.table);
      hit(share_most_, std::find(t.table.share.begin(), t.table.share.end(), all) != t.table.share.end());
      return;
    case Kind::FACE:
      hit(last_face_, t.segment.face == derived::blank_face(config_) - 1);
      faces_[static_cast<std::size_t>(t.segment.unit)].push_back(t.segment.dz);
      return;
    default:
      frame_state();
  }
  hit_span(span_[static_cast<std::size_t>(t.kind)], t.span, line.width());
  switch (t.kind) {
    case Kind::SEG:
      segment(t.segment);
      break;
    case Kind::OP:
      if (lights_ > 0)
        light(t.span, line);
      else
        opaque(t.span, line);
      break;
    case Kind::RESOLVE:
      resolve(line);
      if (config_.linear_bits == 0) break;
      hit(light_early_, !volume_);
      hit(light_again_, ++lights_ == 2);
      samples_ = t.samples;
      break;
    case Kind::TP:
      translucent(t.span, line);
      break;
    case Kind::EOL:
      hit(bare_line_, !has_spans_);
      lights_ = 0;
      break;
    default:
      if (info_of(t.kind).volume) volume(t, line);
  }
  has_spans_ = t.kind != Kind::EOL;
  volume_ = info_of(t.kind).volume;
}

void Coverage::after(std::uint32_t /*index*/, const Token& t, const LineView& line) {
  if (t.kind == Kind::TREE) tree(line);
}

void Coverage::failed(const FrameStatus& status, std::span<const std::uint32_t> /*words*/, const LineView& /*line*/) {
  hit(error_[static_cast<std::size_t>(status.error)]);
}

// Points that a span of at least a pixel reaches.
void Coverage::ramps(const SpanToken& s, bool colored) {
  const int count = s.xr - s.xl;
  hit_ramp(depth_, s.z, s.dz, count, depth_range());
  for (std::size_t i = 0; colored && config_.smooth != 0 && i < static_cast<std::size_t>(config_.channels); ++i)
    hit_ramp(color_, s.color[i], s.dcolor[i], count, color_range());
}

void Coverage::opaque(const SpanToken& s, const LineView& line) {
  if (s.xl == s.xr) return;
  ramps(s, true);
  hit(unlit_, s.normal_class == 0);
  hit(last_class_, s.normal_class == derived::most_class(config_));
  const std::uint32_t clear = derived::clear_depth(config_);
  const std::uint32_t met = line.pixel(s.xl).z;
  const std::uint32_t z = span_depth(config_, s, s.xl);
  hit(tie_, met != clear && z == met);
  hit(behind_, met != clear && z > met);
}

// An OP behind a RESOLVE of linear light.
void Coverage::light(const SpanToken& s, const LineView& line) {
  if (s.xl == s.xr) return;
  ramps(s, true);
  const auto pass = static_cast<std::uint32_t>(lights_) & 1U;
  const std::int64_t most = (1 << config_.linear_bits) - 1;
  for (int x = s.xl; x < s.xr; ++x) {
    const PixelState p = line.pixel(x);
    if (p.z == derived::clear_depth(config_) || span_depth(config_, s, x) > p.z) continue;
    hit(light_tie_, p.served == pass);
    if (p.served == pass) continue;
    hit(light_few_, p.counts[0] > static_cast<std::uint32_t>(samples_));
    const auto left = config_.count_bits > 0 ? static_cast<std::int64_t>(samples_) - p.counts[0]
                      : in_shadow(p, 0)      ? 0
                                             : 1;
    const auto light = std::int64_t{span_levels(config_, s, x)[0]} * left >> config_.count_bits;
    hit(light_most_, p.color[0] + light > most);
  }
}

void Coverage::volume(const Token& t, const LineView& line) {
  const KindInfo& info = info_of(t.kind);
  if (info.depth) ramps(t.span, false);
  if (info.weight) hit(t.span.w == 1 ? weight_plus_ : t.span.w == -1 ? weight_minus_ : weight_other_);
  if (t.kind != Kind::EV) return;
  hit(bias_at_ev_, line.bias() != 0);
  const std::uint32_t all = derived::most_dsf(config_);
  for (int x = t.span.xl; x < t.span.xr; ++x) hit(inside_at_ev_, ((line.pixel(x).dsf + line.bias()) & all) != 0);
}

// Whether a pixel is in shadow, as docs/stream.md has it: by the counters where there are any, else by the flag, else
// by the sum.
bool Coverage::in_shadow(const PixelState& p, std::uint32_t bias) const {
  if (config_.count_bits > 0) return p.counts != decltype(p.counts){};
  if (config_.fsf != 0) return p.fsf != 0;
  return ((p.dsf + bias) & derived::most_dsf(config_)) != 0;
}

// The least sum of shares over the lights that has its highest bit.
std::uint64_t Coverage::half_sum() const {
  const auto lights = static_cast<std::uint64_t>(config_.lights);
  return std::bit_ceil(lights) << (config_.count_bits + config_.shade_frac - 1);
}

// The share that all shadowed samples together take of a channel of a pixel, in 2^-SHADE_FRAC.
std::uint64_t Coverage::lost(const PixelState& p, std::size_t channel) const {
  const auto lights = static_cast<std::size_t>(config_.lights);
  std::uint64_t sum = 0;
  for (std::size_t l = 0; p.normal_class > 0 && l < lights; ++l) {
    const std::size_t entry = (p.normal_class - 1) * lights + l;
    if (entry < table_.size()) sum += std::uint64_t{p.counts[l]} * table_[entry].share[channel];
  }
  return sum;
}

void Coverage::resolve(const LineView& line) {
  const std::uint32_t full = derived::most_count(config_);
  for (int x = 0; x < line.width(); ++x) {
    const PixelState p = line.pixel(x);
    hit(dark_, in_shadow(p, line.bias()));
    for (std::size_t l = 0; l < static_cast<std::size_t>(config_.lights); ++l) hit(counter_full_, p.counts[l] == full);
    for (std::size_t c = 0; derived::has_table(config_) && c < static_cast<std::size_t>(config_.channels); ++c) {
      const std::uint64_t sum = lost(p, c);
      hit(black_, sum > derived::whole_share(config_));
      hit(half_sum_, sum >= half_sum() && sum - half_sum() < derived::whole_share(config_));
    }
  }
}

void Coverage::translucent(const SpanToken& s, const LineView& line) {
  if (s.xl == s.xr) return;
  ramps(s, true);
  hit(s.alpha == 0 ? alpha_none_ : s.alpha == 255 ? alpha_all_ : alpha_some_);
  const std::uint32_t clear = derived::clear_depth(config_);
  const std::uint32_t met = line.pixel(s.xl).z;
  hit(met == clear ? over_clear_ : span_depth(config_, s, s.xl) < met ? over_surface_ : hidden_);
}

void Coverage::segment(const SegmentToken& s) {
  hit(blank_, s.face == derived::blank_face(config_));
  hit(dx_one_, s.dx == 1);
  hit(dx_most_, s.dx == derived::most_dx(config_));
  const auto unit = static_cast<std::size_t>(s.unit);
  const auto face = static_cast<std::size_t>(s.face);
  if (face < faces_[unit].size()) hit_ramp(face_depth_, s.z, faces_[unit][face], s.dx, depth_range());
  segments_[unit] = s.sync ? 1 : segments_[unit] + 1;
  hit(unit_full_, segments_[unit] == derived::most_segments(config_));
}

void Coverage::tree(const LineView& line) {
  const std::uint32_t clear = derived::clear_depth(config_);
  for (int x = 0; x < line.width(); ++x)
    for (int a = 0; a + 1 < config_.units; ++a) {
      const auto left = line.unit_pixel(a, x);
      if (left.z == clear) continue;
      for (int b = a + 1; b < config_.units; ++b) {
        const auto right = line.unit_pixel(b, x);
        if (left.z == right.z) hit(left.index == right.index ? unit_tie_ : index_tie_);
      }
    }
}

}  // namespace kage::verif
