// SPDX-License-Identifier: Apache-2.0
// Sound RTL differs in no stage, in every named configuration and in twenty by chance, as kage cosim --stages holds it.
// A monitor that fails sound RTL would blame a module for the fault of another, or for none.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cosim/diverge/divergence.hpp"
#include "cosim/model/model.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"
#include "stimulus/random_frames.hpp"
#include "stimulus/shard.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

using namespace kage;
using namespace kage::cosim;
using namespace kage::verif;

namespace {

constexpr int kRandomConfigs = 20;
constexpr int kFrames = 8;  // of each manner and level

/// Small ones, whose models are quick to build: few systolic processors, short tables.
NamedConfig small_random(Random& random, int number) {
  Config c = random_config(random, random.in(1, 40));
  if (c.arrangement == 0) c.max_width = std::min(c.max_width, 16);
  // Units of every number of levels of the tree: 1, 2, 4, ..., 64 and those between.
  if (c.units > 0) c.units = random.in(1, 1 << (number % 7));
  c.face_bits = std::min(c.face_bits, 5);
  c.seg_bits = std::min(c.seg_bits, 5);
  c.class_bits = std::min(c.class_bits, 5);
  if (c.classic != 0) c.face_bits = 7;
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(c)) rule.repair(c);
  std::string text;
  for (const ParamInfo& p : kParams) text += fmt::format("{}: {}, ", p.name, c.*(p.member));
  validate(c, text);
  return {text, c};
}

void check_stages(const NamedConfig& named, std::uint64_t seed) {
  CAPTURE(named.name);
  const Config& c = named.config;
  ReplayOptions options;
  options.library = find_model(c, {.monitors = true}).library;
  CHECK(make_rtl(options.library, c)->missing_monitors().empty());
  for (const Manner manner : {Manner::sound, Manner::damaged}) {
    const RandomFrames frames(c, manner, seed, c.active > 0 ? kage::Level::polygons : kage::Level::spans);
    const auto feed = [&](int frame, const WordSink& sink) {
      sink(frames.words(frame));
      return TokenCounts{};
    };
    for (int i = 0; i < kFrames; ++i) {
      CAPTURE(i, static_cast<int>(manner));
      options.steps = {i, 1};  // a core that has seen no other frame
      options.rtl.idle_percent = i % 3 == 1 ? 30 : 0;
      options.rtl.backpressure_percent = i % 3 == 2 ? 50 : 0;
      const auto d = find_divergence(i, feed, c, options);
      if (d) UNSCOPED_INFO(describe(*d));
      CHECK_FALSE(d);
    }
  }
}

}  // namespace

TEST_CASE("named configurations differ in no stage") {
  CAPTURE(test_seed());
  const std::vector<NamedConfig> named = named_configs();
  const Shard shard = test_shard();
  for (std::size_t i = 0; i < named.size(); ++i)
    if (shard.has(i, named.size())) check_stages(named[i], test_seed());
}

TEST_CASE("random configurations differ in no stage") {
  Random random(test_seed());
  CAPTURE(test_seed());
  const Shard shard = test_shard();
  for (int i = 0; i < kRandomConfigs; ++i) {
    const NamedConfig named = small_random(random, i);
    if (shard.has(static_cast<std::size_t>(i), kRandomConfigs)) check_stages(named, test_seed());
  }
}
