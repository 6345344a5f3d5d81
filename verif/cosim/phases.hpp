// SPDX-License-Identifier: Apache-2.0
//
// The clocks that the RTL lost at its ports, by the phases that the clocks of a frame go to (cost/token_clocks.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cost/token_clocks.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {

/// Clocks that a core with a clock lost at its ports.
struct Stalls {
  std::uint64_t starved = 0;  ///< no input was offered
  std::uint64_t blocked = 0;  ///< its output was not taken
};

/// By the phase of the token at which the input stood; the last: behind the frame's last one. The core itself may still
/// be at work on a token or two before it.
using PhaseStalls = std::array<Stalls, kPhases + 1>;

/// The phase of each word of a frame, that of its token. The header's is Phase::state, and so is that of words behind
/// what is no token.
class PhaseMarker {
 public:
  explicit PhaseMarker(const Config& config) : layout_(config) {}

  /// A frame begins.
  void start() {
    phase_ = Phase::state;
    left_ = kHeaderWords;
    first_ = true;
  }

  /// The next of its words: a mark each is added to `marks`.
  void mark(std::span<const std::uint32_t> words, std::vector<std::uint8_t>& marks);

 private:
  Layout layout_;
  Phase phase_ = Phase::state;
  std::uint64_t left_ = kHeaderWords;  // words of the token at hand
  bool first_ = true;                  // the next word is the frame's first
  Level level_ = Level::spans;
};

}  // namespace kage::cosim
