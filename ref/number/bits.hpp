// SPDX-License-Identifier: Apache-2.0
//
// Bit fields in 32-bit words, and integers of stated widths.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kage/defs.hpp"
#include "number/int128.hpp"

namespace kage {

/// The low `bits` (1 .. 64) of `v` as a two's complement number.
constexpr std::int64_t sign_extend(std::uint64_t v, unsigned bits) {
  return static_cast<std::int64_t>(v << (64 - bits)) >> (64 - bits);
}

/// True if v is a two's complement number of `bits` (1 .. 63) bits.
constexpr bool fits_signed(std::int64_t v, unsigned bits) {
  const std::int64_t limit = std::int64_t{1} << (bits - 1);
  return v >= -limit && v < limit;
}

/// A field of a token: unsigned, or sign-extended where the layout says so. 0 for an absent field.
inline std::int64_t extract(std::span<const std::uint32_t> words, Field f) {
  if (f.bits == 0) return 0;
  std::size_t i = f.lsb / 32;
  unsigned shift = f.lsb % 32;
  std::uint64_t v = 0;
  unsigned have = 0;
  while (have < f.bits) {
    v |= static_cast<std::uint64_t>(words[i] >> shift) << have;
    have += 32 - shift;
    shift = 0;
    ++i;
  }
  return f.is_signed ? sign_extend(v, f.bits)
                     : static_cast<std::int64_t>(f.bits == 64 ? v : v & ((std::uint64_t{1} << f.bits) - 1));
}

/// What of a value, counted from the least that fits its field, lies above the field's bits: 0 if it fits. A field of
/// no bits holds 0.
constexpr std::uint64_t beyond(std::int64_t value, Field f) {
  const std::uint64_t least = (std::uint64_t{f.is_signed} << f.bits) >> 1;
  return (static_cast<std::uint64_t>(value) + least) >> f.bits;
}

/// The words of one token: fields of up to 63 bits each, least significant bit first.
class BitPacker {
 public:
  void put(std::int64_t value, Field f) {
    lost_ |= beyond(value, f);
    auto v = static_cast<std::uint64_t>(value);
    unsigned bits = f.bits;
    if (bits > 32) {
      put_half(static_cast<std::uint32_t>(v), 32);
      v >>= 32;
      bits -= 32;
    }
    put_half(v & ((std::uint64_t{1} << bits) - 1), bits);
  }

  /// False if a value did not fit its field.
  [[nodiscard]] bool whole() const { return lost_ == 0; }

  /// The words so far, with zeros up to the end of the last.
  [[nodiscard]] std::span<const std::uint32_t> close() {
    if (have_ > 0) words_[count_++] = static_cast<std::uint32_t>(acc_);
    acc_ = 0;
    have_ = 0;
    return std::span(words_).first(count_);
  }

 private:
  // have_ < 32 between calls, so 32 more bits fit.
  void put_half(std::uint64_t value, unsigned bits) {
    acc_ |= value << have_;
    have_ += bits;
    if (have_ < 32) return;
    words_[count_++] = static_cast<std::uint32_t>(acc_);
    acc_ >>= 32;
    have_ -= 32;
  }

  std::array<std::uint32_t, 16> words_;  // only the first count_ are ever read
  std::size_t count_ = 0;
  std::uint64_t acc_ = 0;
  unsigned have_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace kage
