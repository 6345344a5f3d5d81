// SPDX-License-Identifier: Apache-2.0
//
// Bit fields in 32-bit words, and integers of stated widths.
#pragma once

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

/// Appends fields to words, least significant bit first.
class BitPacker {
 public:
  explicit BitPacker(std::vector<std::uint32_t>& out) : out_(&out) {}

  void put(std::uint64_t value, unsigned bits) {
    if (bits == 0) return;
    acc_ |= static_cast<Uint128>(value & (~std::uint64_t{0} >> (64 - bits))) << have_;
    have_ += bits;
    while (have_ >= 32) {
      out_->push_back(static_cast<std::uint32_t>(acc_));
      acc_ >>= 32;
      have_ -= 32;
    }
  }
  void put_signed(std::int64_t value, unsigned bits) { put(static_cast<std::uint64_t>(value), bits); }

  /// Pad with zeros to the next word.
  void close() {
    if (have_ > 0) out_->push_back(static_cast<std::uint32_t>(acc_));
    acc_ = 0;
    have_ = 0;
  }

 private:
  std::vector<std::uint32_t>* out_;
  Uint128 acc_ = 0;
  unsigned have_ = 0;
};

}  // namespace kage
