// SPDX-License-Identifier: Apache-2.0
#include "image/views.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "image/sample.hpp"

namespace kage {
namespace {

/// 0 .. 255; NaN is 0.
std::uint8_t byte_of(double value) {
  return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0) * 255)) : std::uint8_t{0};
}

}  // namespace

std::array<std::size_t, 3> colour_channels(const Picture& picture) {
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < picture.channels.size() && shown.size() < 3; ++c)
    if (static_cast<int>(c) != picture.alpha || picture.channels.size() == 1) shown.push_back(c);
  if (shown.size() < 3) return {shown.front(), shown.front(), shown.front()};
  return {shown[0], shown[1], shown[2]};
}

Image view_of(const Picture& picture) {
  const std::array<std::size_t, 3> shown = colour_channels(picture);
  Image view(picture.width, picture.height, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Picture::Channel& channel = picture.channels[shown[i]];
    with_sample(channel.sample, [&](auto type) {
      const std::byte* at = picture.data.data() + channel.offset;
      for (std::size_t out = i; out < view.data.size(); out += 3, at += picture.pixel_bytes)
        view.data[out] = byte_of(decltype(type)::number(at));
    });
  }
  return view;
}

void paint(Image& heat, std::size_t pixel, PixelVerdict verdict, std::uint64_t steps, int background) {
  std::uint8_t* const out = &heat.data[pixel * 3];
  const auto set = [out](int red, int green, int blue) {
    out[0] = static_cast<std::uint8_t>(red);
    out[1] = static_cast<std::uint8_t>(green);
    out[2] = static_cast<std::uint8_t>(blue);
  };
  const int dim = background * 80 / 255;
  switch (verdict) {
    case PixelVerdict::same:
      return set(dim, dim, dim);
    case PixelVerdict::left_out:
      return set(dim / 2, dim / 2, 64);
    case PixelVerdict::tolerated:
      return set(112, 84, 0);
    case PixelVerdict::nan:
      return set(255, 160, 255);
    case PixelVerdict::different:
      return set(std::min(255, 127 + 16 * static_cast<int>(std::bit_width(steps))), 0, 0);
  }
}

void frame_regions(Image& heat, const std::vector<DiffResult::Region>& regions,
                   const std::array<std::uint8_t, 3>& color) {
  const auto dot = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= heat.width || y >= heat.height) return;
    std::uint8_t* const out = &heat.data[heat.index(x, y)];
    const bool taken = out[0] != out[1] && out[0] > 100;  // a pixel that has something to say
    if (taken) return;
    std::copy(color.begin(), color.end(), out);
  };
  constexpr int kAway = 3;
  for (const DiffResult::Region& region : regions) {
    const Box& b = region.box;
    const int left = b.x - kAway;
    const int top = b.y - kAway;
    const int right = b.x + b.width - 1 + kAway;
    const int bottom = b.y + b.height - 1 + kAway;
    for (int x = left; x <= right; ++x) {
      dot(x, top);
      dot(x, bottom);
    }
    for (int y = top; y <= bottom; ++y) {
      dot(left, y);
      dot(right, y);
    }
  }
}

}  // namespace kage
