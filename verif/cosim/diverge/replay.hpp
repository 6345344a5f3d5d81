// SPDX-License-Identifier: Apache-2.0
//
// Frames through one core again, at the rhythm of who watches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>

#include "cosim/model/rtl.hpp"
#include "cosim/run.hpp"

namespace kage::cosim {

/// How frames are run again.
struct ReplayOptions {
  std::filesystem::path library;  ///< of a model: with monitors for a search, with waves for a waveform
  RtlOptions rtl;
  FrameSteps steps;            ///< which frames the run had
  std::function<void()> wait;  ///< called now and then; may throw, which ends the replay
};

/// Hands a frame on in pieces of a size for which who watches can keep all that happens: some hundred bytes a pixel.
template <class Take>
void in_pieces(const Feed& feed, int frame, Take take) {
  constexpr std::size_t kPiece = 512;
  feed(frame, [&](std::span<const std::uint32_t> words) {
    for (; !words.empty(); words = words.subspan(std::min(words.size(), kPiece)))
      take(words.first(std::min(words.size(), kPiece)));
  });
}

/// Frames and how they are run again, together.
struct Replay {
  Feed feed;
  ReplayOptions options;
};

/// The replay of the frame alone that RtlOptions::prelude puts ahead of `frame`.
inline Replay replay_ahead(int frame, const ReplayOptions& options) {
  ReplayOptions alone = options;
  alone.rtl.prelude = {};
  alone.steps = {frame, 1};
  return {[words = options.rtl.prelude(frame)](int, const WordSink& sink) {
            sink(words);
            return TokenCounts{};
          },
          std::move(alone)};
}

}  // namespace kage::cosim
