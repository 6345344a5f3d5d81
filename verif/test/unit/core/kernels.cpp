// SPDX-License-Identifier: Apache-2.0
// The vector kernels, on every instruction set of this machine, against docs/stream.md written out pixel by pixel; and
// the core against it.
#include <algorithm>
#include <array>
#include <optional>

#include "kage/core.hpp"
#include "oracle/simple_core.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"
#include "test/support/guarded_new.hpp"
#include "test/support/simd.hpp"

namespace kage::verif {
namespace {

/// The errors and tokens of all frames.
struct Taken {
  std::array<int, kErrorNames.size()> errors{};
  std::array<std::uint64_t, kKinds> tokens{};
};

/// A random frame of up to `width` pixels a line, sound or damaged, through the golden core and SimpleCore. With
/// `guarded`, all that the golden core keeps lies in guarded memory.
void check_frame(Random& random, int width, int round, const Edge* guarded, Taken& taken) {
  const Config c = random_config(random, std::max(width, 1));
  std::vector<std::uint32_t> words;
  const bool polygons = c.active > 0 && random.chance(0.5);
  const int of_width = guarded != nullptr ? width : random.in(1, 150);
  const int height = random.in(1, 5);
  const auto number = static_cast<std::uint32_t>(round);
  const auto count = polygons ? random_polygon_frame(random, c, of_width, height, words, number)
                              : random_frame(random, c, of_width, height, words, number);
  for (std::size_t k = 0; k < taken.tokens.size(); ++k) taken.tokens[k] += count[k];
  if (round % 4 == 1) damage_tree(random, c, words);
  if (round % 8 == 2) damage_light(random, c, words);
  if (polygons && round % 8 == 5) damage_polygons(random, c, words);
  if (round % 4 == 3 || (round % 4 == 1 && c.units == 0)) damage(random, words);
  CAPTURE(round, to_yaml(c));
  std::vector<std::uint8_t> fast;
  int lines = 0;
  const FrameStatus a = [&] {
    std::optional<GuardedNew> guard;
    if (guarded != nullptr) guard.emplace(*guarded);
    GoldenCore core(c);
    return core.frame(words, [&](int y, std::span<const std::uint8_t> p) {
      REQUIRE(y == lines++);
      fast.insert(fast.end(), p.begin(), p.end());
    });
  }();
  std::vector<std::uint8_t> slow;
  bool loose = false;
  const FrameStatus b = simple_core(c, words, slow, &loose);
  if (loose) return;  // docs/stream.md leaves open what a damaged edge shows
  REQUIRE(a.error == b.error);
  REQUIRE(a == b);
  REQUIRE(lines == a.height);
  REQUIRE(fast == slow);
  ++taken.errors[static_cast<std::size_t>(a.error)];
}

void check_every_kind_of_token(const Taken& taken) {
  for (std::size_t k = 1; k < kKindNames.size(); ++k) {
    if (kKindNames[k] == "-") continue;
    CAPTURE(kKindNames[k]);
    CHECK(taken.tokens[k] > 0);
  }
}

}  // namespace

TEST_CASE(
    "the golden core is docs/stream.md to the letter, on every instruction set, for valid frames and damaged ones") {
  Random random(test_seed());
  CAPTURE(test_seed());
  Taken taken;
  on_every_target([&](const simd::Target& target) {
    CAPTURE(target.name);
    for (int round = 0; round < 800; ++round) check_frame(random, 200, round, nullptr, taken);
  });
  // Every kind of token there is took part, and the damage reached every error.
  check_every_kind_of_token(taken);
  for (std::size_t e = 0; e < kErrorNames.size(); ++e) {
    CAPTURE(kErrorNames[e]);
    CHECK(taken.errors[e] > 0);
  }
}

TEST_CASE("lines of 1 to 48 pixels, on every instruction set, in guarded memory") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  Taken taken;
  const std::uint64_t before = GuardedNew::given();
  on_every_target([&](const simd::Target& target) {
    CAPTURE(target.name);
    for (int width = 1; width <= kMostSize; ++width)
      for (int round = 0; round < 8; ++round) check_frame(random, width, round, &kEdges[round / 4], taken);
  });
  check_every_kind_of_token(taken);
  CHECK(GuardedNew::gave_more_than(before + std::uint64_t{48} * 8 * 5));
}

}  // namespace kage::verif
