// SPDX-License-Identifier: Apache-2.0
#include "cosim/compare.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kage::cosim {
namespace {

const char* channel_name(int channels, int channel) {
  static constexpr const char* kColors[] = {"red", "green", "blue"};
  return channels == 1 ? "grey" : kColors[channel];
}

/// `image` cut or filled with black to a size.
Image fitted(const Image& image, int width, int height, int channels) {
  Image out(width, height, channels);
  if (image.channels != channels) return out;
  const auto row = static_cast<std::size_t>(std::min(width, image.width)) * static_cast<std::size_t>(channels);
  for (int y = 0; y < std::min(height, image.height); ++y) {
    const auto from = image.data.begin() + static_cast<std::ptrdiff_t>(image.index(0, y));
    std::copy(from, from + static_cast<std::ptrdiff_t>(row),
              out.data.begin() + static_cast<std::ptrdiff_t>(out.index(0, y)));
  }
  return out;
}

std::optional<Difference> first_pixel(int frame, const FrameResult& expected, const FrameResult& actual) {
  const Image& e = expected.image;
  const Image& a = actual.image;
  const int width = std::min(e.width, a.width);
  const auto channels = static_cast<std::size_t>(e.channels);
  const std::uint64_t present = a.data.size() / channels - actual.missing;
  for (int y = 0; y < std::min(e.height, a.height); ++y) {
    const std::size_t start = a.index(0, y);
    const std::uint64_t left = present - std::min(present, start / channels);
    const std::size_t n = std::min(static_cast<std::uint64_t>(width), left) * channels;
    const std::uint8_t* pe = &e.data[e.index(0, y)];
    const std::uint8_t* pa = &a.data[start];
    const std::uint8_t* at = std::mismatch(pe, pe + n, pa).first;
    if (at != pe + n) {
      const auto offset = static_cast<int>(at - pe);
      return Difference{frame,      y, offset / e.channels, channel_name(e.channels, offset % e.channels), *at,
                        pa[offset], {}};
    }
    if (left < static_cast<std::uint64_t>(width)) {
      const auto pixels = static_cast<std::int64_t>(a.data.size() / channels);
      return Difference{
          frame, y, static_cast<int>(left), "missing", pixels, static_cast<std::int64_t>(present), actual.misconduct};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Difference> first_difference(int frame, const FrameResult& expected, const FrameResult& actual) {
  const Image& e = expected.image;
  const Image& a = actual.image;
  if (e.width > 0 && a.width > 0 && e.channels == a.channels)
    if (auto pixel = first_pixel(frame, expected, actual)) return pixel;
  const auto whole = [&](int line, const char* field, std::int64_t want, std::int64_t got) {
    return Difference{frame, line, -1, field, want, got, actual.misconduct};
  };
  if (e.channels != a.channels && e.width > 0 && a.width > 0) return whole(-1, "channels", e.channels, a.channels);
  if (e.width != a.width) return whole(-1, "width", e.width, a.width);
  if (e.height != a.height) return whole(std::min(e.height, a.height), "height", e.height, a.height);
  const FrameStatus& es = expected.status;
  const FrameStatus& as = actual.status;
  const int line = static_cast<int>(es.line);
  if (es.error != as.error) return whole(line, "error", static_cast<int>(es.error), static_cast<int>(as.error));
  if (es.frame != as.frame) return whole(line, "error_frame", es.frame, as.frame);
  if (es.line != as.line) return whole(line, "error_line", es.line, as.line);
  if (es.token != as.token) return whole(line, "error_token", es.token, as.token);
  if (expected.misconduct != actual.misconduct) return whole(-1, "port", 0, 1);
  return std::nullopt;
}

std::string describe(const Difference& d) {
  std::string text = fmt::format("frame {}", d.frame);
  if (d.line >= 0) text += fmt::format(", line {}", d.line);
  if (d.x >= 0) text += fmt::format(", x {}", d.x);
  if (d.field == "missing") {
    text += fmt::format(": only {} of {} pixels came", d.actual, d.expected);
  } else if (d.field == "error") {
    text += fmt::format(": expected {}, got {}", kErrorNames[static_cast<std::size_t>(d.expected) % kErrorNames.size()],
                        kErrorNames[static_cast<std::size_t>(d.actual) % kErrorNames.size()]);
  } else if (d.field != "port") {
    text += fmt::format(", {}: expected {}, got {}", d.field, d.expected, d.actual);
  }
  return d.remark.empty() ? text : text + ": " + d.remark;
}

Image difference_picture(const Image& expected, const Image& actual) {
  Image heat;
  (void)diff_images(expected, fitted(actual, expected.width, expected.height, expected.channels), {}, &heat);
  return heat;
}

}  // namespace kage::cosim
