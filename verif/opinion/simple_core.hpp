// SPDX-License-Identifier: Apache-2.0
//
// docs/stream.md as plainly as it can be written: a pixel at a time, no vectors, no shared code but the bit positions.
// For tests of the golden core.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "number/int128.hpp"

namespace kage::verif {

class SimpleCore {
 public:
  SimpleCore(const Config& c, std::vector<std::uint32_t> words, std::vector<std::uint8_t>& out)
      : c_(c), l_(c), words_(std::move(words)), out_(&out) {
    while (words_.size() % static_cast<std::size_t>(c.beat_words) != 0) words_.push_back(0);
  }

  FrameStatus run() {
    if (words_.size() < 5) return fail(ErrorCode::LAST_EARLY);
    const int width = static_cast<int>(words_[1] & 0xFFFFU);
    const int height = static_cast<int>(words_[1] >> 16);
    if (words_[0] != (kStreamMagic << 16 | kStreamVersion)) return fail(ErrorCode::HEADER);
    if (width == 0 || height == 0 || width > c_.max_width || height > 32767) return fail(ErrorCode::SIZE);
    if (words_[2] != param_hash(c_)) return fail(ErrorCode::PARAMS);
    status_.width = width;
    status_.height = height;
    units_.resize(static_cast<std::size_t>(c_.units));
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

 private:
  struct Pixel {
    std::int64_t z;
    std::array<std::int64_t, 3> color;
    std::int64_t normal_class;
    unsigned dsf;
    bool fsf;
    std::array<std::int64_t, 8> count;
  };

  FrameStatus fail(ErrorCode e) {
    status_.error = e;
    status_.frame = words_.size() < 5 ? 0 : words_[4];
    status_.line = static_cast<std::uint32_t>(line_);
    status_.token = token_;
    return status_;
  }

  [[nodiscard]] std::int64_t field(Field f) const {
    std::int64_t v = 0;
    for (unsigned i = 0; i < f.bits; ++i) {
      const unsigned bit = f.lsb + i;
      if ((words_[at_ + bit / 32] >> (bit % 32)) & 1U) v |= std::int64_t{1} << i;
    }
    if (f.is_signed && f.bits > 0 && ((v >> (f.bits - 1)) & 1) != 0) v -= std::int64_t{1} << f.bits;
    return v;
  }

  // The value of an accumulator of so many bits: what two's complement leaves of it.
  static std::int64_t wrap(Int128 v, int bits) {
    const auto modulus = static_cast<Int128>(1) << bits;
    auto r = v % modulus;
    if (r < 0) r += modulus;
    if (r >= modulus / 2) r -= modulus;
    return static_cast<std::int64_t>(r);
  }

  static std::int64_t shift_down(std::int64_t v, int by) {
    const std::int64_t unit = std::int64_t{1} << by;
    return (v >= 0 ? v : v - (unit - 1)) / unit;
  }

  [[nodiscard]] std::int64_t depth(Field z, Field dz, int k) const { return depth(field(z), field(dz), k); }

  [[nodiscard]] std::int64_t depth(std::int64_t z, std::int64_t dz, int k) const {
    const int bits = c_.z_bits + c_.z_frac + 2;
    const std::int64_t v = shift_down(wrap(static_cast<Int128>(z) + static_cast<Int128>(k) * dz, bits), c_.z_frac);
    const std::int64_t top = (std::int64_t{1} << c_.z_bits) - 2;
    return v < 1 ? 1 : v > top ? top : v;
  }

  void clear() {
    pixels_.assign(static_cast<std::size_t>(status_.width),
                   Pixel{(std::int64_t{1} << c_.z_bits) - 1, background(), 0, 0, false, {}});
    bias_ = 0;
  }

  [[nodiscard]] std::array<std::int64_t, 3> background() const {
    return {words_[3] & 255U, words_[3] >> 8 & 255U, words_[3] >> 16 & 255U};
  }

  /// A channel of a span k pixels from its start.
  [[nodiscard]] std::int64_t color(Field start, Field step, int k) const {
    if (c_.smooth == 0) return field(start);
    const std::int64_t v =
        shift_down(wrap(static_cast<Int128>(field(start)) + static_cast<Int128>(k) * field(step), 10 + c_.color_frac),
                   c_.color_frac);
    return v < 0 ? 0 : v > 255 ? 255 : v;
  }

  void end_line() {
    for (const Pixel& p : pixels_)
      for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
        out_->push_back(static_cast<std::uint8_t>(p.color[ch]));
    clear();
    ++line_;
  }

  struct Face {
    std::int64_t index, dz, normal_class;
    std::array<std::int64_t, 3> color;
  };

  struct TreePixel {
    std::int64_t z, index, normal_class;
    std::array<std::int64_t, 3> color;
  };

  struct Unit {
    std::vector<Face> faces;
    std::vector<std::vector<TreePixel>> lines;  // complete
    std::vector<TreePixel> line;                // under way
    int segments = 0;                           // in it
    ErrorCode fault = ErrorCode::NONE;
    int fault_line = 0;
    std::uint32_t fault_token = 0;
  };

  void seg(Unit& u) {
    const std::int64_t blank = (1 << c_.face_bits) - 1;
    const std::int64_t dx = field(l_.seg_dx);
    const std::int64_t number = field(l_.seg_face);
    const auto fault = [&](ErrorCode code, int of_line) {
      u.fault = code;
      u.fault_line = of_line;
      u.fault_token = token_;
    };
    if (u.fault != ErrorCode::NONE) return;
    const auto line = static_cast<int>(u.lines.size());
    if (line > line_ + 1) return fault(ErrorCode::UNIT_LONG, line_ + 1);
    const bool unknown = number != blank && number >= static_cast<std::int64_t>(u.faces.size());
    if ((field(l_.seg_sync) != 0) != u.line.empty() || dx == 0 || unknown) return fault(ErrorCode::SEGMENT, line);
    if (static_cast<std::int64_t>(u.line.size()) + dx > status_.width || u.segments == 1 << c_.seg_bits)
      return fault(ErrorCode::UNIT_LONG, line);
    for (int k = 0; k < dx; ++k) {
      if (number == blank) {
        u.line.push_back({(std::int64_t{1} << c_.z_bits) - 1, 0, 0, {}});
        continue;
      }
      const Face& f = u.faces[static_cast<std::size_t>(number)];
      u.line.push_back({depth(field(l_.seg_z), f.dz, k), f.index, f.normal_class, f.color});
    }
    ++u.segments;
    if (u.line.size() < static_cast<std::size_t>(status_.width)) return;
    u.lines.push_back(u.line);
    u.line.clear();
    u.segments = 0;
  }

  // False if a unit is at fault.
  bool tree() {
    const Unit* first = nullptr;
    for (const Unit& u : units_)
      if (u.fault != ErrorCode::NONE && u.fault_line <= line_ &&
          (first == nullptr || u.fault_token < first->fault_token))
        first = &u;
    ErrorCode code = first != nullptr ? first->fault : ErrorCode::NONE;
    for (const Unit& u : units_) {
      if (code != ErrorCode::NONE || static_cast<int>(u.lines.size()) > line_) continue;
      first = &u;
      code = ErrorCode::UNIT_SHORT;
    }
    if (code != ErrorCode::NONE) {
      if (code != ErrorCode::UNIT_SHORT) token_ = first->fault_token;
      fail(code);
      status_.unit = static_cast<std::uint32_t>(first - units_.data());
      return false;
    }
    for (std::size_t x = 0; x < pixels_.size(); ++x) {
      const TreePixel* best = nullptr;
      for (const Unit& u : units_) {
        const TreePixel& t = u.lines[static_cast<std::size_t>(line_)][x];
        if (best == nullptr || t.z < best->z || (t.z == best->z && t.index < best->index)) best = &t;
      }
      Pixel& p = pixels_[x];
      if (best->z >= p.z) continue;
      p.z = best->z;
      p.normal_class = best->normal_class;
      p.color = best->color;
    }
    return true;
  }

  [[nodiscard]] std::int64_t largest_count() const { return (1 << c_.count_bits) - 1; }

  [[nodiscard]] bool lacks_class(std::int64_t normal_class) const {
    return c_.class_bits > 1 && normal_class > static_cast<std::int64_t>(table_.size()) / c_.lights;
  }

  /// RESOLVE with counters.
  void resolve(Pixel& p) const {
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

  // One token; false at the end of the frame or at an error.
  bool step() {
    const std::size_t n = words_.size();
    if (at_ >= n) return fail(ErrorCode::LAST_EARLY), false;
    const auto kind = static_cast<Kind>(words_[at_] & 15U);
    const std::size_t length = l_.words[words_[at_] & 15U];
    if (length == 0) return fail(ErrorCode::KIND), false;
    if (at_ + length > n) return fail(ErrorCode::LAST_EARLY), false;
    const bool all_lines = line_ == status_.height;
    const int width = status_.width;
    const unsigned modulus = 1U << c_.dsf_bits;
    const auto order = [this] { return fail(ErrorCode::ORDER), false; };
    const auto range = [this] { return fail(ErrorCode::RANGE), false; };
    const auto bad_range = [&](Field xl, Field xr) { return field(xl) > field(xr) || field(xr) > width; };
    if (due_ && kind != Kind::SEG && kind != Kind::TREE && kind != Kind::END) return order();
    switch (kind) {
      case Kind::FACE: {
        if (all_lines || begun_) return order();
        if (field(l_.face_unit) >= c_.units) return range();
        auto& faces = units_[static_cast<std::size_t>(field(l_.face_unit))].faces;
        const auto next = static_cast<std::int64_t>(faces.size());
        if (field(l_.face_face) != next || next == (1 << c_.face_bits) - 1) return range();
        if (lacks_class(field(l_.face_class))) return range();
        Face f{field(l_.face_index), field(l_.face_dz), field(l_.face_class), {}};
        for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
          f.color[ch] = field(l_.face_color[ch]);
        faces.push_back(f);
        break;
      }
      case Kind::SEG: {
        if (all_lines || (begun_ && !due_)) return order();
        if (field(l_.seg_unit) >= c_.units) return range();
        Unit& u = units_[static_cast<std::size_t>(field(l_.seg_unit))];
        if (static_cast<int>(u.lines.size()) == status_.height) return order();
        begun_ = has_tree_ = due_ = true;
        seg(u);
        break;
      }
      case Kind::TREE:
        if (all_lines || !due_) return order();
        if (!tree()) return false;
        due_ = false;
        break;
      case Kind::SHADE:
        if (begun_ || shade_seen_) return order();
        if (field(l_.shade_shade) > (1 << c_.shade_frac)) return range();
        shade_ = field(l_.shade_shade);
        shade_seen_ = true;
        break;
      case Kind::TABLE: {
        if (all_lines || begun_) return order();
        const auto entries = static_cast<std::int64_t>(table_.size());
        if (field(l_.table_class) != entries / c_.lights + 1 || field(l_.table_light) != entries % c_.lights)
          return range();
        std::array<std::int64_t, 3> share{};
        for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) {
          share[ch] = field(l_.table_share[ch]);
          if (share[ch] > (1 << c_.shade_frac)) return range();
        }
        table_.push_back(share);
        break;
      }
      case Kind::OP:
        if (all_lines || phase_ > 0) return order();
        if (bad_range(l_.op_xl, l_.op_xr) || lacks_class(field(l_.op_class))) return range();
        begun_ = true;
        for (std::int64_t x = field(l_.op_xl); x < field(l_.op_xr); ++x) {
          Pixel& p = pixels_[static_cast<std::size_t>(x)];
          const int k = static_cast<int>(x - field(l_.op_xl));
          const std::int64_t z = depth(l_.op_z, l_.op_dz, k);
          if (z >= p.z) continue;
          p.z = z;
          p.normal_class = field(l_.op_class);
          for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
            p.color[ch] = color(l_.op_color[ch], l_.op_dcolor[ch], k);
        }
        break;
      case Kind::TP:
        if (all_lines || phase_ == 1) return order();
        if (bad_range(l_.tp_xl, l_.tp_xr)) return range();
        begun_ = true;
        phase_ = 3;
        for (std::int64_t x = field(l_.tp_xl); x < field(l_.tp_xr); ++x) {
          Pixel& p = pixels_[static_cast<std::size_t>(x)];
          const int k = static_cast<int>(x - field(l_.tp_xl));
          if (depth(l_.tp_z, l_.tp_dz, k) >= p.z) continue;
          const std::int64_t alpha = field(l_.tp_alpha);
          // Nearest whole number: there is never one as far above as below, since 255 is odd.
          for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch)
            p.color[ch] =
                (2 * (p.color[ch] * (255 - alpha) + color(l_.tp_color[ch], l_.tp_dcolor[ch], k) * alpha) + 255) / 510;
        }
        break;
      case Kind::SP:
      case Kind::NC: {
        if (all_lines || phase_ > 1) return order();
        const bool sp = kind == Kind::SP;
        const Field xl = sp ? l_.sp_xl : l_.nc_xl;
        const Field xr = sp ? l_.sp_xr : l_.nc_xr;
        if (bad_range(xl, xr)) return range();
        begun_ = open_ = sample_ = true;
        phase_ = 1;
        for (std::int64_t x = field(xl); x < field(xr); ++x) {
          Pixel& p = pixels_[static_cast<std::size_t>(x)];
          if (!sp || depth(l_.sp_z, l_.sp_dz, static_cast<int>(x - field(xl))) < p.z)
            p.dsf = (p.dsf + static_cast<unsigned>(field(sp ? l_.sp_w : l_.nc_w))) % modulus;
        }
        break;
      }
      case Kind::IF:
        if (all_lines || phase_ > 1) return order();
        begun_ = open_ = sample_ = true;
        phase_ = 1;
        bias_ = (bias_ + static_cast<unsigned>(field(l_.if_w))) % modulus;
        break;
      case Kind::EV:
        if (all_lines || phase_ != 1 || !open_) return order();
        if (bad_range(l_.ev_xl, l_.ev_xr)) return range();
        open_ = false;
        for (std::int64_t x = field(l_.ev_xl); x < field(l_.ev_xr); ++x) {
          Pixel& p = pixels_[static_cast<std::size_t>(x)];
          if ((p.dsf + bias_) % modulus != 0) p.fsf = true;
          p.dsf = 0;
        }
        bias_ = 0;
        break;
      case Kind::ES:
        if (all_lines || phase_ != 1 || !sample_ || (c_.fsf != 0 && open_)) return order();
        if (bad_range(l_.es_xl, l_.es_xr) || field(l_.es_light) >= c_.lights) return range();
        sample_ = false;
        for (std::int64_t x = field(l_.es_xl); x < field(l_.es_xr); ++x) {
          Pixel& p = pixels_[static_cast<std::size_t>(x)];
          std::int64_t& count = p.count[static_cast<std::size_t>(field(l_.es_light))];
          if (c_.fsf != 0 ? p.fsf : (p.dsf + bias_) % modulus != 0) count = std::min(count + 1, largest_count());
          if (c_.fsf == 0) p.dsf = 0;
          p.fsf = false;
        }
        bias_ = 0;
        break;
      case Kind::RESOLVE:
        if (all_lines || phase_ != 1 || (c_.fsf != 0 && open_)) return order();
        if (c_.count_bits != 0 && sample_) return order();
        phase_ = 2;
        for (Pixel& p : pixels_) {
          if (c_.count_bits != 0) {
            resolve(p);
            continue;
          }
          const bool shadowed = c_.fsf != 0 ? p.fsf : (p.dsf + bias_) % modulus != 0;
          if (!shadowed || p.normal_class == 0 || p.z == (std::int64_t{1} << c_.z_bits) - 1) continue;
          for (std::int64_t& v : p.color)
            v = (v * ((1 << c_.shade_frac) - shade_) + (1 << (c_.shade_frac - 1))) >> c_.shade_frac;
        }
        break;
      case Kind::EOL:
        if (all_lines || phase_ == 1) return order();
        if (field(l_.eol_y) != line_) return fail(ErrorCode::LINE), false;
        begun_ = true;
        open_ = sample_ = false;
        phase_ = 0;
        end_line();
        due_ = has_tree_;
        break;
      case Kind::END:
        if (!all_lines) return fail(ErrorCode::LINE), false;
        if ((at_ / static_cast<std::size_t>(c_.beat_words) + 1) * static_cast<std::size_t>(c_.beat_words) != n)
          fail(ErrorCode::LAST_LATE);
        return false;
      default:
        return false;
    }
    at_ += length;
    return true;
  }

  Config c_;
  Layout l_;
  std::vector<std::uint32_t> words_;
  std::vector<std::uint8_t>* out_;
  FrameStatus status_;
  std::vector<Pixel> pixels_;
  std::size_t at_ = 0;
  std::uint32_t token_ = 0;
  int line_ = 0;
  int phase_ = 0;
  bool begun_ = false;
  bool open_ = false;
  bool sample_ = false;
  bool shade_seen_ = false;
  bool has_tree_ = false;
  bool due_ = false;  // this line's TREE has not come yet
  std::vector<Unit> units_;
  std::int64_t shade_ = 0;
  std::vector<std::array<std::int64_t, 3>> table_;
  unsigned bias_ = 0;
};

inline FrameStatus simple_core(const Config& c, const std::vector<std::uint32_t>& words,
                               std::vector<std::uint8_t>& out) {
  return SimpleCore(c, words, out).run();
}

}  // namespace kage::verif
