// SPDX-License-Identifier: Apache-2.0
#include "core/expansion_unit.hpp"

#include <algorithm>

#include "contract/derived.hpp"
#include "number/packed_color.hpp"

namespace kage {

void ExpansionUnit::start() {
  faces_.clear();
  for (auto& line : lines_) line.clear();
  oldest_ = filling_ = sum_ = 0;
}

void ExpansionUnit::add_face(const SegmentToken& f) {
  const int bits = derived::pixel_level_bits(config_);
  const std::uint64_t attr = static_cast<std::uint64_t>(f.normal_class) << 3 * bits | packed_levels(f.color, bits);
  faces_.push_back({f.dz, static_cast<std::uint32_t>(f.index), attr});
}

void ExpansionUnit::add_segment(const SegmentToken& s, int width) {
  lines_[static_cast<std::size_t>(filling_)].push_back({s.z, s.dx, s.face});
  sum_ += s.dx;
  if (sum_ < width) return;
  sum_ = 0;
  filling_ ^= 1;
}

void ExpansionUnit::expand(TreeLine& out) {
  const int shift = 64 - derived::depth_bits(config_);
  const std::int64_t z_max = derived::most_depth(config_);
  const std::uint64_t clear =
      std::uint64_t{derived::clear_depth(config_)} << TreeLine::kIndexBits | TreeLine::kMostIndex;
  std::size_t x = 0;
  auto& line = lines_[static_cast<std::size_t>(oldest_)];
  for (const Segment& s : line) {
    const auto n = static_cast<std::size_t>(s.dx);
    if (s.face == derived::blank_face(config_)) {
      std::fill_n(out.key.begin() + static_cast<std::ptrdiff_t>(x), n, clear);
      std::fill_n(out.attr.begin() + static_cast<std::ptrdiff_t>(x), n, std::uint64_t{0});
    } else {
      // Registers of the Z generator: Z wraps at its own width, which is kept at the top of 64 bits.
      const Face& f = faces_[static_cast<std::size_t>(s.face)];
      auto z = static_cast<std::uint64_t>(s.z) << shift;
      const std::uint64_t def = static_cast<std::uint64_t>(f.dz) << shift;
      for (std::size_t i = x; i < x + n; ++i, z += def) {
        const std::int64_t depth =
            std::clamp(static_cast<std::int64_t>(z) >> (shift + config_.z_frac), std::int64_t{1}, z_max);
        out.key[i] = static_cast<std::uint64_t>(depth) << TreeLine::kIndexBits | f.index;
        out.attr[i] = f.attr;
      }
    }
    x += n;
  }
  line.clear();
  oldest_ ^= 1;
}

}  // namespace kage
