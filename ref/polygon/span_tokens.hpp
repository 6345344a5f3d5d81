// SPDX-License-Identifier: Apache-2.0
//
// The tokens of the span level that a frame's tokens come to.
#pragma once

#include <type_traits>

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

  /// Calls use(token, made) for each span-level token that the frame's next token comes to: `made` by the front end, or
  /// as it came. `use` may return an error; then it is called no more.
  /// @return NONE, or the error of `use`, or that of the token out of its place; after an error only start() may follow
  template <class Use>
  ErrorCode add(const Token& t, Use use) {
    const auto give = [&use](const Token& token, bool made) {
      if constexpr (std::is_void_v<std::invoke_result_t<Use&, const Token&, bool>>) {
        use(token, made);
        return ErrorCode::NONE;
      } else {
        return use(token, made);
      }
    };
    return level_ == Level::spans ? give(t, false) : front_end_.accept(t, give);
  }

  /// FrontEnd::most().
  [[nodiscard]] std::size_t most() const { return front_end_.most(); }

 private:
  FrontEnd front_end_;
  Level level_ = Level::spans;
};

}  // namespace kage
