// SPDX-License-Identifier: Apache-2.0
// Frames at the polygon level: random ones, sound and damaged, through the golden core and a plain reading of
// docs/stream.md.
#include <array>
#include <span>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "oracle/simple_core.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/polygon_frames.hpp"
#include "stimulus/random_frames.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

namespace kage::verif {
namespace {

using Words = std::vector<std::uint32_t>;

/// Any configuration with a front end, mostly of few polygons at once.
Config config_with_front_end(Random& random, int width) {
  Config c = random_config(random, width);
  c.active = random.chance(0.7) ? random.in(1, 12) : random.in(1, kGreatest.active);
  return c;
}

struct Outcome {
  FrameStatus status;
  std::vector<std::uint8_t> pixels;
};

Outcome golden(const Config& c, const Words& words, CoreObserver* observer = nullptr) {
  Outcome o;
  GoldenCore core(c);
  core.observe(observer);
  o.status = core.frame(
      words, [&](int, std::span<const std::uint8_t> p) { o.pixels.insert(o.pixels.end(), p.begin(), p.end()); });
  return o;
}

struct Reference : Outcome {
  bool loose = false;  // the contract leaves open what the frame shows
};

Reference reference(const Config& c, const Words& words) {
  Reference o;
  o.status = simple_core(c, words, o.pixels, &o.loose);
  return o;
}

PolygonStyle any_style(Random& random) {
  PolygonStyle style;
  style.spans.trees = 0.3;
  if (random.chance(0.3)) style.most_polygons = style.most_lines = 30;
  if (random.chance(0.2)) style.most_tokens = 0;
  return style;
}

}  // namespace

TEST_CASE("sound frames at the polygon level are taken, and show what a plain reading says") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::array<std::uint64_t, kKinds> tokens{};
  std::uint64_t made = 0;
  for (int round = 0; round < 1500; ++round) {
    const Config c = config_with_front_end(random, random.in(1, 200));
    const PolygonStyle style = any_style(random);
    Words words;
    const auto count = random_polygon_frame(random, c, random.in(1, 150), random.in(1, 40), words,
                                            static_cast<std::uint32_t>(round), style);
    for (std::size_t k = 0; k < kKinds; ++k) tokens[k] += count[k];
    CAPTURE(round, to_yaml(c));
    made += check_frame(c, words, "frame", 0).made;
    const Outcome a = golden(c, words);
    const Reference b = reference(c, words);
    REQUIRE(a.status.error == ErrorCode::NONE);
    REQUIRE_FALSE(b.loose);
    REQUIRE(a.status == b.status);
    REQUIRE(a.pixels == b.pixels);
  }
  for (const Kind kind : {Kind::AT, Kind::POLYGON, Kind::EDGE, Kind::GRADIENT, Kind::OP, Kind::SP, Kind::NC, Kind::TP,
                          Kind::SEG, Kind::TREE, Kind::SHADE, Kind::TABLE, Kind::FACE}) {
    CAPTURE(kKindNames[static_cast<std::size_t>(kind)]);
    CHECK(tokens[static_cast<std::size_t>(kind)] > 0);
  }
  CHECK(made > tokens[static_cast<std::size_t>(Kind::POLYGON)]);
}

TEST_CASE("frames at the polygon level as a port takes them show what a plain reading says") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int round = 0; round < 1500; ++round) {
    const Config c = config_with_front_end(random, random.in(1, 200));
    const Words words = sound_frame(random, c, static_cast<std::uint32_t>(round), Level::polygons);
    CAPTURE(round, to_yaml(c));
    const Outcome a = golden(c, words);
    const Reference b = reference(c, words);
    REQUIRE(a.status.error == ErrorCode::NONE);
    REQUIRE_FALSE(b.loose);
    REQUIRE(a.status == b.status);
    REQUIRE(a.pixels == b.pixels);
  }
}

TEST_CASE("damaged frames at the polygon level end with the status that a plain reading says") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  std::array<int, kErrorNames.size()> errors{};
  int open = 0;
  constexpr int kRounds = 4000;
  for (int round = 0; round < kRounds; ++round) {
    const Config c = config_with_front_end(random, random.in(1, 200));
    Words words = sound_frame(random, c, static_cast<std::uint32_t>(round), Level::polygons);
    if (round % 2 == 0)
      damage_polygons(random, c, words);
    else
      words = damaged_frame(random, c, static_cast<std::uint32_t>(round), Level::polygons);
    if (FrameHeader::read(words).height > 2000) continue;  // takes long, and shows no more
    CAPTURE(round, to_yaml(c));
    CoreObserver watched;  // made tokens become words
    const Outcome a = golden(c, words, round % 3 == 0 ? &watched : nullptr);
    const Reference b = reference(c, words);
    // Where an edge is not one that goes down through its line, which of the two spans is empty is open.
    if (b.loose) {
      ++open;
      continue;
    }
    REQUIRE(a.status.error == b.status.error);
    REQUIRE(a.status == b.status);
    REQUIRE(a.pixels == b.pixels);
    ++errors[static_cast<std::size_t>(a.status.error)];
  }
  CHECK(open < kRounds / 3);
  for (const ErrorCode code :
       {ErrorCode::NONE, ErrorCode::HEADER, ErrorCode::SIZE, ErrorCode::PARAMS, ErrorCode::KIND, ErrorCode::ORDER,
        ErrorCode::RANGE, ErrorCode::LINE, ErrorCode::LAST_EARLY, ErrorCode::PLACE, ErrorCode::ACTIVE_FULL}) {
    CAPTURE(kErrorNames[static_cast<std::size_t>(code)]);
    CHECK(errors[static_cast<std::size_t>(code)] > 0);
  }
}

TEST_CASE("a file takes no edge that does not go down through its line") {
  Config c;
  c.active = 4;
  const auto frame = [&](int top_y, int bottom_y) {
    Words words;
    TokenWriter w(c, words);
    w.header({.width = 16, .height = 2, .version = kPolygonVersion});
    w.at({}, 0);
    PolygonToken plane;
    plane.value = std::int64_t{1000} << kPlaneFrac;
    w.polygon(plane, {});
    for (const int side : {0, 1}) {
      PolygonToken edge;
      edge.side = side;
      edge.last = true;
      edge.top_x = edge.bottom_x = side * 8 * 256;
      edge.top_y = top_y;
      edge.bottom_y = bottom_y;
      w.edge(edge);
    }
    w.eol(0);
    w.eol(1);
    w.end();
    return words;
  };
  // The centre of line 0 is at 128; an end there is below it, a beginning is not.
  CHECK_NOTHROW(check_frame(c, frame(128, 129), "frame", 0));
  CHECK_NOTHROW(check_frame(c, frame(-8000, 600), "frame", 0));
  using Catch::Matchers::ContainsSubstring;
  const auto refuses = [&](int top_y, int bottom_y) {
    CHECK_THROWS_WITH(check_frame(c, frame(top_y, bottom_y), "frame", 0),
                      ContainsSubstring("the edge does not go down through the centre of the line"));
  };
  refuses(129, 600);
  refuses(0, 128);
  refuses(50, 50);
  refuses(300, 10);
}

TEST_CASE("a core without front end refuses a frame at the polygon level by its header") {
  Random random(test_seed(4));
  Config with;
  with.active = 8;
  Words words;
  random_polygon_frame(random, with, 20, 4, words);
  const Config without;  // the same pixel parameters
  CHECK(golden(with, words).status.error == ErrorCode::NONE);
  CHECK(golden(without, words).status.error == ErrorCode::HEADER);
  CHECK_THROWS_WITH(check_frame(without, words, "frame", 0), Catch::Matchers::ContainsSubstring("(HEADER)"));
}

TEST_CASE("the least ACTIVE that a frame needs is what the front end asks for") {
  Config c;
  for (int polygons = 1; polygons <= 9; ++polygons) {
    c.active = polygons;
    Words words;
    TokenWriter w(c, words);
    w.header({.width = 16, .height = 3, .version = kPolygonVersion});
    const auto polygon = [&](int rank, int y) {
      PolygonToken at;
      at.rank = rank;
      w.at(at, 0);
      PolygonToken plane;
      plane.value = std::int64_t{1000} << kPlaneFrac;
      w.polygon(plane, {});
      for (const int side : {0, 1}) {
        PolygonToken edge;
        edge.side = side;
        edge.last = true;
        edge.top_x = edge.bottom_x = side * 8 * 256;
        edge.top_y = y * 256;
        edge.bottom_y = (y + 2) * 256;
        w.edge(edge);
      }
    };
    for (int i = 0; i < polygons; ++i) polygon(2 * i, 0);
    w.eol(0);
    // On its last line a polygon leaves before those at later places come.
    for (int i = 0; i < polygons; ++i) polygon(2 * i + 1, 1);
    w.eol(1);
    w.eol(2);
    w.end();
    CHECK(golden(c, words).status.error == ErrorCode::NONE);
    c.active = polygons - 1;
    if (c.active == 0) continue;
    const FrameStatus status = golden(c, words).status;
    CHECK(status.error == ErrorCode::ACTIVE_FULL);
    CHECK(status.token == static_cast<std::uint32_t>(4 * polygons));  // the second EDGE of the polygon too many
  }
}

}  // namespace kage::verif
