// SPDX-License-Identifier: Apache-2.0
#include "frontend/polygon_layout.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "frontend/weight.hpp"

namespace kage {
namespace {

constexpr std::uint32_t kMostRank = (1U << kRankBits) - 1;
constexpr std::uint32_t kMostVolumes = 1U << kVolumeBits;
constexpr std::size_t kMostSamples = std::size_t{1} << kSampleBits;

}  // namespace

/// Words that polygons take.
class Prices {
 public:
  explicit Prices(const Config& config) : layout_(config) {
    gradients_ = config.smooth != 0 ? config.channels * words(Kind::GRADIENT) : 0;
  }

  /// How many fewer it takes as a polygon than as spans of so many words with `ats` ATs.
  [[nodiscard]] std::int64_t saved(const ScreenPolygon& p, const PolygonShape& s, Kind span, std::int64_t span_words,
                                   int ats) const {
    const bool varies = has_color_planes(p) && span != Kind::SP;
    const std::int64_t polygon =
        words(Kind::AT) + words(Kind::POLYGON) + (varies ? gradients_ : 0) + 2 * words(Kind::EDGE);
    return span_words + ats * words(Kind::AT) - polygon - s.words;
  }

  [[nodiscard]] std::int64_t words(Kind k) const { return layout_.words[static_cast<std::size_t>(k)]; }

 private:
  Layout layout_;
  std::int64_t gradients_;
};

PolygonLayout::PolygonLayout(const FrameGeometry& geometry, const Config& config, std::uint32_t first_span_polygon,
                             const SpanWords* words, Arena& arena)
    : g_(&geometry),
      words_(words),
      uses_(geometry, config),
      first_opaque_(std::min(first_span_polygon, geometry.drawn)),
      shapes_(geometry.polygons.size()),
      ways_(uses_.count()),
      before_(uses_.count()),
      made_of_(geometry.volumes.size()),
      counts_(config.count_bits > 0) {
  find_shapes(config, arena);
  number_volumes();
  choose(config);
  choose_volumes(config);
  keep_active(config);
  join_spans(config);
  count();
}

bool PolygonLayout::fits(const FrameGeometry& g) {
  // With linear light each light has a number among the samples for its own spans.
  if (!g.passes.empty() && g.sample_light.size() + g.passes.size() > kMostSamples) return false;
  std::uint32_t in_sample = 0;
  for (std::size_t v = 0; v < g.volumes.size(); ++v) {
    in_sample = v > 0 && g.volumes[v].sample == g.volumes[v - 1].sample ? in_sample + 1 : 0;
    if (in_sample >= kMostVolumes || g.volumes[v].sample >= kMostSamples) return false;
  }
  return true;
}

void PolygonLayout::find_shapes(const Config& config, Arena& arena) {
  // Volumes' sides have no colour.
  std::vector<std::uint8_t> drawn(shapes_.size(), 0);
  std::fill_n(drawn.begin(), g_->drawn, 1);
  for (const ScreenFragment& f : g_->fragments) std::fill_n(drawn.begin() + f.first_polygon, f.polygon_count, 1);
  constexpr std::size_t kGrain = 64;
  arena.for_each(tbb::blocked_range<std::size_t>(0, shapes_.size(), kGrain),
                 [&](const tbb::blocked_range<std::size_t>& some) {
                   ShapeFinder finder(*g_, config);
                   for (std::size_t i = some.begin(); i < some.end(); ++i)
                     shapes_[i] = finder.find(g_->polygons[i], drawn[i] != 0);
                 });
}

void PolygonLayout::number_volumes() {
  number_.resize(g_->volumes.size());
  for (std::size_t v = 1; v < g_->volumes.size(); ++v)
    if (g_->volumes[v].sample == g_->volumes[v - 1].sample) number_[v] = number_[v - 1] + 1;
}

std::int64_t PolygonLayout::span_words(const Prices& prices, std::size_t use) const {
  if (words_ != nullptr) return words_->of(use);
  return shapes_[uses_.polygon_of(use)].spans * prices.words(uses_.span_of(use));
}

void PolygonLayout::choose(const Config& config) {
  const Prices prices(config);
  for (std::size_t i = 0; i < ways_.size(); ++i) ways_[i] = choice(config, prices, i);
}

PolygonWay PolygonLayout::choice(const Config& config, const Prices& prices, std::size_t use) const {
  const std::uint32_t polygon = uses_.polygon_of(use);
  const PolygonShape& s = shapes_[polygon];
  const Kind span = uses_.span_of(use);
  if (s.spans == 0 || (span == Kind::OP && use < first_opaque_)) return kUnseen;
  if (span == Kind::SP && weight(config, g_->volume_faces[use - uses_.first_face()].w) == 0) return kUnseen;
  if (words_ != nullptr && words_->of(use) == 0) return kUnseen;
  if (span == Kind::TP) {
    const ScreenFragment& f = uses_.fragment_of(use);
    if (f.cut_count > 0 || s.first < f.first_line || s.last >= f.end_line) return PolygonWay::cut;
  }
  const PolygonWay way = span == Kind::SP ? s.as_face : s.as_drawn;
  if (way != PolygonWay::polygon) return way;
  // Spans take an AT on each line where none of its neighbours is spans.
  const bool saves = prices.saved(g_->polygons[polygon], s, span, span_words(prices, use), s.lines()) > 0;
  return saves ? way : PolygonWay::words;
}

// A face that goes as a polygon counts on all of its lines, and has the volume's other spans there with it. Where none
// does, lines on which the volume has no effect are left out, and spans before all that receives become few fronts.
void PolygonLayout::choose_volumes(const Config& config) {
  if (words_ == nullptr || !uses_.has_faces()) return;
  const Prices prices(config);
  for (std::size_t v = 0; v < g_->volumes.size(); ++v) {
    const std::size_t first = uses_.face(g_->volumes[v].first_face);
    const std::size_t end = first + g_->volumes[v].face_count;
    std::int64_t apart = 0;
    for (std::size_t i = first; i < end; ++i) {
      if (ways_[i] == kUnseen) continue;
      const std::uint32_t polygon = uses_.polygon_of(i);
      const PolygonShape& s = shapes_[polygon];
      const std::int64_t words = words_->of(i) + s.lines() * prices.words(Kind::AT);
      const bool made = ways_[i] == PolygonWay::polygon;
      apart += words - (made ? prices.saved(g_->polygons[polygon], s, Kind::SP, words_->of(i), s.lines()) : 0);
    }
    if (words_->of_volume(v) >= apart) continue;
    for (std::size_t i = first; i < end; ++i)
      if (ways_[i] == PolygonWay::polygon) ways_[i] = PolygonWay::words;
  }
}

namespace {

int pixels_in(const LineRange& r) { return r.end - r.first; }

LineRange hull(const LineRange& a, const LineRange& b) {
  if (pixels_in(a) == 0) return b;
  if (pixels_in(b) == 0) return a;
  return {std::min(a.first, b.first), std::max(a.end, b.end)};
}

/// A polygon that goes as such, on a line.
struct Active {
  std::uint32_t use;
  int end;
  std::int64_t saved;     // words
  std::int64_t relieved;  // lines with too many, from the one at hand on
};

/// How many polygons are there at once, on each line.
class Crowd {
 public:
  Crowd(int height, int most) : most_(most), count_(static_cast<std::size_t>(height) + 1, 0), before_(count_) {}

  void add(int first, int end) {
    ++at(first);
    --at(end);
  }
  /// All have been added.
  int sum() {
    for (std::size_t y = 1; y < count_.size(); ++y) count_[y] += count_[y - 1];
    int most = 0;
    for (const int n : count_) most = std::max(most, n);
    return most;
  }
  void drop(int y, int end) {
    for (; y < end; ++y) --at(y);
  }

  /// Find what dropping each relieves.
  void relieve(int y, std::vector<Active>& active) {
    int last = y;
    for (const Active& a : active) last = std::max(last, a.end);
    int sum = 0;
    for (int l = y; l <= last; ++l) {
      before_[static_cast<std::size_t>(l)] = sum;
      sum += at(l) > most_ ? 1 : 0;
    }
    for (Active& a : active) a.relieved = before_[static_cast<std::size_t>(a.end)];
  }

 private:
  int& at(int y) { return count_[static_cast<std::size_t>(y)]; }

  int most_;
  std::vector<int> count_;
  std::vector<int> before_;  // lines with too many
};

}  // namespace

// Line by line from the top: of too many, those go as spans that save the fewest words for each line that is relieved.
void PolygonLayout::keep_active(const Config& config) {
  const auto end_of = [this](const PolygonShape& s) { return std::min<int>(s.end, g_->height); };
  const auto each_made = [this](auto made) {
    for (std::size_t i = 0; i < ways_.size(); ++i)
      if (ways_[i] == PolygonWay::polygon) made(static_cast<std::uint32_t>(i), shapes_[uses_.polygon_of(i)]);
  };
  Crowd crowd(g_->height, config.active);
  std::vector<std::uint32_t> start(static_cast<std::size_t>(g_->height) + 1, 0);  // in uses, by first line
  each_made([&](std::uint32_t, const PolygonShape& s) {
    ++start[s.first + std::size_t{1}];
    crowd.add(s.first, end_of(s));
  });
  active_ = crowd.sum();
  if (active_ <= config.active) return;
  active_ = config.active;
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> uses(start.back());
  std::vector<std::uint32_t> at(start.begin(), start.end() - 1);
  each_made([&](std::uint32_t i, const PolygonShape& s) { uses[at[s.first]++] = i; });
  const Prices prices(config);
  std::vector<Active> active;
  for (int y = 0; y < g_->height; ++y) {
    std::erase_if(active, [y](const Active& a) { return a.end <= y; });
    for (std::uint32_t i = start[static_cast<std::size_t>(y)]; i < start[static_cast<std::size_t>(y) + 1]; ++i) {
      const std::uint32_t polygon = uses_.polygon_of(uses[i]);
      const PolygonShape& s = shapes_[polygon];
      const std::int64_t saved =
          prices.saved(g_->polygons[polygon], s, uses_.span_of(uses[i]), span_words(prices, uses[i]), s.lines());
      active.push_back({uses[i], end_of(s), saved, 0});
    }
    if (static_cast<int>(active.size()) <= config.active) continue;
    crowd.relieve(y, active);
    const auto keep = active.begin() + config.active;
    std::nth_element(active.begin(), keep, active.end(), [](const Active& a, const Active& b) {
      const std::int64_t of_a = a.saved * b.relieved;
      const std::int64_t of_b = b.saved * a.relieved;
      return of_a != of_b ? of_a > of_b : a.use < b.use;
    });
    for (auto a = keep; a != active.end(); ++a) {
      ways_[a->use] = PolygonWay::active;
      crowd.drop(y, a->end);
    }
    active.erase(keep, active.end());
  }
}

template <class Each>
void PolygonLayout::each_order(Each order) const {
  order(std::size_t{0}, uses_.first_face());
  if (uses_.has_faces())
    for (const ShadowVolume& v : g_->volumes) order(uses_.face(v.first_face), uses_.face(v.first_face + v.face_count));
  order(uses_.first_translucent(), uses_.first_lit());
  for (std::size_t l = 0; l < g_->passes.size(); ++l) order(uses_.lit(l, 0), uses_.lit(l + 1, 0));
}

// Spans that stand between the same two polygons share the AT of a line, and a polygon parts those before it from those
// behind it. So one goes as spans, too, where that saves more than it costs.
void PolygonLayout::join_spans(const Config& config) {
  const Prices prices(config);
  each_order([&](std::size_t first, std::size_t end) {
    LineRange before;  // lines of the spans right before the polygon at hand, and what lies between them
    for (std::size_t i = first; i < end; ++i) {
      const PolygonShape& s = shapes_[uses_.polygon_of(i)];
      if (ways_[i] == kUnseen) continue;
      const LineRange here{s.first, s.last + 1};
      if (ways_[i] != PolygonWay::polygon) {
        before = hull(before, here);
        continue;
      }
      LineRange behind;
      for (std::size_t k = i + 1; k < end && ways_[k] != PolygonWay::polygon; ++k)
        if (ways_[k] != kUnseen)
          behind = hull(behind, {shapes_[uses_.polygon_of(k)].first, shapes_[uses_.polygon_of(k)].last + 1});
      const LineRange all = hull(hull(before, here), behind);
      const int ats = std::min(pixels_in(all) - pixels_in(before) - pixels_in(behind), s.lines());
      const bool joins =
          prices.saved(g_->polygons[uses_.polygon_of(i)], s, uses_.span_of(i), span_words(prices, i), ats) <= 0;
      if (joins) ways_[i] = PolygonWay::words;
      before = joins ? hull(before, here) : LineRange{};
    }
  });
}

void PolygonLayout::count() {
  const auto count_some = [this](std::size_t first, std::size_t end, std::uint32_t most) {
    std::uint32_t made = 0;
    for (std::size_t i = first; i < end; ++i) {
      if (ways_[i] == PolygonWay::polygon && made == most) ways_[i] = PolygonWay::place;
      before_[i] = made;
      made += ways_[i] == PolygonWay::polygon ? 1 : 0;
    }
    return made;
  };
  constexpr std::uint32_t kAny = std::numeric_limits<std::uint32_t>::max();
  count_some(0, uses_.first_face(), kAny);
  count_some(uses_.first_translucent(), uses_.first_lit(), kAny);
  for (std::size_t l = 0; l < g_->passes.size(); ++l) count_some(uses_.lit(l, 0), uses_.lit(l + 1, 0), kMostRank);
  if (!uses_.has_faces()) return;
  for (std::size_t v = 0; v < g_->volumes.size(); ++v) {
    const std::size_t first = uses_.face(g_->volumes[v].first_face);
    made_of_[v] = count_some(first, first + g_->volumes[v].face_count, kMostRank);
  }
}

Place PolygonLayout::place(std::uint32_t volume, std::uint32_t before) const {
  std::uint32_t sample = g_->volumes[volume].sample;
  const int light = sample < g_->sample_light.size() ? g_->sample_light[sample] : 0;
  if (!g_->passes.empty()) sample += static_cast<std::uint32_t>(light);  // a light's own spans have a number, too
  PolygonToken t;
  t.layer = static_cast<int>(Layer::volumes);
  t.sample = static_cast<int>(sample);
  t.volume = static_cast<int>(number_[volume]);
  t.rank = static_cast<int>(before);
  return {t, g_->passes.empty() ? light : 0};
}

Place PolygonLayout::light_place(std::size_t light, std::uint32_t before) const {
  const auto samples = std::upper_bound(g_->sample_light.begin(), g_->sample_light.end(), light);
  PolygonToken t;
  t.layer = static_cast<int>(Layer::volumes);
  t.sample = static_cast<int>(samples - g_->sample_light.begin()) + static_cast<int>(light);
  t.volume = counts_ ? g_->passes[light] : 0;
  t.rank = static_cast<int>(before);
  return {t, 1};
}

void PolygonLayout::add_to(PolygonReport& report) const {
  report.active = active_;
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (ways_[i] == kUnseen) continue;
    const PolygonShape& s = shapes_[uses_.polygon_of(i)];
    auto& of = report.ways[static_cast<std::size_t>(ways_[i])];
    const bool tall = s.lines() >= kTallLines;
    ++of.polygons;
    of.tall_polygons += tall ? 1 : 0;
    if (ways_[i] != PolygonWay::polygon) continue;
    of.spans += s.spans;
    of.tall_spans += tall ? s.spans : 0;
  }
}

PolygonReport::Way& PolygonReport::Way::operator+=(const Way& other) {
  polygons += other.polygons;
  spans += other.spans;
  tall_polygons += other.tall_polygons;
  tall_spans += other.tall_spans;
  return *this;
}

PolygonReport::Way PolygonReport::all() const {
  Way sum;
  for (const Way& way : ways) sum += way;
  return sum;
}

PolygonReport& PolygonReport::operator+=(const PolygonReport& other) {
  polygons = polygons || other.polygons;
  for (std::size_t i = 0; i < ways.size(); ++i) ways[i] += other.ways[i];
  active = std::max(active, other.active);
  words += other.words;
  return *this;
}

}  // namespace kage
