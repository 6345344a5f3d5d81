// SPDX-License-Identifier: Apache-2.0
//
// docs/stream.md as plainly as it can be written: a pixel at a time, no vectors, a function for each token, no shared
// code but the bit positions. For tests of the golden core.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "oracle/simple_frame.hpp"
#include "oracle/simple_polygons.hpp"

namespace kage::verif {

class SimpleCore : private SimpleFrame {
 public:
  SimpleCore(const Config& c, std::vector<std::uint32_t> words, std::vector<std::uint8_t>& out)
      : SimpleFrame(c, std::move(words), out) {}

  FrameStatus run() {
    if (words_.size() < 5) return fail(ErrorCode::LAST_EARLY);
    const int width = static_cast<int>(words_[1] & 0xFFFFU);
    const int height = static_cast<int>(words_[1] >> 16);
    const bool polygons = words_[0] == (kStreamMagic << 16 | 2) && c_.active > 0;
    if (words_[0] != (kStreamMagic << 16 | 1) && !polygons) return fail(ErrorCode::HEADER);
    if (width == 0 || height == 0 || width > c_.max_width || height > 32767) return fail(ErrorCode::SIZE);
    if (words_[2] != param_hash(c_)) return fail(ErrorCode::PARAMS);
    status_.width = width;
    status_.height = height;
    units_.resize(static_cast<std::size_t>(c_.units));
    if (polygons) polygons_.emplace(c_, width);
    clear();
    at_ = 5;
    token_ = 1;
    for (; step(); ++token_) {
    }
    if (status_.error != ErrorCode::NONE && status_.error != ErrorCode::LAST_LATE) {
      clear();
      while (line_ < height) end_line();
    }
    return status_;
  }

  /// SimplePolygons::loose() of the frame that has been run.
  [[nodiscard]] bool loose() const { return polygons_ && polygons_->loose(); }

 private:
  // One token; false at the end of the frame or at an error.
  bool step() {
    if (at_ >= words_.size()) return refuse(ErrorCode::LAST_EARLY);
    const Kind kind = kind_here();
    const std::size_t length = l_.words[static_cast<std::size_t>(kind)];
    if (length == 0) return refuse(ErrorCode::KIND);
    if (at_ + length > words_.size()) return refuse(ErrorCode::LAST_EARLY);
    if (!(polygons_ ? take_polygons(kind) : take(kind))) return false;
    at_ += length;
    return true;
  }

  // The kind of the stream's next token: at the polygon level four codes are of other tokens.
  [[nodiscard]] Kind kind_here() const {
    const std::uint32_t code = words_[at_] & 15U;
    if (polygons_ && code == 9) return Kind::GRADIENT;
    if (polygons_ && code == 10) return Kind::POLYGON;
    if (polygons_ && code == 11) return Kind::EDGE;
    if (polygons_ && code == 12) return Kind::AT;
    return static_cast<Kind>(code);
  }

  // A token of a frame at the polygon level; false as step().
  bool take_polygons(Kind kind) {
    using Verdict = SimplePolygons::Verdict;
    const auto verdict = polygons_->take(
        kind, [this](Field f) { return field(f); }, [this](const PlainSpan& s) { return take_made(s); });
    switch (verdict) {
      case Verdict::done:
        return true;
      case Verdict::itself:
        return take(kind);
      case Verdict::stopped:
        return false;
      case Verdict::place:
        return refuse(ErrorCode::PLACE);
      default:
        return refuse(ErrorCode::ACTIVE_FULL);
    }
  }

  // A token that is made; false as step().
  bool take_made(const PlainSpan& s) {
    made_.assign(kMostTokenWords, 0);
    const auto range = [&](Field xl, Field xr) {
      put(xl, s.xl);
      put(xr, s.xr);
    };
    const auto depth_and_color = [&](Field z, Field dz, const auto& color, const auto& dcolor) {
      put(z, s.z);
      put(dz, s.dz);
      for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) {
        put(color[ch], s.color[ch]);
        put(dcolor[ch], s.dcolor[ch]);
      }
    };
    switch (s.kind) {
      case Kind::OP:
        range(l_.op_xl, l_.op_xr);
        put(l_.op_class, s.normal_class);
        depth_and_color(l_.op_z, l_.op_dz, l_.op_color, l_.op_dcolor);
        break;
      case Kind::TP:
        range(l_.tp_xl, l_.tp_xr);
        put(l_.tp_alpha, s.alpha);
        depth_and_color(l_.tp_z, l_.tp_dz, l_.tp_color, l_.tp_dcolor);
        break;
      case Kind::SP:
        range(l_.sp_xl, l_.sp_xr);
        put(l_.sp_w, s.w);
        put(l_.sp_z, s.z);
        put(l_.sp_dz, s.dz);
        break;
      case Kind::IF:
        put(l_.if_w, s.w);
        break;
      case Kind::RESOLVE:
        put(l_.resolve_samples, s.samples);
        break;
      case Kind::EV:
        range(l_.ev_xl, l_.ev_xr);
        break;
      case Kind::ES:
        range(l_.es_xl, l_.es_xr);
        put(l_.es_light, s.light);
        // A light that the field cannot hold is none that the core has.
        if (s.light >= c_.lights && !all_lines() && phase_ == 1 && sample_ && !(c_.fsf != 0 && open_)) {
          made_.clear();
          return refuse(ErrorCode::RANGE);
        }
        break;
      default:
        break;
    }
    const bool good = take(s.kind);
    made_.clear();
    return good;
  }

  // Action of a token of each kind; false as step().
  bool take(Kind kind) {
    if (due_ && kind != Kind::SEG && kind != Kind::TREE && kind != Kind::END) return refuse(ErrorCode::ORDER);
    using Take = bool (SimpleCore::*)();
    constexpr std::array<Take, 16> kTakes{
        // of the span level
        nullptr,           &SimpleCore::shade, &SimpleCore::table,   &SimpleCore::face, &SimpleCore::seg,
        &SimpleCore::tree, &SimpleCore::op,    &SimpleCore::sp,      &SimpleCore::nc,   &SimpleCore::inside,
        &SimpleCore::ev,   &SimpleCore::es,    &SimpleCore::resolve, &SimpleCore::tp,   &SimpleCore::eol,
        &SimpleCore::end};
    return (this->*kTakes[static_cast<std::size_t>(kind)])();
  }

  bool refuse(ErrorCode code) {
    fail(code);
    return false;
  }

  [[nodiscard]] bool all_lines() const { return line_ == status_.height; }
  [[nodiscard]] unsigned modulus() const { return 1U << c_.dsf_bits; }
  [[nodiscard]] bool bad_range(Field xl, Field xr) const { return field(xl) > field(xr) || field(xr) > status_.width; }

  // Calls f(pixel, k) for the pixels of a range, k from its start.
  template <class F>
  void each(Field xl, Field xr, F f) {
    for (std::int64_t x = field(xl); x < field(xr); ++x)
      f(pixels_[static_cast<std::size_t>(x)], static_cast<int>(x - field(xl)));
  }

  bool face() {
    if (all_lines() || begun_) return refuse(ErrorCode::ORDER);
    if (field(l_.face_unit) >= c_.units) return refuse(ErrorCode::RANGE);
    auto& faces = units_[static_cast<std::size_t>(field(l_.face_unit))].faces;
    const auto next = static_cast<std::int64_t>(faces.size());
    if (field(l_.face_face) != next || next == (1 << c_.face_bits) - 1) return refuse(ErrorCode::RANGE);
    if (lacks_class(field(l_.face_class))) return refuse(ErrorCode::RANGE);
    Face f{field(l_.face_index), field(l_.face_dz), field(l_.face_class), {}};
    for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) f.color[ch] = field(l_.face_color[ch]);
    faces.push_back(f);
    return true;
  }

  bool seg() {
    if (all_lines() || (begun_ && !due_)) return refuse(ErrorCode::ORDER);
    if (field(l_.seg_unit) >= c_.units) return refuse(ErrorCode::RANGE);
    Unit& u = units_[static_cast<std::size_t>(field(l_.seg_unit))];
    if (static_cast<int>(u.lines.size()) == status_.height) return refuse(ErrorCode::ORDER);
    begun_ = has_tree_ = due_ = true;
    add_segment(u);
    return true;
  }

  bool tree() {
    if (all_lines() || !due_) return refuse(ErrorCode::ORDER);
    if (!take_tree()) return false;
    due_ = false;
    return true;
  }

  bool shade() {
    if (begun_ || shade_seen_) return refuse(ErrorCode::ORDER);
    if (field(l_.shade_shade) > (1 << c_.shade_frac)) return refuse(ErrorCode::RANGE);
    shade_ = field(l_.shade_shade);
    shade_seen_ = true;
    return true;
  }

  bool table() {
    if (all_lines() || begun_) return refuse(ErrorCode::ORDER);
    const auto entries = static_cast<std::int64_t>(table_.size());
    if (field(l_.table_class) != entries / c_.lights + 1 || field(l_.table_light) != entries % c_.lights)
      return refuse(ErrorCode::RANGE);
    std::array<std::int64_t, 3> share{};
    for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) {
      share[ch] = field(l_.table_share[ch]);
      if (share[ch] > (1 << c_.shade_frac)) return refuse(ErrorCode::RANGE);
    }
    table_.push_back(share);
    return true;
  }

  [[nodiscard]] bool linear() const { return c_.linear_bits > 0; }

  // An OP behind a RESOLVE of linear light.
  bool light() {
    each(l_.op_xl, l_.op_xr, [this](Pixel& p, int k) {
      if (depth(l_.op_z, l_.op_dz, k) > p.z || p.served == pass_) return;
      p.served = pass_;
      std::int64_t left = 0;
      if (c_.count_bits > 0)
        left = std::max<std::int64_t>(0, samples_ - p.count[0]);
      else
        left = c_.fsf != 0 ? !p.fsf : (p.dsf + lit_bias_) % modulus() == 0;
      const std::int64_t parts = std::int64_t{1} << c_.count_bits;
      for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) {
        const std::int64_t level = color(l_.op_color[ch], l_.op_dcolor[ch], k, c_.linear_bits + c_.count_bits);
        const std::int64_t comes = (2 * level * left + parts) / (2 * parts);  // to the nearest, halves up
        p.color[ch] = std::min(p.color[ch] + comes, (std::int64_t{1} << c_.linear_bits) - 1);
      }
      p.count[0] = 0;
      p.dsf = 0;
      p.fsf = false;
    });
    return true;
  }

  bool op() {
    if (all_lines() || (phase_ > 0 && !(linear() && phase_ == 2))) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.op_xl, l_.op_xr) || lacks_class(field(l_.op_class))) return refuse(ErrorCode::RANGE);
    begun_ = true;
    if (phase_ == 2) return light();
    each(l_.op_xl, l_.op_xr, [this](Pixel& p, int k) {
      const std::int64_t z = depth(l_.op_z, l_.op_dz, k);
      if (z >= p.z) return;
      p.z = z;
      p.normal_class = field(l_.op_class);
      p.served = false;
      for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
        p.color[ch] = color(l_.op_color[ch], l_.op_dcolor[ch], k, linear() ? c_.linear_bits : 8);
    });
    return true;
  }

  bool tp() {
    if (all_lines() || phase_ == 1) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.tp_xl, l_.tp_xr)) return refuse(ErrorCode::RANGE);
    begun_ = true;
    if (linear() && phase_ != 3) show();
    shown_ = true;
    phase_ = 3;
    each(l_.tp_xl, l_.tp_xr, [this](Pixel& p, int k) {
      if (depth(l_.tp_z, l_.tp_dz, k) >= p.z) return;
      const std::int64_t alpha = field(l_.tp_alpha);
      // Nearest whole number: there is never one as far above as below, since 255 is odd.
      for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
        p.color[ch] =
            (2 * (p.color[ch] * (255 - alpha) + color(l_.tp_color[ch], l_.tp_dcolor[ch], k) * alpha) + 255) / 510;
    });
    return true;
  }

  void open_volume() {
    begun_ = open_ = sample_ = true;
    phase_ = 1;
  }

  void weigh(Pixel& p, Field w) const { p.dsf = (p.dsf + static_cast<unsigned>(field(w))) % modulus(); }

  // Volumes come first, or behind the spans of a light those of the next one.
  [[nodiscard]] bool volumes_over() const { return phase_ > (linear() ? 2 : 1); }

  bool sp() {
    if (all_lines() || volumes_over()) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.sp_xl, l_.sp_xr)) return refuse(ErrorCode::RANGE);
    open_volume();
    each(l_.sp_xl, l_.sp_xr, [this](Pixel& p, int k) {
      if (depth(l_.sp_z, l_.sp_dz, k) < p.z) weigh(p, l_.sp_w);
    });
    return true;
  }

  bool nc() {
    if (all_lines() || volumes_over()) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.nc_xl, l_.nc_xr)) return refuse(ErrorCode::RANGE);
    open_volume();
    each(l_.nc_xl, l_.nc_xr, [this](Pixel& p, int /*k*/) { weigh(p, l_.nc_w); });
    return true;
  }

  // IF.
  bool inside() {
    if (all_lines() || volumes_over()) return refuse(ErrorCode::ORDER);
    open_volume();
    bias_ = (bias_ + static_cast<unsigned>(field(l_.if_w))) % modulus();
    return true;
  }

  bool ev() {
    if (all_lines() || phase_ != 1 || !open_) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.ev_xl, l_.ev_xr)) return refuse(ErrorCode::RANGE);
    open_ = false;
    each(l_.ev_xl, l_.ev_xr, [this](Pixel& p, int /*k*/) {
      if ((p.dsf + bias_) % modulus() != 0) p.fsf = true;
      p.dsf = 0;
    });
    bias_ = 0;
    return true;
  }

  [[nodiscard]] bool shadowed(const Pixel& p) const { return c_.fsf != 0 ? p.fsf : (p.dsf + bias_) % modulus() != 0; }

  bool es() {
    if (all_lines() || phase_ != 1 || !sample_ || (c_.fsf != 0 && open_)) return refuse(ErrorCode::ORDER);
    if (bad_range(l_.es_xl, l_.es_xr) || field(l_.es_light) >= c_.lights) return refuse(ErrorCode::RANGE);
    sample_ = false;
    each(l_.es_xl, l_.es_xr, [this](Pixel& p, int /*k*/) {
      std::int64_t& count = p.count[static_cast<std::size_t>(field(l_.es_light))];
      if (shadowed(p)) count = std::min(count + 1, largest_count());
      if (c_.fsf == 0) p.dsf = 0;
      p.fsf = false;
    });
    bias_ = 0;
    return true;
  }

  // By counters.
  void resolve_counts(Pixel& p) const {
    if (p.normal_class == 0 || p.z == (std::int64_t{1} << c_.z_bits) - 1) return;
    const std::int64_t one = std::int64_t{1} << c_.shade_frac;
    for (std::size_t ch = 0; ch < 3; ++ch) {
      std::int64_t factor = one;
      for (std::int64_t light = 0; light < c_.lights; ++light) {
        const std::int64_t share =
            c_.class_bits > 1 ? table_[static_cast<std::size_t>((p.normal_class - 1) * c_.lights + light)][ch] : shade_;
        factor -= p.count[static_cast<std::size_t>(light)] * share;
      }
      p.color[ch] = (p.color[ch] * std::max(factor, std::int64_t{0}) + one / 2) / one;
    }
  }

  // By a flag or the sum.
  void resolve_flag(Pixel& p) const {
    if (!shadowed(p) || p.normal_class == 0 || p.z == (std::int64_t{1} << c_.z_bits) - 1) return;
    for (std::int64_t& v : p.color)
      v = (v * ((1 << c_.shade_frac) - shade_) + (1 << (c_.shade_frac - 1))) >> c_.shade_frac;
  }

  bool resolve() {
    const bool may = linear() ? phase_ < 3 : phase_ == 1;
    if (all_lines() || !may || (c_.fsf != 0 && open_)) return refuse(ErrorCode::ORDER);
    if (c_.count_bits != 0 && sample_) return refuse(ErrorCode::ORDER);
    phase_ = 2;
    if (linear()) {
      begun_ = true;
      pass_ = !pass_;
      samples_ = field(l_.resolve_samples);
      lit_bias_ = bias_;
      bias_ = 0;
      open_ = sample_ = false;
      return true;
    }
    for (Pixel& p : pixels_) {
      if (c_.count_bits != 0)
        resolve_counts(p);
      else
        resolve_flag(p);
    }
    return true;
  }

  bool eol() {
    if (all_lines() || phase_ == 1) return refuse(ErrorCode::ORDER);
    if (field(l_.eol_y) != line_) return refuse(ErrorCode::LINE);
    begun_ = true;
    open_ = sample_ = false;
    phase_ = 0;
    end_line();
    due_ = has_tree_;
    return true;
  }

  bool end() {
    if (!all_lines()) return refuse(ErrorCode::LINE);
    const auto beat = static_cast<std::size_t>(c_.beat_words);
    return (at_ / beat + 1) * beat == words_.size() ? false : refuse(ErrorCode::LAST_LATE);
  }

  std::optional<SimplePolygons> polygons_;  // of a frame at the polygon level
};

/// @param loose gets whether the contract leaves open what the frame shows, if given
inline FrameStatus simple_core(const Config& c, const std::vector<std::uint32_t>& words, std::vector<std::uint8_t>& out,
                               bool* loose = nullptr) {
  SimpleCore core(c, words, out);
  const FrameStatus status = core.run();
  if (loose != nullptr) *loose = core.loose();
  return status;
}

}  // namespace kage::verif
