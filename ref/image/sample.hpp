// SPDX-License-Identifier: Apache-2.0
//
// Values of each type a picture may have: how far two are apart, and what they are as a number.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "image/picture.hpp"

namespace kage {

template <typename T>
T load_value(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Integers. `steps` is |a - b|; as a number, the type's largest is 1.
template <typename T>
struct IntegerSample {
  static constexpr bool kFloat = false;
  static bool is_nan(const std::byte*) { return false; }
  static bool in_range(const std::byte*) { return true; }
  static std::uint64_t steps(const std::byte* pa, const std::byte* pb) {
    using U = std::make_unsigned_t<T>;
    const T a = load_value<T>(pa);
    const T b = load_value<T>(pb);
    return a < b ? static_cast<U>(static_cast<U>(b) - static_cast<U>(a))
                 : static_cast<U>(static_cast<U>(a) - static_cast<U>(b));
  }
  static double number(const std::byte* p) {
    return static_cast<double>(load_value<T>(p)) / static_cast<double>(std::numeric_limits<T>::max());
  }
};

/// IEEE numbers of pattern U with `Mantissa` mantissa bits. `steps` counts representable numbers: values in order are
/// patterns in order, once the patterns of negative numbers are turned round, so 0 is equal bits. Not for NaN.
template <typename U, int Mantissa>
struct FloatSample {
  static constexpr bool kFloat = true;
  static constexpr U kSign = static_cast<U>(U{1} << (sizeof(U) * 8 - 1));
  static constexpr U kInfinity = static_cast<U>(static_cast<U>(kSign - 1) & ~((U{1} << Mantissa) - 1));
  static bool is_nan(const std::byte* p) {
    return static_cast<U>(load_value<U>(p) & static_cast<U>(~kSign)) > kInfinity;
  }
  /// 0 .. 1, where white is 1.
  static bool in_range(const std::byte* p) {
    constexpr U kOne = static_cast<U>(((U{1} << (sizeof(U) * 8 - 2 - Mantissa)) - 1) << Mantissa);
    const U v = load_value<U>(p);
    return v <= kOne || v == kSign;
  }
  static U ordered(U v) { return static_cast<U>((v & kSign) != 0 ? ~v : v | kSign); }
  static std::uint64_t steps(const std::byte* pa, const std::byte* pb) {
    const U a = ordered(load_value<U>(pa));
    const U b = ordered(load_value<U>(pb));
    return a < b ? static_cast<U>(b - a) : static_cast<U>(a - b);
  }
  static double number(const std::byte* p) {
    const U v = load_value<U>(p);
    if constexpr (sizeof(U) == 8) {
      return std::bit_cast<double>(v);
    } else if constexpr (sizeof(U) == 4) {
      return static_cast<double>(std::bit_cast<float>(v));
    } else {
      const int exponent = (v & kInfinity) >> Mantissa;
      const auto fraction = static_cast<double>(v & ((1U << Mantissa) - 1));
      double value = 0;
      if (exponent == 31)
        value = fraction != 0 ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
      else
        value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(fraction + 1024, exponent - 25);
      return (v & kSign) != 0 ? -value : value;
    }
  }
};

/// Calls f with the type that says how values of `sample` are read.
template <typename F>
auto with_sample(Sample sample, F f) {
  switch (sample) {
    case Sample::kU8:
      return f(IntegerSample<std::uint8_t>{});
    case Sample::kI8:
      return f(IntegerSample<std::int8_t>{});
    case Sample::kU16:
      return f(IntegerSample<std::uint16_t>{});
    case Sample::kI16:
      return f(IntegerSample<std::int16_t>{});
    case Sample::kU32:
      return f(IntegerSample<std::uint32_t>{});
    case Sample::kI32:
      return f(IntegerSample<std::int32_t>{});
    case Sample::kU64:
      return f(IntegerSample<std::uint64_t>{});
    case Sample::kI64:
      return f(IntegerSample<std::int64_t>{});
    case Sample::kHalf:
      return f(FloatSample<std::uint16_t, 10>{});
    case Sample::kFloat:
      return f(FloatSample<std::uint32_t, 23>{});
    case Sample::kDouble:
      break;
  }
  return f(FloatSample<std::uint64_t, 52>{});
}

}  // namespace kage
