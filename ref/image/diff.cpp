// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

#include "image/picture.hpp"
#include "kage/error.hpp"
#include "kage/image.hpp"

namespace kage {
namespace {

constexpr std::uint64_t kNotANumber = std::numeric_limits<std::uint64_t>::max();

template <typename T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Distance of two integers.
template <typename T>
struct Integer {
  static constexpr std::size_t kSize = sizeof(T);
  static constexpr bool kHasNan = false;
  static std::uint64_t distance(const std::byte* pa, const std::byte* pb) {
    using U = std::make_unsigned_t<T>;
    const T a = load<T>(pa);
    const T b = load<T>(pb);
    return a < b ? static_cast<U>(static_cast<U>(b) - static_cast<U>(a))
                 : static_cast<U>(static_cast<U>(a) - static_cast<U>(b));
  }
  static double unit(const std::byte* p) {  // 0 .. 1 for the heat map's background
    return std::clamp(static_cast<double>(load<T>(p)) / static_cast<double>(std::numeric_limits<T>::max()), 0.0, 1.0);
  }
};

/// Distance of two IEEE numbers of pattern U with `Mantissa` mantissa bits: values in order are patterns in order, once
/// the patterns of negative numbers are turned round.
template <typename U, int Mantissa>
struct Ieee {
  static constexpr std::size_t kSize = sizeof(U);
  static constexpr bool kHasNan = true;
  static constexpr U kSign = static_cast<U>(U{1} << (sizeof(U) * 8 - 1));
  static constexpr U kInfinity = static_cast<U>(static_cast<U>(kSign - 1) & ~((U{1} << Mantissa) - 1));
  static bool is_nan(U v) { return static_cast<U>(v & static_cast<U>(~kSign)) > kInfinity; }
  static U ordered(U v) { return static_cast<U>((v & kSign) != 0 ? ~v : v | kSign); }
  static std::uint64_t distance(const std::byte* pa, const std::byte* pb) {
    const U a = load<U>(pa);
    const U b = load<U>(pb);
    if (is_nan(a) || is_nan(b)) return kNotANumber;
    const U oa = ordered(a);
    const U ob = ordered(b);
    return oa < ob ? static_cast<U>(ob - oa) : static_cast<U>(oa - ob);
  }
  static double unit(const std::byte* p) {
    double value = 0;
    if constexpr (sizeof(U) == 8) {
      value = std::bit_cast<double>(load<U>(p));
    } else if constexpr (sizeof(U) == 4) {
      value = static_cast<double>(std::bit_cast<float>(load<U>(p)));
    } else {
      const U v = load<U>(p);  // half: good enough for a background, subnormals are black
      if ((v & kSign) == 0 && v >= 0x400)
        value = static_cast<double>(std::bit_cast<float>((std::uint32_t{v} << 13) + (112U << 23)));
    }
    return value > 0 ? std::min(value, 1.0) : 0.0;  // NaN too is black
  }
};

/// A pixel's place in the heat map: the dimmed picture where both agree, else red, the brighter the further apart.
void paint(Image& heat, std::size_t pixel, std::uint64_t distance, bool different, double background) {
  std::uint8_t* out = &heat.data[pixel * 3];
  if (!different) {
    out[0] = out[1] = out[2] = static_cast<std::uint8_t>(background * 80);
    return;
  }
  out[0] = static_cast<std::uint8_t>(std::min(255, 127 + 16 * static_cast<int>(std::bit_width(distance))));
  out[1] = out[2] = distance == kNotANumber ? 255 : 0;
}

template <typename Traits>
void compare(const std::byte* a, const std::byte* b, const DiffOptions& options, DiffResult& r, Image* heat) {
  const auto channels = static_cast<std::size_t>(r.channels);
  const std::size_t pixels = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
  for (std::size_t p = 0; p < pixels; ++p) {
    std::uint64_t worst = 0;
    int first_channel = -1;
    bool nan = false;
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t at = (p * channels + c) * Traits::kSize;
      const std::uint64_t d = Traits::distance(a + at, b + at);
      const bool no_number = Traits::kHasNan && d == kNotANumber;
      if ((no_number || d > options.lsb) && first_channel < 0) first_channel = static_cast<int>(c);
      if (no_number)
        nan = true;
      else
        worst = std::max(worst, d);
    }
    r.nan_pixels += nan ? 1 : 0;
    r.max_lsb = std::max(r.max_lsb, worst);
    if (first_channel >= 0) {
      ++r.different_pixels;
      if (!r.first) {
        const auto width = static_cast<std::size_t>(r.width);
        r.first = DiffResult::Position{static_cast<int>(p % width), static_cast<int>(p / width), first_channel};
      }
    }
    if (heat != nullptr) {
      double background = 0;
      for (std::size_t c = 0; c < channels; ++c) background += Traits::unit(a + (p * channels + c) * Traits::kSize);
      paint(*heat, p, nan ? kNotANumber : worst, first_channel >= 0, background / static_cast<double>(channels));
    }
  }
}

void judge(const DiffOptions& options, DiffResult& r) {
  const double pixels = static_cast<double>(r.width) * static_cast<double>(r.height);
  const auto n = r.different_pixels;
  bool within = n == 0;
  if (options.max_pixels || options.max_percent)
    within = (!options.max_pixels || n <= *options.max_pixels) &&
             (!options.max_percent || static_cast<double>(n) * 100 <= *options.max_percent * pixels);
  r.same = within && r.nan_pixels == 0;
  if (r.nan_pixels != 0)
    r.reason = fmt::format("{} pixels hold a NaN", r.nan_pixels);
  else if (!within)
    r.reason = fmt::format("{} pixels differ", n);
}

DiffResult diff_raw(Sample sample, int width, int height, int channels, const std::byte* a, const std::byte* b,
                    const DiffOptions& options, Image* heat) {
  DiffResult r;
  r.width = width;
  r.height = height;
  r.channels = channels;
  if (heat != nullptr) *heat = Image(width, height, 3);
  switch (sample) {
    case Sample::kU8:
      compare<Integer<std::uint8_t>>(a, b, options, r, heat);
      break;
    case Sample::kI8:
      compare<Integer<std::int8_t>>(a, b, options, r, heat);
      break;
    case Sample::kU16:
      compare<Integer<std::uint16_t>>(a, b, options, r, heat);
      break;
    case Sample::kI16:
      compare<Integer<std::int16_t>>(a, b, options, r, heat);
      break;
    case Sample::kU32:
      compare<Integer<std::uint32_t>>(a, b, options, r, heat);
      break;
    case Sample::kI32:
      compare<Integer<std::int32_t>>(a, b, options, r, heat);
      break;
    case Sample::kU64:
      compare<Integer<std::uint64_t>>(a, b, options, r, heat);
      break;
    case Sample::kI64:
      compare<Integer<std::int64_t>>(a, b, options, r, heat);
      break;
    case Sample::kHalf:
      compare<Ieee<std::uint16_t, 10>>(a, b, options, r, heat);
      break;
    case Sample::kFloat:
      compare<Ieee<std::uint32_t, 23>>(a, b, options, r, heat);
      break;
    case Sample::kDouble:
      compare<Ieee<std::uint64_t, 52>>(a, b, options, r, heat);
      break;
  }
  judge(options, r);
  return r;
}

DiffResult unlike(const std::string& what) {
  DiffResult r;
  r.reason = what;
  return r;
}

}  // namespace

DiffResult diff_files(const std::filesystem::path& a, const std::filesystem::path& b, const DiffOptions& options,
                      Image* heat) {
  const Picture pa = load_picture(a);
  const Picture pb = load_picture(b);
  if (pa.width != pb.width || pa.height != pb.height)
    return unlike(fmt::format("sizes are unlike: {}x{} and {}x{}", pa.width, pa.height, pb.width, pb.height));
  if (pa.x != pb.x || pa.y != pb.y)
    return unlike(fmt::format("origins are unlike: {},{} and {},{}", pa.x, pa.y, pb.x, pb.y));
  if (pa.channels != pb.channels || pa.channel_names != pb.channel_names)
    return unlike(fmt::format("channels are unlike: {} and {}", pa.channel_names, pb.channel_names));
  if (pa.sample != pb.sample)
    return unlike(fmt::format("pixel types are unlike: {} and {}", name_of(pa.sample), name_of(pb.sample)));
  return diff_raw(pa.sample, pa.width, pa.height, pa.channels, pa.data.data(), pb.data.data(), options, heat);
}

DiffResult diff_images(const Image& a, const Image& b, const DiffOptions& options, Image* heat) {
  if (a.width != b.width || a.height != b.height)
    return unlike(fmt::format("sizes are unlike: {}x{} and {}x{}", a.width, a.height, b.width, b.height));
  if (a.channels != b.channels) return unlike(fmt::format("channels are unlike: {} and {}", a.channels, b.channels));
  return diff_raw(Sample::kU8, a.width, a.height, a.channels, std::as_bytes(std::span(a.data)).data(),
                  std::as_bytes(std::span(b.data)).data(), options, heat);
}

}  // namespace kage
