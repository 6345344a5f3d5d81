// SPDX-License-Identifier: Apache-2.0
// The meaning of words: pixels of random frames, which no front end has made. A change of the front end leaves these
// checksums alone and changes those of scene/builtin. A change of the core that gives known words other pixels changes
// these, and then the stream's version has to change.
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "stimulus/frames.hpp"
#include "test/support/catch.hpp"
#include "test/support/checksum.hpp"

namespace kage::verif {
namespace {

struct Meaning {
  std::uint32_t version = 0;  // of the stream
  std::uint32_t words = 0;    // CRC-32 of the frames' words behind magic and version, parameter hash as 0
  std::uint32_t pixels = 0;   // CRC-32 of the golden core's pixels
  bool operator==(const Meaning&) const = default;
};

Meaning meaning(const Config& c) {
  Meaning m{.version = kStreamVersion};
  Random random(20250706);  // the same frames whatever $KAGE_SEED is
  GoldenCore core(c);
  for (std::uint32_t number = 0; number < 8; ++number) {
    std::vector<std::uint32_t> words;
    random_frame(random, c, 60, 30, words, number);
    const auto sink = [&](int, std::span<const std::uint8_t> line) { add_checksum(m.pixels, line); };
    REQUIRE(core.frame(words, sink).error == ErrorCode::NONE);
    words[0] = 0;  // magic and version: the words below them are what has a meaning
    add_frame_checksum(m.words, words);
  }
  return m;
}

}  // namespace

TEST_CASE("words mean the pixels that they meant when the stream's version was named") {
  const std::map<std::string, Meaning> known{
#include "test/unit/core/word_meaning.inc"
  };
  for (const NamedConfig& named : named_configs()) {
    const Meaning now = meaning(named.config);
    const auto it = known.find(named.name);
    const Meaning then = it == known.end() ? Meaning{} : it->second;
    const bool same_words = then.words == now.words;
    INFO((!same_words ? "the frames are new: commit their row before the core changes"
          : then.pixels != now.pixels && then.version == now.version
              ? "known words have other pixels: name a new stream version in rtl/defs/kage.yaml, or mend the core"
              : "the stream's version is new: copy the row"));
    INFO(fmt::format("{{\"{}\", {{{}, {:#010x}, {:#010x}}}}},", named.name, now.version, now.words, now.pixels));
    CHECK(then == now);
  }
}

}  // namespace kage::verif
