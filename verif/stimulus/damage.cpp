// SPDX-License-Identifier: Apache-2.0
#include "stimulus/damage.hpp"

#include <algorithm>

#include "contract/derived.hpp"

namespace kage::verif {

void damage(Random& random, std::vector<std::uint32_t>& words) {
  const auto noise = [&random] { return static_cast<std::uint32_t>(random.integer(0, UINT32_MAX)); };
  for (int i = random.in(1, 3); i > 0 && !words.empty(); --i) {
    const auto at = static_cast<std::ptrdiff_t>(random.integer(0, static_cast<std::int64_t>(words.size()) - 1));
    std::uint32_t& word = words[static_cast<std::size_t>(at)];
    switch (random.in(0, 9)) {
      case 0:
        words.resize(static_cast<std::size_t>(at));
        break;
      case 1:
        for (int n = random.chance(0.2) ? random.in(10, 40) : random.in(1, 9); n > 0; --n) words.push_back(noise());
        break;
      case 2:
        words.erase(words.begin() + at);
        break;
      case 3:
        words.insert(words.begin() + at, word);
        break;
      case 4:
        word ^= 1U << random.in(0, 3);
        break;
      case 5:
        words[std::min<std::size_t>(words.size() - 1, static_cast<std::size_t>(random.in(0, 2)))] ^=
            1U << random.in(0, 31);
        break;
      case 6:
        word = noise();
        break;
      case 7:
        if (words.size() > 1) {
          FrameHeader h = FrameHeader::read(words);
          h.height = random.in(0, 6);
          h.width = random.in(0, h.width + 1) & 0xFFFF;
          h.write(words);
        }
        break;
      default:
        word ^= 1U << random.in(0, 31);
    }
  }
}

void damage_light(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  for (int round = random.chance(0.7) ? 1 : random.in(2, 3); round > 0; --round) {
    TokenPlaces places(c, words);
    if (c.count_bits == 0 || !places.whole()) return;
    const Layout& layout = places.layout();
    const auto any = [&random](const std::vector<TokenPlaces::At>& of) {
      return of[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(of.size()) - 1))];
    };
    const auto bits = [&random](Field f) { return static_cast<std::uint64_t>(random.in(0, (1 << f.bits) - 1)); };
    // Any, or the first that the table has not whole.
    const auto other_class = [&](Field f) {
      const std::uint64_t lacking = places.of(Kind::TABLE).size() / static_cast<std::size_t>(c.lights) + 1;
      return random.chance(0.5) && lacking >> f.bits == 0 ? lacking : bits(f);
    };
    const std::array<Kind, 5> kinds{Kind::ES, Kind::ES, Kind::TABLE, Kind::OP, Kind::FACE};
    const Kind kind = kinds[static_cast<std::size_t>(random.in(0, 4))];
    if (places.of(kind).empty()) continue;
    const TokenPlaces::At at = any(places.of(kind));
    switch (random.in(0, 3)) {
      case 0:  // lost
        places.erase(at, places.length(kind));
        break;
      case 1:  // doubled, here or anywhere
        places.copy(at, places.length(kind), random.chance(0.5) ? at : any(places.all()));
        break;
      case 2:  // another class
        if (kind == Kind::TABLE) places.put(at, layout.table_class, bits(layout.table_class));
        if (kind == Kind::OP) places.put(at, layout.op_class, other_class(layout.op_class));
        if (kind == Kind::FACE) places.put(at, layout.face_class, other_class(layout.face_class));
        if (kind == Kind::ES) places.put(at, layout.es_xl, bits(layout.es_xl));
        break;
      default:  // another light, or share
        if (kind == Kind::ES) places.put(at, layout.es_light, bits(layout.es_light));
        if (kind == Kind::TABLE && random.chance(0.5)) places.put(at, layout.table_light, bits(layout.table_light));
        if (kind == Kind::TABLE) places.put(at, layout.table_share[0], bits(layout.table_share[0]));
    }
  }
}

namespace {

using At = TokenPlaces::At;

At any(Random& random, const std::vector<At>& of) {
  return of[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(of.size()) - 1))];
}

constexpr int kSegmentDamages = 9;

/// The SEG at `seg` becomes wrong in way `which` of kSegmentDamages.
void damage_segment(Random& random, const Config& c, TokenPlaces& places, At seg, int which,
                    std::vector<std::uint32_t>& words) {
  const Layout& layout = places.layout();
  const At length = places.length(Kind::SEG);
  switch (which) {
    case 0:
      places.put(seg, layout.seg_dx, 0);
      break;
    case 1:
      places.put(seg, layout.seg_sync, places.get(seg, layout.seg_sync) ^ 1U);
      break;
    case 2:
      places.put(seg, layout.seg_face, static_cast<std::uint64_t>(random.in(0, derived::blank_face(c))));
      break;
    case 3:  // too few pixels
      words.erase(words.begin() + seg, words.begin() + seg + length);
      break;
    case 4:  // too many
      places.copy(seg, length, seg);
      break;
    case 5:
      places.put(seg, layout.seg_dx, places.get(seg, layout.seg_dx) + static_cast<std::uint64_t>(random.in(-2, 2)));
      break;
    case 6: {  // too many segments: as many as it has pixels
      const std::uint64_t dx = places.get(seg, layout.seg_dx);
      places.put(seg, layout.seg_dx, 1);
      for (std::uint64_t i = 1; i < dx; ++i) places.copy(seg, length, seg + length);
      for (std::uint64_t i = 1; i < dx; ++i) places.put(seg + static_cast<At>(i) * length, layout.seg_sync, 0);
      break;
    }
    case 7:
      places.put(seg, layout.seg_unit, static_cast<std::uint64_t>(random.in(0, (1 << layout.seg_unit.bits) - 1)));
      break;
    default:  // out of phase, or past the last line
      places.copy(seg, length, any(random, places.all()));
  }
}

}  // namespace

void damage_tree(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  for (int round = random.chance(0.7) ? 1 : random.in(2, 3); round > 0; --round) {
    TokenPlaces places(c, words);
    if (!places.whole()) return;
    const auto& segs = places.of(Kind::SEG);
    const auto& trees = places.of(Kind::TREE);
    const auto& faces = places.of(Kind::FACE);
    if (segs.empty() || trees.empty()) return;
    const At seg = any(random, segs);
    const int which = random.in(0, kSegmentDamages + 4);
    if (which < kSegmentDamages) {
      damage_segment(random, c, places, seg, which, words);
      continue;
    }
    switch (which - kSegmentDamages) {
      case 0: {                                   // whole lines of a unit too early, or too many of them
        if (trees.front() < segs.front()) break;  // by an earlier round's damage
        const std::vector<std::uint32_t> line(words.begin() + segs.front(), words.begin() + trees.front());
        words.insert(words.begin() + any(random, random.chance(0.5) ? trees : segs), line.begin(), line.end());
        break;
      }
      case 1:
        words.erase(words.begin() + any(random, trees));
        break;
      case 2: {
        const At to = any(random, random.chance(0.5) ? trees : places.all());
        places.copy(any(random, trees), 1, to);
        break;
      }
      case 3: {
        if (faces.empty()) break;
        const At to = any(random, random.chance(0.7) ? faces : places.all());
        places.copy(any(random, faces), places.length(Kind::FACE), to);
        break;
      }
      default: {
        if (faces.empty()) break;
        const At face = any(random, faces);
        words.erase(words.begin() + face, words.begin() + face + places.length(Kind::FACE));
      }
    }
  }
}

namespace {

/// An edge that does not go down through its line.
void damage_edge(Random& random, TokenPlaces& places, At edge) {
  const Layout& layout = places.layout();
  const std::uint64_t top = places.get(edge, layout.edge_top_y);
  const std::uint64_t bottom = places.get(edge, layout.edge_bottom_y);
  switch (random.in(0, 3)) {
    case 0:  // it goes up
      places.put(edge, layout.edge_top_y, bottom);
      places.put(edge, layout.edge_bottom_y, top);
      break;
    case 1:  // it has no height
      places.put(edge, layout.edge_bottom_y, top);
      break;
    case 2:  // it begins later
      places.put(edge, layout.edge_top_y, top + static_cast<std::uint64_t>(random.in(1, 600)));
      break;
    default:  // it ends earlier
      places.put(edge, layout.edge_bottom_y, bottom - static_cast<std::uint64_t>(random.in(1, 600)));
  }
}

/// More polygons at one place than the core keeps: what follows a POLYGON up to its second edge, again and again, and
/// none of them ends.
void crowd(const Config& c, TokenPlaces& places, At polygon, std::vector<std::uint32_t>& words) {
  const Layout& layout = places.layout();
  const auto& all = places.all();
  std::size_t end = static_cast<std::size_t>(std::find(all.begin(), all.end(), polygon) - all.begin()) + 1;
  while (end < all.size() && words[static_cast<std::size_t>(all[end])] % 16 != code_of(Kind::AT)) ++end;
  if (end == all.size()) return;
  for (const At edge : places.of(Kind::EDGE))
    if (edge > polygon && edge < all[end]) places.put(edge, layout.edge_last, 0);
  const std::vector<std::uint32_t> whole(words.begin() + polygon, words.begin() + all[end]);
  for (int i = 0; i < std::min(c.active, 40); ++i) words.insert(words.begin() + all[end], whole.begin(), whole.end());
}

}  // namespace

void damage_polygons(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  constexpr std::array<Kind, 4> kKinds{Kind::AT, Kind::POLYGON, Kind::EDGE, Kind::GRADIENT};
  for (int round = random.chance(0.7) ? 1 : random.in(2, 3); round > 0; --round) {
    TokenPlaces places(c, words);
    if (!places.whole() || places.level() != Level::polygons) return;
    const Kind kind = kKinds[static_cast<std::size_t>(random.in(0, 3))];
    const auto& of = places.of(kind);
    if (of.empty()) continue;
    const Layout& layout = places.layout();
    const At at = any(random, of);
    const At length = places.length(kind);
    switch (random.in(0, 6)) {
      case 0:  // lost
        places.erase(at, length);
        break;
      case 1:  // doubled, here or anywhere
        places.copy(at, length, random.chance(0.3) ? at : any(random, places.all()));
        break;
      case 2: {  // a bit of it flipped
        const auto bit = static_cast<std::uint32_t>(random.integer(0, 32 * length - 1));
        words[static_cast<std::size_t>(at) + bit / 32] ^= 1U << bit % 32;
        break;
      }
      default:
        if (kind == Kind::EDGE) damage_edge(random, places, at);
        if (kind == Kind::POLYGON) crowd(c, places, at, words);
        if (kind == Kind::GRADIENT) places.put(at, layout.gradient_channel, static_cast<std::uint64_t>(c.channels));
        if (kind != Kind::AT) break;
        switch (random.in(0, 3)) {
          case 0:
            places.put(at, layout.at_layer, static_cast<std::uint64_t>(random.in(0, 3)));
            break;
          case 1:
            // With linear light 1 makes spans of a volume stand where a light's own are.
            places.put(at, layout.at_light,
                       static_cast<std::uint64_t>(random.in(0, c.linear_bits > 0 && random.chance(0.7) ? 1 : 7)));
            break;
          case 2:
            places.put(at, layout.at_volume, places.get(at, layout.at_volume) - 1);
            break;
          default:
            places.put(at, layout.at_rank, places.get(at, layout.at_rank) - 1);
        }
    }
  }
}

}  // namespace kage::verif
