// SPDX-License-Identifier: Apache-2.0
// Which files a run writes, and when. No RTL is run: a second golden core is the actual one, which may be made wrong.
#include "cosim/run.hpp"

#include <filesystem>
#include <vector>

#include "kage/config.hpp"
#include "kage/image.hpp"
#include "kage/stream.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"
#include "test/support/wrong_core.hpp"

using namespace kage;
using namespace kage::cosim;

namespace {

namespace fs = std::filesystem;

const Config& config() {
  static const Config c = load_config("tiny").config;
  return c;
}

/// Three lines of background, which is the frame's number.
TokenCounts frame_of(int frame, const WordSink& sink) {
  std::vector<std::uint32_t> words;
  TokenWriter out(config(), words);
  out.header({4, 3, static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(frame)});
  for (int y = 0; y < 3; ++y) out.eol(y);
  out.end();
  sink(words);
  return {};
}

}  // namespace

TEST_CASE("where only a difference has pictures, no other frame writes a file, not even one for a while") {
  for (const bool two_threads : {false, true}) {
    const test::TempDirectory folder;
    const auto golden = make_golden(config());
    verif::WrongCore wrong(config(), 5);
    RunOptions options;
    options.out = folder.path();
    options.all_pictures = false;
    options.two_threads = two_threads;
    int same = 0;
    bool any = false;
    options.same = [&](const FrameResult&) {
      ++same;
      any = any || !fs::is_empty(folder.path());
    };
    const Report report = run(8, frame_of, *golden, wrong, options);
    CHECK(same == 5);
    CHECK_FALSE(any);
    REQUIRE(report.first_difference);
    CHECK(report.first_difference->frame == 5);
    REQUIRE(report.pictures.size() == 4);
    const Image expected = load_image(folder.path() / "frame_0005_expected.png");
    CHECK(expected.width == 4);
    CHECK(expected.height == 3);
    CHECK(load_image(folder.path() / "frame_0005.png").data == expected.data);
    Image actual = load_image(folder.path() / "frame_0005_actual.png");
    CHECK(actual.data != expected.data);
    for (int y = 0; y < 3; ++y) actual.data[actual.index(0, y)] ^= 1U;
    CHECK(actual.data == expected.data);
  }
}

TEST_CASE("every frame has its picture where all are wanted") {
  const test::TempDirectory folder;
  const auto golden = make_golden(config());
  const auto actual = make_golden(config());
  RunOptions options;
  options.out = folder.path();
  CHECK(run(3, frame_of, *golden, *actual, options).same);
  for (const char* name : {"frame_0000.png", "frame_0001.png", "frame_0002.png"})
    CHECK(load_image(folder.path() / name).height == 3);
}
