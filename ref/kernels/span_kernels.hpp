// SPDX-License-Identifier: Apache-2.0
//
// Inner loops over the pixels of a span, compiled for every instruction set that Highway knows for this machine and
// chosen once at run time. All are integer arithmetic modulo 2^n: every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "contract/derived.hpp"
#include "kage/token.hpp"

namespace kage {

/// Depth along a span: acc = z + k * dz, both pre-shifted left so that the top bit of the accumulator is bit 63.
/// Wrapping at 64 bits is then wrapping at the accumulator's own width, and Z = (acc >> 32) >> shift, clamped to 1 ..
/// z_max.
struct DepthRamp {
  std::int64_t z;
  std::int64_t dz;
  int shift;
  std::int32_t z_max;
};

/// The ramp of a span's depth.
inline DepthRamp depth_ramp(const Config& c, const SpanToken& s) {
  const int spare = 64 - derived::depth_bits(c);
  return {static_cast<std::int64_t>(static_cast<std::uint64_t>(s.z) << spare),
          static_cast<std::int64_t>(static_cast<std::uint64_t>(s.dz) << spare), 30 - c.z_bits,
          static_cast<std::int32_t>(derived::most_depth(c))};
}

/// One channel along a span, pre-shifted so that the accumulator's top bit is bit 31: value = clamp(acc >> 22, 0, 255).
struct ColorRamp {
  std::int32_t c;
  std::int32_t dc;
};

/// Arrays may be read and written up to this many elements past `count`, with the old values.
inline constexpr std::size_t kKernelSlack = 64;

/// Where a span's class goes: an array of the line, nullptr without a table.
struct ClassSpan {
  std::uint32_t* at;
  std::uint32_t value;
};

/// Where Z < zb: zb = Z, attr = value, and the class is written.
void span_op_flat(const DepthRamp& ramp, int count, std::int32_t* zb, std::uint32_t* attr, std::uint32_t value,
                  const ClassSpan& classes);

/// Where Z < zb: zb = Z, attr = channels (lowest first) | value, and the class is written.
void span_op_smooth(const DepthRamp& ramp, int count, std::int32_t* zb, std::uint32_t* attr, std::uint32_t value,
                    const ColorRamp* color, int channels, const ClassSpan& classes);

/// Where Z < zb: dsf += w.
void span_sp(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint32_t* dsf, std::uint32_t w);

/// fsf |= ((dsf + bias) & mask) != 0; dsf = 0.
void span_ev(int count, std::uint32_t* dsf, std::uint32_t* fsf, std::uint32_t bias, std::uint32_t mask);

/// Where ((flag + bias) & mask) != 0: counts + 1, at most `most`; flag = 0.
void span_es(int count, std::uint32_t* flag, std::uint32_t* counts, std::uint32_t bias, std::uint32_t mask,
             std::uint32_t most);

/// Darkening: each channel of a colour becomes (channel x keep + half) >> shift.
struct Darkening {
  std::uint32_t keep;
  std::uint32_t half;
  int shift;
};

/// Where ((flag + bias) & mask) != 0, zb is not `clear`, and attr has bit 24: the channels in bits 0 .. 23 of attr are
/// darkened, and the bits above bit 24 become 0.
void span_resolve(int count, const std::int32_t* zb, std::int32_t clear, const std::uint32_t* flag, std::uint32_t bias,
                  std::uint32_t mask, std::uint32_t* attr, const Darkening& darkening);

/// Where Z < zb: each channel of attr = round((old * (255 - alpha) + new * alpha) / 255). Depth stays.
void span_tp(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint32_t* attr, const ColorRamp* color,
             int channels, int alpha);

/// Pixels of a span, from the first to one past the last; none if both are equal.
struct PixelRange {
  int first = 0;
  int end = 0;

  [[nodiscard]] bool none() const { return first == end; }
  void add(int from, int to) {
    first = none() || from < first ? from : first;
    end = to > end ? to : end;
  }
};

/// Pixels of a span, from its first, that lie before a line's depths.
struct Before {
  PixelRange pixels;  ///< where Z < zb, from the first to the last
  bool all = true;    ///< everywhere in the span but where zb is 0
};

/// Pixels where Z < zb, from the first to the last.
PixelRange span_before(const DepthRamp& ramp, int count, const std::int32_t* zb);

/// Where Z < zb: dsf += w, modulo 256.
Before span_count(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint8_t* dsf, std::uint8_t w);

/// Where (dsf & mask) != 0 and zb is not 0: flag = 1; dsf = 0.
/// @return whether a flag was 0 before
bool span_flag(int count, const std::int32_t* zb, std::uint8_t* dsf, std::uint8_t* flag, std::uint8_t mask);

/// The bytes of a line's pixels, `channels` each, lowest first: those of `value`, or, where zb == clear, of
/// `background`.
void line_bytes(int count, const std::int32_t* zb, const std::uint32_t* value, std::int32_t clear,
                std::uint32_t background, int channels, std::uint8_t* out);

}  // namespace kage
