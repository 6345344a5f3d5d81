// SPDX-License-Identifier: Apache-2.0
// The frames of the register check are sound, and part where they must, at the corners of every parameter and anywhere
// between.
#include "cosim/register_frames.hpp"

#include <cstdint>
#include <vector>

#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "stimulus/random.hpp"
#include "stimulus/small_configs.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

using namespace kage;
using namespace kage::cosim;
using namespace kage::verif;

namespace {

/// Every parameter at its least and at its greatest, the others small, without units and with some.
std::vector<SmallConfig> corners() {
  std::vector<SmallConfig> all;
  for (const int units : {0, 2})
    for (const ParamInfo& p : kParams)
      for (const int value : {p.min, p.max}) {
        const auto corner = [&](Config& c) {
          c.units = units;
          c.*(p.member) = value;
          for (const RuleInfo& rule : kRules)
            if (!rule.holds(c)) rule.repair(c);
        };
        all.push_back(small_config(std::string(p.name) + " " + std::to_string(value), corner));
        if (p.name != "BEAT_WORDS")
          all.push_back(
              small_config(std::string(p.name) + " " + std::to_string(value) + ", beats of 8", [&](Config& c) {
                c.beat_words = 8;
                corner(c);
              }));
      }
  return all;
}

/// The output that the first `words` words of a frame have brought: pixels of units, and lines.
class Given : public CoreObserver {
 public:
  Given(const Config& config, std::size_t words) : pixels(static_cast<std::size_t>(config.units)), left_(words) {}
  std::vector<int> pixels;
  int lines = 0;

 private:
  void header(std::span<const std::uint32_t> words, const LineView&) override { left_ -= words.size(); }
  void before(std::uint32_t, const Token& token, std::span<const std::uint32_t> words, const LineView&) override {
    if (words.size() > left_) left_ = 0;
    if (left_ == 0) return;
    left_ -= words.size();
    if (token.kind == Kind::EOL) ++lines;
    if (token.kind == Kind::SEG) pixels[static_cast<std::size_t>(token.segment.unit)] += token.segment.dx;
  }
  std::size_t left_;
};

/// The golden core takes it.
void check_sound(const Config& c, std::span<const std::uint32_t> words, int height, CoreObserver* observer = nullptr) {
  GoldenCore golden(c);
  if (observer != nullptr) golden.observe(observer);
  const FrameStatus status = golden.frame(words, [](int, std::span<const std::uint8_t>) {});
  CHECK(status.error == ErrorCode::NONE);
  CHECK(status.width == register_frame_width(c));
  CHECK(status.height == height);
}

/// It shows long before the last beat.
void check_error(const Config& c, const FrameInParts& f) {
  const FrameStatus status = GoldenCore(c).frame(f.words, [](int, std::span<const std::uint8_t>) {});
  CHECK(status.error == ErrorCode::LINE);
  CHECK(status.frame != 0);
  CHECK(status.line == 1);
  CHECK(status.token == 2);
  const auto beat = static_cast<std::size_t>(c.beat_words);
  CHECK(f.first % beat == 0);
  CHECK(f.first < f.words.size());
  CHECK(f.first >= kHeaderWords + 2 + 3 * beat);
}

void check(const Config& c) {
  CHECK(register_frame_width(c) <= c.max_width);
  const auto beat = static_cast<std::size_t>(c.beat_words);
  check_sound(c, one_line(c), 1);
  const FrameInParts lines = eight_lines(c);
  Given begun(c, lines.first);
  check_sound(c, lines.words, 8, &begun);
  CHECK(lines.first % beat == 0);
  CHECK(lines.first < lines.words.size());
  CHECK(lines.first >= kHeaderWords + beat);
  CHECK(lines.lines == begun.lines);
  check_error(c, early_error(c));
  if (c.units < 2) return;
  const FrameInParts f = unit_behind(c);
  Given given(c, f.first);
  check_sound(c, f.words, 2, &given);
  CHECK(f.first % beat == 0);
  CHECK(f.first + 1 < f.words.size());
  CHECK(given.pixels[0] >= register_frame_width(c));
  CHECK(given.pixels[1] < register_frame_width(c));
}

}  // namespace

TEST_CASE("the frames of the register check are sound at the corners of every parameter") {
  for (const auto& [name, config] : corners()) {
    CAPTURE(name);
    check(config);
  }
}

TEST_CASE("the frames of the register check are sound in any configuration") {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Config c = random_config(random, random.in(1, 40));
    CAPTURE(i, to_yaml(c));
    check(c);
  }
}
