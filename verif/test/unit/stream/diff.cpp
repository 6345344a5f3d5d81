// SPDX-License-Identifier: Apache-2.0
// Stream files against each other: the laws, and that one changed field is found and named.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "contract/fields.hpp"
#include "kage/error.hpp"
#include "kage/stream_diff.hpp"
#include "number/bits.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"
#include "stimulus/random.hpp"
#include "stimulus/random_frames.hpp"
#include "stream/span_frame.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"
#include "test/support/pictures.hpp"

namespace kage::verif {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::uint32_t>;

fs::path write(const fs::path& path, const Config& config, const std::vector<Words>& frames,
               const std::string& origin = "") {
  StreamFileWriter writer(path, config);
  for (const Words& words : frames) writer.frame(words);
  if (!origin.empty()) writer.origin(origin);
  writer.finish();
  return path;
}

/// The same words as a port may bring them.
fs::path write_port(const fs::path& path, const Config& config, const Words& words) {
  StreamFileWriter writer(path, config);
  writer.begin_port_frame();
  writer.words(words);
  writer.end_frame();
  writer.finish();
  return path;
}

StreamDiff diff(const fs::path& a, const fs::path& b) { return diff_streams(StreamFile(a), StreamFile(b)); }

/// Counts are the same both ways, and sides are exchanged.
void check_symmetric(const fs::path& a, const fs::path& b, const StreamDiff& ab) {
  const StreamDiff ba = diff(b, a);
  CHECK(ab.same == ba.same);
  CHECK(ab.different_frames == ba.different_frames);
  CHECK(ab.different_lines == ba.different_lines);
  CHECK(ab.different_tokens == ba.different_tokens);
  CHECK(ab.sections.size() == ba.sections.size());
  REQUIRE(ab.first.has_value() == ba.first.has_value());
  if (!ab.first) return;
  CHECK(ab.first->token == ba.first->token);
  CHECK(ab.first->field == ba.first->field);
  CHECK(ab.first->a == ba.first->b);
  CHECK(ab.first->b == ba.first->a);
}

/// Two lines of two spans each.
Config plain_config() {
  Config c;
  c.dsf_bits = 0;
  c.fsf = 0;
  return c;
}

Words plain_frame(const Config& c, int second_xr = 9, std::uint32_t number = 0, int extra_spans = 0) {
  Words words;
  TokenWriter out(c, words);
  out.header({16, 2, 0x102030, number});
  SpanToken span;
  span.z = 5000 << c.z_frac;
  span.color = {10, 20, 30};
  for (int y = 0; y < 2; ++y) {
    span.xl = 0;
    span.xr = 4;
    out.op(span);
    for (int i = 0; i < (y == 1 ? extra_spans : 0); ++i) {
      span.xr = 1 + i;
      out.op(span);
    }
    span.xl = 5;
    span.xr = y == 1 ? second_xr : 9;
    out.op(span);
    out.eol(y);
  }
  out.end();
  return words;
}

}  // namespace

TEST_CASE(
    "a frame at the polygon level is compared by its spans with one that is not, and by its tokens with another") {
  const TempFolder folder("stream-levels");
  Random random(test_seed());
  CAPTURE(test_seed());
  int changed = 0;
  for (int round = 0; round < 60; ++round) {
    Config c = random_config(random, 60);
    c.active = random.in(1, 8);
    Words polygons;
    random_polygon_frame(random, c, random.in(1, 60), random.in(1, 8), polygons, 5);
    const auto spans = span_frame(c, polygons);
    REQUIRE(spans);
    CAPTURE(round, to_yaml(c));
    Config without = c;  // a core without front end takes the spans
    without.active = round % 2 == 0 ? 0 : c.active;
    const fs::path a = write(folder.path / "a.kage", c, {polygons});
    const fs::path b = write(folder.path / "b.kage", without, {*spans});
    for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a)}) {
      const StreamDiff d = diff(x, y);
      CHECK(d.same);
      CHECK(d.reason.empty());
      CHECK(d.expanded_frames == 1);
      CHECK(d.parameters.empty());
    }
    CHECK(diff(a, a).expanded_frames == 0);
    CHECK(diff(a, a).same);

    // Another depth of the first polygon is one token at the level; where it has a span, the spans tell it too.
    TokenPlaces places(c, polygons);
    if (places.of(Kind::POLYGON).empty()) continue;
    const auto at = places.of(Kind::POLYGON).front();
    const Field value = places.layout().polygon_value;
    places.put(at, value, places.get(at, value) ^ 1U << kPlaneFrac);
    const fs::path other = write(folder.path / "c.kage", c, {polygons});
    const StreamDiff of_tokens = diff(a, other);
    CHECK(of_tokens.different_tokens == 1);
    REQUIRE(of_tokens.first);
    CHECK(of_tokens.first->field == "value");
    CHECK(of_tokens.first->a.starts_with("POLYGON value "));
    const auto other_spans = span_frame(c, polygons);
    REQUIRE(other_spans);
    CHECK(diff(other, b).same == (*other_spans == *spans));
    changed += *other_spans == *spans ? 0 : 1;
  }
  CHECK(changed > 10);
}

TEST_CASE("random streams: the same as themselves, symmetric, and one changed bit is one difference at its place") {
  const TempFolder folder("stream-diff");
  Random random(test_seed());
  CAPTURE(test_seed());
  int changed = 0;
  for (int round = 0; round < 150; ++round) {
    const Config c = random_config(random, 60);
    const Layout layout(c);
    std::vector<Words> frames(static_cast<std::size_t>(random.in(1, 3)));
    for (std::size_t i = 0; i < frames.size(); ++i)
      random_frame(random, c, random.in(1, 60), random.in(1, 6), frames[i], static_cast<std::uint32_t>(i));
    const fs::path a = write(folder.path / "a.kage", c, frames);
    const StreamDiff self = diff(a, a);
    CHECK(self.same);
    CHECK(self.reason.empty());
    CHECK(self.tokens_compared);
    CHECK_FALSE(self.first);
    CHECK(self.different_tokens == 0);

    // Flip a bit of some field of some token; where the frame is still sound, that is the one difference.
    const auto at_frame = static_cast<std::size_t>(random.in(0, static_cast<int>(frames.size()) - 1));
    Words words = frames[at_frame];
    std::vector<std::size_t> starts;
    TokenWalk walk(layout, words);
    for (auto token = walk.next(); !token.empty(); token = walk.next())
      starts.push_back(static_cast<std::size_t>(token.data() - words.data()));
    const auto number = static_cast<std::size_t>(random.in(0, static_cast<int>(starts.size()) - 1));
    const auto kind = kind_of(words[starts[number]]);
    const int bits = layout.bits[static_cast<std::size_t>(kind)];
    if (bits <= 4) continue;
    const auto bit = static_cast<std::size_t>(random.in(4, bits - 1));
    words[starts[number] + bit / 32] ^= std::uint32_t{1} << (bit % 32);
    int line = 0;
    bool state = kind == Kind::SHADE || kind == Kind::TABLE || kind == Kind::FACE;
    for (std::size_t i = 0; i < number; ++i) line += kind_of(words[starts[i]]) == Kind::EOL ? 1 : 0;
    std::string field;
    each_field(c, layout, kind, [&](const char* name, int channel, Field f) {
      if (bit >= f.lsb && bit < f.lsb + std::size_t{f.bits})
        field = channel < 0 ? std::string(name) : std::string(name) + "[" + std::to_string(channel) + "]";
    });
    std::vector<Words> others = frames;
    others[at_frame] = words;
    try {
      (void)check_frame(c, words, "", 0);
    } catch (const Error&) {
      continue;
    }
    ++changed;
    const fs::path b = write(folder.path / "b.kage", c, others);
    const StreamDiff d = diff(a, b);
    CHECK_FALSE(d.same);
    CHECK(d.different_frames == 1);
    CHECK(d.different_lines == (state ? 0 : 1));
    CHECK(d.different_tokens == 1);
    REQUIRE(d.first);
    CHECK(d.first->frame == static_cast<int>(at_frame));
    CHECK(d.first->token == number + 1);
    CHECK(d.first->line == (state ? std::optional<int>() : std::optional<int>(line)));
    CHECK(d.first->field == field);
    CHECK(d.first->a == to_string(c, decode(c, layout, std::span(frames[at_frame]).subspan(starts[number]))));
    CHECK(d.first->b == to_string(c, decode(c, layout, std::span(words).subspan(starts[number]))));
    check_symmetric(a, b, d);
  }
  CHECK(changed > 30);
}

TEST_CASE("random streams of unlike frames: symmetric, and as many differ as have other words") {
  const TempFolder folder("stream-diff");
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int round = 0; round < 60; ++round) {
    const Config c = random_config(random, 60);
    std::vector<Words> x(static_cast<std::size_t>(random.in(1, 4)));
    std::vector<Words> y(static_cast<std::size_t>(random.in(1, 4)));
    for (Words& w : x) random_frame(random, c, random.in(1, 60), random.in(1, 6), w);
    for (Words& w : y) random_frame(random, c, random.in(1, 60), random.in(1, 6), w);
    std::uint64_t unlike = std::max(x.size(), y.size()) - std::min(x.size(), y.size());
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
      if (random.chance(0.5)) y[i] = x[i];
      unlike += x[i] == y[i] ? 0 : 1;
    }
    const fs::path a = write(folder.path / "a.kage", c, x);
    const fs::path b = write(folder.path / "b.kage", c, y);
    std::uint64_t seen = 0;
    const StreamDiff d =
        diff_streams(StreamFile(a), StreamFile(b), [&](const FrameDiff& frame) { seen += frame.same ? 0 : 1; });
    CHECK(d.different_frames == unlike);
    CHECK(seen == unlike);
    CHECK(d.same == (x == y));
    check_symmetric(a, b, d);
  }
}

TEST_CASE("frames that break any rule are compared to their end, and are the same where their words are") {
  const TempFolder folder("stream-diff");
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  for (int round = 0; round < 200; ++round) {
    const Config c = random_config(random, 60);
    Words x = damaged_frame(random, c, 1);
    Words y = random.chance(0.3) ? sound_frame(random, c, 1) : x;
    if (random.chance(0.7)) y.resize(static_cast<std::size_t>(random.in(1, static_cast<int>(y.size()))));
    if (random.chance(0.3)) y.back() ^= 1U << random.in(0, 31);
    const fs::path a = write_port(folder.path / "a.kage", c, x);
    const fs::path b = write_port(folder.path / "b.kage", c, y);
    const StreamDiff d = diff(a, b);
    CAPTURE(round, x.size(), y.size());
    CHECK(d.same == (x == y));
    REQUIRE(d.first.has_value() == !d.same);
    CHECK((d.same || d.different_tokens > 0));
    check_symmetric(a, b, d);
  }
}

TEST_CASE("the same words checked and unchecked are a difference of sections") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const StreamDiff d =
      diff(write(folder.path / "a.kage", c, {plain_frame(c)}), write_port(folder.path / "b.kage", c, plain_frame(c)));
  CHECK(d.different_frames == 1);
  CHECK(d.different_tokens == 0);
  REQUIRE(d.first);
  CHECK(d.first->field == "section");
  CHECK_THAT(d.first->b, Catch::Matchers::StartsWith("PORT"));
}

TEST_CASE("a token put in between is one difference, not all that follow") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const fs::path a = write(folder.path / "a.kage", c, {plain_frame(c)});
  const StreamDiff d = diff(a, write(folder.path / "b.kage", c, {plain_frame(c, 9, 0, 2)}));
  CHECK(d.different_frames == 1);
  CHECK(d.different_lines == 1);
  CHECK(d.different_tokens == 2);
  REQUIRE(d.first);
  CHECK(d.first->line == 1);
  CHECK(d.first->token == 5);
  CHECK(d.first->a == "OP [5, 9) z 5000 dz 0 color 10,20,30");
  CHECK(d.first->b == "OP [0, 1) z 5000 dz 0 color 10,20,30");
  CHECK(d.first->field == "xl");
}

TEST_CASE("headers, sizes and missing frames are differences of their own") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const fs::path a = write(folder.path / "a.kage", c, {plain_frame(c), plain_frame(c, 9, 1)});
  const StreamDiff number = diff(a, write(folder.path / "b.kage", c, {plain_frame(c), plain_frame(c, 9, 7)}));
  CHECK(number.different_frames == 1);
  CHECK(number.different_lines == 0);
  CHECK(number.different_tokens == 1);
  REQUIRE(number.first);
  CHECK(number.first->frame == 1);
  CHECK(number.first->token == 0);
  CHECK_FALSE(number.first->line);
  CHECK(number.first->field == "frame");
  CHECK(number.first->b == "frame number 7");

  const StreamDiff fewer = diff(a, write(folder.path / "b.kage", c, {plain_frame(c)}));
  CHECK_FALSE(fewer.same);
  CHECK(fewer.different_frames == 1);
  CHECK(fewer.different_lines == 2);
  CHECK(fewer.different_tokens == 8);  // the header, four spans, two EOL, END
  REQUIRE(fewer.first);
  CHECK(fewer.first->frame == 1);
  CHECK(fewer.first->b == "nothing");
}

TEST_CASE("configurations: tokens are compared unless a parameter that affects pixels is unlike") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const fs::path a = write(folder.path / "a.kage", c, {plain_frame(c)});
  Config lanes = c;
  lanes.lanes = 8;
  const StreamDiff by_lanes = diff(a, write(folder.path / "b.kage", lanes, {plain_frame(lanes, 10)}));
  CHECK_FALSE(by_lanes.same);
  CHECK(by_lanes.tokens_compared);
  CHECK(by_lanes.different_tokens == 1);
  REQUIRE(by_lanes.parameters.size() == 1);
  CHECK(by_lanes.parameters[0].name == "LANES");
  CHECK(by_lanes.parameters[0].b == 8);
  Config depth = c;
  depth.z_bits = 20;
  const StreamDiff by_depth = diff(a, write(folder.path / "b.kage", depth, {plain_frame(depth)}));
  CHECK_FALSE(by_depth.same);
  CHECK_FALSE(by_depth.tokens_compared);
  CHECK_FALSE(by_depth.first);
  CHECK_THAT(by_depth.reason, Catch::Matchers::ContainsSubstring("Z_BITS is 24 and 20"));
}

TEST_CASE("a section beside the frames makes streams different, and is named") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const fs::path a = write(folder.path / "a.kage", c, {plain_frame(c)}, R"({"scene": "a"})");
  const StreamDiff none = diff(a, write(folder.path / "b.kage", c, {plain_frame(c)}));
  CHECK_FALSE(none.same);
  CHECK(none.different_frames == 0);
  REQUIRE(none.sections.size() == 1);
  CHECK(none.sections[0].tag == "ORIG");
  CHECK(none.sections[0].how == "only in A");
  const StreamDiff other = diff(a, write(folder.path / "b.kage", c, {plain_frame(c)}, R"({"scene": "b"})"));
  REQUIRE(other.sections.size() == 1);
  CHECK(other.sections[0].how == "contents");
  CHECK(diff(a, write(folder.path / "b.kage", c, {plain_frame(c)}, R"({"scene": "a"})")).same);
}

TEST_CASE("a damaged stream is trouble, also in a frame that the other one lacks") {
  const TempFolder folder("stream-diff");
  const Config c = plain_config();
  const fs::path a = write(folder.path / "a.kage", c, {plain_frame(c)});
  const fs::path b = write(folder.path / "b.kage", c, {plain_frame(c), plain_frame(c, 9, 1)});
  const auto offset = [&] {
    const StreamFile file(b);
    return bytes_of(b).rfind("FRAM") + 16 + std::size_t{4} * kHeaderWords;
  }();
  std::fstream(b, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(offset))
      .put('\x66');
  CHECK_THROWS_WITH(diff(a, b), Catch::Matchers::ContainsSubstring("b.kage"));
  CHECK_THROWS_WITH(diff(b, a), Catch::Matchers::ContainsSubstring("b.kage"));
}

}  // namespace kage::verif
