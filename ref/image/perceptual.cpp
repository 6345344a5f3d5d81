// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "image/plugin/table.hpp"
#include "image/sample.hpp"
#include "image/views.hpp"

namespace kage {
namespace {

double linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

/// The part within `box` as three linear floats a pixel, what the measure expects. Empty if a value is not finite.
std::vector<float> linear_colours(const Picture& picture, const Box& box) {
  const std::array<std::size_t, 3> used = colour_channels(picture);
  bool srgb = false;
  for (const auto& [what, text] : picture.notes) srgb = srgb || (what == "colour space" && text == "sRGB");

  std::vector<float> colours(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height) * 3);
  bool finite = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Picture::Channel& channel = picture.channels[used[i]];
    const bool decode = srgb && !is_float(channel.sample);
    with_sample(channel.sample, [&](auto type) {
      std::size_t out = i;
      for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x, out += 3) {
          const double v = decltype(type)::number(picture.row(y) + static_cast<std::size_t>(x) * picture.pixel_bytes +
                                                  channel.offset);
          colours[out] = static_cast<float>(decode ? linear(v) : v);
          finite = finite && std::isfinite(colours[out]);
        }
    });
  }
  if (!finite) colours.clear();
  return colours;
}

}  // namespace

std::optional<std::uint64_t> perceptual_pixels(const Picture& a, const Picture& b, const Box& box) {
  std::vector<float> colours_a = linear_colours(a, box);
  std::vector<float> colours_b = linear_colours(b, box);
  if (colours_a.empty() || colours_b.empty()) return {};
  return plugin_table<PicturePlugin>().yee(box.width, box.height, colours_a.data(), colours_b.data());
}

}  // namespace kage
