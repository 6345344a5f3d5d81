// SPDX-License-Identifier: Apache-2.0
#include "frontend/polygon_plan.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <queue>

#include "frontend/weight.hpp"

namespace kage {
namespace {

constexpr std::uint32_t kMostRank = (1U << kRankBits) - 1;
constexpr std::uint32_t kMostVolumes = 1U << kVolumeBits;
constexpr std::size_t kMostSamples = std::size_t{1} << kSampleBits;

/// Words of spans of a kind, and of a polygon's first tokens.
class Prices {
 public:
  Prices(const Config& config, Kind span_kind) : layout_(config), span_(words(span_kind)) {
    if (config.smooth != 0) gradients_ = static_cast<std::uint64_t>(config.channels) * words(Kind::GRADIENT);
  }

  /// Whether it is fewer words as a polygon. As spans it needs an AT on each of its lines.
  [[nodiscard]] bool worth(const PolygonShape& s, bool gradients) const {
    const std::uint64_t at = words(Kind::AT);
    const std::uint64_t polygon = at + words(Kind::POLYGON) + (gradients ? gradients_ : 0) + 2 * words(Kind::EDGE);
    return polygon + s.words < s.spans * span_ + static_cast<std::uint64_t>(s.lines()) * at;
  }

 private:
  [[nodiscard]] std::uint64_t words(Kind k) const { return layout_.words[static_cast<std::size_t>(k)]; }

  Layout layout_;
  std::uint64_t span_;
  std::uint64_t gradients_ = 0;
};

}  // namespace

PolygonPlan::PolygonPlan(const FrameGeometry& geometry, const Config& config, std::uint32_t first_span_polygon,
                         Arena& arena)
    : g_(&geometry), first_opaque_(std::min(first_span_polygon, geometry.drawn)), shapes_(geometry.polygons.size()) {
  find_shapes(config, arena);
  choose(config);
  keep_active(config);
  count();
}

bool PolygonPlan::fits(const FrameGeometry& g) {
  std::uint32_t in_sample = 0;
  for (std::size_t v = 0; v < g.volumes.size(); ++v) {
    in_sample = v > 0 && g.volumes[v].sample == g.volumes[v - 1].sample ? in_sample + 1 : 0;
    if (in_sample >= kMostVolumes || g.volumes[v].sample >= kMostSamples) return false;
  }
  return true;
}

void PolygonPlan::find_shapes(const Config& config, Arena& arena) {
  // Volumes' sides have no colour.
  std::vector<std::uint8_t> drawn(shapes_.size(), 0);
  std::fill_n(drawn.begin(), g_->drawn, 1);
  for (const ScreenFragment& f : g_->fragments) std::fill_n(drawn.begin() + f.first_polygon, f.polygon_count, 1);
  constexpr std::size_t kGrain = 64;
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, shapes_.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& some) {
                        ShapeFinder finder(*g_, config);
                        for (std::size_t i = some.begin(); i < some.end(); ++i)
                          shapes_[i] = finder.find(g_->polygons[i], drawn[i] != 0);
                      });
  });
}

void PolygonPlan::choose(const Config& config) {
  const auto way = [](const Prices& prices, const PolygonShape& s, PolygonWay possible, bool gradients) {
    if (s.spans == 0) return kUnseen;
    return possible == PolygonWay::polygon && !prices.worth(s, gradients) ? PolygonWay::words : possible;
  };
  const auto has_gradients = [this](std::size_t polygon) { return g_->polygons[polygon].color_planes >= 0; };
  opaque_.resize(g_->drawn);
  const Prices op(config, Kind::OP);
  for (std::size_t i = 0; i < g_->drawn; ++i)
    opaque_.way[i] = i < first_opaque_ ? kUnseen : way(op, shapes_[i], shapes_[i].as_drawn, has_gradients(i));
  number_.resize(g_->volumes.size());
  made_of_.resize(g_->volumes.size());
  if (config.dsf_bits > 0) {
    faces_.resize(g_->volume_faces.size());
    const Prices sp(config, Kind::SP);
    for (std::size_t i = 0; i < g_->volume_faces.size(); ++i) {
      const VolumeFace& f = g_->volume_faces[i];
      const PolygonShape& s = shapes_[f.polygon];
      faces_.way[i] = weight(config, f.w) == 0 ? kUnseen : way(sp, s, s.as_face, false);
    }
    for (std::size_t v = 1; v < g_->volumes.size(); ++v)
      if (g_->volumes[v].sample == g_->volumes[v - 1].sample) number_[v] = number_[v - 1] + 1;
  }
  if (config.translucency == 0) return;
  std::size_t uses = 0;
  for (const ScreenFragment& f : g_->fragments) {
    first_translucent_.push_back(uses);
    uses += f.polygon_count;
  }
  translucent_.resize(uses);
  const Prices tp(config, Kind::TP);
  for (std::size_t i = 0; i < g_->fragments.size(); ++i) {
    const ScreenFragment& f = g_->fragments[i];
    for (std::uint32_t n = 0; n < f.polygon_count; ++n) {
      const PolygonShape& s = shapes_[f.first_polygon + n];
      const bool whole = f.cut_count == 0 && f.first_line <= s.first && s.last < f.end_line;
      translucent_.way[first_translucent_[i] + n] =
          way(tp, s, whole ? s.as_drawn : PolygonWay::cut, has_gradients(f.first_polygon + n));
    }
  }
}

template <class Plan, class Each>
void PolygonPlan::each(Plan& plan, Each use) {
  const FrameGeometry& g = *plan.g_;
  for (std::size_t i = 0; i < plan.opaque_.way.size(); ++i) use(plan.opaque_.way[i], plan.shapes_[i]);
  for (std::size_t i = 0; i < plan.faces_.way.size(); ++i)
    use(plan.faces_.way[i], plan.shapes_[g.volume_faces[i].polygon]);
  for (std::size_t i = 0; i < plan.first_translucent_.size(); ++i)
    for (std::uint32_t n = 0; n < g.fragments[i].polygon_count; ++n)
      use(plan.translucent_.way[plan.first_translucent_[i] + n], plan.shapes_[g.fragments[i].first_polygon + n]);
}

// Line by line from the top: of too many the one that ends last goes as spans, which leaves as many as can be.
void PolygonPlan::keep_active(const Config& config) {
  std::vector<std::uint32_t> start(static_cast<std::size_t>(g_->height) + 1, 0);
  each(*this, [&](PolygonWay way, const PolygonShape& s) {
    if (way == PolygonWay::polygon) ++start[s.first + std::size_t{1}];
  });
  for (std::size_t y = 1; y < start.size(); ++y) start[y] += start[y - 1];
  struct Item {
    PolygonWay* way;
    int end;
  };
  std::vector<Item> items(start.back());
  std::vector<std::uint32_t> at(start.begin(), start.end() - 1);
  each(*this, [&](PolygonWay& way, const PolygonShape& s) {
    if (way == PolygonWay::polygon) items[at[s.first]++] = {&way, s.end};
  });
  // Those that are kept, by their ends; of one end, the newest is dropped first.
  std::vector<std::vector<std::uint32_t>> by_end(static_cast<std::size_t>(kGuard) + 2);
  int count = 0;
  int latest = 0;
  for (int y = 0; y < g_->height; ++y) {
    count -= static_cast<int>(by_end[static_cast<std::size_t>(y)].size());
    for (std::uint32_t i = start[static_cast<std::size_t>(y)]; i < start[static_cast<std::size_t>(y) + 1]; ++i) {
      by_end[static_cast<std::size_t>(items[i].end)].push_back(i);
      latest = std::max(latest, items[i].end);
      ++count;
    }
    for (; count > config.active; --count) {
      while (by_end[static_cast<std::size_t>(latest)].empty()) --latest;
      auto& last = by_end[static_cast<std::size_t>(latest)];
      *items[last.back()].way = PolygonWay::active;
      last.pop_back();
    }
    active_ = std::max(active_, count);
  }
}

void PolygonPlan::count() {
  const auto count_all = [](Uses& uses) {
    std::uint32_t made = 0;
    for (std::size_t i = 0; i < uses.way.size(); ++i) {
      uses.before[i] = made;
      made += uses.way[i] == PolygonWay::polygon ? 1 : 0;
    }
  };
  count_all(opaque_);
  count_all(translucent_);
  if (faces_.way.empty()) return;
  for (std::size_t v = 0; v < g_->volumes.size(); ++v) {
    const ShadowVolume& volume = g_->volumes[v];
    std::uint32_t made = 0;
    for (std::size_t i = volume.first_face; i < volume.first_face + volume.face_count; ++i) {
      PolygonWay& way = faces_.way[i];
      if (way == PolygonWay::polygon && made == kMostRank) way = PolygonWay::place;
      faces_.before[i] = made;
      made += way == PolygonWay::polygon ? 1 : 0;
    }
    made_of_[v] = made;
  }
}

Place PolygonPlan::place(std::uint32_t volume, std::uint32_t before) const {
  const std::uint32_t sample = g_->volumes[volume].sample;
  PolygonToken t;
  t.layer = static_cast<int>(Layer::volumes);
  t.sample = static_cast<int>(sample);
  t.volume = static_cast<int>(number_[volume]);
  t.rank = static_cast<int>(before);
  return {t, sample < g_->sample_light.size() ? g_->sample_light[sample] : 0};
}

void PolygonPlan::add_to(PolygonReport& report) const {
  report.active = active_;
  each(*this, [&](PolygonWay way, const PolygonShape& s) {
    if (way == kUnseen) return;
    auto& of = report.ways[static_cast<std::size_t>(way)];
    const bool tall = s.lines() >= kTallLines;
    ++of.polygons;
    of.tall_polygons += tall ? 1 : 0;
    if (way != PolygonWay::polygon) return;
    of.spans += s.spans;
    of.tall_spans += tall ? s.spans : 0;
  });
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
