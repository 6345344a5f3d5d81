// SPDX-License-Identifier: Apache-2.0
//
// The rules of FACE, SEG and TREE (docs/stream.md, "Units and the tree"): which segment belongs to which line, and
// whose fault is raised at which TREE. Shared by the golden core and the file reader; the RTL's segment_check is the
// same.
#pragma once

#include <cstdint>
#include <vector>

#include "contract/derived.hpp"
#include "kage/token.hpp"

namespace kage {

class SegmentRules {
 public:
  /// A unit's fault.
  struct Fault {
    ErrorCode code = ErrorCode::NONE;
    std::uint32_t unit = 0;
    std::uint32_t token = 0;  ///< index of the token that shows it
  };

  /// Outcome of a SEG: an error at once, a fault that is raised at its line's TREE, or neither. Its unit gets it only
  /// if `taken` is set.
  struct Outcome {
    ErrorCode error = ErrorCode::NONE;
    ErrorCode fault = ErrorCode::NONE;
    bool taken = false;
  };

  void start(const Config& config, int width, int height) {
    config_ = &config;
    width_ = width;
    height_ = height;
    units_.assign(static_cast<std::size_t>(config.units), Unit{});
  }

  /// Faces of a unit come in order; the blank one has no entry.
  ErrorCode face(const SegmentToken& t) {
    if (t.unit >= config_->units) return ErrorCode::RANGE;
    Unit& u = units_[static_cast<std::size_t>(t.unit)];
    if (t.face != u.faces || t.face == blank()) return ErrorCode::RANGE;
    ++u.faces;
    return ErrorCode::NONE;
  }

  /// A SEG with index `token` on line `line`, that is, after that many EOLs.
  Outcome seg(const SegmentToken& t, int line, std::uint32_t token) {
    if (t.unit >= config_->units) return {ErrorCode::RANGE, {}, false};
    Unit& u = units_[static_cast<std::size_t>(t.unit)];
    if (u.fault != ErrorCode::NONE) return {{}, u.fault, false};
    if (u.lines == height_) return {ErrorCode::ORDER, {}, false};
    const auto at_fault = [&](ErrorCode code, int of_line) {
      u.fault = code;
      u.fault_line = of_line;
      u.fault_token = token;
      return Outcome{{}, code, false};
    };
    if (u.lines > line + 1) return at_fault(ErrorCode::UNIT_LONG, line + 1);
    if (t.sync != (u.sum == 0) || t.dx == 0 || (t.face != blank() && t.face >= u.faces))
      return at_fault(ErrorCode::SEGMENT, u.lines);
    if (u.sum + t.dx > width_ || u.segments == derived::most_segments(*config_))
      return at_fault(ErrorCode::UNIT_LONG, u.lines);
    u.sum += t.dx;
    ++u.segments;
    if (u.sum == width_) {
      ++u.lines;
      u.sum = 0;
      u.segments = 0;
    }
    return {{}, {}, true};
  }

  /// The fault that the TREE of this line raises, if any.
  [[nodiscard]] Fault tree(int line, std::uint32_t token) const {
    Fault fault;
    for (std::uint32_t i = 0; i < units_.size(); ++i) {
      const Unit& u = units_[i];
      if (u.fault != ErrorCode::NONE && u.fault_line <= line &&
          (fault.code == ErrorCode::NONE || u.fault_token < fault.token))
        fault = {u.fault, i, u.fault_token};
    }
    if (fault.code != ErrorCode::NONE) return fault;
    for (std::uint32_t i = 0; i < units_.size(); ++i)
      if (units_[i].lines <= line) return {ErrorCode::UNIT_SHORT, i, token};
    return {};
  }

 private:
  struct Unit {
    int faces = 0;     // defined in this frame
    int sum = 0;       // pixels of the line under way
    int segments = 0;  // of the line under way
    int lines = 0;     // complete
    ErrorCode fault = ErrorCode::NONE;
    int fault_line = 0;
    std::uint32_t fault_token = 0;
  };

  [[nodiscard]] int blank() const { return derived::blank_face(*config_); }

  const Config* config_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  std::vector<Unit> units_;
};

}  // namespace kage
