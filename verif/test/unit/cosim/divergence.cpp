// SPDX-License-Identifier: Apache-2.0
// The search for the first divergence. Where RTL and golden model agree it finds none in any stage, whatever the
// configuration, the frames and the stalls. Where a defect is built in it names the module that has it.
#include "cosim/diverge/divergence.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>

#include "cosim/diverge/event_search.hpp"
#include "cosim/mismatch.hpp"
#include "cosim/model/model.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/small_configs.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::cosim;
using namespace kage::verif;

namespace {

Feed feed_of(const std::vector<std::vector<std::uint32_t>>& frames) {
  return [&frames](int frame, const WordSink& sink) {
    sink(frames[static_cast<std::size_t>(frame)]);
    return TokenCounts{};
  };
}

std::vector<std::vector<std::uint32_t>> random_frames(Random& random, const Config& c, int count) {
  std::vector<std::vector<std::uint32_t>> frames;
  for (int i = 0; i < count; ++i)
    random_frame(random, c, random.in(1, c.max_width), random.in(1, 6), frames.emplace_back(),
                 static_cast<std::uint32_t>(i));
  return frames;
}

// One of each kind; unit/cosim/stages has twenty more by chance.
std::vector<SmallConfig> configurations() {
  return {
      small_config("parity", [](Config&) {}),
      small_config("counting, smooth, glass",
                   [](Config& c) { c.dsf_bits = 3, c.smooth = 1, c.color_frac = 6, c.translucency = 1; }),
      small_config("lights without FSF, systolic, glass",
                   [](Config& c) {
                     c.fsf = 0, c.dsf_bits = 2, c.count_bits = 2, c.lights = 2, c.class_bits = 2, c.translucency = 1,
                     c.arrangement = 0;
                   }),
      // Five levels of the tree, with buffers behind two of them, and a unit that passes levels alone.
      small_config("units", [](Config& c) { c.units = 19, c.dx_bits = 6, c.face_bits = 3, c.translucency = 1; }),
      small_config("a count and no table, one unit, one lane",
                   [](Config& c) { c.count_bits = 4, c.lanes = 1, c.units = 1, c.dx_bits = 6, c.face_bits = 4; }),
  };
}

template <class... Stages>
constexpr std::uint32_t bits(Stages... stages) {
  return ((1U << static_cast<int>(stages)) | ...);
}

// The stages that are lost with each monitor that gives events (build.py finds it in the monitors' text).
constexpr std::array kMonitors{
    bits(Stage::token, Stage::table, Stage::error, Stage::end),
    bits(Stage::line, Stage::command),
    bits(Stage::claim, Stage::face, Stage::segment, Stage::tree),
    bits(Stage::exit, Stage::load, Stage::out),
    bits(kHandshakeStage),
    bits(Stage::unit),
    bits(Stage::pixel),
    bits(Stage::state),
};

}  // namespace

TEST_CASE("sound RTL does not diverge in any stage") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const auto& [name, c] : configurations()) {
    CAPTURE(name);
    ReplayOptions options;
    options.library = find_model(c, {.monitors = true}).library;
    CHECK(make_rtl(options.library, c)->missing_monitors().empty());
    auto frames = random_frames(random, c, 24);
    for (std::size_t i = 16; i < frames.size(); ++i) {
      damage(random, frames[i]);
      if (frames[i].empty()) frames[i].push_back(0);  // a port brings a beat at least
    }
    const int last = static_cast<int>(frames.size()) - 1;
    for (int i = 0; i <= last; ++i) {
      CAPTURE(i);
      // A search in which nothing differs goes back to the first frame: here to two before, and of the last to all.
      options.steps.first = i == last ? 0 : std::max(0, i - 2);
      options.rtl.idle_percent = i % 3 == 1 ? 30 : 0;
      options.rtl.backpressure_percent = i % 3 == 2 ? 50 : 0;
      const auto d = find_divergence(i, feed_of(frames), c, options);
      if (d) UNSCOPED_INFO(describe(*d));
      CHECK_FALSE(d);
    }
  }
}

TEST_CASE(
    "a monitor that does not fit costs its own stages only: sound frames are the same, what the others see is told") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const auto& [name, c] : configurations()) {
    const auto rtl = make_rtl(find_model(c, {.monitors = true}).library, c);
    auto frames = random_frames(random, c, 8);
    for (std::size_t i = 4; i < frames.size(); ++i) {
      damage(random, frames[i]);
      if (frames[i].empty()) frames[i].push_back(0);
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
      rtl->record(true);
      (void)rtl->frame(frames[i], kNowhere);
      const auto events = rtl->take_events();
      const std::vector<kage_rtl_event> all(events.begin(), events.end());
      for (const std::uint32_t unwatched : kMonitors) {
        CAPTURE(name, i, unwatched);
        std::vector<kage_rtl_event> seen;
        std::copy_if(all.begin(), all.end(), std::back_inserter(seen),
                     [&](const kage_rtl_event& e) { return (unwatched >> static_cast<unsigned>(e.stage) & 1U) == 0; });
        const auto search = [&](const std::vector<kage_rtl_event>& given) {
          auto made = std::make_unique<EventSearch>(c, unwatched);
          made->feed(frames[i]);
          made->finish();
          made->take(given);
          made->end(rtl->clock(), true);
          return made;
        };
        const auto sound = search(seen);
        CHECK_FALSE(sound->first());
        CHECK_FALSE(sound->unexpected());
        CHECK_FALSE(sound->part());
        if (i != 0) continue;
        // The first command, or the first pixel of video where commands are not watched, is wrong in its first value.
        const Stage wrong = (unwatched & bits(Stage::command)) == 0 ? Stage::command : Stage::out;
        const auto one = std::find_if(seen.begin(), seen.end(),
                                      [&](const kage_rtl_event& e) { return static_cast<Stage>(e.stage) == wrong; });
        REQUIRE(one != seen.end());
        one->value[0] ^= 1;
        const auto found = search(seen);
        REQUIRE(found->first());
        CHECK(found->first()->expected.stage == wrong);
      }
    }
  }
}

TEST_CASE("a token that differs is told by its field") {
  const Config c;
  std::vector<std::uint32_t> words;
  TokenWriter writer(c, words);
  SpanToken span;
  span.xl = 12;
  span.xr = 40;
  span.z = 1000;
  span.dz = -3;
  span.color = {10, 20, 30};
  writer.op(span);
  const auto event = [](const std::vector<std::uint32_t>& from) {
    Mismatch m;
    m.expected.stage = Stage::token;
    m.expected.token = 7;
    m.value = 0;
    for (std::size_t i = 0; i < from.size(); ++i) m.expected.value[i / 2] |= std::uint64_t{from[i]} << (i % 2 * 32);
    return m;
  };
  Mismatch m = event(words);
  const auto told = [&](const std::vector<std::uint32_t>& got) {
    const Mismatch other = event(got);
    m.actual = kage_rtl_event{};
    std::copy(other.expected.value.begin(), other.expected.value.end(), m.actual->value);
    const MismatchText t = describe(c, m);
    return t.field + ": " + t.expected + ", " + t.actual;
  };
  const auto with = [&](auto change) {
    SpanToken s = span;
    change(s);
    std::vector<std::uint32_t> changed;
    TokenWriter(c, changed).op(s);
    return changed;
  };
  CHECK(told(with([](SpanToken& s) { s.xl = 13; })) == "xl: 12, 13");
  CHECK(told(with([](SpanToken& s) { s.dz = 4; })) == "dz: -3, 4");
  CHECK(told(with([](SpanToken& s) { s.color[1] = 21; })) == "color[1]: 20, 21");
  auto kind = words;
  kind[0] ^= static_cast<std::uint32_t>(Kind::OP) ^ static_cast<std::uint32_t>(Kind::SP);
  CHECK(told(kind) == "kind: OP, SP");
  // Behind the last field no name is left.
  auto behind = words;
  const auto bits = Layout(c).bits[static_cast<std::size_t>(Kind::OP)];
  REQUIRE(bits % 32 != 0);
  behind[bits / 32] ^= 0x80000000U;
  CHECK(told(behind).substr(0, 5) == "words");
  m.expected.token = 0;
  auto header = words;
  header[1] ^= 1;
  CHECK(told(header).substr(0, 4) == "size");
}

TEST_CASE("what goes to another unit, or is another's last, is told so") {
  Config c;
  c.units = 2;
  const auto told = [&](Stage stage, int expected, int actual) {
    Mismatch m;
    m.expected.stage = stage;
    m.expected.unit = expected;
    m.actual = kage_rtl_event{};
    m.actual->unit = actual;
    m.value = first_difference(m.expected, *m.actual);
    if (m.value < 0) return std::string("same");
    const MismatchText t = describe(c, m);
    return t.field + ": " + t.expected + ", " + t.actual;
  };
  for (const Stage stage : {Stage::face, Stage::segment}) {
    CHECK(told(stage, 0, 0) == "same");
    CHECK(told(stage, 0, 1) == "unit: 0, 1");
    CHECK(told(stage, 1, 0) == "unit: 1, 0");
  }
  CHECK(told(Stage::exit, 1, 1) == "same");
  CHECK(told(Stage::exit, 0, 1) == "last of the line: 0, 1");
  CHECK(told(Stage::pixel, 3, 4) == "same");  // by its queue
}

// A TP behind the last line is refused, and paints nothing: the next frame finds its pixels as the last EOL left them.
TEST_CASE("a TP behind the last line paints nothing, and that is no divergence") {
  for (const auto& [name, c] : configurations()) {
    if (c.translucency == 0) continue;
    CAPTURE(name);
    std::vector<std::vector<std::uint32_t>> frames(2);
    SpanToken span;
    span.xl = 1;
    span.xr = 7;
    span.z = std::int64_t{5} << c.z_frac;
    span.w = 1;
    span.alpha = 99;
    TokenWriter late(c, frames[0]);
    late.header({8, 1, 0x563412, 0});
    late.eol(0);
    late.tp(span);
    late.end();
    TokenWriter next(c, frames[1]);
    next.header({8, 2, 0x998877, 1});
    next.sp(span);
    if (c.fsf != 0) next.ev(0, 8);
    if (c.count_bits != 0) next.es(0, 8, 0);
    next.resolve();
    next.eol(0);
    next.tp(span);
    next.eol(1);
    next.end();
    ReplayOptions options;
    options.library = find_model(c, {.monitors = true}).library;
    const auto rtl = make_rtl(options.library, c, {});
    CHECK(rtl->frame(frames[0], kNowhere).status.error == ErrorCode::ORDER);
    CHECK(rtl->frame(frames[1], kNowhere).status.error == ErrorCode::NONE);
    const auto d = find_divergence(1, feed_of(frames), c, options);
    if (d) UNSCOPED_INFO(describe(*d));
    CHECK_FALSE(d);
  }
}

// It is refused, and paints nothing, though volumes have been counted.
TEST_CASE("a TP among volumes paints nothing, and that is no divergence") {
  int tried = 0;
  for (const auto& [name, c] : configurations()) {
    if (c.translucency == 0 || c.dsf_bits == 0 || c.class_bits > 1) continue;
    CAPTURE(name);
    ++tried;
    std::vector<std::vector<std::uint32_t>> frames(1);
    SpanToken span;
    span.xl = 1;
    span.xr = 7;
    span.z = std::int64_t{500} << c.z_frac;
    span.normal_class = 1;
    span.color = {200 << c.color_frac, 100 << c.color_frac, 50 << c.color_frac};
    if (c.smooth == 0) span.color = {200, 100, 50};
    TokenWriter w(c, frames[0]);
    w.header({8, 1, 0x563412, 0});
    w.shade(1U << (c.shade_frac - 1));
    w.op(span);
    span.z = std::int64_t{5} << c.z_frac;
    span.w = 1;
    span.xl = 3;
    w.sp(span);
    if (c.fsf != 0) w.ev(0, 8);
    if (c.count_bits != 0) w.es(0, 8, 0);
    span.alpha = 99;
    w.tp(span);
    w.end();
    ReplayOptions options;
    options.library = find_model(c, {.monitors = true}).library;
    CHECK(make_rtl(options.library, c, {})->frame(frames[0], kNowhere).status.error == ErrorCode::ORDER);
    const auto d = find_divergence(0, feed_of(frames), c, options);
    if (d) UNSCOPED_INFO(describe(*d));
    CHECK_FALSE(d);
  }
  CHECK(tried >= 2);
}
