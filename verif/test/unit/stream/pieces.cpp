// SPDX-License-Identifier: Apache-2.0
// A frame may come in pieces of any size: to the golden core, to the check, to a file. Nothing may depend on the cuts.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "oracle/simple_core.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

namespace kage::verif {
namespace {

using Words = std::vector<std::uint32_t>;

/// Hand `words` to `take` in pieces, some of them empty.
template <class Take>
void in_pieces(Random& random, const Words& words, Take take) {
  const int longest = random.chance(0.3) ? 1 : random.in(1, 40);
  for (std::size_t at = 0; at < words.size();) {
    const auto n = std::min(static_cast<std::size_t>(random.in(0, longest)), words.size() - at);
    const Words piece(words.begin() + static_cast<std::ptrdiff_t>(at),
                      words.begin() + static_cast<std::ptrdiff_t>(at + n));  // gone after the call
    take(std::span(piece));
    at += n;
  }
}

std::string bytes_of(const std::filesystem::path& p) {
  std::ifstream in(p, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("the golden core makes the same of a frame however it is cut, one frame after the other") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::array<int, kErrorNames.size()> errors{};
  for (int round = 0; round < 400; ++round) {
    const Config c = random_config(random, 200);
    GoldenCore core(c);
    for (std::uint32_t number = 0; number < 4; ++number) {
      Words words;
      const int width = random.in(1, 150);
      const int height = random.in(1, 5);
      if (c.active > 0 && random.chance(0.5))
        random_polygon_frame(random, c, width, height, words, number);
      else
        random_frame(random, c, width, height, words, number);
      if (random.chance(0.6)) damage(random, words);
      if (random.chance(0.4)) damage_polygons(random, c, words);
      CAPTURE(round, number, to_yaml(c));
      std::vector<std::uint8_t> pixels;
      int lines = 0;
      const LineSink sink = [&](int y, std::span<const std::uint8_t> p) {
        REQUIRE(y == lines++);
        pixels.insert(pixels.end(), p.begin(), p.end());
      };
      in_pieces(random, words, [&](std::span<const std::uint32_t> piece) { core.feed(piece, sink); });
      const FrameStatus a = core.finish(sink);
      std::vector<std::uint8_t> plain;
      bool loose = false;
      const FrameStatus b = simple_core(c, words, plain, &loose);
      if (loose) continue;  // docs/stream.md leaves open what a damaged edge shows
      REQUIRE(a.error == b.error);
      REQUIRE(a == b);
      REQUIRE(lines == a.height);
      REQUIRE(pixels == plain);
      ++errors[static_cast<std::size_t>(a.error)];
    }
  }
  for (std::size_t e = 0; e < kErrorNames.size(); ++e) {
    CAPTURE(kErrorNames[e]);
    CHECK(errors[e] > 0);
  }
}

TEST_CASE("a line leaves the golden core as soon as its EOL is there") {
  const Config c;
  Words words;
  TokenWriter writer(c, words);
  GoldenCore core(c);
  int lines = 0;
  const LineSink sink = [&](int, std::span<const std::uint8_t>) { ++lines; };
  const auto flow = [&] {
    core.feed(words, sink);
    words.clear();
  };
  writer.header({64, 3, 0, 0});
  flow();
  CHECK(lines == 0);
  for (int y = 0; y < 3; ++y) {
    writer.eol(y);
    flow();
    CHECK(lines == y + 1);
  }
  writer.end();
  flow();
  CHECK(core.finish(sink).error == ErrorCode::NONE);
}

TEST_CASE("the check finds the same counts and the same faults however a frame is cut") {
  Random random(test_seed());
  CAPTURE(test_seed());
  int sound = 0;
  int faulty = 0;
  for (int round = 0; round < 1000; ++round) {
    const Config c = random_config(random, 200);
    Words words;
    random_frame(random, c, random.in(1, 150), random.in(1, 5), words, static_cast<std::uint32_t>(round));
    if (random.chance(0.6)) damage(random, words);
    CAPTURE(round, to_yaml(c));
    std::string whole;
    std::string cut;
    TokenCounts a;
    TokenCounts b;
    try {
      a = check_frame(c, words, "x", 24);
    } catch (const Error& e) {
      whole = e.what();
    }
    try {
      FrameChecker checker(c, "x", 24);
      in_pieces(random, words, [&](std::span<const std::uint32_t> piece) { checker.feed(piece); });
      b = checker.finish();
    } catch (const Error& e) {
      cut = e.what();
    }
    REQUIRE(whole == cut);
    REQUIRE(a.of_kind == b.of_kind);
    REQUIRE(a.words == b.words);
    REQUIRE(a.span_pixels == b.span_pixels);
    ++(whole.empty() ? sound : faulty);
  }
  CHECK(sound > 100);
  CHECK(faulty > 100);
}

TEST_CASE("a stream file has the same bytes however its frames were cut") {
  const auto dir = std::filesystem::temp_directory_path() / ("kage-pieces-" + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  Random random(test_seed());
  const Config c;
  {
    StreamFileWriter whole(dir / "whole.kage", c);
    StreamFileWriter cut(dir / "cut.kage", c);
    for (std::uint32_t i = 0; i < 5; ++i) {
      Words words;
      random_frame(random, c, 50, random.in(1, 9), words, i);
      whole.frame(words);
      cut.begin_frame();
      in_pieces(random, words, [&](std::span<const std::uint32_t> piece) { cut.words(piece); });
      cut.end_frame();
    }
    whole.finish();
    cut.finish();
  }
  CHECK(bytes_of(dir / "whole.kage").size() > 1000);
  CHECK(bytes_of(dir / "whole.kage") == bytes_of(dir / "cut.kage"));
  CHECK_NOTHROW(StreamFile(dir / "cut.kage").frame(4));
  std::filesystem::remove_all(dir);
}

}  // namespace kage::verif
