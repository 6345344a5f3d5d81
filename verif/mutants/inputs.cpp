// SPDX-License-Identifier: Apache-2.0
#include "mutants/inputs.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "cosim/core.hpp"
#include "support/damage.hpp"
#include "support/streams.hpp"

namespace kage::verif {
namespace {

// Frames of a sequence: the first are valid, the others damaged.
constexpr int kValid = 12;
constexpr int kDamaged = 36;

TrialFrame finished(const Config& config, std::vector<std::uint32_t> words) {
  TrialFrame f;
  f.words = std::move(words);
  const auto golden = cosim::make_golden(config);
  const LineSink sink = [&f](int, std::span<const std::uint8_t> line) {
    f.lines.emplace_back(line.begin(), line.end());
  };
  golden->feed(f.words, sink);
  f.end = golden->finish(sink);
  return f;
}

// A whole token lost, doubled, or put where it does not belong.
void misplace(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  const TokenPlaces places(c, words);
  if (!places.whole() || places.all().empty()) return;
  TokenPlaces change(c, words);
  const auto any = [&] {
    return places.all()[static_cast<std::size_t>(random.in(0, static_cast<int>(places.all().size()) - 1))];
  };
  const TokenPlaces::At at = any();
  const TokenPlaces::At length = change.length(static_cast<Kind>(words[static_cast<std::size_t>(at)] & 15U));
  if (random.chance(0.3))
    change.erase(at, length);
  else
    change.copy(at, length, any());
}

// One field just past what it may be.
void near_miss(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  TokenPlaces places(c, words);
  if (!places.whole()) return;
  const Layout& layout = places.layout();
  const auto any = [&](Kind kind) -> std::optional<TokenPlaces::At> {
    const auto& of = places.of(kind);
    if (of.empty()) return std::nullopt;
    return of[static_cast<std::size_t>(random.in(0, static_cast<int>(of.size()) - 1))];
  };
  if (c.class_bits > 1 && random.chance(0.6)) {
    const auto at = any(Kind::OP);
    std::uint64_t most = 0;
    for (const auto table : places.of(Kind::TABLE)) most = std::max(most, places.get(table, layout.table_class));
    if (at) places.put(*at, layout.op_class, most + 1);
  } else if (c.lights > 1) {
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
    places.put(*at, layout.op_xr, (words[1] & 0xFFFFU) + 1);
  }
}

// Lines with nothing on them, one behind the other.
std::vector<std::uint32_t> bare_frame(Random& random, const Config& c, int number) {
  FrameStyle style;
  style.most_opaque = style.most_volumes = style.most_translucent = style.most_samples = 0;
  style.trees = 0;
  std::vector<std::uint32_t> words;
  random_frame(random, c, random.in(1, c.max_width), random.in(10, 20), words, static_cast<std::uint32_t>(number),
               style);
  return words;
}

std::vector<std::uint32_t> frame(Random& random, const Config& c, int number) {
  FrameStyle style;
  style.port = random.chance(0.5);
  style.most_samples = 6;
  if (random.chance(0.15)) return bare_frame(random, c, number);
  std::vector<std::uint32_t> words;
  const int width = random.chance(0.2) ? c.max_width : random.chance(0.2) ? random.in(1, 3) : random.in(1, c.max_width);
  const int height = random.chance(0.2) ? random.in(8, 20) : random.in(1, 6);
  random_frame(random, c, width, height, words, static_cast<std::uint32_t>(number), style);
  return words;
}

// Cut within the header, a few words too long, or with another header.
void header_or_end(Random& random, const Config& c, std::vector<std::uint32_t>& words) {
  const double manner = random.real(0, 1);
  if (manner < 0.25)
    words.resize(static_cast<std::size_t>(random.in(1, static_cast<int>(kHeaderWords) - 1)));
  else if (manner < 0.5)
    words.resize(words.size() + static_cast<std::size_t>(random.in(1, 2 * c.beat_words)));
  else
    words[static_cast<std::size_t>(random.in(0, 2))] ^= 1U << (random.chance(0.3) ? 31 : random.in(0, 31));
}

std::vector<std::uint32_t> damaged(Random& random, const Config& c, int number) {
  std::vector<std::uint32_t> words = frame(random, c, number);
  switch (number % 6) {
    case 0:
      damage(random, words);
      break;
    case 1:
      near_miss(random, c, words);
      break;
    case 2:
      header_or_end(random, c, words);
      break;
    case 3:
      if (c.count_bits > 0)
        damage_light(random, c, words);
      else
        misplace(random, c, words);
      break;
    case 4:
      if (c.units > 0)
        damage_tree(random, c, words);
      else
        misplace(random, c, words);
      break;
    default:
      misplace(random, c, words);
  }
  if (words.empty()) words.push_back(0);  // a port brings a beat at least
  // A height that flipped bits made great takes long and shows no more; one past 15 bits is refused.
  if (words.size() > 1 && (words[1] >> 31) == 0) words[1] &= 0x001FFFFFU;
  return words;
}

}  // namespace

std::vector<Inputs> trial_configurations() {
  std::vector<Inputs> all;
  const auto add = [&](const char* name, auto change) {
    Config c;
    c.max_width = 40;
    c.x_bits = 6;
    c.lanes = 4;
    change(c);
    validate(c, name);
    all.push_back({name, c, {}});
  };
  add("parity", [](Config& c) { c.shade_frac = 3; });
  add("grey",
      [](Config& c) { c.fsf = 0, c.dsf_bits = 2, c.channels = 1, c.lanes = 8, c.beat_words = 1, c.shade_frac = 2; });
  add("glass", [](Config& c) { c.dsf_bits = 3, c.smooth = 1, c.color_frac = 6, c.translucency = 1, c.beat_words = 2; });
  add("lights", [](Config& c) {
    c.smooth = 1, c.count_bits = 2, c.lights = 3, c.class_bits = 3, c.translucency = 1, c.shade_frac = 4;
  });
  add("units", [](Config& c) { c.units = 3, c.dx_bits = 6, c.face_bits = 4, c.seg_bits = 4, c.translucency = 1; });
  add("counting", [](Config& c) { c.dsf_bits = 3, c.arrangement = 0; });
  add("smooth_systolic", [](Config& c) { c.smooth = 1, c.color_frac = 6, c.arrangement = 0; });
  add("lights_systolic", [](Config& c) {
    c.fsf = 0, c.dsf_bits = 2, c.count_bits = 2, c.lights = 2, c.class_bits = 2, c.translucency = 1, c.arrangement = 0;
  });
  add("units_systolic", [](Config& c) { c.units = 2, c.dx_bits = 6, c.face_bits = 4, c.arrangement = 0; });
  return all;
}

void make_frames(Inputs& inputs, std::uint64_t seed) {
  Random random(seed);
  constexpr std::array<std::pair<int, int>, 3> kStalls{{{0, 0}, {30, 30}, {0, 70}}};
  for (const auto& [idle, backpressure] : kStalls) {
    Sequence s;
    s.rtl.seed = seed;
    s.rtl.idle_percent = idle;
    s.rtl.backpressure_percent = backpressure;
    for (int i = 0; i < kValid + kDamaged; ++i)
      s.frames.push_back(
          finished(inputs.config, i < kValid ? frame(random, inputs.config, i) : damaged(random, inputs.config, i)));
    inputs.sequences.push_back(std::move(s));
  }
}

}  // namespace kage::verif
