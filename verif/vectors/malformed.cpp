// SPDX-License-Identifier: Apache-2.0
#include "vectors/malformed.hpp"

#include <map>

#include "stimulus/random_frames.hpp"

namespace kage::vectors {
namespace {

/// Enough for the rarest error of each named configuration (unit/vectors/malformed).
constexpr int kTries = 6000;

/// What a frame costs: words in, pixels out.
std::uint64_t size_of(const MalformedFrame& f) {
  return f.words.size() + static_cast<std::uint64_t>(f.status.width) * static_cast<std::uint64_t>(f.status.height);
}

}  // namespace

std::vector<MalformedFrame> malformed_frames(const Config& config, std::uint64_t seed) {
  const verif::RandomFrames random(config, verif::Manner::damaged, seed);
  const LineSink nowhere = [](int, std::span<const std::uint8_t>) {};
  GoldenCore golden(config);
  std::map<ErrorCode, MalformedFrame> smallest;
  for (int i = 0; i < kTries; ++i) {
    MalformedFrame f{random.words(i), {}};
    f.status = golden.frame(f.words, nowhere);
    if (f.status.error == ErrorCode::NONE) continue;
    const auto known = smallest.find(f.status.error);
    if (known == smallest.end())
      smallest.emplace(f.status.error, std::move(f));
    else if (size_of(f) < size_of(known->second))
      known->second = std::move(f);
  }
  std::vector<MalformedFrame> frames;
  for (auto& [code, frame] : smallest) frames.push_back(std::move(frame));
  return frames;
}

}  // namespace kage::vectors
