// SPDX-License-Identifier: Apache-2.0
// Words and stream files.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "file/read_file.hpp"
#include "fuzz/target.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "kage/stream_diff.hpp"
#include "kage/token.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::fuzz {
namespace {

const std::vector<NamedConfig>& configs() {
  static const std::vector<NamedConfig> list = named_configs();
  return list;
}

/// A frame on a port: the first byte chooses the configuration, the rest are words. A core ends whatever comes, and the
/// check of a file and the walk over the tokens do.
void run_frame(Bytes bytes) {
  if (bytes.empty()) return;
  const Config& config = configs()[bytes.front() % configs().size()].config;
  std::vector<std::uint32_t> words((bytes.size() - 1) / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data() + 1, 4 * words.size());
  if (words.size() >= kHeaderWords) {  // a picture of a thousand lines takes as long as a thousand small ones
    const FrameHeader h = FrameHeader::read(words);
    if (h.height > 64 || h.width > 512) return;
  }
  int lines = 0;
  (void)GoldenCore(config).frame(words, [&](int, std::span<const std::uint8_t>) { ++lines; });
  const Layout layout(config);
  if (words.size() >= kHeaderWords) {
    TokenWalk walk(layout, words);
    for (auto token = walk.next(); !token.empty(); token = walk.next())
      (void)to_string(config, decode(config, layout, token, walk.level()));
  }
  FrameChecker checker(config, "frame", 0);
  checker.feed(words);
  (void)checker.finish();
  // The core draws each frame that a file may hold.
  require(lines > 0, "a frame that is sound has lines");
}

std::vector<std::string> frame_seeds() {
  std::vector<std::string> seeds;
  for (std::size_t c = 0; c < configs().size(); ++c) {
    verif::Random random(c);
    const auto words = verif::sound_frame(random, configs()[c].config, 0);
    if (words.size() > 1500) continue;
    std::string seed(1 + 4 * words.size(), static_cast<char>(c));
    std::memcpy(seed.data() + 1, words.data(), 4 * words.size());
    seeds.push_back(seed);
  }
  return seeds;
}

/// The same bytes with the checksums that they ought to have, so that what is behind these is reached.
std::vector<std::uint8_t> with_sums(Bytes bytes) {
  std::vector<std::uint8_t> file(bytes.begin(), bytes.end());
  auto heads = static_cast<std::uint32_t>(crc32_z(0, nullptr, 0));
  for (std::size_t at = 8; at + 16 <= file.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, &file[at + 8], 8);
    if (size > file.size() - at - 16) break;
    if (std::memcmp(&file[at], "DONE", 4) == 0 && size >= 12) std::memcpy(&file[at + 24], &heads, 4);
    const auto sum = static_cast<std::uint32_t>(crc32_z(0, &file[at + 16], size));
    std::memcpy(&file[at + 4], &sum, 4);
    heads = static_cast<std::uint32_t>(crc32_z(heads, &file[at], 16));
    at += 16 + (size + 7) / 8 * 8;
  }
  return file;
}

void run_stream(Bytes bytes) {
  const auto path = file_of("s.kage", with_sums(bytes));
  const StreamFile file(path);
  for (int i = 0; i < file.frame_count(); ++i) {
    const std::span<const std::uint32_t> words = file.frame(i);
    if (words.size() >= kHeaderWords && FrameHeader::read(words).height > 64) return;
  }
  (void)file.sections();
  require(diff_streams(file, StreamFile(path), [](const FrameDiff&) {}).same, "a file is the same as itself");
}

std::vector<std::string> stream_seeds() {
  std::vector<std::string> seeds;
  for (const char* name : {"tiny", "polyhedra", "glass"}) {
    const Config config = load_config(name).config;
    const auto path = file_of("seed.kage", {});
    StreamFileWriter writer(path, config);
    verif::Random random(1);
    for (std::uint32_t n = 0; n < 2; ++n) {
      const auto words = verif::sound_frame(random, config, n);
      if (words.size() < 1000) writer.frame(words);
    }
    writer.begin_port_frame();
    writer.words(verif::damaged_frame(random, config, 3));
    writer.end_frame();
    writer.origin(R"({"scene":"a","polyhedra":null})");
    writer.finish();
    seeds.push_back(read_file(path));
  }
  return seeds;
}

}  // namespace

std::span<const Target> frame_targets() {
  static const Target kTargets[] = {{"frame", "words at a port", run_frame, frame_seeds},
                                    {"stream", "stream files", run_stream, stream_seeds}};
  return kTargets;
}

}  // namespace kage::fuzz
