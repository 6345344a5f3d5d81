// SPDX-License-Identifier: Apache-2.0
//
// The rules of token order, range and line (docs/stream.md, "Order in a line" and "Errors"), as one small machine that
// the golden core and the file reader share.
#pragma once

#include "kage/stream.hpp"

namespace kage {

class TokenRules {
 public:
  /// Start of a frame whose header has been accepted.
  void start(const Config& config, int width, int height) {
    config_ = &config;
    width_ = width;
    height_ = height;
    line_ = 0;
    phase_ = Phase::state;
    shade_seen_ = false;
    volume_open_ = false;
  }

  /// The error of this token, or NONE; then the machine has moved on. Kinds that the configuration lacks are the
  /// caller's.
  ErrorCode accept(const Token& t) {
    if (!in_order(t.kind)) return ErrorCode::ORDER;
    if (!in_range(t)) return ErrorCode::RANGE;
    if (t.kind == Kind::EOL && t.y != line_) return ErrorCode::LINE;
    if (t.kind == Kind::END && line_ < height_) return ErrorCode::LINE;
    move(t.kind);
    return ErrorCode::NONE;
  }

  /// Number of EOLs accepted.
  [[nodiscard]] int line() const { return line_; }

 private:
  enum class Phase { state, opaque, volume, resolved };

  [[nodiscard]] bool in_order(Kind k) const {
    if (k == Kind::END) return true;
    if (line_ >= height_) return false;
    const bool opaque = phase_ == Phase::state || phase_ == Phase::opaque;
    switch (k) {
      case Kind::SHADE:
        return phase_ == Phase::state && !shade_seen_;
      case Kind::OP:
        return opaque;
      case Kind::SP:
      case Kind::NC:
      case Kind::IF:
        return opaque || phase_ == Phase::volume;
      case Kind::EV:
        return phase_ == Phase::volume && volume_open_;
      case Kind::RESOLVE:
        return phase_ == Phase::volume && (config_->fsf == 0 || !volume_open_);
      case Kind::EOL:
        return opaque || phase_ == Phase::resolved;
      default:
        return false;
    }
  }

  [[nodiscard]] bool in_range(const Token& t) const {
    switch (t.kind) {
      case Kind::SHADE:
        return t.shade <= (1U << config_->shade_frac);
      case Kind::OP:
      case Kind::SP:
      case Kind::NC:
      case Kind::EV:
        return t.span.xl <= t.span.xr && t.span.xr <= width_;
      default:
        return true;
    }
  }

  void move(Kind k) {
    switch (k) {
      case Kind::SHADE:
        shade_seen_ = true;
        break;
      case Kind::OP:
        phase_ = Phase::opaque;
        break;
      case Kind::SP:
      case Kind::NC:
      case Kind::IF:
        phase_ = Phase::volume;
        volume_open_ = true;
        break;
      case Kind::EV:
        volume_open_ = false;
        break;
      case Kind::RESOLVE:
        phase_ = Phase::resolved;
        break;
      case Kind::EOL:
        phase_ = Phase::opaque;
        volume_open_ = false;
        ++line_;
        break;
      default:
        break;
    }
  }

  const Config* config_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  int line_ = 0;
  Phase phase_ = Phase::state;
  bool shade_seen_ = false;
  bool volume_open_ = false;
};

}  // namespace kage
