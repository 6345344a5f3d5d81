// SPDX-License-Identifier: Apache-2.0
//
// The tokens of the span level that a frame's tokens come to.
#pragma once

#include "kage/token.hpp"
#include "polygon/front_end.hpp"

namespace kage {

/// For frames of either level: those at the polygon level go through the front end.
class SpanTokens {
 public:
  explicit SpanTokens(const Config& config) : front_end_(config) {}

  /// A frame begins whose header has been accepted.
  void start(const FrameHeader& header) {
    level_ = header.level();
    if (level_ == Level::polygons) front_end_.start(header.width);
  }

  [[nodiscard]] Level level() const { return level_; }

  /// Calls use(token, made) for each that the frame's next token comes to; `made` by the front end, or as it came. The
  /// answer is what is wrong with the token, as far as no rule of the span level is broken: nothing but start() may
  /// follow it.
  template <class Use>
  ErrorCode add(const Token& t, Use use) {
    if (level_ == Level::spans) {
      use(t, false);
      return ErrorCode::NONE;
    }
    return front_end_.accept(t, [&use](const Token& token, bool made) {
      use(token, made);
      return ErrorCode::NONE;
    });
  }

 private:
  FrontEnd front_end_;
  Level level_ = Level::spans;
};

}  // namespace kage
