// SPDX-License-Identifier: Apache-2.0
// The current line, as an observer of the golden core sees it.
#include "contract/derived.hpp"
#include "core/line_parts.hpp"
#include "number/packed_color.hpp"

namespace kage {

int LineView::y() const { return parts_->rules.line(); }
bool LineView::segment_taken() const { return parts_->rules.outcome().taken; }
int LineView::width() const { return parts_->pixels.width(); }
std::uint32_t LineView::bias() const { return parts_->pixels.bias(); }
std::uint32_t LineView::background() const { return parts_->pixels.background(); }
bool LineView::painted() const { return parts_->pixels.painted(); }
PixelState LineView::pixel(int x) const { return parts_->pixels.state(x); }

namespace {

LineView::UnitPixel unit_pixel_of(const Config& config, const TreeLine& line, int x) {
  const std::uint64_t key = line.key[static_cast<std::size_t>(x)];
  const std::uint64_t attr = line.attr[static_cast<std::size_t>(x)];
  LineView::UnitPixel p;
  p.z = static_cast<std::uint32_t>(key >> TreeLine::kIndexBits);
  p.index = static_cast<std::uint32_t>(key & TreeLine::kMostIndex);
  const int bits = derived::pixel_level_bits(config);
  p.color = unpacked_levels(attr, bits);
  p.normal_class = static_cast<std::uint32_t>(attr >> 3 * bits);
  return p;
}

}  // namespace

LineView::UnitPixel LineView::unit_pixel(int unit, int x) const {
  return unit_pixel_of(parts_->pixels.config(), parts_->tree.unit_lines()[static_cast<std::size_t>(unit)], x);
}
LineView::UnitPixel LineView::tree_pixel(int x) const {
  return unit_pixel_of(parts_->pixels.config(), parts_->tree.line(), x);
}

}  // namespace kage
