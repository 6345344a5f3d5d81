// SPDX-License-Identifier: Apache-2.0
// The co-simulation can say no, and at the right pixel: frames made by hand, in which each defect of
// verif/cosim/model/faults.yaml can show first in one known place, go through RTL with the defect. The sound RTL passes
// the same frames.
#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include "cosim/diverge/divergence.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/ranges.hpp"
#include "cosim/run.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::cosim;

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 8;
constexpr int kFrames = 2;

const Config& config() {
  static const Config c = load_config("default").config;
  return c;
}

SpanToken span(int xl, int xr, std::int64_t z, int grey) {
  SpanToken s;
  s.xl = xl;
  s.xr = xr;
  s.z = z << config().z_frac;
  s.normal_class = 1;
  s.color = {grey, grey, grey};
  return s;
}

SpanToken volume(int xl, int xr, int w) {
  SpanToken s = span(xl, xr, 500, 0);
  s.w = w;
  return s;
}

using LineMaker = std::function<void(TokenWriter& out, int frame, int line)>;

/// On each line what `opaque` and `volumes` write; without `shade` nothing says how dark a shadow is.
std::vector<std::uint32_t> make(int frame, const LineMaker& opaque, const LineMaker& volumes, bool shade = true) {
  std::vector<std::uint32_t> words;
  TokenWriter out(config(), words);
  out.header({kWidth, kHeight, 0, static_cast<std::uint32_t>(frame)});
  if (shade) out.shade(1U << (config().shade_frac - 1));
  for (int y = 0; y < kHeight; ++y) {
    opaque(out, frame, y);
    if (volumes) {
      volumes(out, frame, y);
      out.ev(0, kWidth);
      out.resolve();
    }
    out.eol(y);
  }
  out.end();
  return words;
}

Report compare(const std::string& fault, const LineMaker& opaque, const LineMaker& volumes, int backpressure = 0) {
  const Model model = find_model(config(), {.fault = fault});
  const auto golden = make_golden(config());
  RtlOptions options;
  options.backpressure_percent = backpressure;
  const auto rtl = make_rtl(model.library, config(), options);
  const auto feed = [&](int frame, const WordSink& sink) {
    sink(make(frame, opaque, volumes));
    return TokenCounts{};
  };
  return run(kFrames, feed, *golden, *rtl, {});
}

void check(const std::string& fault, const LineMaker& opaque, const LineMaker& volumes, int line, int x, int expected,
           int actual) {
  CHECK(compare("", opaque, volumes).same);
  CHECK(compare("", opaque, volumes, 50).same);
  const Report r = compare(fault, opaque, volumes);
  CHECK_FALSE(r.same);
  REQUIRE(r.first_difference);
  CHECK(r.first_difference->frame == 1);
  CHECK(r.first_difference->line == line);
  CHECK(r.first_difference->x == x);
  CHECK(r.first_difference->field == "red");
  CHECK(r.first_difference->expected == expected);
  CHECK(r.first_difference->actual == actual);
}

void wall(TokenWriter& out) { out.op(span(0, kWidth, 1000, 100)); }

}  // namespace

TEST_CASE("a wrong comparison shows where two spans tie, and nowhere before") {
  const LineMaker opaque = [](TokenWriter& out, int frame, int line) {
    wall(out);
    out.op(span(50, 60, 1001, 200));                                // behind the wall: no tie
    if (frame == 1 && line == 5) out.op(span(137, 139, 1000, 30));  // a tie: the wall stays
  };
  check("wrong_compare", opaque, {}, 5, 137, 100, 30);
}

TEST_CASE("a swallowed toggle shows where a second face of the volume is crossed") {
  const LineMaker opaque = [](TokenWriter& out, int, int) { wall(out); };
  const LineMaker volumes = [](TokenWriter& out, int frame, int line) {
    out.sp(volume(10, 20, 1));
    if (frame == 1 && line == 3) {
      out.sp(volume(30, 90, 1));
      out.sp(volume(41, 90, -1));
    }
  };
  check("swallowed_toggle", opaque, volumes, 3, 41, 100, 50);
}

TEST_CASE("a token lost in a stall shows at its own pixels") {
  // A wall takes as many clocks as the line has groups; the second and third change nothing, and what follows finds the
  // core busy.
  const LineMaker opaque = [](TokenWriter& out, int frame, int line) {
    if (frame != 1 || line != 4) return;
    for (int i = 0; i < 3; ++i) wall(out);
    out.op(span(203, 204, 900, 20));
  };
  check("lost_token", opaque, {}, 4, 203, 20, 100);
}

TEST_CASE(
    "what a register holds at first is the same with monitors and for waveforms, and is told where a fault depends on "
    "it") {
  const LineMaker opaque = [](TokenWriter& out, int, int) { wall(out); };
  const LineMaker volumes = [](TokenWriter& out, int, int) { out.sp(volume(10, 20, 1)); };
  const Feed feed = [&](int frame, const WordSink& sink) {
    sink(make(frame, opaque, volumes, false));
    return TokenCounts{};
  };
  const Model plain = find_model(config(), {.fault = "unreset_shade"});
  const Model monitored = find_model(config(), {.fault = "unreset_shade", .monitors = true});
  const Model waves = find_model(config(), {.fault = "unreset_shade", .waves = true});
  std::set<std::int64_t> seen;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    RtlOptions options;
    options.seed = seed;
    const auto first = [&](const Model& model) {
      const auto golden = make_golden(config());
      const auto rtl = make_rtl(model.library, config(), options);
      const Report r = run(1, feed, *golden, *rtl, {});
      REQUIRE(r.first_difference);
      CHECK(r.first_difference->x == 10);
      return r.first_difference->actual;
    };
    const std::int64_t actual = first(plain);
    CHECK(first(monitored) == actual);
    CHECK(first(waves) == actual);
    seen.insert(actual);
    ReplayOptions search;
    search.library = monitored.library;
    search.rtl = options;
    const auto d = find_divergence(0, feed, config(), search);
    REQUIRE(d);
    CHECK(d->module == "frame_control");
    CHECK(d->field == "shade");
    CHECK(d->initial_state);
    CHECK(describe(*d).find("depends on the initial state") != std::string::npos);
  }
  CHECK(seen.size() > 4);  // each seed has its own

  // A fault that any initial state shows alike.
  const LineMaker tie = [](TokenWriter& out, int, int) {
    wall(out);
    out.op(span(137, 139, 1000, 30));
  };
  ReplayOptions search;
  search.library = find_model(config(), {.fault = "wrong_compare", .monitors = true}).library;
  const Feed ties = [&](int frame, const WordSink& sink) {
    sink(make(frame, tie, {}));
    return TokenCounts{};
  };
  const auto d = find_divergence(0, ties, config(), search);
  REQUIRE(d);
  CHECK_FALSE(d->initial_state);
}

TEST_CASE("what a frame leaves in the core is found by the next one, in however many ranges the frames are run") {
  constexpr int kMany = 6;
  constexpr int kWithout = 4;  // this frame alone says no shade
  const LineMaker opaque = [](TokenWriter& out, int, int) { wall(out); };
  const LineMaker volumes = [](TokenWriter& out, int frame, int) { out.sp(volume(10, 20 + frame, 1)); };
  const Feed feed = [&](int frame, const WordSink& sink) {
    sink(make(frame, opaque, volumes, frame != kWithout));
    return TokenCounts{};
  };
  const auto in_ranges = [&](const std::string& fault, int ranges) {
    const Model model = find_model(config(), {.fault = fault});
    std::vector<Report> reports;
    for (const FrameRange& range : split({}, kMany, ranges)) {
      const auto golden = make_golden(config());
      RtlOptions stalled;
      stalled.idle_percent = stalled.backpressure_percent = 30;
      const auto rtl = make_rtl(model.library, config(), stalled);
      RunOptions options;
      options.steps = range.steps;
      options.before = range.before;
      reports.push_back(run(range.end, feed, *golden, *rtl, options));
      if (!reports.back().same) break;
    }
    return join(std::move(reports));
  };
  const Report sound = in_ranges("", 1);
  const Report one = in_ranges("unreset_shade", 1);
  CHECK(sound.same);
  CHECK(sound.frames == kMany);
  REQUIRE(one.first_difference);
  CHECK(one.first_difference->frame == kWithout);
  for (const int ranges : {2, 3, kMany, 20}) {
    CAPTURE(ranges);
    const Report all = in_ranges("", ranges);
    CHECK(all.same);
    CHECK(all.frames == kMany);
    CHECK(all.cycles == sound.cycles);
    CHECK(all.stalls.starved == sound.stalls.starved);
    CHECK(all.stalls.blocked == sound.stalls.blocked);
    const Report some = in_ranges("unreset_shade", ranges);
    REQUIRE(some.first_difference);
    CHECK(describe(*some.first_difference) == describe(*one.first_difference));
    CHECK(some.frames == one.frames);
    CHECK(some.cycles == one.cycles);
  }
}

TEST_CASE("a run is split into ranges that have each frame once, and the frame before each range") {
  for (const FrameSteps& steps : {FrameSteps{0, 1}, FrameSteps{2, 3}})
    for (int frames = 1; frames < 20; ++frames)
      for (int ranges = 1; ranges < 24; ++ranges) {
        CAPTURE(steps.first, steps.step, frames, ranges);
        std::vector<int> seen;
        std::size_t least = 100;
        std::size_t most = 0;
        for (const FrameRange& r : split(steps, frames, ranges)) {
          const std::size_t before = seen.size();
          for (int i = r.steps.first; i < r.end; i += r.steps.step) seen.push_back(i);
          least = std::min(least, seen.size() - before);
          most = std::max(most, seen.size() - before);
          CHECK(r.before == (before == 0 ? 0 : 1));
        }
        std::vector<int> all;
        for (int i = steps.first; i < frames; i += steps.step) all.push_back(i);
        CHECK(seen == all);
        CHECK(most - std::min(least, most) <= 1);
      }
}
