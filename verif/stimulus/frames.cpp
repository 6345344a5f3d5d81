// SPDX-License-Identifier: Apache-2.0
#include "stimulus/frames.hpp"

#include <algorithm>
#include <deque>
#include <span>
#include <utility>

#include "contract/derived.hpp"

namespace kage::verif {
namespace {

/// A two's complement field of so many bits: any magnitude is as likely as any other.
std::int64_t random_field(Random& random, int bits) {
  const std::int64_t limit = std::int64_t{1} << (random.in(1, bits) - 1);
  return random.integer(-limit, limit - 1);
}

/// A span of a valid frame: any start and slope that stay within the accumulator.
void random_ramp(Random& random, int bits, int count, std::int64_t& start, std::int64_t& step) {
  const std::int64_t limit = std::int64_t{1} << (bits - 1);
  // Often within the range that is drawn, sometimes past it, sometimes all equal (ties).
  start = random.chance(0.8) ? random.integer(0, limit / 2) : random.integer(-limit, limit - 1);
  if (random.chance(0.2)) start = limit / 4;
  step = 0;
  if (count > 1 && random.chance(0.8)) {
    const std::int64_t up = std::min(limit - 1, (limit - 1 - start) / (count - 1));
    const std::int64_t down = std::max(-limit, -((start + limit) / (count - 1)));
    step = random.chance(0.1) ? (random.chance(0.5) ? up : down) : random.integer(down, up);
  }
}

/// A class that a table of so many has, or, without table, lit or not.
int random_class(Random& random, const Config& c, int classes) {
  if (c.dsf_bits == 0 || random.chance(0.2)) return 0;
  return !derived::has_table(c) ? 1 : random.in(0, classes);
}

/// `home` is the pixel round which the spans of a crowded line meet.
SpanToken random_span(Random& random, const Config& c, int width, const FrameStyle& style = {}, int home = 0,
                      int classes = 0) {
  SpanToken s;
  s.xl = random.in(0, width);
  s.xr = random.chance(0.2)   ? width
         : random.chance(0.2) ? s.xl
         : random.chance(0.3) ? std::min(width, s.xl + random.in(0, 3))
                              : random.in(s.xl, width);
  if (random.chance(0.1)) s.xl = 0;
  const int count = s.xr - s.xl;
  const int depth_bits = derived::depth_bits(c);
  random_ramp(random, depth_bits, count, s.z, s.dz);
  s.normal_class = random_class(random, c, classes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
    if (c.smooth == 0) {
      s.color[i] = random.in(0, 255);
      continue;
    }
    std::int64_t start = 0;
    std::int64_t step = 0;
    random_ramp(random, derived::ramp_bits(c), count, start, step);
    s.color[i] = static_cast<std::int32_t>(start);
    s.dcolor[i] = static_cast<std::int32_t>(step);
  }
  if (!style.port) return s;
  if (random.chance(0.35)) {
    s.xl = std::min(width, home + random.in(0, 2));
    s.xr = std::min(width, s.xl + random.in(0, 9));
  }
  if (random.chance(0.5)) {
    s.z = ((std::int64_t{1} << (c.z_bits - 1)) + random.in(-8, 8)) * (std::int64_t{1} << c.z_frac);
    s.dz = random_field(random, std::min(depth_bits, c.z_frac + 2));
  } else if (random.chance(0.3)) {
    s.z = random_field(random, depth_bits);
    s.dz = random_field(random, depth_bits);
  }
  for (std::size_t i = 0; c.smooth != 0 && i < static_cast<std::size_t>(c.channels); ++i) {
    if (!random.chance(0.3)) continue;
    s.color[i] = static_cast<std::int32_t>(random_field(random, derived::ramp_bits(c)));
    s.dcolor[i] = static_cast<std::int32_t>(random_field(random, derived::ramp_bits(c)));
  }
  return s;
}

/// A translucent span: any span, often one that is not blended at all or nothing but itself.
SpanToken random_translucent(Random& random, const Config& c, int width, const FrameStyle& style, int home) {
  SpanToken s = random_span(random, c, width, style, home);
  s.alpha = random.chance(0.3) ? random.in(0, 1) * 255 : random.in(0, 255);
  return s;
}

int random_weight(Random& random, const Config& c) {
  const auto most = static_cast<int>(derived::most_dsf(c));
  return random.chance(0.8) ? (random.chance(0.5) ? 1 : -1) : random.in(-most - 1, most);
}

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

  /// What is left of line y's segments, and some of the next line's.
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
    for (std::size_t i = 0; i < static_cast<std::size_t>(config_.channels); ++i) t.color[i] = random_->in(0, 255);
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
std::vector<TableToken> random_table(Random& random, const Config& c, int classes, bool port) {
  if (!derived::has_table(c)) return {};
  const auto most = static_cast<int>(derived::whole_share(c));
  // Shares that black out at once, and such that take many samples.
  const int usual = random.chance(0.5) ? most : std::max(1, most >> c.count_bits);
  std::vector<TableToken> entries;
  const int begun =
      port && classes < derived::most_class(c) ? random.in(0, c.lights - 1) : 0;  // of a class never whole
  for (int k = 1; k <= classes + 1; ++k)
    for (int light = 0; light < (k <= classes ? c.lights : begun); ++light) {
      TableToken t{k, light, {}};
      for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i)
        t.share[i] = static_cast<std::uint32_t>(random.chance(0.1) ? most : random.in(0, usual));
      entries.push_back(t);
    }
  return entries;
}

/// The volumes of a sample of a light, or of the only one there is; false if there are none.
bool random_sample(Random& random, const Config& c, int width, TokenWriter& w, std::array<std::uint64_t, 16>& count,
                   const FrameStyle& style, int home) {
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  const int volumes = c.fsf != 0 ? random.in(0, style.most_volumes) : random.in(0, 1);
  for (int v = 0; v < volumes; ++v) {
    for (int i = random.in(1, style.most_in_volume); i > 0; --i) {
      SpanToken s = random_span(random, c, width, style, home);
      s.w = random_weight(random, c);
      switch (random.in(0, 9)) {
        case 0:
          w.inside(s.w);
          add(Kind::IF);
          break;
        case 1:
        case 2:
          w.nc(s.xl, s.xr, s.w);
          add(Kind::NC);
          break;
        default:
          w.sp(s);
          add(Kind::SP);
      }
    }
    if (c.fsf != 0) {
      const SpanToken s = random_span(random, c, width, style, home);
      if (random.chance(0.6))
        w.ev(0, width);
      else
        w.ev(s.xl, s.xr);
      add(Kind::EV);
    }
  }
  if (volumes > 0 && c.count_bits != 0) {
    const SpanToken s = random_span(random, c, width, style, home);
    const int light = random.in(0, c.lights - 1);
    if (random.chance(0.7))
      w.es(0, width, light);
    else
      w.es(s.xl, s.xr, light);
    add(Kind::ES);
  }
  return volumes > 0;
}

}  // namespace

std::array<std::uint64_t, 16> random_frame(Random& random, const Config& c, int width, int height,
                                           std::vector<std::uint32_t>& words, std::uint32_t number,
                                           const FrameStyle& style) {
  width = std::min(width, c.max_width);
  std::array<std::uint64_t, 16> count{};
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  TokenWriter w(c, words);
  w.header({width, height, static_cast<std::uint32_t>(random.in(0, 0xFFFFFF)), number});
  const bool has_tree = c.units > 0 && width <= RandomTree::widest(c) && random.chance(style.trees);
  // The table may be empty, or, at a port, end within a class.
  const int most_classes = derived::has_table(c) ? derived::most_class(c) : 0;
  const int classes = random.chance(0.02) ? most_classes : random.in(0, std::min(most_classes, 9));
  RandomTree tree(random, c, width, has_tree ? height : 0, style.port, classes);
  const std::vector<TableToken> table = random_table(random, c, classes, style.port);
  count[static_cast<std::size_t>(Kind::TABLE)] += table.size();
  // Faces may come without a tree, before SHADE or after it.
  const bool has_faces = has_tree || (c.units > 0 && random.chance(0.2));
  const bool faces_first = random.chance(0.5);
  if (has_faces && faces_first) tree.write_faces(w, count[static_cast<std::size_t>(Kind::FACE)], table);
  if (c.dsf_bits > 0 && most_classes == 0 && random.chance(0.8)) {
    const auto all = static_cast<int>(derived::whole_share(c));
    w.shade(static_cast<std::uint32_t>(random.chance(0.1) ? 0 : random.chance(0.1) ? all : random.in(0, all)));
    add(Kind::SHADE);
  }
  if (has_faces && !faces_first) tree.write_faces(w, count[static_cast<std::size_t>(Kind::FACE)], table);
  if (!has_faces)
    for (const TableToken& entry : table) w.table(entry);
  for (int y = 0; y < height; ++y) {
    if (has_tree) {
      tree.write_segments(w, y, count[static_cast<std::size_t>(Kind::SEG)]);
      w.tree();
      add(Kind::TREE);
    }
    const int home = style.port ? random.in(0, width - 1) : 0;
    for (int i = random.in(0, style.most_opaque); i > 0; --i) {
      w.op(random_span(random, c, width, style, home, classes));
      add(Kind::OP);
    }
    const int samples = c.dsf_bits == 0 ? 0 : c.count_bits == 0 ? 1 : random.in(0, style.most_samples);
    bool any_volume = false;
    for (int sample = 0; sample < samples; ++sample)
      any_volume |= random_sample(random, c, width, w, count, style, home);
    if (any_volume) {
      w.resolve();
      add(Kind::RESOLVE);
    }
    for (int i = c.translucency != 0 && random.chance(0.7) ? random.in(0, style.most_translucent) : 0; i > 0; --i) {
      w.tp(random_translucent(random, c, width, style, home));
      add(Kind::TP);
    }
    w.eol(y);
    add(Kind::EOL);
  }
  w.end();
  add(Kind::END);
  return count;
}

}  // namespace kage::verif
