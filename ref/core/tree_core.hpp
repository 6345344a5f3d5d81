// SPDX-License-Identifier: Apache-2.0
//
// Expansion units and the tree over them: the lines of convex polyhedra. The golden counterpart of tree_core.sv.
#pragma once

#include <vector>

#include "core/compare_tree.hpp"
#include "core/expansion_unit.hpp"

namespace kage {

class TreeCore {
 public:
  explicit TreeCore(const Config& config)
      : units_(static_cast<std::size_t>(config.units), ExpansionUnit(config)),
        lines_(static_cast<std::size_t>(config.units)) {}

  /// A new frame: no faces, no segments.
  void start(int width) {
    width_ = width;
    for (ExpansionUnit& u : units_) u.start();
    for (TreeLine& l : lines_) l.resize(static_cast<std::size_t>(width));
  }

  // Only what SegmentRules lets through.
  void add_face(const SegmentToken& t) { units_[static_cast<std::size_t>(t.unit)].add_face(t); }
  void add_segment(const SegmentToken& t) { units_[static_cast<std::size_t>(t.unit)].add_segment(t, width_); }

  /// Every unit has its line: merge them. Valid until the next call. `keep`: for unit_lines().
  const TreeLine& take_line(bool keep) {
    for (std::size_t i = 0; i < units_.size(); ++i) units_[i].expand(lines_[i]);
    if (keep) kept_ = lines_;
    compare_tree(lines_);
    return lines_[0];
  }

  /// The units' lines before they were merged.
  [[nodiscard]] const std::vector<TreeLine>& unit_lines() const { return kept_; }
  [[nodiscard]] const TreeLine& line() const { return lines_[0]; }

 private:
  std::vector<ExpansionUnit> units_;
  std::vector<TreeLine> lines_;
  std::vector<TreeLine> kept_;
  int width_ = 0;
};

}  // namespace kage
