// SPDX-License-Identifier: Apache-2.0
//
// The rules of token order, range and line (docs/stream.md, "Order in a line" and "Errors"), as one small machine that
// the golden core and the file reader share.
#pragma once

#include <algorithm>

#include "contract/derived.hpp"
#include "contract/kinds.hpp"
#include "contract/order.hpp"
#include "contract/segment_rules.hpp"
#include "kage/token.hpp"

namespace kage {

class TokenRules {
 public:
  /// Start of a frame whose header has been accepted.
  void start(const Config& config, int width, int height) {
    config_ = &config;
    width_ = width;
    height_ = height;
    line_ = 0;
    phase_ = order_rules::Phase::state;
    marks_ = 0;
    marks_of_core_ = order_rules::marks_of(config);
    next_class_ = 1;
    next_light_ = 0;
    segments_.start(config, width, height);
    outcome_ = {};
    fault_ = {};
  }

  /// The error of this token, which has index `token`, or NONE; then the machine has moved on. Kinds that the
  /// configuration lacks are the caller's.
  ErrorCode accept(const Token& t, std::uint32_t token) {
    if (!rule(t.kind).allows(phase_, marks_, *config_)) return ErrorCode::ORDER;
    if (!in_range(t)) return ErrorCode::RANGE;
    if (const ErrorCode e = accept_segment(t, token); e != ErrorCode::NONE) return e;
    if (t.kind == Kind::EOL && t.y != line_) return ErrorCode::LINE;
    if (t.kind == Kind::END && line_ < height_) return ErrorCode::LINE;
    move(t.kind);
    return ErrorCode::NONE;
  }

  /// Outcome of the last SEG.
  [[nodiscard]] const SegmentRules::Outcome& outcome() const { return outcome_; }

  /// The fault that the last TREE raised; its code is NONE if it raised none.
  [[nodiscard]] const SegmentRules::Fault& fault() const { return fault_; }

  /// Whether the light table ends within a class, so far.
  [[nodiscard]] bool class_cut() const { return next_light_ != 0; }

  /// Number of EOLs accepted.
  [[nodiscard]] int line() const { return line_; }

 private:
  static constexpr const order_rules::Rule& rule(Kind k) { return order_rules::kRules[static_cast<std::size_t>(k)]; }

  [[nodiscard]] bool in_range(const Token& t) const {
    switch (t.kind) {
      case Kind::SHADE:
        return t.shade <= derived::whole_share(*config_);
      case Kind::TABLE:
        return t.table.normal_class == next_class_ && t.table.light == next_light_ &&
               std::ranges::all_of(t.table.share, [this](auto s) { return s <= derived::whole_share(*config_); });
      case Kind::FACE:
        return has_class(t.segment.normal_class);
      case Kind::OP:
        return in_line(t.span) && has_class(t.span.normal_class);
      case Kind::ES:
        return in_line(t.span) && t.table.light < config_->lights;
      default:
        return !info_of(t.kind).range || in_line(t.span);
    }
  }

  [[nodiscard]] bool in_line(const SpanToken& s) const { return s.xl <= s.xr && s.xr <= width_; }

  /// Whether the frame's table has this class whole; without a table there is nothing to have.
  [[nodiscard]] bool has_class(int normal_class) const {
    return !derived::has_table(*config_) || normal_class < next_class_;
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
    const order_rules::Rule& r = rule(k);
    marks_ = static_cast<order_rules::Marks>(((marks_ & ~r.clears) | r.sets) & marks_of_core_);
    if (r.leads_on(phase_)) phase_ = order_rules::entered(r.to, marks_);
    if (k == Kind::TABLE && ++next_light_ == config_->lights) {
      next_light_ = 0;
      ++next_class_;
    }
    if (k == Kind::EOL && ++line_ == height_) phase_ = order_rules::Phase::behind;
  }

  const Config* config_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  int line_ = 0;
  order_rules::Phase phase_{};
  order_rules::Marks marks_ = 0;
  order_rules::Marks marks_of_core_ = 0;
  int next_class_ = 1;  // of the table's next entry
  int next_light_ = 0;
  SegmentRules segments_;
  SegmentRules::Outcome outcome_;
  SegmentRules::Fault fault_;
};

}  // namespace kage
