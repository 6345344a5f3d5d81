// SPDX-License-Identifier: Apache-2.0
// The history of a pixel: it ends in the colour that the golden core gives, its states follow from each other, and its
// words say what they show. Random frames of random configurations, and frames made by hand.
#include "kage/explain.hpp"

#include "catch.hpp"
#include "kage/error.hpp"
#include "support/configs.hpp"
#include "support/streams.hpp"

namespace kage::verif {
namespace {

TEST_CASE("histories of random pixels are whole, and end as the golden core does") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::size_t touches = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    const Config c = random_config(random, 64);
    std::vector<std::uint32_t> words;
    random_frame(random, c, random.in(1, c.max_width), random.in(1, 5), words);
    std::vector<std::vector<std::uint8_t>> lines;
    GoldenCore core(c);
    const FrameStatus status =
        core.frame(words, [&](int, std::span<const std::uint8_t> p) { lines.emplace_back(p.begin(), p.end()); });
    const int x = random.in(0, status.width - 1);
    const int y = random.in(0, status.height - 1);
    const PixelHistory h = explain_pixel(c, words, x, y);
    CHECK(h.status == status);
    const auto channels = static_cast<std::size_t>(c.channels);
    for (std::size_t k = 0; k < channels; ++k)
      CHECK(h.color[k] == lines[static_cast<std::size_t>(y)][static_cast<std::size_t>(x) * channels + k]);
    CHECK(h.color_text.find(std::to_string(h.color[0])) != std::string::npos);
    const std::uint32_t clear = (1U << c.z_bits) - 1U;
    PixelState now;
    now.z = clear;
    for (const PixelTouch& t : h.touches) {
      ++touches;
      CAPTURE(t.token, t.text, t.effect);
      CHECK_FALSE(t.effect.empty());
      // A line's first TP gives clear pixels the background's colour, wherever it is.
      if (now.z == clear && t.before.z == clear) now.color = t.before.color;
      CHECK(t.before == now);
      now = t.after;
      if (!t.z || t.what.kind == Kind::TREE) continue;
      const bool front = *t.z < t.before.z;
      CHECK((t.effect.rfind("hidden", 0) == 0 || t.effect.rfind("not counted", 0) == 0) == !front);
      if (t.what.kind == Kind::OP) CHECK(t.after.z == (front ? *t.z : t.before.z));
    }
  }
  CHECK(touches > 1000);
}

TEST_CASE("a pixel that the frame lacks is an error that says so") {
  const Config c;
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({4, 2, 0, 0});
  w.eol(0);
  w.eol(1);
  w.end();
  CHECK_THROWS_AS(explain_pixel(c, words, 4, 0), Error);
  CHECK_THROWS_AS(explain_pixel(c, words, 0, 2), Error);
  CHECK(explain_pixel(c, words, 3, 1).touches.empty());
}

}  // namespace
}  // namespace kage::verif
