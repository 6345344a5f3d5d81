// SPDX-License-Identifier: Apache-2.0
#include "image/regions.hpp"

#include <algorithm>
#include <tuple>

namespace kage {

RegionFinder::RegionFinder(int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void RegionFinder::add(int x, int y) {
  Tile& tile = tiles_[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(x / kTile)];
  if (tile.pixels++ == 0) {
    tile.left = tile.right = x;
    tile.top = tile.bottom = y;
    return;
  }
  tile.left = std::min(tile.left, x);
  tile.right = std::max(tile.right, x);
  tile.top = std::min(tile.top, y);
  tile.bottom = std::max(tile.bottom, y);
}

std::vector<DiffResult::Region> RegionFinder::regions() const {
  std::vector<DiffResult::Region> found;
  std::vector<bool> seen(tiles_.size());
  std::vector<std::size_t> open;
  const auto columns = static_cast<std::size_t>(columns_);
  for (std::size_t start = 0; start < tiles_.size(); ++start) {
    if (seen[start] || tiles_[start].pixels == 0) continue;
    Tile all = tiles_[start];
    all.pixels = 0;
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      const Tile& tile = tiles_[at];
      all.left = std::min(all.left, tile.left);
      all.right = std::max(all.right, tile.right);
      all.top = std::min(all.top, tile.top);
      all.bottom = std::max(all.bottom, tile.bottom);
      all.pixels += tile.pixels;
      const int column = static_cast<int>(at % columns);
      const int row = static_cast<int>(at / columns);
      for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r)
        for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) {
          const std::size_t next = static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c);
          if (seen[next] || tiles_[next].pixels == 0) continue;
          seen[next] = true;
          open.push_back(next);
        }
    }
    found.push_back({{all.left, all.top, all.right - all.left + 1, all.bottom - all.top + 1}, all.pixels});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(b.pixels, a.box.y, a.box.x) < std::tie(a.pixels, b.box.y, b.box.x);
  });
  return found;
}

}  // namespace kage
