// SPDX-License-Identifier: Apache-2.0
// The comparison of cores, tried with cores that lie: it must say where. And how far one runs ahead of the other.
#include "cosim/compare.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "cosim/run.hpp"
#include "fake_core.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"

namespace fs = std::filesystem;
using namespace kage;
using namespace kage::cosim;

namespace {

const Feed small = feed_of(8, 6, 4);

struct Folder {
  fs::path path = fs::temp_directory_path() / ("kage-cosim-" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }

  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(path)) names.insert(entry.path().filename().string());
    return names;
  }
};

}  // namespace

TEST_CASE("cores that agree are the same, with one thread and with two") {
  for (const bool two_threads : {false, true}) {
    FakeCore a;
    FakeCore b;
    RunOptions options;
    options.two_threads = two_threads;
    const Report r = run(5, small, a, b, options);
    CHECK(r.same);
    CHECK(r.frames == 5);
    CHECK(r.pixels_compared == 240);
    CHECK(r.cycles == 500);
    CHECK(r.spans == 50);
    CHECK_FALSE(r.first_difference);
  }
}

TEST_CASE("a single bit is found at its frame, line, x and channel, with pictures") {
  for (const bool two_threads : {false, true}) {
    const Folder folder;
    FakeCore good;
    FakeCore bad;
    bad.spoil_line = [](std::uint32_t frame, int y, Line& line) {
      if (frame != 2) return;
      if (y == 3) line[5 * 3 + 1] ^= 1;
      if (y == 4) line[0] ^= 1;
    };
    RunOptions options;
    options.two_threads = two_threads;
    options.out = folder.path;
    const Report r = run(5, small, good, bad, options);
    CHECK_FALSE(r.same);
    CHECK(r.frames == 3);
    CHECK(r.spans == 30);
    REQUIRE(r.first_difference);
    CHECK(r.first_difference->frame == 2);
    CHECK(r.first_difference->line == 3);
    CHECK(r.first_difference->x == 5);
    CHECK(r.first_difference->field == "green");
    CHECK(folder.names() == std::set<std::string>{"frame_0000.png", "frame_0001.png", "frame_0002.png",
                                                  "frame_0002_actual.png", "frame_0002_difference.png",
                                                  "frame_0002_expected.png"});
    const Image expected = load_image(folder.path / "frame_0002_expected.png");
    CHECK(expected == load_image(folder.path / "frame_0002.png"));
    const Image actual = load_image(folder.path / "frame_0002_actual.png");
    REQUIRE(actual.data.size() == expected.data.size());
    for (std::size_t i = 0; i < actual.data.size(); ++i) {
      const bool spoilt = i == expected.index(5, 3) + 1 || i == expected.index(0, 4);
      CHECK((actual.data[i] ^ expected.data[i]) == (spoilt ? 1 : 0));
    }
    const Image difference = load_image(folder.path / "frame_0002_difference.png");
    CHECK(difference.data[difference.index(5, 3)] >= 127);
    CHECK(difference.data[difference.index(4, 3)] < 127);
  }
}

TEST_CASE("lost lines and pixels, lines too many, another size, another status: none passes") {
  const Folder folder;
  RunOptions options;
  options.out = folder.path;
  const auto difference = [&](FakeCore& bad) {
    FakeCore good;
    const Report r = run(2, small, good, bad, options);
    CHECK_FALSE(r.same);
    REQUIRE(r.first_difference);
    CHECK(r.first_difference->frame == 0);
    return *r.first_difference;
  };
  {
    FakeCore bad;  // the last line and half of the one before never come
    bad.spoil_line = [](std::uint32_t, int y, Line& line) { line.resize(y < 4 ? 24 : y == 4 ? 12 : 0); };
    bad.spoil_end = [](std::uint32_t, FrameEnd& end) { end.misconduct = "idle"; };
    const Difference d = difference(bad);
    CHECK(d.field == "missing");
    CHECK(d.line == 4);
    CHECK(d.x == 4);
    CHECK(d.expected == 48);
    CHECK(d.actual == 36);
    CHECK(d.remark == "idle");
    const Image actual = load_image(folder.path / "frame_0000_actual.png");
    CHECK(actual.height == 6);
    CHECK(actual.data[actual.index(3, 4) + 2] != 0);
    CHECK(std::all_of(actual.data.begin() + static_cast<std::ptrdiff_t>(actual.index(4, 4)), actual.data.end(),
                      [](std::uint8_t v) { return v == 0; }));
  }
  {
    FakeCore bad;  // nothing comes
    bad.spoil_line = [](std::uint32_t, int, Line& line) { line.clear(); };
    const Difference d = difference(bad);
    CHECK(d.field == "missing");
    CHECK(d.line == 0);
    CHECK(d.x == 0);
    CHECK(d.actual == 0);
    const Image actual = load_image(folder.path / "frame_0000_actual.png");
    CHECK(std::all_of(actual.data.begin(), actual.data.end(), [](std::uint8_t v) { return v == 0; }));
  }
  {
    FakeCore bad;
    bad.spoil_end = [](std::uint32_t, FrameEnd& end) { end.status.height = 5; };
    CHECK(difference(bad).field == "height");
    CHECK(difference(bad).line == 5);
  }
  {
    FakeCore bad;
    bad.spoil_end = [](std::uint32_t, FrameEnd& end) { end.status.width = end.status.height = 0; };
    CHECK(difference(bad).field == "width");
  }
  {
    FakeCore good;  // a frame that is refused, and pixels all the same
    good.spoil_line = [](std::uint32_t, int, Line& line) { line.clear(); };
    good.spoil_end = [](std::uint32_t, FrameEnd& end) { end.status = {ErrorCode::PARAMS, 0, 0, 0, 0, 0}; };
    FakeCore bad;
    bad.spoil_end = good.spoil_end;
    const Report r = run(2, small, good, bad, options);
    REQUIRE(r.first_difference);
    CHECK(r.first_difference->field == "height");
    CHECK(r.first_difference->actual == 6);
  }
  for (const char* field : {"error", "error_frame", "error_line", "error_token", "error_unit", "port"}) {
    const std::string name = field;
    FakeCore bad;
    bad.spoil_end = [&](std::uint32_t, FrameEnd& end) {
      if (name == "error") end.status.error = ErrorCode::ORDER;
      if (name == "error_frame") end.status.frame = 1;
      if (name == "error_line") end.status.line = 1;
      if (name == "error_token") end.status.token = 1;
      if (name == "error_unit") end.status.unit = 1;
      if (name == "port") end.misconduct = "TUSER";
    };
    CHECK(difference(bad).field == name);
  }
}

TEST_CASE("an assertion of the actual core is a difference, of the frame in which it failed") {
  const auto fails = [] { throw AssertionError("rtl/line_out.sv:7"); };
  for (const bool two_threads : {false, true}) {
    const Folder folder;
    RunOptions options;
    options.two_threads = two_threads;
    options.out = folder.path;
    const auto difference = [&](FakeCore& bad) {
      FakeCore good;
      const Report r = run(5, small, good, bad, options);
      CHECK_FALSE(r.same);
      CHECK(r.frames == 3);
      CHECK(r.height == 6);
      REQUIRE(r.first_difference);
      CHECK(r.first_difference->frame == 2);
      CHECK(r.first_difference->assertion == "rtl/line_out.sv:7");
      CHECK(describe(*r.first_difference).ends_with(": an assertion failed: rtl/line_out.sv:7"));
      CHECK(load_image(folder.path / "frame_0002_actual.png").height == 6);
      return *r.first_difference;
    };
    {
      FakeCore bad;  // on the way
      bad.spoil_line = [&](std::uint32_t frame, int y, Line&) {
        if (frame == 2 && y == 3) fails();
      };
      const Difference d = difference(bad);
      CHECK(d.field == "assertion");
      CHECK(d.line == 3);
      CHECK(d.x == -1);
    }
    {
      FakeCore bad;  // once all pixels are out
      bad.spoil_end = [&](std::uint32_t frame, FrameEnd&) {
        if (frame == 2) fails();
      };
      CHECK(difference(bad).line == -1);
    }
    {
      FakeCore bad;  // below a pixel that is wrong
      bad.spoil_line = [&](std::uint32_t frame, int y, Line& line) {
        if (frame == 2 && y == 1) line[4] ^= 1;
        if (frame == 2 && y == 4) fails();
      };
      const Difference d = difference(bad);
      CHECK(d.field == "green");
      CHECK(d.line == 1);
      CHECK(d.x == 1);
    }
  }
}

TEST_CASE("another initial state gets the first frame too, and what it has wrong is told as its own") {
  for (const bool two_threads : {false, true}) {
    FakeCore expected;
    FakeCore actual;
    FakeCore other;
    int frames = 0;
    other.spoil_line = [&](std::uint32_t frame, int y, Line& line) {
      frames = std::max(frames, static_cast<int>(frame) + 1);
      if (frame == 1 && y == 1) line[5] ^= 1;
    };
    RunOptions options;
    options.two_threads = two_threads;
    options.other_state = &other;
    CHECK(run(3, feed_of(7, 3, 1), expected, actual, options).same);
    CHECK(frames == 1);
    options.steps.first = 1;
    const Report r = run(3, feed_of(7, 3, 1), expected, actual, options);
    CHECK_FALSE(r.same);
    REQUIRE(r.first_difference);
    CHECK(r.frames == 1);
    CHECK(r.first_difference->frame == 1);
    CHECK(r.first_difference->x == 1);
    CHECK(r.first_difference->other_state);
    CHECK(describe(*r.first_difference).find("another initial state") != std::string::npos);
    // An error of the run's own core comes before it.
    actual.spoil_line = [](std::uint32_t frame, int y, Line& line) {
      if (frame == 1 && y == 2) line[0] ^= 1;
    };
    const Report own = run(3, feed_of(7, 3, 1), expected, actual, options);
    REQUIRE(own.first_difference);
    CHECK(own.first_difference->line == 2);
    CHECK_FALSE(own.first_difference->other_state);
  }
}

TEST_CASE("a frame that both refuse is no verdict") {
  FakeCore a;
  a.spoil_line = [](std::uint32_t, int, Line& line) { line.clear(); };
  a.spoil_end = [](std::uint32_t, FrameEnd& end) { end.status = {ErrorCode::PARAMS, 0, 0, 0, 0, 0}; };
  FakeCore b;
  b.spoil_line = a.spoil_line;
  b.spoil_end = a.spoil_end;
  CHECK_THROWS_AS(run(2, small, a, b, {}), Error);
  CHECK_THROWS_AS(run(0, small, a, b, {}), Error);
}

TEST_CASE("an exception in either core or in the feed ends the run, and leaves no picture behind it") {
  for (const bool two_threads : {false, true}) {
    const Folder folder;
    RunOptions options;
    options.two_threads = two_threads;
    options.out = folder.path;
    FakeCore good;
    FakeCore bad;
    bad.spoil_line = [](std::uint32_t frame, int y, Line&) {
      if (frame == 1 && y == 3) throw std::runtime_error("stalled");
    };
    CHECK_THROWS_WITH(run(3, small, good, bad, options), "stalled");
    CHECK(folder.names().empty());
    FakeCore other;
    FakeCore bad_too;
    bad_too.spoil_line = bad.spoil_line;
    CHECK_THROWS_WITH(run(3, small, bad_too, other, options), "stalled");
    CHECK(folder.names().empty());

    // A frame that cannot be made does not hide a difference before it, however far behind its comparison is.
    const Feed broken = [](int index, const WordSink& sink) {
      if (index == 2) throw Error("no frame 2");
      return small(index, sink);
    };
    FakeCore a;
    FakeCore b;
    CHECK_THROWS_WITH(run(3, broken, a, b, options), "no frame 2");
    FakeCore c;
    FakeCore d;
    d.spoil_line = [](std::uint32_t frame, int y, Line& line) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      if (frame == 1 && y == 0) line[0] ^= 1;
    };
    const Report r = run(3, broken, c, d, options);
    REQUIRE(r.first_difference);
    CHECK(r.first_difference->frame == 1);
  }
}

TEST_CASE("the expected core runs ahead by so much and no more, whatever the height and the number of frames") {
  constexpr std::uint32_t kWidth = 1000;
  constexpr std::size_t kLine = std::size_t{kWidth} * 3;
  constexpr std::size_t kPiece = 16;
  for (const std::uint32_t height : {30'000U, 100U}) {
    std::atomic<std::int64_t> ahead{0};
    std::int64_t most = 0;
    FakeCore fast;
    fast.spoil_line = [&](std::uint32_t, int, Line&) { most = std::max<std::int64_t>(most, ++ahead); };
    FakeCore slow;
    slow.spoil_line = [&](std::uint32_t, int y, Line&) {
      if (y == 0) std::this_thread::sleep_for(std::chrono::milliseconds(height == 100 ? 1 : 300));
      --ahead;
    };
    const Report r = run(height == 100 ? 300 : 1, feed_of(kWidth, height, std::uint32_t{kPiece}), fast, slow, {});
    CHECK(r.same);
    CHECK(ahead == 0);
    CAPTURE(height, most);
    CHECK(static_cast<std::size_t>(most) * kLine > kAheadBytes / 2);  // it does run ahead, or this shows nothing
    CHECK(static_cast<std::size_t>(most) * kLine < kAheadBytes + 2 * kPiece * kLine);
  }
}

TEST_CASE("lines that are the same take room once") {
  Lines lines;
  const Line a(3000, 1);
  const Line b(3000, 2);
  for (int i = 0; i < 5; ++i) lines.add(a);
  lines.add(b);
  for (int i = 0; i < 30'000; ++i) lines.add(a);
  CHECK(lines.bytes() < 3 * 3000 + 100);
  for (int i = 0; i < 30'006; ++i) {
    REQUIRE_FALSE(lines.empty());
    REQUIRE(lines.front()[0] == (i == 5 ? 2 : 1));
    lines.pop();
  }
  CHECK(lines.empty());
}

TEST_CASE("a run without a verdict leaves the folder as it was") {
  for (const bool two_threads : {false, true}) {
    const Folder folder;
    std::ofstream(folder.path / "frame_0000.png") << "of an earlier run";
    FakeCore good;
    FakeCore bad;
    bad.spoil_end = [](std::uint32_t frame, FrameEnd&) {
      if (frame == 2) throw std::runtime_error("stalled");
    };
    RunOptions options;
    options.out = folder.path;
    options.two_threads = two_threads;
    CHECK_THROWS_WITH(run(3, small, good, bad, options), "stalled");
    CHECK(folder.names() == std::set<std::string>{"frame_0000.png"});
    CHECK(fs::file_size(folder.path / "frame_0000.png") == 17);
  }
}
