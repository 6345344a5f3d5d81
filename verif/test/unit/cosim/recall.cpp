// SPDX-License-Identifier: Apache-2.0
// Which frames of a range need the RTL, given verdicts of earlier runs; and the folder of verdicts. No RTL is run: a
// second golden core is the actual one, which may be made wrong.
#include "cosim/recall.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <type_traits>
#include <vector>

#include "cosim/model/trust.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"
#include "test/support/wrong_core.hpp"

using namespace kage;
using namespace kage::cosim;

namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 8;

/// A cache of this test's own.
class Cache {
 public:
  Cache() { setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1); }

 private:
  test::TempDirectory folder_;
};

const Config& config() {
  static const Config c = load_config("tiny").config;
  return c;
}

/// A frame of two lines; its background is `what`.
std::vector<std::uint32_t> words_of(int frame, int what) {
  std::vector<std::uint32_t> words;
  TokenWriter out(config(), words);
  out.header({4, 2, static_cast<std::uint32_t>(what), static_cast<std::uint32_t>(frame)});
  for (int y = 0; y < 2; ++y) out.eol(y);
  out.end();
  return words;
}

/// A core with clocks, some of them lost, which may have a frame wrong.
class Clocked : public verif::WrongCore {
 public:
  explicit Clocked(int wrong) : WrongCore(config(), wrong) {}
  FrameEnd finish(const LineSink& sink) override {
    FrameEnd end = WrongCore::finish(sink);
    end.cycles = 1000 + static_cast<std::uint64_t>(number());
    end.phase_stalls[2] = {3, 4};
    return end;
  }
};

/// Runs what has no verdict, as kage cosim does.
class Run {
 public:
  explicit Run(bool whole, std::string context = "context")
      : options_{std::make_shared<VerdictStore>(), std::move(context), whole} {}

  std::vector<int> backgrounds = std::vector<int>(kFrames, 7);
  int wrong = -1;             // frame that the actual core has wrong
  bool golden_wrong = false;  // the golden core is another: each frame's first byte

  /// The frames that went through the actual core; "2 3" behind 1 is "1> 2 3".
  std::string go(FrameRange range = {{0, 1}, kFrames, 0}) {
    std::string text;
    const Feed feed = [&](int i, const WordSink& sink) {
      sink(words_of(i, backgrounds[static_cast<std::size_t>(i)]));
      return TokenCounts{};
    };
    report = {};
    std::vector<Report> reports;
    const auto golden = this->golden();
    for (const auto& s : recall(range, {0, 1}, feed, feed, *golden, {}, options_)) {
      if (!s->taken) {
        const auto again = this->golden();
        VerdictKeeper keeper(*again, options_);
        Clocked actual(wrong);
        RunOptions run_options;
        run_options.steps = s->range.steps;
        run_options.before = s->range.before;
        run_options.begin = [&](int frame) {
          text += std::to_string(frame) + (frame < s->range.steps.first ? "> " : " ");
          keeper.next(frame);
        };
        run_options.same = [&](const FrameResult& r) { keeper.same(r); };
        run_options.two_threads = false;
        s->report = run(s->range.end, feed, keeper, actual, run_options);
      }
      reports.push_back(std::move(s->report));
      if (!reports.back().same) break;
    }
    report = join(std::move(reports));
    return text;
  }

  Report report;

 private:
  /// Nobody calls begin() of an expected core: -1 is every frame's number.
  [[nodiscard]] std::unique_ptr<Core> golden() const { return std::make_unique<Clocked>(golden_wrong ? -1 : -2); }

  RecallOptions options_;
};

}  // namespace

TEST_CASE("what has no verdict is run, behind the frame before it") {
  const Cache cache;
  Run r(false);
  CHECK(r.go() == "0 1 2 3 4 5 6 7 ");
  CHECK(r.report.taken.empty());
  CHECK(r.go().empty());
  CHECK(r.report.taken == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(r.report.frames == kFrames);
  CHECK(r.report.cycles == std::uint64_t{8} * 1000 + 28);  // the actual core's, as it told them
  CHECK(r.report.stalls.starved == std::uint64_t{3} * 8);
  CHECK(r.report.each[5].phase_stalls[2].blocked == 4);
  // Another frame 3 is another predecessor of frame 4.
  r.backgrounds[3] = 9;
  CHECK(r.go() == "2> 3 4 ");
  CHECK(r.report.taken == std::vector<int>{0, 1, 2, 5, 6, 7});
  CHECK(r.go().empty());
  r.backgrounds[3] = 7;
  CHECK(r.go().empty());
  // The first frame is run with two initial states, and so its verdict is its own; so is the last.
  r.backgrounds[0] = r.backgrounds[7] = 9;
  CHECK(r.go() == "0 1 6> 7 ");
  // A range that begins with a frame before it.
  CHECK(r.go({{4, 1}, kFrames, 1}).empty());
  CHECK(Run(false, "another").go({{4, 1}, kFrames, 1}) == "3> 4 5 6 7 ");
  // Shards: another frame is before it.
  CHECK(Run(false).go({{0, 2}, kFrames, 0}) == "0> 2 4 6 ");
}

TEST_CASE("with the whole history, what is behind a frame that is run is run as well") {
  const Cache cache;
  Run pair(false);
  pair.go();
  Run r(true);
  CHECK(r.go() == "0 1 2 3 4 5 6 7 ");
  CHECK(r.go().empty());
  r.backgrounds[3] = 9;
  CHECK(r.go() == "0> 1> 2> 3 4 5 6 7 ");
  CHECK(r.report.taken == std::vector<int>{0, 1, 2});
  CHECK(r.go().empty());
}

TEST_CASE("a verdict is of what the golden model made: another golden model has none") {
  const Cache cache;
  Run r(false);
  r.go();
  r.golden_wrong = true;
  CHECK(r.go() == "0 ");
  CHECK_FALSE(r.report.same);
  r.golden_wrong = false;
  CHECK(r.go().empty());
}

TEST_CASE("a frame that is different leaves no verdict, and those before it do") {
  const Cache cache;
  Run r(false);
  r.wrong = 5;
  CHECK(r.go() == "0 1 2 3 4 5 ");
  CHECK_FALSE(r.report.same);
  CHECK(r.go() == "4> 5 ");
  REQUIRE(r.report.first_difference);
  CHECK(r.report.first_difference->frame == 5);
  CHECK(r.report.frames == 6);
  CHECK(r.report.taken == std::vector<int>{0, 1, 2, 3, 4});
  r.wrong = -1;
  CHECK(r.go() == "4> 5 6 7 ");
}

TEST_CASE("a frame that cannot be made is met by whoever runs it, and so is one that a core refuses") {
  const Cache cache;
  const RecallOptions options{std::make_shared<VerdictStore>(), "context", false};
  const Feed feed = [&](int i, const WordSink& sink) {
    if (i == 3) throw Error("no such frame");
    sink(i == 2 ? std::vector<std::uint32_t>{0, 0, 0, 0, 0, 0} : words_of(i, 7));
    return TokenCounts{};
  };
  const auto golden = make_golden(config());
  const auto stretches = recall({{0, 1}, kFrames, 0}, {0, 1}, feed, feed, *golden, {}, options);
  REQUIRE(stretches.size() == 1);
  CHECK_FALSE(stretches[0]->taken);
  CHECK(stretches[0]->range.end == kFrames);
  // Even with a verdict a frame without pixels is none, unless frames may be refused.
  FrameKeys keys(options);
  HeardCore heard(*golden);
  std::vector<std::string> names;
  for (int i = 0; i < 3; ++i) {
    feed(i, [&](std::span<const std::uint32_t> words) { heard.feed(words, kNowhere); });
    heard.finish(kNowhere);
    CHECK(options.store->keep(keys.next(i, heard.words()), {heard.output(), 1, {}}));
  }
  RunOptions run_options;
  CHECK(recall({{0, 1}, 3, 0}, {0, 1}, feed, feed, *golden, run_options, options).size() == 2);
  run_options.refusals = true;
  CHECK(recall({{0, 1}, 3, 0}, {0, 1}, feed, feed, *golden, run_options, options).size() == 1);
}

TEST_CASE("the context is of RTL, seed, stalls, mutant and assertions") {
  const RtlIdentity rtl{"key", "behaviour", ""};
  std::vector<std::string> all{recall_context(rtl, {}), recall_context({"key", "other", ""}, {})};
  RtlOptions o;
  const auto with = [&]<class T>(T RtlOptions::*member, std::type_identity_t<T> value) {
    RtlOptions changed;
    changed.*member = value;
    all.push_back(recall_context(rtl, changed));
  };
  with(&RtlOptions::seed, 2);
  with(&RtlOptions::initial, 2);
  with(&RtlOptions::idle_percent, 2);
  with(&RtlOptions::backpressure_percent, 2);
  with(&RtlOptions::mutant, 2);
  with(&RtlOptions::assertions, false);
  std::sort(all.begin(), all.end());
  CHECK(std::adjacent_find(all.begin(), all.end()) == all.end());
  // A model of another key, with the same behaviour, is as good.
  CHECK(recall_context({"other key", "behaviour", ""}, {}) == recall_context(rtl, {}));
}

TEST_CASE("the store keeps so many, and those used last") {
  const Cache cache;
  VerdictStore store(40);
  const auto key = [](int i) {
    Sha256 hash;
    hash.add(static_cast<std::uint64_t>(i));
    return hash.take();
  };
  const auto age = [&](int i, int minutes) {
    fs::last_write_time(store.folder() / key(i), fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
  };
  for (int i = 0; i < 500; ++i) {
    REQUIRE(store.keep(key(i), {"output", static_cast<std::uint64_t>(i), {}}));
    age(i, 500 - i);
    if (i > 0) CHECK(store.find(key(0)).has_value());  // which is used again and again
    CHECK(store.list().size() <= 40);
  }
  CHECK(store.list().size() >= 33);
  CHECK(store.find(key(0))->cycles == 0);
  CHECK_FALSE(store.find(key(1)).has_value());
  CHECK(store.find(key(499))->cycles == 499);
  // Files that are no verdicts are nobody's business.
  std::ofstream(store.folder() / "notes") << "mine";
  (void)store.prune({.age = std::chrono::seconds(0), .bytes = 0});
  CHECK(store.list().empty());
  CHECK(fs::exists(store.folder() / "notes"));
}

TEST_CASE("a verdict that is cut anywhere, or has another byte, is none; threads may keep the same at once") {
  const Cache cache;
  VerdictStore store;
  const std::string key(64, 'a');
  const Verdict verdict{std::string(64, 'b'), 12345, {{{1, 2}, {3, 4}}}};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        store.keep(key, verdict);
        const auto found = store.find(key);  // another thread may be writing it
        if (found && found->cycles != 12345) std::abort();
      }
    });
  for (std::thread& t : threads) t.join();
  REQUIRE(store.trouble().empty());
  REQUIRE(store.find(key));
  CHECK(store.find(key)->phase_stalls[1].blocked == 4);
  std::ifstream in(store.folder() / key);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::ofstream(store.folder() / key) << text.substr(0, i);
    CHECK_FALSE(store.find(key));
    std::string other = text;
    other[i] ^= 1;
    std::ofstream(store.folder() / key) << other;
    CHECK_FALSE(store.find(key));
  }
  CHECK(store.keep(key, verdict));
  CHECK(store.find(key));
}
