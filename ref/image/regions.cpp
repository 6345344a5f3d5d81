// SPDX-License-Identifier: Apache-2.0
#include "image/regions.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kage {
namespace {

/// Most pixels first, then from the top and the left.
bool before(const DiffResult::Region& a, const DiffResult::Region& b) {
  return std::tie(b.pixels, a.box.y, a.box.x) < std::tie(a.pixels, b.box.y, b.box.x);
}

}  // namespace

RegionFinder::RegionFinder(int width, std::size_t most)
    : most_(most), tiles_(static_cast<std::size_t>((width + kTile - 1) / kTile)), above_(tiles_.size(), kNone) {}

void RegionFinder::add(int x, int y) {
  if (y / kTile != line_) {
    end_tiles();
    if (y / kTile != line_ + 1) end_tiles();  // lines without a pixel in between part all that comes
    line_ = y / kTile;
  }
  Tile& tile = tiles_[static_cast<std::size_t>(x / kTile)];
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

/// The line's tiles join the boxes that they touch.
void RegionFinder::end_tiles() {
  std::vector<std::size_t> now(tiles_.size(), kNone);
  for (std::size_t c = 0; c < tiles_.size(); ++c) {
    if (tiles_[c].pixels == 0) continue;
    std::size_t box = boxes_.size();
    boxes_.push_back(tiles_[c]);
    parents_.push_back(box);
    if (c > 0 && now[c - 1] != kNone) box = joined(box, now[c - 1]);
    for (std::size_t n = c == 0 ? 0 : c - 1; n <= std::min(c + 1, tiles_.size() - 1); ++n)
      if (above_[n] != kNone) box = joined(box, above_[n]);
    now[c] = box;
    tiles_[c] = {};
  }
  close_boxes(now);
}

std::size_t RegionFinder::root_of(std::size_t box) {
  while (parents_[box] != box) box = parents_[box] = parents_[parents_[box]];
  return box;
}

std::size_t RegionFinder::joined(std::size_t a, std::size_t b) {
  a = root_of(a);
  b = root_of(b);
  if (a == b) return a;
  if (a > b) std::swap(a, b);
  Tile& all = boxes_[a];
  const Tile& more = boxes_[b];
  all.left = std::min(all.left, more.left);
  all.right = std::max(all.right, more.right);
  all.top = std::min(all.top, more.top);
  all.bottom = std::max(all.bottom, more.bottom);
  all.pixels += more.pixels;
  parents_[b] = a;
  return a;
}

/// Boxes that none of these tiles is of grow no more. The others get numbers without gaps.
void RegionFinder::close_boxes(const std::vector<std::size_t>& boxes_of_tiles) {
  std::vector<std::size_t> numbers(boxes_.size(), kNone);
  std::vector<Tile> open;
  for (std::size_t c = 0; c < boxes_of_tiles.size(); ++c) {
    above_[c] = kNone;
    if (boxes_of_tiles[c] == kNone) continue;
    const std::size_t root = root_of(boxes_of_tiles[c]);
    if (numbers[root] == kNone) {
      numbers[root] = open.size();
      open.push_back(boxes_[root]);
    }
    above_[c] = numbers[root];
  }
  for (std::size_t box = 0; box < boxes_.size(); ++box)
    if (parents_[box] == box && numbers[box] == kNone) close(boxes_[box]);
  boxes_ = std::move(open);
  parents_.resize(boxes_.size());
  for (std::size_t i = 0; i < parents_.size(); ++i) parents_[i] = i;
}

void RegionFinder::close(const Tile& box) {
  ++count_;
  const DiffResult::Region region{{box.left, box.top, box.right - box.left + 1, box.bottom - box.top + 1}, box.pixels};
  // A heap: its front is the one to go.
  if (closed_.size() >= most_) {
    if (most_ == 0 || !before(region, closed_.front())) return;
    std::pop_heap(closed_.begin(), closed_.end(), before);
    closed_.pop_back();
  }
  closed_.push_back(region);
  std::push_heap(closed_.begin(), closed_.end(), before);
}

std::vector<DiffResult::Region> RegionFinder::regions() {
  end_tiles();
  end_tiles();
  std::sort(closed_.begin(), closed_.end(), before);
  return std::move(closed_);
}

}  // namespace kage
