// SPDX-License-Identifier: Apache-2.0
// The report page's part of a frame at the polygon level: the tokens of the span level, each with the index of the
// stream's token that it comes from.
#include "cosim/report/token_store.hpp"

#include <zlib.h>

#include <cstring>
#include <tuple>
#include <vector>

#include "contract/kinds.hpp"
#include "file/base64.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "stimulus/polygon_frames.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Words = std::vector<std::uint32_t>;

/// A token as the page is to have it: the index of the stream's, whether it was made, its text.
using Told = std::tuple<std::uint32_t, bool, std::string>;

/// The tokens that the golden core sees.
struct Observer : CoreObserver {
  explicit Observer(const Config& c) : config(c) {}
  void came(std::uint32_t, const Token&, std::span<const std::uint32_t> words) override { own = words.data(); }
  void before(std::uint32_t index, const Token& t, std::span<const std::uint32_t> words, const LineView&) override {
    told.emplace_back(index, words.data() != own, to_string(config, t));
  }
  Config config;
  const std::uint32_t* own = nullptr;
  std::vector<Told> told;
};

Words unpacked(const std::string& text) {
  const auto packed = scene::base64_decode(text);
  REQUIRE(packed);
  std::vector<std::uint8_t> bytes(std::size_t{1} << 20);
  uLongf size = bytes.size();
  REQUIRE(uncompress(bytes.data(), &size, packed->data(), static_cast<uLong>(packed->size())) == Z_OK);
  Words words(size / 4);
  for (std::size_t i = 0; i < size; ++i) words[i / 4] |= std::uint32_t{bytes[i]} << (i % 4 * 8);
  return words;
}

}  // namespace

TEST_CASE("of a frame at the polygon level the page has the spans, with the indices of the stream's tokens") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::size_t made = 0;
  for (int round = 0; round < 40; ++round) {
    Config c;
    c.active = random.in(1, 10);
    c.smooth = c.translucency = round % 2;
    c.units = round % 3;
    c.max_width = 70;
    Words words;
    random_polygon_frame(random, c, random.in(1, 70), random.in(1, 40), words);
    GoldenCore golden(c);
    Observer observer(c);
    golden.observe(&observer);
    REQUIRE(golden.frame(words, [](int, std::span<const std::uint8_t>) {}).error == ErrorCode::NONE);

    report::TokenStore store(c, std::size_t{1} << 30);
    store.begin(0);
    store.words(words);
    store.end();
    const Layout layout(c);
    std::vector<Told> told;
    for (const report::Band& band : store.bands()) {
      REQUIRE(band.indexed);
      const Words of_band = unpacked(store.text(band));
      std::uint32_t ahead = band.ahead;
      for (std::size_t at = 0; at < of_band.size();) {
        const std::uint32_t index = of_band[at++];
        const Token t = decode(c, layout, std::span(of_band).subspan(at));
        at += layout.words_of(of_band[at]);
        if (ahead > 0)
          --ahead;  // of an earlier band
        else
          told.emplace_back(index & ~report::kMade, (index & report::kMade) != 0, to_string(c, t));
      }
    }
    // Tokens that stay in the front end are counted by themselves, and each of the rest in its phase.
    std::uint64_t stay = 0;
    for (TokenWalk walk(layout, words); !walk.peek().empty();) {
      const Kind kind = kind_of(walk.next()[0], Level::polygons);
      stay += kind == Kind::AT || kind == Kind::POLYGON || kind == Kind::GRADIENT || kind == Kind::EDGE ? 1 : 0;
    }
    const PhaseSums& phases = store.frames().front().phases;
    REQUIRE(phases.of[static_cast<std::size_t>(Phase::polygons)].tokens == stay);
    REQUIRE(phases.of[static_cast<std::size_t>(Phase::polygons)].clocks == 0);
    std::uint64_t tokens = 0;
    for (const PhaseSums::Sum& sum : phases.of) tokens += sum.tokens;
    REQUIRE(tokens == stay + observer.told.size());
    // Behind the last line comes END alone, which does nothing.
    if (told.size() + 1 == observer.told.size()) observer.told.pop_back();
    REQUIRE(told == observer.told);
    for (const Told& t : told) made += std::get<1>(t) ? 1 : 0;
  }
  CHECK(made > 500);
}

}  // namespace kage::verif
