// SPDX-License-Identifier: Apache-2.0
#include "stimulus/random_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "contract/derived.hpp"
#include "kage/error.hpp"
#include "number/mixed.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"

namespace kage::verif {
namespace {

using Words = std::vector<std::uint32_t>;

// A height that flipped bits made great takes long and shows no more; one past 15 bits is refused, so it may stay.
constexpr int kMostLines = 40;
constexpr int kLinesRefused = kMaxHeight + 1;

// Each sample of a line is a sweep over the line's groups of LANES pixels. More sweeps of them take minutes, in the
// widest core with the most lights, and show no more.
constexpr int kMostGroupSweeps = 1 << 19;

// A whole token lost, doubled, or put where it does not belong.
void misplace(Random& random, const Config& c, Words& words) {
  const TokenPlaces places(c, words);
  if (!places.whole() || places.all().empty()) return;
  TokenPlaces change(c, words);
  const auto any = [&] {
    return places.all()[static_cast<std::size_t>(random.in(0, static_cast<int>(places.all().size()) - 1))];
  };
  const TokenPlaces::At at = any();
  const TokenPlaces::At length = change.length(kind_of(words[static_cast<std::size_t>(at)], places.level()));
  if (random.chance(0.3))
    change.erase(at, length);
  else
    change.copy(at, length, any());
}

// One field just past what it may be.
void near_miss(Random& random, const Config& c, Words& words) {
  TokenPlaces places(c, words);
  if (!places.whole()) return;
  const Layout& layout = places.layout();
  const auto any = [&](Kind kind) -> std::optional<TokenPlaces::At> {
    const auto& of = places.of(kind);
    if (of.empty()) return std::nullopt;
    return of[static_cast<std::size_t>(random.in(0, static_cast<int>(of.size()) - 1))];
  };
  if (derived::has_table(c) && random.chance(0.6)) {
    const auto at = any(Kind::OP);
    std::uint64_t most = 0;
    for (const auto table : places.of(Kind::TABLE)) most = std::max(most, places.get(table, layout.table_class));
    if (at) places.put(*at, layout.op_class, most + 1);
  } else if (c.lights > 1 && random.chance(0.7)) {
    const auto at = any(Kind::ES);
    if (at) places.put(*at, layout.es_light, static_cast<std::uint64_t>(c.lights));
  } else if (c.units > 0 && random.chance(0.7)) {
    const auto at = any(Kind::SEG);
    if (!at) return;
    const std::uint64_t unit = places.get(*at, layout.seg_unit);
    const auto& faces = places.of(Kind::FACE);
    const auto of_unit = [&](TokenPlaces::At face) { return places.get(face, layout.face_unit) == unit; };
    places.put(*at, layout.seg_face, static_cast<std::uint64_t>(std::count_if(faces.begin(), faces.end(), of_unit)));
  } else if (const auto at = any(Kind::OP)) {
    places.put(*at, layout.op_xr, static_cast<std::uint64_t>(FrameHeader::read(words).width) + 1);
  }
}

// Cut within the header, a few words too long, or with another header.
void header_or_end(Random& random, const Config& c, Words& words) {
  const double manner = random.real(0, 1);
  if (manner < 0.25)
    words.resize(static_cast<std::size_t>(random.in(1, static_cast<int>(kHeaderWords) - 1)));
  else if (manner < 0.5)
    words.resize(words.size() + static_cast<std::size_t>(random.in(1, 2 * c.beat_words)));
  else
    words[static_cast<std::size_t>(random.in(0, 2))] ^= 1U << (random.chance(0.3) ? 31 : random.in(0, 31));
}

void make_wrong(Random& random, const Config& c, Words& words) {
  if (words.size() < kHeaderWords) return damage(random, words);
  if (FrameHeader::read(words).level() == Level::polygons && random.chance(0.6))
    return damage_polygons(random, c, words);
  if (c.units > 0 && random.chance(0.4)) return damage_tree(random, c, words);
  if (c.count_bits > 0 && random.chance(0.3)) return damage_light(random, c, words);
  switch (random.in(0, 3)) {
    case 0:
      return damage(random, words);
    case 1:
      return near_miss(random, c, words);
    case 2:
      return header_or_end(random, c, words);
    default:
      return misplace(random, c, words);
  }
}

}  // namespace

namespace {

Words polygon_frame(Random& random, const Config& c, std::uint32_t number, int width, int height,
                    const PolygonStyle& style) {
  Words words;
  random_polygon_frame(random, c, width, height, words, number, style);
  return words;
}

/// The frame of sound_frame() at the polygon level.
Words sound_polygons(Random& random, const Config& c, std::uint32_t number, int width) {
  PolygonStyle style;
  style.spans.port = random.chance(0.8);
  style.spans.trees = 0.3;
  int height = random.in(1, random.chance(0.3) ? 30 : 8);
  if (random.chance(0.2)) style.most_polygons = style.most_lines = 40;  // as many at once as the core keeps
  if (random.chance(0.15)) style.most_tokens = 0;
  if (random.chance(0.1)) style.most_lines = 1;
  if (random.chance(0.05)) {  // lines with nothing on them
    style.most_polygons = style.most_tokens = 0;
    height = random.in(10, 20);
  }
  return polygon_frame(random, c, number, width, height, style);
}

}  // namespace

Words sound_frame(Random& random, const Config& c, std::uint32_t number, Level level) {
  const auto any_width = [&] {
    return random.chance(0.2)   ? random.in(1, std::min(c.max_width, 4))
           : random.chance(0.3) ? c.max_width
                                : random.in(1, std::min(c.max_width, 70));
  };
  if (level == Level::polygons) return sound_polygons(random, c, number, any_width());
  FrameStyle style{.most_opaque = 12, .most_volumes = 4, .most_in_volume = 8, .port = random.chance(0.8)};
  int height = random.in(1, random.chance(0.1) ? 12 : 4);
  if (random.chance(0.2)) style.most_opaque = style.most_in_volume = 60;
  if (random.chance(0.12)) {  // more samples than a counter holds, and little else
    style.most_samples = (3 << c.count_bits) * c.lights;
    style.most_opaque = style.most_volumes = style.most_in_volume = 2;
  }
  if (half_sum(c) > 0 && random.chance(0.04)) {  // a line of many tokens, so it is the only one
    style.dark_samples = half_sum(c);
    height = 1;
  }
  if (random.chance(0.15)) style.most_opaque = style.most_volumes = 0;  // line upon line, and all that a line needs
  if (random.chance(0.05)) {                                            // lines with nothing on them
    style.most_opaque = style.most_volumes = style.most_translucent = style.most_samples = 0;
    style.trees = 0;
    height = random.in(10, 20);
  }
  Words words;
  const int samples = std::max(style.most_samples, style.dark_samples);
  const int most_width = std::max(c.lanes, kMostGroupSweeps / std::max(samples, 1) * c.lanes);
  random_frame(random, c, std::min(any_width(), most_width), height, words, number, style);
  return words;
}

Words earlier_frame(Random& random, const Config& c, std::uint32_t number, Level level) {
  if (random.chance(0.4)) return damaged_frame(random, c, number, level);
  if (random.chance(0.5)) return sound_frame(random, c, number, level);
  FrameStyle style{.most_opaque = 0, .most_volumes = 0, .most_translucent = 0, .most_samples = 0};
  if (random.chance(0.7)) {
    style.most_opaque = style.dark_samples = 1;
    style.dark_lines = 0.5;
  }
  Words words;
  random_frame(random, c, random.in(1, 2), random.in(8, 24), words, number, style);
  return words;
}

Words tall_frame(Random& random, const Config& c, std::uint32_t number, Level level) {
  FrameStyle style{
      .most_opaque = 1, .most_volumes = 1, .most_in_volume = 2, .most_translucent = 1, .most_samples = 2, .port = true};
  style.trees = 0.2;
  // A little above a power of two, so that a counter of lines that lacks bits wraps within the frame.
  const int height = random.chance(0.3) ? kMaxHeight : (1 << random.in(7, 12)) + random.in(-1, 40);
  const int width = random.in(1, std::min(c.max_width, 4));
  if (level == Level::polygons) {
    style.port = random.chance(0.8);
    return polygon_frame(random, c, number, width, height, {style, 1, 1, 200});
  }
  Words words;
  random_frame(random, c, width, height, words, number, style);
  return words;
}

Words wide_frame(Random& random, const Config& c, std::uint32_t number, Level level) {
  const int groups = random.in(1, std::max(1, c.max_width / c.lanes));
  const int width = std::clamp(groups * c.lanes + random.in(-1, 1), 1, c.max_width);
  if (level == Level::polygons) return sound_polygons(random, c, number, width);
  Words words;
  random_frame(random, c, width, random.in(1, 3), words, number, {.most_opaque = 12, .port = random.chance(0.8)});
  return words;
}

Words damaged_frame(Random& random, const Config& c, std::uint32_t number, Level level) {
  for (;;) {
    const Words sound = sound_frame(random, c, number, level);
    Words words = sound;
    make_wrong(random, c, words);
    if (random.chance(0.1)) make_wrong(random, c, words);
    if (words.empty() || words == sound) continue;  // a port brings a beat at least
    const int lines = FrameHeader::read(words).height;
    if (lines <= kMostLines || lines >= kLinesRefused) return words;
  }
}

std::optional<Manner> random_manner(const std::string& name) {
  for (const RandomSource& source : kRandomSources)
    if (name == source.name) return source.manner;
  if (!name.starts_with("random:")) return std::nullopt;
  std::string names;
  for (const RandomSource& source : kRandomSources)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", source.name);
  throw Error(fmt::format("{}: no such random frames (there are {})", name, names));
}

Level RandomFrames::any_level(Random& random) const {
  return level_ == Level::polygons && random.chance(0.8) ? Level::polygons : Level::spans;
}

Words RandomFrames::words(int index) const {
  Random random(mixed(seed_, static_cast<std::uint64_t>(index)));
  const Level level = any_level(random);
  const bool wrong = manner_ == Manner::damaged || (manner_ == Manner::mixed && random.chance(0.5));
  const auto number = static_cast<std::uint32_t>(random.integer(0, UINT32_MAX));
  if (wrong) return damaged_frame(random, config_, number, level);
  if (index % kSizes == kTall) return tall_frame(random, config_, number, level);
  if (index % kSizes == kWide) return wide_frame(random, config_, number, level);
  return sound_frame(random, config_, number, level);
}

std::function<Words(int)> RandomFrames::prelude() const {
  if (manner_ != Manner::mixed) return nullptr;
  return [frames = RandomFrames(config_, manner_, mixed(~seed_), level_)](int index) {
    Random random(mixed(frames.seed_, static_cast<std::uint64_t>(index)));
    const Level level = frames.any_level(random);
    const auto number = static_cast<std::uint32_t>(random.integer(0, UINT32_MAX));
    return earlier_frame(random, frames.config_, number, level);
  };
}

}  // namespace kage::verif
