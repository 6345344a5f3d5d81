// SPDX-License-Identifier: Apache-2.0
// The C interface of the golden core: the same as GoldenCore by itself, word by word or in one piece; errors of calls
// and of frames.
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/golden.h"
#include "kage/stream.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"
#include "test/support/catch.hpp"

namespace {

using Words = std::vector<std::uint32_t>;

/// A frame with shadows: two lines of 8 pixels.
Words frame_of(const kage::Config& config) {
  Words words;
  kage::TokenWriter w(config, words);
  w.header({8, 2, 0x112233, 7});
  w.shade(128);
  const std::int64_t one = std::int64_t{1} << config.z_frac;
  kage::SpanToken near;
  near.xl = 2;
  near.xr = 6;
  near.z = 100 * one;
  near.normal_class = 1;
  near.color = {200, 100, 50};
  kage::SpanToken shadow;
  shadow.xl = 3;
  shadow.xr = 8;
  shadow.z = 50 * one;
  shadow.w = 1;
  w.op(near);
  w.sp(shadow);
  w.ev(0, 8);
  w.resolve();
  w.eol(0);
  w.eol(1);
  w.end();
  return words;
}

struct Core {
  explicit Core(const char* parameters = "{}") : p(kage_golden_create_parameters(parameters)) { REQUIRE(p != nullptr); }
  ~Core() { kage_golden_destroy(p); }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;
  operator kage_golden*() const { return p; }  // NOLINT(google-explicit-constructor)
  kage_golden* p;
};

int feed_to(kage_golden* core, const Words& words, int kind) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (kage_golden_word(core, words[i]) == KAGE_GOLDEN_TOKEN && kage_golden_token_kind(core) == kind)
      return static_cast<int>(i);
  return -1;
}

void collect(void* user, int y, const unsigned char* pixels, int bytes) {
  auto& lines = *static_cast<std::vector<std::vector<std::uint8_t>>*>(user);
  REQUIRE(y == static_cast<int>(lines.size()));
  lines.emplace_back(pixels, pixels + bytes);
}

}  // namespace

TEST_CASE("a pixel's state after each token") {
  const kage::Config config;
  const Words words = frame_of(config);
  Core core;
  REQUIRE(kage_golden_abi() == KAGE_GOLDEN_ABI);
  REQUIRE(kage_golden_parameter(core, "Z_BITS") == config.z_bits);
  REQUIRE(kage_golden_pixel(core, 0, KAGE_PIXEL_Z) == KAGE_PIXEL_ABSENT);
  REQUIRE(kage_golden_token_index(core) == -1);

  REQUIRE(feed_to(core, words, KAGE_KIND_HEADER) == 4);
  REQUIRE(kage_golden_width(core) == 8);
  REQUIRE(kage_golden_height(core) == 2);
  REQUIRE(kage_golden_background(core) == 0x112233);
  REQUIRE(std::string(kage_golden_token_text(core)) == "header 8x2");
  REQUIRE(kage_golden_token_words(core) == 5);
  REQUIRE(kage_golden_token_word(core, 1) == words[1]);
  REQUIRE(kage_golden_token_word(core, 5) == 0);

  Words rest(words.begin() + 5, words.end());
  const auto go_on = [&](int kind) {
    const int at = feed_to(core, rest, kind);
    REQUIRE(at >= 0);
    rest.erase(rest.begin(), rest.begin() + at + 1);
  };
  const auto pixel = [&](int x, int field) { return kage_golden_pixel(core, x, field); };
  go_on(KAGE_KIND_OP);
  REQUIRE(kage_golden_token_index(core) == 2);
  REQUIRE(kage_golden_token_field(core, KAGE_TOKEN_XL) == 2);
  REQUIRE(kage_golden_token_field(core, KAGE_TOKEN_Z) == std::int64_t{100} << config.z_frac);
  REQUIRE(kage_golden_token_field(core, KAGE_TOKEN_COLOR + 1) == 100);
  REQUIRE(kage_golden_token_field(core, KAGE_TOKEN_FIELDS) == 0);
  REQUIRE(pixel(2, KAGE_PIXEL_Z) == 100);
  REQUIRE(pixel(1, KAGE_PIXEL_Z) == (1 << config.z_bits) - 1);
  REQUIRE(pixel(1, KAGE_PIXEL_COLOR) == KAGE_PIXEL_ANY);
  REQUIRE(pixel(1, KAGE_PIXEL_CLASS) == KAGE_PIXEL_ANY);
  REQUIRE(pixel(5, KAGE_PIXEL_COLOR + 2) == 50);
  REQUIRE(pixel(5, KAGE_PIXEL_CLASS) == 1);
  REQUIRE(pixel(5, KAGE_PIXEL_COUNT) == KAGE_PIXEL_ABSENT);
  for (const int x : {-1, 8}) REQUIRE(pixel(x, KAGE_PIXEL_Z) == KAGE_PIXEL_ABSENT);
  for (const int field : {-1, static_cast<int>(KAGE_PIXEL_FIELDS)}) {
    REQUIRE(pixel(0, field) == KAGE_PIXEL_ABSENT);
    REQUIRE(std::string(kage_golden_pixel_name(field)).empty());
  }
  go_on(KAGE_KIND_SP);
  REQUIRE(pixel(3, KAGE_PIXEL_DSF) == 1);
  REQUIRE(pixel(7, KAGE_PIXEL_DSF) == 1);
  REQUIRE(pixel(2, KAGE_PIXEL_DSF) == 0);
  go_on(KAGE_KIND_EV);
  REQUIRE(pixel(3, KAGE_PIXEL_FSF) == 1);
  REQUIRE(pixel(3, KAGE_PIXEL_DSF) == 0);
  go_on(KAGE_KIND_RESOLVE);  // clears the flags
  REQUIRE(pixel(3, KAGE_PIXEL_FSF) == 0);
  REQUIRE(pixel(3, KAGE_PIXEL_COLOR) == 100);
  REQUIRE(pixel(2, KAGE_PIXEL_COLOR) == 200);
  REQUIRE(kage_golden_out_line(core) == -1);
  go_on(KAGE_KIND_EOL);
  REQUIRE(kage_golden_line(core) == 1);
  REQUIRE(kage_golden_out_line(core) == 0);
  REQUIRE(kage_golden_out(core, 3, 0) == 100);
  REQUIRE(kage_golden_out(core, 0, 0) == 0x33);
  REQUIRE(kage_golden_out(core, 8, 0) == -1);
  REQUIRE(kage_golden_out(core, 0, 3) == -1);
  REQUIRE(pixel(3, KAGE_PIXEL_Z) == (1 << config.z_bits) - 1);
  go_on(KAGE_KIND_EOL);
  REQUIRE(kage_golden_word(core, rest.at(0)) == KAGE_GOLDEN_END);
  REQUIRE(kage_golden_token_kind(core) == KAGE_KIND_END);
  REQUIRE(kage_golden_word(core, 0) == KAGE_GOLDEN_END);  // fill
  REQUIRE(kage_golden_pixel(core, 0, KAGE_PIXEL_Z) == KAGE_PIXEL_ABSENT);
}

TEST_CASE("at the polygon level the stream's tokens are at hand, and what each has come to") {
  /// The outcome of each token, by GoldenCore itself.
  struct Observer : kage::CoreObserver {
    explicit Observer(const kage::Config& c) : config(c) {}
    void came(std::uint32_t index, const kage::Token& t, std::span<const std::uint32_t>) override {
      REQUIRE(index == texts.size() + 1);
      texts.push_back({kage::to_string(config, t)});
    }
    void before(std::uint32_t index, const kage::Token& t, std::span<const std::uint32_t>,
                const kage::LineView&) override {
      REQUIRE(index == texts.size());
      texts.back().push_back(kage::to_string(config, t));
    }
    kage::Config config;
    std::vector<std::vector<std::string>> texts;
  };
  kage::verif::Random random(kage::verif::test_seed(7));
  CAPTURE(kage::verif::test_seed(7));
  std::size_t made = 0;
  for (int round = 0; round < 30; ++round) {
    kage::Config config;
    config.active = random.in(1, 9);
    config.translucency = config.smooth = round % 2;
    config.max_width = 60;
    Words words;
    kage::verif::random_polygon_frame(random, config, random.in(1, 60), random.in(1, 8), words);
    kage::GoldenCore golden(config);
    Observer observer(config);
    golden.observe(&observer);
    REQUIRE(golden.frame(words, [](int, std::span<const std::uint8_t>) {}).error == kage::ErrorCode::NONE);
    const Core core(kage::to_yaml(config).c_str());
    std::size_t index = 0;
    for (const std::uint32_t word : words) {
      const int result = kage_golden_word(core, word);
      REQUIRE(result != KAGE_GOLDEN_FAILED);
      if (result == KAGE_GOLDEN_MORE || kage_golden_token_index(core) == 0) continue;
      REQUIRE(index < observer.texts.size());
      const std::vector<std::string>& expected = observer.texts[index++];
      REQUIRE(kage_golden_token_index(core) == static_cast<int>(index));
      REQUIRE(kage_golden_token_text(core) == expected[0]);
      const int kind = kage_golden_token_kind(core);
      REQUIRE(kage_golden_made(core) == static_cast<int>(expected.size()) - 1);
      for (int i = 0; i < kage_golden_made(core); ++i) {
        REQUIRE(kage_golden_choose_made(core, i) == 0);
        REQUIRE(kage_golden_token_text(core) == expected[static_cast<std::size_t>(i) + 1]);
        REQUIRE(kage_golden_token_kind(core) < KAGE_KIND_GRADIENT);
        REQUIRE(kage_golden_token_words(core) > 0);
        ++made;
      }
      REQUIRE(kage_golden_choose_made(core, kage_golden_made(core)) == KAGE_GOLDEN_ERROR);
      REQUIRE(kage_golden_choose_made(core, -2) == KAGE_GOLDEN_ERROR);
      REQUIRE(kage_golden_choose_made(core, -1) == 0);
      REQUIRE(kage_golden_token_kind(core) == kind);
    }
    REQUIRE(index == observer.texts.size());
    REQUIRE(kage_golden_finish(core) == 0);
  }
  CHECK(made > 100);
  CHECK(kage_golden_made(nullptr) == 0);
  CHECK(kage_golden_choose_made(nullptr, 0) == KAGE_GOLDEN_ERROR);
}

TEST_CASE("lines, words in one piece, and the status are GoldenCore's, of damaged frames too") {
  for (const auto& [name, config] : kage::named_configs()) {
    kage::verif::Random random(kage::verif::test_seed());
    for (int round = 0; round < 20; ++round) {
      CAPTURE(name, round, kage::verif::test_seed());
      Words words;
      kage::verif::random_frame(random, config, random.in(1, 60), random.in(1, 5), words);
      if (round % 2 == 1) kage::verif::damage(random, words);
      std::vector<std::vector<std::uint8_t>> expected, whole, single;
      kage::GoldenCore golden(config);
      const kage::FrameStatus status = golden.frame(words, [&](int, std::span<const std::uint8_t> pixels) {
        expected.emplace_back(pixels.begin(), pixels.end());
      });
      const Core core(kage::to_yaml(config).c_str());
      const auto check = [&](const std::vector<std::vector<std::uint8_t>>& lines) {
        REQUIRE(kage_golden_finish(core) == static_cast<int>(status.error));
        REQUIRE(lines == expected);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_ERROR) == static_cast<int>(status.error));
        REQUIRE(kage_golden_status(core, KAGE_STATUS_FRAME) == status.frame);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_LINE) == status.line);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_TOKEN) == status.token);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_UNIT) == status.unit);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_WIDTH) == status.width);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_HEIGHT) == status.height);
        REQUIRE(kage_golden_status(core, KAGE_STATUS_FIELDS) == -1);
        const std::string text = kage_golden_status_text(core);
        REQUIRE((text == "no error") == (status.error == kage::ErrorCode::NONE));
      };
      kage_golden_on_line(core, collect, &whole);
      REQUIRE(kage_golden_feed(core, words.data(), static_cast<int>(words.size())) != KAGE_GOLDEN_ERROR);
      check(whole);
      kage_golden_on_line(core, collect, &single);
      for (const std::uint32_t word : words) REQUIRE(kage_golden_word(core, word) != KAGE_GOLDEN_ERROR);
      check(single);
    }
  }
}

TEST_CASE("what cannot be done says why and changes nothing") {
  REQUIRE(kage_golden_create("nonsense") == nullptr);
  REQUIRE(std::string(kage_golden_error(nullptr)).find("nonsense: no such file") == 0);
  REQUIRE(kage_golden_create(nullptr) == nullptr);
  REQUIRE(std::string(kage_golden_error(nullptr)) == "no configuration given");
  REQUIRE(kage_golden_create_parameters("{Z_BITS: 40}") == nullptr);
  REQUIRE(std::string(kage_golden_error(nullptr)) == "parameters: Z_BITS is 40, legal are 4 .. 28");
  REQUIRE(kage_golden_create_parameters("{Z_BITS: ") == nullptr);
  std::thread([] { REQUIRE(std::string(kage_golden_error(nullptr)).empty()); }).join();
  kage_golden_destroy(nullptr);

  Core core;
  const auto refused = [&](int result, const std::string& why) {
    REQUIRE(result == KAGE_GOLDEN_ERROR);
    REQUIRE(std::string(kage_golden_error(core)) == why);
  };
  refused(kage_golden_parameter(core, "DEPTH"), "DEPTH: no such parameter");
  refused(kage_golden_parameter(core, nullptr), "no parameter given");
  refused(kage_golden_feed(core, nullptr, 3), "3 words cannot be given");
  refused(kage_golden_feed(core, nullptr, -1), "-1 words cannot be given");
  refused(kage_golden_frame(core, 0), "no stream file is open");
  refused(kage_golden_next(core), "no frame of a stream file is at hand");
  REQUIRE(kage_golden_open(core, "nowhere.kage") == KAGE_GOLDEN_ERROR);
  REQUIRE(kage_golden_feed(core, nullptr, 0) == KAGE_GOLDEN_MORE);
  REQUIRE(std::string(kage_golden_error(core)).empty());
}

TEST_CASE("a stream file, token by token") {
  const kage::Config config;
  const std::string path = "golden_c.kage";
  {
    kage::StreamFileWriter file(path, config);
    file.frame(frame_of(config));
    file.frame(frame_of(config));
    file.finish();
  }
  kage_golden* core = kage_golden_create(path.c_str());
  REQUIRE(core != nullptr);
  REQUIRE(kage_golden_open(core, path.c_str()) == 2);
  REQUIRE(kage_golden_frame(core, 2) == KAGE_GOLDEN_ERROR);
  REQUIRE(std::string(kage_golden_error(core)) == "frame 2: the file has 2");
  for (const int frame : {1, 0}) {
    REQUIRE(kage_golden_frame(core, frame) == 0);
    REQUIRE(kage_golden_next(core) == KAGE_GOLDEN_TOKEN);
    REQUIRE(kage_golden_frame(core, frame) == 0);  // from its header again
    std::vector<int> kinds;
    while (kage_golden_next(core) == KAGE_GOLDEN_TOKEN) kinds.push_back(kage_golden_token_kind(core));
    REQUIRE(kinds == std::vector<int>{0, 1, 6, 7, 10, 12, 14, 14});
    REQUIRE(kage_golden_next(core) == KAGE_GOLDEN_END);
    REQUIRE(kage_golden_finish(core) == 0);
  }
  kage_golden_destroy(core);
  Core other("{Z_BITS: 20}");
  REQUIRE(kage_golden_open(other, path.c_str()) == KAGE_GOLDEN_ERROR);
  REQUIRE(std::string(kage_golden_error(other)) == path + ": its pixel parameters are not this core's");
  REQUIRE(std::remove(path.c_str()) == 0);
}

TEST_CASE("no core at all is an error, not a crash") {
  // A chandle of DPI-C is null until a create has been called, and after one that failed.
  REQUIRE(kage_golden_create("no such configuration") == nullptr);
  const std::string why = kage_golden_error(nullptr);
  CHECK(why.find("no such configuration") != std::string::npos);
  const unsigned word = 0;
  CHECK(kage_golden_parameter(nullptr, "Z_BITS") == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_word(nullptr, 0) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_feed(nullptr, &word, 1) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_finish(nullptr) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_open(nullptr, "x.kage") == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_frame(nullptr, 0) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_next(nullptr) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_token_kind(nullptr) == KAGE_GOLDEN_ERROR);
  CHECK(kage_golden_token_index(nullptr) == -1);
  CHECK(kage_golden_token_words(nullptr) == 0);
  CHECK(kage_golden_token_word(nullptr, 0) == 0);
  CHECK(kage_golden_token_field(nullptr, KAGE_TOKEN_XL) == 0);
  CHECK(std::string(kage_golden_token_text(nullptr)).empty());
  CHECK(kage_golden_width(nullptr) == 0);
  CHECK(kage_golden_height(nullptr) == 0);
  CHECK(kage_golden_line(nullptr) == 0);
  CHECK(kage_golden_bias(nullptr) == 0);
  CHECK(kage_golden_background(nullptr) == 0);
  CHECK(kage_golden_pixel(nullptr, 0, KAGE_PIXEL_Z) == KAGE_PIXEL_ABSENT);
  CHECK(kage_golden_out_line(nullptr) == -1);
  CHECK(kage_golden_out(nullptr, 0, 0) == -1);
  CHECK(kage_golden_status(nullptr, 0) == -1);
  CHECK(std::string(kage_golden_status_text(nullptr)).empty());
  kage_golden_on_line(nullptr, nullptr, nullptr);
  kage_golden_destroy(nullptr);
  CHECK(kage_golden_error(nullptr) == why);
}
