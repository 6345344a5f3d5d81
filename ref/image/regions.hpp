// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "kage/diff.hpp"

namespace kage {

/// Gathers pixels into boxes of neighbours. The picture is cut into tiles of 8 x 8 pixels; pixels belong together if a
/// chain of touching tiles with pixels in them leads from one to the other.
///
/// Pixels come line by line. A box is done once no tile of the last line of tiles touches it, and of the boxes that
/// are done the largest are kept. So the memory is that of a line's tiles and of the kept boxes, whatever the height.
class RegionFinder {
 public:
  /// `most`: so many boxes are kept.
  explicit RegionFinder(int width, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Lines from the top on.
  void add(int x, int y);

  /// The boxes, most pixels first, then from the top and the left. No pixel comes after that.
  [[nodiscard]] std::vector<DiffResult::Region> regions();
  /// How many boxes there are, kept or not: after regions().
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  static constexpr int kTile = 8;
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Tile {
    int left = 0;
    int top = 0;
    int right = 0;  // the last column
    int bottom = 0;
    std::uint64_t pixels = 0;
  };

  void end_tiles();
  std::size_t root_of(std::size_t box);
  std::size_t joined(std::size_t a, std::size_t b);
  void close_boxes(const std::vector<std::size_t>& boxes_of_tiles);
  void close(const Tile& box);

  std::size_t most_;
  int line_ = 0;                      // of tiles_, in tiles
  std::vector<Tile> tiles_;           // of the line under way
  std::vector<std::size_t> above_;    // of each tile in the line before, its box, or kNone
  std::vector<Tile> boxes_;           // that may still grow
  std::vector<std::size_t> parents_;  // of each box, the one that it has become part of, or itself
  std::vector<DiffResult::Region> closed_;
  std::uint64_t count_ = 0;
};

}  // namespace kage
