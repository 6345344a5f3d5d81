// SPDX-License-Identifier: Apache-2.0
//
// The tokens of a sound frame whose words come in pieces of any size.
#pragma once

#include <cstdint>
#include <span>

#include "kage/token.hpp"
#include "stream/cutter.hpp"

namespace kage {

class TokenPieces {
 public:
  explicit TokenPieces(const Config& config) : config_(config), layout_(config) {}

  /// A frame begins with the next piece.
  void start() {
    cutter_.start();
    in_header_ = true;
  }

  /// Calls use(token) for each token that is whole by now. The frame must be sound.
  template <class Use>
  void feed(std::span<const std::uint32_t> words, Use use) {
    cutter_.feed(words);
    if (in_header_) {
      const auto header = cutter_.take(kHeaderWords);
      if (header.empty()) return;
      level_ = FrameHeader::read(header).level();
      in_header_ = false;
    }
    while (const std::uint32_t* first = cutter_.peek()) {
      const auto body = cutter_.take(layout_.words_of(*first, level_));
      if (body.empty()) return;
      decode(config_, layout_, body, token_, level_);
      use(static_cast<const Token&>(token_));
    }
  }

 private:
  Config config_;
  Layout layout_;
  WordCutter cutter_;
  Token token_;
  bool in_header_ = true;
  Level level_ = Level::spans;
};

}  // namespace kage
