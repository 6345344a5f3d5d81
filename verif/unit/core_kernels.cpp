// SPDX-License-Identifier: Apache-2.0
// The vector kernels, on every instruction set of this machine, against docs/stream.md written out pixel by pixel; and
// the core against it.
#include <hwy/targets.h>

#include <array>

#include "catch.hpp"
#include "kage/core.hpp"
#include "support/configs.hpp"
#include "support/damage.hpp"
#include "support/random.hpp"
#include "support/simple_core.hpp"
#include "support/streams.hpp"

namespace kage::verif {

TEST_CASE(
    "the golden core is docs/stream.md to the letter, on every instruction set, for valid frames and damaged ones") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::size_t targets = 0;
  std::array<int, 16> errors{};
  std::array<std::uint64_t, 16> tokens{};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    ++targets;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (int round = 0; round < 800; ++round) {
      const Config c = random_config(random, 200);
      std::vector<std::uint32_t> words;
      const auto count =
          random_frame(random, c, random.in(1, 150), random.in(1, 5), words, static_cast<std::uint32_t>(round));
      for (std::size_t k = 0; k < tokens.size(); ++k) tokens[k] += count[k];
      if (round % 4 == 1) damage_tree(random, c, words);
      if (round % 8 == 2) damage_light(random, c, words);
      if (round % 4 == 3 || (round % 4 == 1 && c.units == 0)) damage(random, words);
      CAPTURE(target, round, to_yaml(c));
      std::vector<std::uint8_t> fast;
      GoldenCore core(c);
      int lines = 0;
      const FrameStatus a = core.frame(words, [&](int y, std::span<const std::uint8_t> p) {
        REQUIRE(y == lines++);
        fast.insert(fast.end(), p.begin(), p.end());
      });
      std::vector<std::uint8_t> slow;
      const FrameStatus b = simple_core(c, words, slow);
      REQUIRE(a.error == b.error);
      REQUIRE(a == b);
      REQUIRE(lines == a.height);
      REQUIRE(fast == slow);
      ++errors[static_cast<std::size_t>(a.error)];
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  CHECK(targets >= 1);
  // Every kind of token there is took part, and the damage reached every error.
  for (std::size_t k = 1; k < kKindNames.size(); ++k) {
    CAPTURE(kKindNames[k]);
    CHECK(tokens[k] > 0);
  }
  for (std::size_t e = 0; e < kErrorNames.size(); ++e) {
    CAPTURE(kErrorNames[e]);
    CHECK(errors[e] > 0);
  }
}

}  // namespace kage::verif
