// SPDX-License-Identifier: Apache-2.0
// Families as such: all are there, their cases are what their texts say, and RapidCheck shrinks them within their
// ranges.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "extremes/campaign.hpp"
#include "extremes/depth.hpp"
#include "extremes/fill_rule.hpp"
#include "extremes/found.hpp"
#include "extremes/polyhedra.hpp"
#include "extremes/shadows.hpp"
#include "kage/error.hpp"
#include "test/extremes/hold.hpp"
#include "test/support/temp_directory.hpp"

namespace kage::verif {
namespace {

/// Each way to make a case simpler is a case in its ranges, and after steps enough there is none left.
template <class Case>
bool shrinks_within_ranges(const Case& c) {
  rc::Shrinkable<Case> at = shrinkable_case(c);
  for (int steps = 0; steps < 3000; ++steps) {
    const auto next = at.shrinks().next();
    if (!next) return true;
    const std::string text = text_of(next->value());
    if (text_of(case_of<Case>(text, "shrunk")) != text) return false;  // throws where a value is out of its range
    at = *next;
  }
  return false;
}

}  // namespace

TEST_CASE("every family has cases, and no two the same name") {
  std::set<int> numbers;
  std::set<std::string> names;
  for (const auto& f : all_families()) {
    numbers.insert(f->info().number);
    CHECK(names.insert(f->info().name).second);
    CHECK(family_named(f->info().name) == f.get());
  }
  for (int n = 1; n <= 41; ++n) {
    CAPTURE(n);
    CHECK(numbers.count(n) == 1);
  }
  CHECK(family_named("no such") == nullptr);
}

TEST_CASE("a case is what its text says, in every family, and follows from seed and index") {
  for (const auto& f : all_families())
    for (std::uint64_t index = 0; index < 30; ++index) {
      CAPTURE(f->info().name, index);
      const std::string text = f->text(7, index);
      CHECK(f->reread(text) == text);
      CHECK(f->text(7, index) == text);
    }
  CHECK(all_families()[0]->text(7, 0) != all_families()[0]->text(8, 0));
}

TEST_CASE("RapidCheck shrinks cases within their ranges, to an end") {
  CHECK(rc::check([](const SliverCase& c) { RC_ASSERT(shrinks_within_ranges(c)); }));
  CHECK(rc::check([](const JointsCase& c) { RC_ASSERT(shrinks_within_ranges(c)); }));
  CHECK(rc::check([](const RampCase& c) { RC_ASSERT(shrinks_within_ranges(c)); }));
  CHECK(rc::check([](const UnitsCase& c) { RC_ASSERT(shrinks_within_ranges(c)); }));
  CHECK(rc::check([](const CrossedCase& c) { RC_ASSERT(shrinks_within_ranges(c)); }));
}

TEST_CASE("RapidCheck's properties take cases") {
  CHECK(rc::check([](const LevelCase& c) { RC_ASSERT(c.check(Context{}).wrong.empty()); }));
}

TEST_CASE("changed cases stay within their ranges") {
  Random random(test_seed());
  for (int i = 0; i < 200; ++i) {
    auto c = draw_case<TornCase>(random);
    for (int k = 0; k < 20; ++k) {
      MutateFields mutate(random, 0.2);
      c.fields(mutate);
      settle(c);
      const std::string text = text_of(c);
      REQUIRE(text_of(case_of<TornCase>(text, "changed")) == text);
    }
  }
}

TEST_CASE("a search comes nearer to the bound than its start") {
  const Family& layers = *family_named("20");
  double start = 0;
  double search = 0;
  for (std::uint64_t i = 0; i < 5; ++i) {
    start += layers.check(layers.text(3, i), "start", Context{}).share();
    const Search run = layers.run(3, i, Context{}, [] { return false; });
    search += run.sum.share();
    CHECK(run.cases == 1 + static_cast<std::uint64_t>(layers.info().climb));
    if (run.sum.share() > 0) CHECK(layers.check(run.nearest, "nearest", Context{}).share() == run.sum.share());
  }
  CHECK(search > start);
}

TEST_CASE("a check that throws is a failure, and a failure of any sort ends with a small file that holds it") {
  CHECK(guarded([]() -> Outcome { throw Error("of a sort"); }).wrong == "an error: of a sort");
  const test::TempDirectory folder;
  CampaignOptions o;
  o.families = {family_named("6"), family_named("2")};
  o.starts = 30;
  o.found = folder.path();
  o.context.injection = Injection::wide_span;
  const CampaignState state = run_campaign(o);
  CHECK(state.failed() == 2);
  const auto files = found_files(folder.path());
  REQUIRE(files.size() == 2);
  for (const auto& file : files) {
    const FoundCase c = read_found(file);
    CHECK_FALSE(c.family->check(c.text, file.string(), o.context).wrong.empty());
    CHECK(c.family->check(c.text, file.string(), Context{}).wrong.empty());
  }
  // Nothing is left of a file that cannot be written.
  CHECK_THROWS_AS(write_found(folder.path() / "nowhere", *o.families[0], "", "", ""), Error);
  CHECK(found_files(folder.path()).size() == 2);
}

}  // namespace kage::verif
