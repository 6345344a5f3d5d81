// SPDX-License-Identifier: Apache-2.0
// A regression as a library: what its rounds hold, and what ends it. Golden cores stand for the RTL.
#include "cosim/regress/regress.hpp"

#include <algorithm>
#include <set>

#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/fake_cores.hpp"

using namespace kage;
using namespace kage::cosim;
using test::FakeCores;

namespace {

RegressOptions one_round() {
  RegressOptions o;
  o.configs = {"tiny", "glass"};
  o.rounds = 1;
  o.jobs = 2;
  o.no_divergence = true;
  return o;
}

report::RunRecord go(const RegressOptions& o, Cores& cores) {
  Host host;
  Regress regress(o, host, cores);
  regress.prepare();
  regress.run();
  return regress.record();
}

}  // namespace

TEST_CASE("a round has each configuration with each sort of frames") {
  const auto runs = runs_of_round({load_config("tiny"), load_config("glass")}, 0, {});
  std::vector<std::string> names;
  for (const RoundRun& r : runs) names.push_back(r.name);
  REQUIRE(names == std::vector<std::string>{"random.tiny.0", "random.glass.0", "mixed.tiny.0", "mixed.glass.0",
                                            "damaged.tiny.0", "damaged.glass.0", "courtyard.tiny.0", "knot.glass.0"});
  for (const RoundRun& r : runs) {
    CHECK(r.options.jobs == 1);
    CHECK(r.options.out.empty());
    CHECK(r.options.lines.again.find(r.options.config) != std::string::npos);
  }
}

TEST_CASE("each scene meets each configuration in as many rounds as there are scenes") {
  const std::vector<NamedConfig> configs{load_config("tiny"), load_config("glass"), load_config("full")};
  std::set<std::pair<std::string, std::string>> met;
  std::set<std::pair<int, int>> stalls;
  for (int round = 0; round < static_cast<int>(builtin_scenes().size()); ++round)
    for (const RoundRun& r : runs_of_round(configs, round, {})) {
      const auto& all = builtin_scenes();
      if (std::find(all.begin(), all.end(), r.options.input) != all.end()) met.emplace(r.options.input, r.config);
      stalls.emplace(r.options.rtl.idle, r.options.rtl.backpressure);
    }
  REQUIRE(met.size() == configs.size() * builtin_scenes().size());
  REQUIRE(stalls.size() == 4);
}

TEST_CASE("a front end gets polygons, unless the level is named") {
  RegressRun how;
  const auto level = [&] { return runs_of_round({load_config("polygons")}, 0, how).front().options.level; };
  CHECK(level() == Level::polygons);
  how.level = Level::spans;
  CHECK(level() == Level::spans);
  CHECK(runs_of_round({load_config("tiny")}, 0, {}).front().options.level == Level::spans);
}

TEST_CASE("right cores: all runs are told, in their order") {
  for (const int jobs : {1, 2, 5}) {
    FakeCores cores;
    RegressOptions o = one_round();
    o.jobs = jobs;
    const report::RunRecord r = go(o, cores);
    std::vector<std::string> names;
    for (const report::SceneRecord& s : r.scenes) names.push_back(s.scene);
    REQUIRE(names == std::vector<std::string>{"random.tiny.0", "random.glass.0", "mixed.tiny.0", "mixed.glass.0",
                                              "damaged.tiny.0", "damaged.glass.0", "courtyard.tiny.0", "knot.glass.0"});
    REQUIRE(r.totals().same);
    REQUIRE(cores.registers_read == 2);  // behind the mixed frames
  }
}

TEST_CASE("the first difference ends it, and is that of one job") {
  for (const int jobs : {1, 2, 3}) {
    FakeCores cores;
    cores.wrong = 5;
    RegressOptions o = one_round();
    o.jobs = jobs;
    const report::RunRecord r = go(o, cores);
    REQUIRE(r.scenes.size() == 1);
    REQUIRE(!r.scenes[0].same);
    REQUIRE(r.scenes[0].scene == "random.tiny.0");
    REQUIRE(r.scenes[0].first_difference->frame == 5);
    REQUIRE(r.regress->rounds == 1);
  }
}

TEST_CASE("trouble ends it, with the run's name; of the very first run nothing is left to tell") {
  FakeCores cores;
  cores.before_core = [&] {
    if (cores.cores >= 2) throw Error("no more cores");
  };
  RegressOptions o = one_round();
  o.jobs = 1;
  const report::RunRecord r = go(o, cores);
  REQUIRE(r.scenes.size() == 1);  // its two cores: another initial state runs the first frame too
  REQUIRE(r.regress->trouble == "random.glass.0 (configuration glass): no more cores");
  cores.before_core = [] { throw Error("no cores"); };
  REQUIRE_THROWS_WITH(go(o, cores), "random.tiny.0 (configuration tiny): no cores");
}

TEST_CASE("two configurations of one name are refused") {
  NamedConfig other = load_config("tiny");
  other.name = "elsewhere/tiny.yaml";
  REQUIRE_THROWS_AS(runs_of_round({load_config("tiny"), other}, 0, {}), Error);
}
