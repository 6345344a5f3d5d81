// SPDX-License-Identifier: Apache-2.0
//
// A random frame's state and tree.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "stimulus/random_spans.hpp"

namespace kage::verif {

/// The faces and segments of a frame with a tree, in one of the orders that the contract allows.
class RandomTree {
 public:
  /// The widest line that any unit can hold.
  static int widest(const Config& c) { return derived::most_dx(c) * derived::most_segments(c); }

  RandomTree(Random& random, const Config& c, int width, int height, bool port, int classes)
      : random_(&random),
        config_(c),
        width_(width),
        classes_(classes),
        waiting_(static_cast<std::size_t>(c.units)),
        faces_(waiting_.size()) {
    for (std::size_t u = 0; u < waiting_.size(); ++u) {
      const int blank = derived::blank_face(c);
      const int count = random.chance(0.02)  ? blank
                        : random.chance(0.1) ? std::min(blank, 20)
                                             : random.in(0, std::min(blank, 4));
      for (int f = 0; f < count; ++f) faces_[u].push_back(face(static_cast<int>(u), f, port));
      for (int y = 0; y < height; ++y) line(u, y, port);
    }
  }

  /// Each unit's in order, but the units in any; among them the entries of the table, each class before the faces that
  /// have it.
  void write_faces(TokenWriter& w, std::uint64_t& count, std::span<const TableToken> table) {
    std::vector<std::size_t> units;
    for (std::size_t u = 0; u < faces_.size(); ++u) units.insert(units.end(), faces_[u].size(), u);
    random_->shuffle(units);
    std::vector<std::size_t> next(faces_.size());
    const double eager = random_->in(0, 2) / 2.0;  // entries as late as they may be, all first, or some
    std::size_t entry = 0;
    const auto lacks = [&](const SegmentToken& f) {
      return static_cast<int>(entry) < (derived::has_table(config_) ? f.normal_class * config_.lights : 0);
    };
    for (const std::size_t u : units) {
      const SegmentToken& f = faces_[u][next[u]++];
      while (entry < table.size() && (lacks(f) || random_->chance(eager))) w.table(table[entry++]);
      w.face(f);
    }
    while (entry < table.size()) w.table(table[entry++]);
    count += units.size();
  }

  /// Writes the rest of line y's segments, and some of the next line's.
  void write_segments(TokenWriter& w, int y, std::uint64_t& count) {
    const double eager = random_->chance(0.3) ? 0 : random_->chance(0.2) ? 1 : random_->real(0, 1);
    std::vector<std::size_t> units;  // a place for each segment that may come
    for (std::size_t u = 0; u < waiting_.size(); ++u)
      for (const auto& [of, segment] : waiting_[u])
        if (of == y || (of == y + 1 && random_->chance(eager))) units.push_back(u);
    if (random_->chance(0.7)) random_->shuffle(units);
    for (const std::size_t u : units) {
      w.seg(waiting_[u].front().second);
      waiting_[u].pop_front();
    }
    count += units.size();
  }

 private:
  [[nodiscard]] int depth_bits() const { return derived::depth_bits(config_); }

  SegmentToken face(int unit, int number, bool port) {
    SegmentToken t;
    t.unit = unit;
    t.face = number;
    const int most = (1 << config_.order_bits) - 1;
    t.index = random_->chance(0.6) ? random_->in(0, std::min(most, 2)) : random_->in(0, most);
    t.normal_class = random_class(*random_, config_, classes_);
    // A slope along which no run of this width can leave the accumulator; at a port, any.
    const std::int64_t steepest = ((std::int64_t{1} << (depth_bits() - 2)) - 1) / width_;
    t.dz = random_->chance(0.3) ? 0 : random_->integer(-steepest, steepest);
    if (port && random_->chance(0.3)) t.dz = random_field(*random_, depth_bits());
    for (std::size_t i = 0; i < static_cast<std::size_t>(config_.channels); ++i)
      t.color[i] = random_->in(0, (1 << derived::pixel_level_bits(config_)) - 1);
    return t;
  }

  [[nodiscard]] std::int64_t most_classic_depth() const {
    return (std::int64_t{1} << derived::segment_depth_bits(config_)) - 1;
  }

  std::int64_t depth(bool port) {
    const std::int64_t one = std::int64_t{1} << config_.z_frac;
    const std::int64_t middle = (std::int64_t{1} << (config_.z_bits - 1)) * one;
    if (random_->chance(0.4)) return middle + random_->in(-2, 2) * one;
    if (config_.classic != 0) return random_->integer(0, most_classic_depth());
    if (port && random_->chance(0.3)) return random_field(*random_, depth_bits());
    return random_->integer(0, 2 * middle - 1);
  }

  void line(std::size_t unit, int y, bool port) {
    const int blank = derived::blank_face(config_);
    const int longest = derived::most_dx(config_);
    const int manner = random_->in(0, 5);
    int segments = derived::most_segments(config_);
    SegmentToken t;
    t.unit = static_cast<int>(unit);
    t.face = blank;
    t.sync = true;
    for (int left = width_; left > 0; left -= t.dx, t.sync = false, --segments) {
      const SegmentToken before = t;
      // The segments that may still come must be enough for the rest.
      const std::int64_t others = std::int64_t{segments - 1} * longest;
      const int least = static_cast<int>(std::max<std::int64_t>(1, left - others));
      const int most = std::min(left, longest);
      t.dx = manner < 2    ? least
             : manner == 2 ? most
                           : random_->in(least, random_->chance(0.5) ? most : std::min(most, least + 4));
      const bool run = !before.sync || left < width_;
      const auto& faces = faces_[unit];
      if (manner == 5 || faces.empty() || random_->chance(0.2)) {
        t.face = blank;
        t.z = 0;
      } else if (run && before.face != blank && random_->chance(0.4)) {
        // One run in two segments: the second starts at what the sum has reached.
        const std::uint64_t sum = static_cast<std::uint64_t>(before.z) +
                                  static_cast<std::uint64_t>(before.dx) *
                                      static_cast<std::uint64_t>(faces[static_cast<std::size_t>(before.face)].dz);
        const int spare = 64 - depth_bits();
        t.z = static_cast<std::int64_t>(sum << spare) >> spare;
        if (config_.classic != 0) t.z &= most_classic_depth();
      } else {
        t.face = random_->in(0, static_cast<int>(faces.size()) - 1);
        t.z = depth(port);
      }
      waiting_[unit].emplace_back(y, t);
    }
  }

  Random* random_;
  Config config_;
  int width_;
  int classes_;
  std::vector<std::deque<std::pair<int, SegmentToken>>> waiting_;  // with the line it belongs to
  std::vector<std::vector<SegmentToken>> faces_;
};

/// The entries of a table of so many classes, at a port often with some of another's.
inline std::vector<TableToken> random_table(Random& random, const Config& c, int classes, const FrameStyle& style) {
  if (!derived::has_table(c)) return {};
  const auto most = static_cast<int>(derived::whole_share(c));
  // Shares that black out at once, and such that take many samples.
  const int usual = random.chance(0.5) ? most : std::max(1, most >> c.count_bits);
  std::vector<TableToken> entries;
  const int begun =
      style.port && classes < derived::most_class(c) ? random.in(0, c.lights - 1) : 0;  // of a class never whole
  for (int k = 1; k <= classes + 1; ++k)
    for (int light = 0; light < (k <= classes ? c.lights : begun); ++light) {
      TableToken t{k, light, {}};
      for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i)
        t.share[i] =
            static_cast<std::uint32_t>(style.dark_samples > 0 || random.chance(0.1) ? most : random.in(0, usual));
      entries.push_back(t);
    }
  return entries;
}

/// The state of a random frame, and what its lines have of a tree.
class RandomState {
 public:
  /// Writes the state behind the header.
  RandomState(Random& random, const Config& c, int width, int height, const FrameStyle& style, TokenWriter& w,
              std::array<std::uint64_t, kKinds>& count)
      : writer_(&w),
        count_(&count),
        with_tree_(c.units > 0 && width <= RandomTree::widest(c) && random.chance(style.trees)),
        classes_(most_classes(random, c)),
        tree_(random, c, width, with_tree_ ? height : 0, style.port, classes_) {
    const std::vector<TableToken> table = random_table(random, c, classes_, style);
    of(Kind::TABLE) += table.size();
    // Faces may come without a tree, before SHADE or after it.
    const bool has_faces = with_tree_ || (c.units > 0 && random.chance(0.2));
    const bool faces_first = random.chance(0.5);
    if (has_faces && faces_first) tree_.write_faces(w, of(Kind::FACE), table);
    if (c.dsf_bits > 0 && !derived::has_table(c) && c.linear_bits == 0 && random.chance(0.8)) {
      const auto all = static_cast<int>(derived::whole_share(c));
      w.shade(static_cast<std::uint32_t>(random.chance(0.1) ? 0 : random.chance(0.1) ? all : random.in(0, all)));
      ++of(Kind::SHADE);
    }
    if (has_faces && !faces_first) tree_.write_faces(w, of(Kind::FACE), table);
    if (!has_faces)
      for (const TableToken& entry : table) w.table(entry);
  }

  /// Classes that the frame's table has.
  [[nodiscard]] int classes() const { return classes_; }

  /// How line y begins: with segments and TREE, where the frame has a tree.
  void begin_line(int y) {
    if (!with_tree_) return;
    tree_.write_segments(*writer_, y, of(Kind::SEG));
    writer_->tree();
    ++of(Kind::TREE);
  }

 private:
  std::uint64_t& of(Kind k) { return (*count_)[static_cast<std::size_t>(k)]; }

  // The table may be empty, or, at a port, end within a class.
  static int most_classes(Random& random, const Config& c) {
    const int most = derived::has_table(c) ? derived::most_class(c) : 0;
    return random.chance(0.02) ? most : random.in(0, std::min(most, 9));
  }

  TokenWriter* writer_;
  std::array<std::uint64_t, kKinds>* count_;
  bool with_tree_;
  int classes_;
  RandomTree tree_;
};

}  // namespace kage::verif
