// SPDX-License-Identifier: Apache-2.0
// The comparison of cores, tried with cores that lie: it must say where.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "catch.hpp"
#include "cosim/compare.hpp"
#include "cosim/run.hpp"

namespace fs = std::filesystem;
using namespace kage;
using namespace kage::cosim;

namespace {

/// Draws a pattern that depends on the frame number, the first word; `spoil` may change what it made.
class FakeCore : public Core {
 public:
  explicit FakeCore(std::function<void(std::uint32_t frame, FrameResult&)> spoil = {}) : spoil_(std::move(spoil)) {}

  FrameResult frame(std::span<const std::uint32_t> words) override {
    FrameResult r;
    r.image = Image(8, 6, 3);
    for (std::size_t i = 0; i < r.image.data.size(); ++i) r.image.data[i] = static_cast<std::uint8_t>(i + words[0]);
    r.status.width = 8;
    r.status.height = 6;
    r.cycles = 100;
    if (spoil_) spoil_(words[0], r);
    return r;
  }

 private:
  std::function<void(std::uint32_t, FrameResult&)> spoil_;
};

std::uint32_t word;
std::span<const std::uint32_t> feed(int index) {
  word = static_cast<std::uint32_t>(index);
  return {&word, 1};
}

}  // namespace

TEST_CASE("cores that agree are the same, with one thread and with two") {
  for (const bool two_threads : {false, true}) {
    FakeCore a;
    FakeCore b;
    RunOptions options;
    options.two_threads = two_threads;
    const Report r = run(5, feed, a, b, options);
    CHECK(r.same);
    CHECK(r.frames == 5);
    CHECK(r.pixels_compared == 240);
    CHECK(r.cycles == 500);
    CHECK_FALSE(r.first_difference);
  }
}

TEST_CASE("a single bit is found at its frame, line, x and channel, with pictures") {
  const fs::path folder = fs::temp_directory_path() / ("kage-cosim-" + std::to_string(getpid()));
  fs::create_directories(folder);
  FakeCore good;
  FakeCore bad([](std::uint32_t frame, FrameResult& r) {
    if (frame != 2) return;
    r.image.data[r.image.index(5, 3) + 1] ^= 1;
    r.image.data[r.image.index(0, 4)] ^= 1;
  });
  RunOptions options;
  options.out = folder;
  const Report r = run(5, feed, good, bad, options);
  CHECK_FALSE(r.same);
  CHECK(r.frames == 3);
  REQUIRE(r.first_difference);
  CHECK(r.first_difference->frame == 2);
  CHECK(r.first_difference->line == 3);
  CHECK(r.first_difference->x == 5);
  CHECK(r.first_difference->field == "green");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  CHECK(names == std::set<std::string>{"frame_0000.png", "frame_0001.png", "frame_0002.png", "frame_0002_actual.png",
                                       "frame_0002_difference.png", "frame_0002_expected.png"});
  fs::remove_all(folder);
}

TEST_CASE("lost lines, another width, another status: none passes") {
  FrameResult e = FakeCore().frame(std::span(&word, 1));
  FrameResult a = e;
  a.image.height = a.status.height = 5;
  a.image.data.resize(a.image.index(0, 5));
  REQUIRE(first_difference(0, e, a));
  CHECK(first_difference(0, e, a)->field == "height");
  CHECK(first_difference(0, e, a)->line == 5);
  a = e;
  a.image = Image();
  CHECK(first_difference(0, e, a)->field == "width");
  for (const char* field : {"error", "error_frame", "error_line", "error_token"}) {
    a = e;
    const std::string name = field;
    if (name == "error") a.status.error = ErrorCode::ORDER;
    if (name == "error_frame") a.status.frame = 1;
    if (name == "error_line") a.status.line = 1;
    if (name == "error_token") a.status.token = 1;
    REQUIRE(first_difference(0, e, a));
    CHECK(first_difference(0, e, a)->field == name);
  }
  CHECK_FALSE(first_difference(0, e, e));
}

TEST_CASE("an exception in either core ends the run") {
  FakeCore good;
  FakeCore bad([](std::uint32_t, FrameResult&) { throw std::runtime_error("stalled"); });
  CHECK_THROWS_WITH(run(3, feed, good, bad, {}), "stalled");
  CHECK_THROWS_WITH(run(3, feed, bad, good, {}), "stalled");
}

TEST_CASE("a run without a verdict leaves the folder as it was") {
  const fs::path folder = fs::temp_directory_path() / ("kage-cosim-" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "frame_0000.png") << "of an earlier run";
  FakeCore good;
  FakeCore bad([](std::uint32_t frame, FrameResult&) {
    if (frame == 2) throw std::runtime_error("stalled");
  });
  RunOptions options;
  options.out = folder;
  CHECK_THROWS_WITH(run(3, feed, good, bad, options), "stalled");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  CHECK(names == std::set<std::string>{"frame_0000.png"});
  CHECK(fs::file_size(folder / "frame_0000.png") == 17);
  fs::remove_all(folder);
}
