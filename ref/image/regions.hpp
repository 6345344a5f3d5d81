// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kage/diff.hpp"

namespace kage {

/// Gathers pixels into boxes of neighbours: the picture is cut into tiles of 8 x 8 pixels, and pixels belong together
/// if a chain of touching tiles with pixels in them leads from one to the other. Memory is a tile's, not a pixel's.
class RegionFinder {
 public:
  RegionFinder(int width, int height);

  void add(int x, int y);

  /// The boxes, most pixels first, then from the top and the left.
  [[nodiscard]] std::vector<DiffResult::Region> regions() const;

 private:
  static constexpr int kTile = 8;
  struct Tile {
    int left = 0;
    int top = 0;
    int right = 0;  // the last column
    int bottom = 0;
    std::uint64_t pixels = 0;
  };
  int columns_;
  int rows_;
  std::vector<Tile> tiles_;
};

}  // namespace kage
