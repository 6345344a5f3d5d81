// SPDX-License-Identifier: Apache-2.0
// Random frames: what they are said to be, what they reach, and how they are made smaller.
#include <algorithm>
#include <set>

#include "catch.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "stimulus/coverage.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/random_frames.hpp"
#include "stimulus/shrink.hpp"
#include "stimulus/small_configs.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

using Words = std::vector<std::uint32_t>;

const LineSink kNobody = [](int, std::span<const std::uint8_t>) {};

/// Small ones that between them have everything.
std::vector<SmallConfig> configurations() {
  return {
      small_config("parity", [](Config&) {}),
      small_config("no shadows, grey", [](Config& c) { c.dsf_bits = c.fsf = 0, c.channels = 1; }),
      small_config("counting, smooth, glass",
                   [](Config& c) { c.dsf_bits = 3, c.smooth = 1, c.color_frac = 6, c.translucency = 1; }),
      small_config("lights", [](Config& c) { c.count_bits = 2, c.lights = 3, c.class_bits = 3, c.shade_frac = 4; }),
      small_config("units", [](Config& c) { c.units = 3, c.dx_bits = 6, c.face_bits = 4, c.seg_bits = 3; }),
      small_config("systolic", [](Config& c) { c.arrangement = 0, c.translucency = 1; }),
  };
}

}  // namespace

TEST_CASE("a random frame follows from configuration, manner, seed and number alone, and a sound one is taken") {
  for (const auto& [name, c] : configurations()) {
    CAPTURE(name);
    GoldenCore golden(c);
    std::set<Words> seen;
    int errors = 0;
    for (int i = 0; i < 100; ++i) {
      const Words sound = RandomFrames(c, Manner::sound, test_seed()).words(i);
      CHECK(sound == RandomFrames(c, Manner::sound, test_seed()).words(i));
      CHECK(golden.frame(sound, kNobody).error == ErrorCode::NONE);
      const Words wrong = RandomFrames(c, Manner::damaged, test_seed()).words(i);
      REQUIRE_FALSE(wrong.empty());
      errors += golden.frame(wrong, kNobody).error == ErrorCode::NONE ? 0 : 1;
      seen.insert(sound);
      seen.insert(wrong);
    }
    CHECK(seen.size() > 195);
    CHECK(errors > 70);  // damage may be survived
  }
}

TEST_CASE("a frame that is cut within a token is not whole, so nothing is changed past its end") {
  for (const auto& [name, c] : configurations()) {
    CAPTURE(name);
    Random random(test_seed());
    const Layout layout(c);
    Words whole = sound_frame(random, c, 0);
    const TokenPlaces places(c, whole);
    REQUIRE(places.whole());
    std::set<std::size_t> ends{kHeaderWords};
    for (const TokenPlaces::At at : places.all())
      ends.insert(static_cast<std::size_t>(at) + layout.words[whole[static_cast<std::size_t>(at)] & 15U]);
    for (std::size_t length = kHeaderWords; length <= whole.size(); ++length) {
      Words cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      CHECK(TokenPlaces(c, cut).whole() == ends.contains(length));
    }
  }
}

TEST_CASE("random frames reach all that a configuration has") {
  for (const auto& [name, c] : configurations()) {
    Coverage coverage(c);
    const RandomFrames frames(c, Manner::mixed, test_seed());
    for (int i = 0; i < 4000; ++i) {
      coverage.words(frames.words(i));
      coverage.end_frame();
    }
    CHECK(coverage.frames() == 4000);
    for (const CoveragePoint& p : coverage.points()) {
      CAPTURE(name, p.group, p.name);
      CHECK(p.frames > 0);
      CHECK(p.frames <= 4000);
    }
  }
}

TEST_CASE("a frame is made as small as what is wanted of it lets it be") {
  for (const auto& [name, c] : configurations()) {
    GoldenCore golden(c);
    Random random(test_seed());
    const Layout layout(c);
    // It has an OP, and no fault.
    const auto keeps = [&](const Words& words) {
      return count_tokens(c, words).of_kind[static_cast<std::size_t>(Kind::OP)] > 0 &&
             golden.frame(words, kNobody).error == ErrorCode::NONE;
    };
    for (int i = 0; i < 20; ++i) {
      const Words words = sound_frame(random, c, static_cast<std::uint32_t>(i));
      if (!keeps(words)) continue;
      CAPTURE(name, i);
      const Words small = shrink(c, words, keeps, [] { return true; });
      CHECK(keeps(small));
      const TokenCounts counts = count_tokens(c, small);
      CHECK(counts.of_kind[static_cast<std::size_t>(Kind::EOL)] == 1);
      CHECK(counts.of_kind[static_cast<std::size_t>(Kind::OP)] == 1);
      // A tree's segments hold its width and its lines together, and a class its table; else header, OP, EOL and END
      // are left.
      if (counts.of_kind[static_cast<std::size_t>(Kind::TREE)] + counts.of_kind[static_cast<std::size_t>(Kind::TABLE)] >
          0)
        continue;
      CHECK((small[1] & 0xFFFFU) == 1);
      CHECK(small.size() ==
            kHeaderWords + static_cast<std::size_t>(layout.words[static_cast<std::size_t>(Kind::OP)]) + 2);
    }
  }
  // Told that it is enough, it stops.
  const Config c;
  Random random(1);
  const Words words = sound_frame(random, c, 1);
  CHECK(shrink(
            c, words, [](const Words&) { return true; }, [] { return false; }) == words);
}
