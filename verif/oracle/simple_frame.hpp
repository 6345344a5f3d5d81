// SPDX-License-Identifier: Apache-2.0
//
// A frame's state in SimpleCore, and the arithmetic of docs/stream.md: no shared code but the bit positions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "number/int128.hpp"

namespace kage::verif {

class SimpleFrame {
 protected:
  SimpleFrame(const Config& c, std::vector<std::uint32_t> words, std::vector<std::uint8_t>& out)
      : c_(c), l_(c), words_(std::move(words)), out_(&out) {
    while (words_.size() % static_cast<std::size_t>(c.beat_words) != 0) words_.push_back(0);
  }

  struct Pixel {
    std::int64_t z;
    std::array<std::int64_t, 3> color;
    std::int64_t normal_class;
    unsigned dsf;
    bool fsf;
    std::array<std::int64_t, 8> count;
    bool served;  // by the light at hand, or else by the one before
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
      const std::uint32_t word = made_.empty() ? words_[at_ + bit / 32] : made_[bit / 32];
      if ((word >> (bit % 32)) & 1U) v |= std::int64_t{1} << i;
    }
    if (f.is_signed && f.bits > 0 && ((v >> (f.bits - 1)) & 1) != 0) v -= std::int64_t{1} << f.bits;
    return v;
  }

  /// Puts a value into a field of made_.
  void put(Field f, std::int64_t value) {
    for (unsigned i = 0; i < f.bits; ++i)
      if (((value >> i) & 1) != 0) made_[(f.lsb + i) / 32] |= 1U << ((f.lsb + i) % 32);
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
                   Pixel{(std::int64_t{1} << c_.z_bits) - 1, background(), 0, 0, false, {}, false});
    bias_ = lit_bias_ = 0;
    pass_ = false;
  }

  [[nodiscard]] std::array<std::int64_t, 3> background() const {
    return {words_[3] & 255U, words_[3] >> 8 & 255U, words_[3] >> 16 & 255U};
  }

  /// A channel of a span k pixels from its start, in 2^-bits of white: as displayed, or linear light.
  [[nodiscard]] std::int64_t color(Field start, Field step, int k, int bits = 8) const {
    if (c_.smooth == 0) return field(start);
    const std::int64_t v =
        shift_down(wrap(static_cast<Int128>(field(start)) + static_cast<Int128>(k) * field(step), 10 + c_.color_frac),
                   c_.color_frac + 8 - bits);
    const std::int64_t most = (std::int64_t{1} << bits) - 1;
    return v < 0 ? 0 : v > most ? most : v;
  }

  /// Linear light as a display takes it: the sRGB formula, rounded to the nearest.
  [[nodiscard]] std::int64_t shown(std::int64_t level) const {
    const long double x = std::ldexp(static_cast<long double>(level), -c_.linear_bits);
    const long double s = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
    return std::lround(255 * s);
  }

  /// The line's light becomes colours, and the background's where there is none.
  void show() {
    for (Pixel& p : pixels_) {
      if (p.z == (std::int64_t{1} << c_.z_bits) - 1) {
        p.color = background();
        continue;
      }
      for (std::int64_t& v : p.color) v = shown(v);
    }
  }

  void end_line() {
    if (c_.linear_bits > 0 && !shown_) show();
    shown_ = false;
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

  // SEG, for a unit.
  void add_segment(Unit& u) {
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

  // The compare tree's line; false if a unit is at fault.
  bool take_tree() {
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
      p.served = false;
      p.color = best->color;
    }
    return true;
  }

  [[nodiscard]] std::int64_t largest_count() const { return (1 << c_.count_bits) - 1; }

  [[nodiscard]] bool lacks_class(std::int64_t normal_class) const {
    return c_.class_bits > 1 && normal_class > static_cast<std::int64_t>(table_.size()) / c_.lights;
  }

  Config c_;
  Layout l_;
  std::vector<std::uint32_t> words_;
  std::vector<std::uint32_t> made_;  // the token at hand, if it is none of the stream
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
  bool pass_ = false;  // of linear light: which of two values `served` has where the light at hand has come
  bool shown_ = false;
  std::int64_t samples_ = 0;  // of the light at hand
  unsigned lit_bias_ = 0;     // or, without counters, its bias
};

}  // namespace kage::verif
