// SPDX-License-Identifier: Apache-2.0
//
// Bit fields in 32-bit words, and integers of stated widths.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "kage/defs.hpp"
#include "number/int128.hpp"

namespace kage {

/// The low `bits` (1 .. 64) of `v` as a two's complement number.
constexpr std::int64_t sign_extend(std::uint64_t v, int bits) {
  return static_cast<std::int64_t>(v << (64 - bits)) >> (64 - bits);
}

/// The bits of a value above those of its field, counted from the least value that fits: 0 if the value fits. A field
/// of no bits holds 0.
constexpr std::uint64_t beyond(std::int64_t value, Field f) {
  const std::uint64_t least = (std::uint64_t{f.is_signed} << f.bits) >> 1;
  return (static_cast<std::uint64_t>(value) + least) >> f.bits;
}

/// Writes the words of one token: fields of up to 63 bits each, least significant bit first. The words lie elsewhere,
/// so that what is kept here can stay in registers.
class BitPacker {
 public:
  explicit BitPacker(std::uint32_t* to) : to_(to) {}

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

  /// Write what is left, with zeros above it, and return the end of the words.
  [[nodiscard]] std::uint32_t* close() {
    if (have_ > 0) *to_++ = static_cast<std::uint32_t>(acc_);
    return to_;
  }

 private:
  // have_ < 32 between calls, so 32 more bits fit.
  void put_half(std::uint64_t value, unsigned bits) {
    acc_ |= value << have_;
    have_ += bits;
    if (have_ < 32) return;
    *to_++ = static_cast<std::uint32_t>(acc_);
    acc_ >>= 32;
    have_ -= 32;
  }

  std::uint32_t* to_;
  std::uint64_t acc_ = 0;
  unsigned have_ = 0;
  std::uint64_t lost_ = 0;
};

/// Bits of the widest field of a token: with up to 7 bits before it in its first byte, they are 64.
inline constexpr int kMostFieldBits = 57;

/// The other way round: takes any field of a token. The eight bytes from its first byte on hold a field whole, so the
/// words are copied to where as many may be read.
class BitUnpacker {
 public:
  /// Begins with the token's words; others may follow.
  explicit BitUnpacker(std::span<const std::uint32_t> words) {
    const std::size_t count = std::min(words.size(), kMostTokenWords);
    for (std::size_t i = 0; i < count; ++i) words_[i] = words[i];
    words_[count] = words_[count + 1] = 0;
  }

  /// A field, sign-extended where the layout says so. 0 for an absent one.
  [[nodiscard]] std::int64_t take(Field f) const {
    if (f.bits == 0) return 0;
    std::uint64_t v = 0;
    std::memcpy(&v, reinterpret_cast<const unsigned char*>(words_) + f.lsb / 8, sizeof v);
    v = v >> f.lsb % 8 << (64 - f.bits);
    return f.is_signed ? static_cast<std::int64_t>(v) >> (64 - f.bits) : static_cast<std::int64_t>(v >> (64 - f.bits));
  }

 private:
  static_assert(std::endian::native == std::endian::little, "the bytes of a word begin with its lowest");

  std::uint32_t words_[kMostTokenWords + 2];  // only what a token has, and two more, is written and read
};

/// A field by its place, without sign.
constexpr std::uint64_t bits_at(std::span<const std::uint32_t> words, Field f) {
  std::uint64_t value = 0;
  for (unsigned done = 0; done < f.bits;) {
    const unsigned at = (f.lsb + done) % 32;
    const unsigned taken = std::min(32 - at, f.bits - done);
    value |= (words[(f.lsb + done) / 32] >> at & ((std::uint64_t{1} << taken) - 1)) << done;
    done += taken;
  }
  return value;
}

/// Puts a value's low bits in a field's place; what is beside it stays.
constexpr void put_at(std::span<std::uint32_t> words, Field f, std::uint64_t value) {
  for (unsigned done = 0; done < f.bits;) {
    const unsigned at = (f.lsb + done) % 32;
    const unsigned taken = std::min(32 - at, f.bits - done);
    const std::uint64_t mask = ((std::uint64_t{1} << taken) - 1) << at;
    std::uint32_t& word = words[(f.lsb + done) / 32];
    word = static_cast<std::uint32_t>((word & ~mask) | (value >> done << at & mask));
    done += taken;
  }
}

}  // namespace kage
