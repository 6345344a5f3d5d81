// SPDX-License-Identifier: Apache-2.0
#include "vectors/malformed.hpp"

#include <map>
#include <utility>

#include "stimulus/random_frames.hpp"

namespace kage::vectors {
namespace {

constexpr int kTries = 6000;  // damaged frames: of each error some hundreds, of the rarest a few

/// Cost of a frame: words in, pixels out. A frame with a line before the error and one behind it, which is background
/// then, tries more than one without.
std::pair<bool, std::uint64_t> cost_of(const MalformedFrame& f) {
  const bool within = f.status.line > 0 && f.status.line < static_cast<std::uint32_t>(f.status.height);
  return {!within,
          f.words.size() + static_cast<std::uint64_t>(f.status.width) * static_cast<std::uint64_t>(f.status.height)};
}

/// The frames of a level.
void add_malformed(std::vector<MalformedFrame>& frames, const Config& config, std::uint64_t seed, Level level) {
  const verif::RandomFrames random(config, verif::Manner::damaged, seed, level);
  const LineSink nowhere = [](int, std::span<const std::uint8_t>) {};
  GoldenCore golden(config);
  std::map<ErrorCode, MalformedFrame> smallest;
  for (int i = 0; i < kTries; ++i) {
    MalformedFrame f{random.words(i), {}, level};
    f.status = golden.frame(f.words, nowhere);
    if (f.status.error == ErrorCode::NONE) continue;
    const auto known = smallest.find(f.status.error);
    if (known == smallest.end())
      smallest.emplace(f.status.error, std::move(f));
    else if (cost_of(f) < cost_of(known->second))
      known->second = std::move(f);
  }
  for (auto& [code, frame] : smallest) frames.push_back(std::move(frame));
}

}  // namespace

std::vector<MalformedFrame> malformed_frames(const Config& config, std::uint64_t seed) {
  std::vector<MalformedFrame> frames;
  add_malformed(frames, config, seed, Level::spans);
  if (config.active > 0) add_malformed(frames, config, seed, Level::polygons);
  return frames;
}

}  // namespace kage::vectors
