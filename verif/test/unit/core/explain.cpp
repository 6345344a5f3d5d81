// SPDX-License-Identifier: Apache-2.0
// The history of a pixel: it ends in the colour that the golden core gives, its states follow from each other, and its
// words say what they show. Random frames of random configurations, and frames made by hand.
#include "kage/explain.hpp"

#include "kage/error.hpp"
#include "stimulus/frames.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

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
      // It has linear light displayed, and then nobody asks for counters and flags.
      if (c.linear_bits > 0 && (t.what.kind == Kind::TP || t.what.kind == Kind::EOL) && t.before.dsf == 0 &&
          t.before.fsf == 0 && t.before.counts == decltype(t.before.counts){})
        now = t.before;
      CHECK(t.before == now);
      now = t.after;
      if (!t.z || t.what.kind == Kind::TREE) continue;
      const bool light = t.effect.rfind("lit", 0) == 0 || t.effect.rfind("in shadow: light", 0) == 0;
      if (c.linear_bits > 0 && (light || t.before.served != t.after.served || t.effect.rfind("a span", 0) == 0 ||
                                t.effect == "nothing is drawn here")) {
        CHECK(t.after.z == t.before.z);
        CHECK((!light || *t.z <= t.before.z));
        continue;
      }
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

TEST_CASE("an end of a light sample tells whether the pixel is in shadow, even where its count is full") {
  Config c;
  c.fsf = 0;
  c.dsf_bits = 2;
  c.count_bits = 1;
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({4, 1, 0, 0});
  w.op({.xr = 4, .z = 100LL << c.z_frac, .normal_class = 1});
  for (int sample = 0; sample < 3; ++sample) {
    if (sample < 2)
      w.nc(0, 2, 1);
    else
      w.nc(2, 4, 1);
    w.es(0, 4, 0);
  }
  w.resolve();
  w.eol(0);
  w.end();
  const auto told = [&](int x) {
    std::vector<std::string> effects;
    for (const PixelTouch& t : explain_pixel(c, words, x, 0).touches)
      if (t.what.kind == Kind::ES) effects.push_back(t.effect);
    return effects;
  };
  CHECK(told(1) == std::vector<std::string>{"end of a sample of light 0: in shadow; count 1",
                                            "end of a sample of light 0: in shadow; count 1",
                                            "end of a sample of light 0: not in shadow; count 1"});
  CHECK(told(3) == std::vector<std::string>{"end of a sample of light 0: not in shadow; count 0",
                                            "end of a sample of light 0: not in shadow; count 0",
                                            "end of a sample of light 0: in shadow; count 1"});
}

}  // namespace
}  // namespace kage::verif
