// SPDX-License-Identifier: Apache-2.0
//
// Inner loops over the pixels of a span, compiled for every instruction set that Highway knows for this machine and
// chosen once at run time. All are integer arithmetic modulo 2^n: every instruction set gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

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

/// Where Z < zb: each channel of attr = round((old * (255 - alpha) + new * alpha) / 255). Depth stays.
void span_tp(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint32_t* attr, const ColorRamp* color,
             int channels, int alpha);

/// The bytes of a line's pixels, `channels` each, lowest first: those of `value`, or, where zb == clear, of
/// `background`.
void line_bytes(int count, const std::int32_t* zb, const std::uint32_t* value, std::int32_t clear,
                std::uint32_t background, int channels, std::uint8_t* out);

}  // namespace kage
