// SPDX-License-Identifier: Apache-2.0
// Stream files, and family 40 for them.
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "kage/config.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

namespace fs = std::filesystem;

struct Scratch {
  fs::path dir = fs::temp_directory_path() / ("kage-stream-" + std::to_string(::getpid()));
  Scratch() { fs::create_directories(dir); }
  ~Scratch() { fs::remove_all(dir); }
};

std::string bytes_of(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& p, const std::string& bytes) { std::ofstream(p, std::ios::binary) << bytes; }

/// Read everything there is; the message, or "" if nothing was refused.
std::string refusal(const fs::path& p) {
  try {
    const StreamFile f(p);
    for (int i = 0; i < f.frame_count(); ++i) (void)f.frame(i);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a stream file gives back configuration and frames") {
  Scratch scratch;
  Random random(test_seed());
  CAPTURE(test_seed());
  Config c;
  c.z_bits = 20;
  c.dsf_bits = 3;
  const fs::path path = scratch.dir / "a.kage";
  std::vector<std::vector<std::uint32_t>> frames(3);
  {
    StreamFileWriter w(path, c);
    for (std::uint32_t i = 0; i < frames.size(); ++i) {
      random_frame(random, c, 50, 4, frames[i], i);
      w.frame(frames[i]);
    }
    CHECK_FALSE(fs::exists(path));
    w.finish();
  }
  CHECK(is_stream_file(path));
  const StreamFile f(path);
  CHECK(f.config() == c);
  REQUIRE(f.frame_count() == 3);
  CHECK(f.bytes() == fs::file_size(path));
  TokenCounts counts;
  for (int i = 0; i < 3; ++i) {
    const auto words = f.frame(i, &counts);
    CHECK(std::vector<std::uint32_t>(words.begin(), words.end()) == frames[static_cast<std::size_t>(i)]);
  }
  CHECK(counts.of_kind[15] == 3);
}

TEST_CASE("a frame as a port brings it is not checked, but has a word at least") {
  Scratch scratch;
  const fs::path path = scratch.dir / "p.kage";
  for (const std::size_t words : {0U, 1U, 7U}) {
    StreamFileWriter w(path, Config{});
    w.begin_port_frame();
    w.words(std::vector<std::uint32_t>(words, 0xFFFFFFFFU));
    w.end_frame();
    w.finish();
    if (words == 0) {
      CHECK_THAT(refusal(path), Catch::Matchers::ContainsSubstring("a frame without words, which no port can bring"));
      continue;
    }
    CHECK(refusal(path).empty());
    CHECK(StreamFile(path).is_port_frame(0));
    CHECK(StreamFile(path).frame(0).size() == words);
  }
}

TEST_CASE("a walk over a frame that breaks rules goes over its tokens, and says what is left") {
  const Config c;
  const Layout layout(c);
  std::vector<std::uint32_t> sound;
  Random random(test_seed());
  random_frame(random, c, 20, 2, sound);
  const auto told = [&](std::vector<std::uint32_t> words, std::vector<std::uint32_t> more) {
    words.insert(words.end(), more.begin(), more.end());
    TokenWalk walk(layout, words);
    std::size_t walked = std::min<std::size_t>(words.size(), kHeaderWords);
    for (auto token = walk.next(); !token.empty(); token = walk.next()) walked += token.size();
    CHECK(walked + walk.rest().size() == words.size());
    CHECK(count_tokens(c, words).words == words.size());
    return walk.rest_text();
  };
  for (std::size_t words = 0; words <= kHeaderWords; ++words)
    CHECK(told({sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(words)}, {}).empty());
  CHECK(told(sound, {}).empty());
  CHECK(told(sound, {0}) == "1 word behind END");
  CHECK(told(sound, {15, 15}) == "2 words behind END");
  const std::vector<std::uint32_t> header(sound.begin(), sound.begin() + kHeaderWords);
  CHECK(told(header, {0, 1}) == "kind 0, which is no token here");
  CHECK(told(header, {5, 1}) == "kind 5, which is no token here");  // TREE, without units
  CHECK(told(header, {14, 6, 1}) == "OP of " + std::to_string(layout.words[6]) + " words, cut after 2");
}

TEST_CASE("a writer that does not finish leaves nothing") {
  Scratch scratch;
  {
    StreamFileWriter w(scratch.dir / "b.kage", Config{});
    w.frame(std::vector<std::uint32_t>{1, 2, 3});
  }
  CHECK(fs::is_empty(scratch.dir));
  CHECK_THROWS_AS(StreamFileWriter(scratch.dir / "no" / "such.kage", Config{}), Error);
}

TEST_CASE("a disk that takes nothing is found at once, and leaves nothing") {
  Scratch scratch;
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit none = before;
  none.rlim_cur = 0;
  REQUIRE(setrlimit(RLIMIT_FSIZE, &none) == 0);
  std::string said;
  try {
    const StreamFileWriter w(scratch.dir / "full.kage", Config{});
  } catch (const Error& e) {
    said = e.what();
  }
  none.rlim_cur = 1024;
  REQUIRE(setrlimit(RLIMIT_FSIZE, &none) == 0);
  std::string later;
  try {
    StreamFileWriter w(scratch.dir / "full.kage", Config{});
    w.frame(std::vector<std::uint32_t>(300));  // stays in the buffer until finish()
    w.finish();
  } catch (const Error& e) {
    later = e.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  CHECK(said == (scratch.dir / "full.kage").string() + ": cannot be written: File too large");
  CHECK(later == said);
  CHECK(fs::is_empty(scratch.dir));
}

TEST_CASE("family 40: a stream file with any bit flipped or cut anywhere is refused with a place") {
  Scratch scratch;
  Random random(test_seed());
  CAPTURE(test_seed());
  const Config c;
  const fs::path path = scratch.dir / "c.kage";
  {
    StreamFileWriter w(path, c);
    for (std::uint32_t i = 0; i < 2; ++i) {
      std::vector<std::uint32_t> words;
      random_frame(random, c, 20, 2, words, i);
      w.frame(words);
    }
    w.finish();
  }
  REQUIRE(refusal(path).empty());
  const std::string whole = bytes_of(path);
  const fs::path bad = scratch.dir / "bad.kage";
  using Catch::Matchers::ContainsSubstring;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int bit = 0; bit < 8; bit += i % 3 == 0 ? 1 : 3) {
      std::string flipped = whole;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
      write(bad, flipped);
      const std::string said = refusal(bad);
      CAPTURE(i, bit);
      REQUIRE_FALSE(said.empty());
      REQUIRE(said.find('\n') == std::string::npos);
      REQUIRE_THAT(said, ContainsSubstring("bad.kage"));
    }
    write(bad, whole.substr(0, i));
    CAPTURE(i);
    REQUIRE_FALSE(refusal(bad).empty());
  }
  write(bad, whole + '\0');
  CHECK_THAT(refusal(bad), ContainsSubstring("after the last section"));
  CHECK_FALSE(refusal(scratch.dir / "none").empty());
  CHECK_FALSE(refusal(scratch.dir).empty());
}

}  // namespace kage::verif
