// SPDX-License-Identifier: Apache-2.0
//
// The rules of token order, range and line (docs/stream.md, "Order in a line" and "Errors"), as one small machine that
// the golden core and the file reader share.
#pragma once

#include <algorithm>

#include "contract/segment_rules.hpp"
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
    sample_open_ = false;
    has_tree_ = false;
    next_class_ = 1;
    next_light_ = 0;
    segments_.start(config, width, height);
    outcome_ = {};
    fault_ = {};
  }

  /// The error of this token, which has index `token`, or NONE; then the machine has moved on. Kinds that the
  /// configuration lacks are the caller's.
  ErrorCode accept(const Token& t, std::uint32_t token) {
    if (!in_order(t.kind)) return ErrorCode::ORDER;
    if (!in_range(t)) return ErrorCode::RANGE;
    if (const ErrorCode e = accept_segment(t, token); e != ErrorCode::NONE) return e;
    if (t.kind == Kind::EOL && t.y != line_) return ErrorCode::LINE;
    if (t.kind == Kind::END && line_ < height_) return ErrorCode::LINE;
    move(t.kind);
    return ErrorCode::NONE;
  }

  /// What became of the last SEG.
  [[nodiscard]] const SegmentRules::Outcome& outcome() const { return outcome_; }

  /// The fault that the last TREE raised; its code is NONE if it raised none.
  [[nodiscard]] const SegmentRules::Fault& fault() const { return fault_; }

  /// Whether the light table ends within a class, so far.
  [[nodiscard]] bool class_cut() const { return next_light_ != 0; }

  /// Number of EOLs accepted.
  [[nodiscard]] int line() const { return line_; }

 private:
  enum class Phase { state, ahead, opaque, volume, resolved, translucent };

  [[nodiscard]] bool in_order(Kind k) const {
    if (k == Kind::END) return true;
    if (line_ >= height_) return false;
    const bool ahead = phase_ == Phase::state || phase_ == Phase::ahead;
    const bool opaque = phase_ == Phase::opaque || (ahead && !has_tree_);
    switch (k) {
      case Kind::SHADE:
        return phase_ == Phase::state && !shade_seen_;
      case Kind::TABLE:
      case Kind::FACE:
        return phase_ == Phase::state;
      case Kind::SEG:
        return phase_ == Phase::state || (phase_ == Phase::ahead && has_tree_);
      case Kind::TREE:
        return phase_ == Phase::ahead && has_tree_;
      case Kind::OP:
        return opaque;
      case Kind::SP:
      case Kind::NC:
      case Kind::IF:
        return opaque || phase_ == Phase::volume;
      case Kind::EV:
        return phase_ == Phase::volume && volume_open_;
      case Kind::RESOLVE:
        return phase_ == Phase::volume && (config_->fsf == 0 || !volume_open_) &&
               (config_->count_bits == 0 || !sample_open_);
      case Kind::ES:
        return phase_ == Phase::volume && (config_->fsf == 0 || !volume_open_) && sample_open_;
      case Kind::TP:
      case Kind::EOL:
        return opaque || phase_ == Phase::resolved || phase_ == Phase::translucent;
      default:
        return false;
    }
  }

  [[nodiscard]] bool in_range(const Token& t) const {
    switch (t.kind) {
      case Kind::SHADE:
        return t.shade <= (1U << config_->shade_frac);
      case Kind::TABLE:
        return t.table.normal_class == next_class_ && t.table.light == next_light_ &&
               std::ranges::all_of(t.table.share, [this](auto s) { return s <= (1U << config_->shade_frac); });
      case Kind::FACE:
        return has_class(t.segment.normal_class);
      case Kind::OP:
        return in_line(t.span) && has_class(t.span.normal_class);
      case Kind::ES:
        return in_line(t.span) && t.table.light < config_->lights;
      case Kind::SP:
      case Kind::NC:
      case Kind::EV:
      case Kind::TP:
        return in_line(t.span);
      default:
        return true;
    }
  }

  [[nodiscard]] bool in_line(const SpanToken& s) const { return s.xl <= s.xr && s.xr <= width_; }

  /// Whether the frame's table has this class whole; without a table there is nothing to have.
  [[nodiscard]] bool has_class(int normal_class) const {
    return config_->class_bits == 1 || normal_class < next_class_;
  }

  ErrorCode accept_segment(const Token& t, std::uint32_t token) {
    switch (t.kind) {
      case Kind::FACE:
        return segments_.face(t.segment);
      case Kind::SEG:
        outcome_ = segments_.seg(t.segment, line_, token);
        return outcome_.error;
      case Kind::TREE:
        fault_ = segments_.tree(line_, token);
        return fault_.code;
      default:
        return ErrorCode::NONE;
    }
  }

  void move(Kind k) {
    switch (k) {
      case Kind::SHADE:
        shade_seen_ = true;
        break;
      case Kind::TABLE:
        if (++next_light_ < config_->lights) break;
        next_light_ = 0;
        ++next_class_;
        break;
      case Kind::SEG:
        phase_ = Phase::ahead;
        has_tree_ = true;
        break;
      case Kind::TREE:
      case Kind::OP:
        phase_ = Phase::opaque;
        break;
      case Kind::SP:
      case Kind::NC:
      case Kind::IF:
        phase_ = Phase::volume;
        volume_open_ = true;
        sample_open_ = true;
        break;
      case Kind::ES:
        sample_open_ = false;
        break;
      case Kind::EV:
        volume_open_ = false;
        break;
      case Kind::RESOLVE:
        phase_ = Phase::resolved;
        break;
      case Kind::TP:
        phase_ = Phase::translucent;
        break;
      case Kind::EOL:
        phase_ = Phase::ahead;
        volume_open_ = false;
        sample_open_ = false;
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
  bool sample_open_ = false;  // an SP, NC or IF came after the last ES
  int next_class_ = 1;        // of the table's next entry
  int next_light_ = 0;
  bool has_tree_ = false;
  SegmentRules segments_;
  SegmentRules::Outcome outcome_;
  SegmentRules::Fault fault_;
};

}  // namespace kage
