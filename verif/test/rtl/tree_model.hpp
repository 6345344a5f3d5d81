// SPDX-License-Identifier: Apache-2.0
//
// Faces, segments and the pixels they mean, as docs/stream.md says it ("Units and the tree"), and lines of them to
// feed. The tests of the expansion unit and of the units' core hold the RTL against these pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bench.hpp"

namespace kage::rtl {

struct TreeShape : kage::Config {
  int lit_bits() const { return dsf_bits > 0 ? 1 : 0; }
  int depth_bits() const { return z_bits + z_frac + 2; }
  int rgb_bits() const { return 8 * channels; }
  int blank() const { return (1 << face_bits) - 1; }
  int longest() const { return (1 << dx_bits) - 1; }
  int most_segments() const { return 1 << seg_bits; }
  int widest() const { return std::min((1 << x_bits) - 1, most_segments() * longest()); }
};

template <class Model>
constexpr TreeShape tree_shape_of() {
  return TreeShape{config_of<Model>()};
}

struct Face {
  std::uint64_t index, lit, dz, color;
};

struct Segment {
  std::uint64_t z;
  int dx, face;
  bool completes;  // its line
};

struct Point {
  std::uint64_t z, index, color, lit;
  bool last;
  bool operator==(const Point&) const = default;
};

inline Face random_face(Dice& dice, const TreeShape& s) {
  const std::uint64_t mask = (1ULL << s.depth_bits()) - 1;
  // Slopes of both kinds: any, and small enough that depth stays in range for a while.
  const std::uint64_t dz = dice.percent(50) ? dice.bits(s.depth_bits()) : (dice.bits(s.z_frac + 2) - 2) & mask;
  return {dice.bits(s.order_bits), s.lit_bits() != 0 ? dice.bits(1) : 0, dz, dice.bits(s.rgb_bits())};
}

/// A line's segments: they sum to `width`, by the buffer's measure and no longer than `dx` can say.
inline std::vector<Segment> random_line(Dice& dice, const TreeShape& s, int width, int faces) {
  std::vector<Segment> line;
  const int manner = dice.below(4);  // short ones, long ones, exactly a full buffer, any
  const bool full = manner == 2 && width >= s.most_segments();
  while (width > 0) {
    const int left = s.most_segments() - static_cast<int>(line.size());
    const int low = std::max(1, width - (left - 1) * s.longest());
    int high = std::min(s.longest(), width);
    if (full) high = std::min(high, width - (left - 1));
    int dx = dice.between(low, high);
    if (manner == 0 && dice.percent(90)) dx = low;
    if (manner == 1) dx = high;
    const int face = faces == 0 || dice.percent(25) ? s.blank() : dice.below(faces);
    line.push_back({dice.bits(s.classic != 0 ? 15 : s.depth_bits()), dx, face, dx == width});
    width -= dx;
  }
  return line;
}

inline std::vector<Point> expand(const TreeShape& s, const std::vector<Face>& faces, const std::vector<Segment>& line) {
  std::vector<Point> points;
  const std::int64_t span = std::int64_t{1} << s.depth_bits();
  const std::int64_t deepest = (std::int64_t{1} << s.z_bits) - 2;
  for (const Segment& segment : line) {
    for (int k = 0; k < segment.dx; ++k) {
      if (segment.face == s.blank()) {
        points.push_back({(1ULL << s.z_bits) - 1, (1ULL << s.order_bits) - 1, 0, 0, false});
        continue;
      }
      const Face& face = faces.at(static_cast<std::size_t>(segment.face));
      std::int64_t acc = static_cast<std::int64_t>(segment.z + static_cast<std::uint64_t>(k) * face.dz) & (span - 1);
      if (acc >= span / 2) acc -= span;
      const std::int64_t z = std::clamp<std::int64_t>(acc >> s.z_frac, 1, deepest);
      points.push_back({static_cast<std::uint64_t>(z), face.index, face.color, face.lit, false});
    }
  }
  points.back().last = true;
  return points;
}

/// Both modules take a face, and a segment, by piece_i.
template <class Top>
void put_face(Top& top, const TreeShape& s, int number, const Face& face) {
  const PieceBus piece(s);
  put(top.piece_i, piece.face, static_cast<std::uint64_t>(number));
  int at = piece.entry.lsb;
  const auto field = [&](int bits, std::uint64_t value) {
    if (bits != 0) put(top.piece_i, at, bits, value);
    at += bits;
  };
  field(s.order_bits, face.index);
  field(s.lit_bits(), face.lit);
  field(s.depth_bits(), face.dz);
  field(s.rgb_bits(), face.color);
}

template <class Top>
void put_segment(Top& top, const TreeShape& s, const Segment& segment) {
  const PieceBus piece(s);
  put(top.piece_i, piece.z, segment.z);
  put(top.piece_i, piece.dx, static_cast<std::uint64_t>(segment.dx));
  put(top.piece_i, piece.face, static_cast<std::uint64_t>(segment.face));
  put(top.piece_i, piece.completes, segment.completes ? 1U : 0U);
}

}  // namespace kage::rtl
