// SPDX-License-Identifier: Apache-2.0
#include "kernels/span_kernels.hpp"

#include <array>
#include <bit>

#include "simd/targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/span_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kage::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D32 = hn::ScalableTag<std::int32_t>;
using DU32 = hn::RebindToUnsigned<D32>;
using D64 = hn::RepartitionToWide<D32>;

// The depth of Lanes(D32) neighbouring pixels at a time.
class Depths {
 public:
  explicit Depths(const DepthRamp& r) : shift_(r.shift), z_max_(hn::Set(D32(), r.z_max)) {
    const D64 d;
    const std::size_t half = hn::Lanes(d);
    // Multiples of the step by its doubles, in registers: a vector just written to memory in parts is slow to read.
    const auto step = static_cast<std::uint64_t>(r.dz);
    const auto lane = hn::Iota(d, 0);
    low_ = hn::Set(d, r.z);
    for (std::size_t bit = 1; bit < half; bit *= 2) {
      const auto odd = hn::TestBit(lane, hn::Set(d, static_cast<std::int64_t>(bit)));
      low_ = hn::Add(low_, hn::IfThenElseZero(odd, hn::Set(d, static_cast<std::int64_t>(step * bit))));
    }
    const auto half_step = hn::Set(d, static_cast<std::int64_t>(step * half));
    high_ = hn::Add(low_, half_step);
    full_step_ = hn::Add(half_step, half_step);
  }

  HWY_INLINE hn::Vec<D32> next() {
    const D32 d;
    const auto top = hn::ConcatOdd(d, hn::BitCast(d, high_), hn::BitCast(d, low_));
    low_ = hn::Add(low_, full_step_);
    high_ = hn::Add(high_, full_step_);
    return hn::Min(hn::Max(hn::ShiftRightSame(top, shift_), hn::Set(d, 1)), z_max_);
  }

 private:
  int shift_;
  hn::Vec<D32> z_max_;
  hn::Vec<D64> low_;
  hn::Vec<D64> high_;
  hn::Vec<D64> full_step_;
};

class Colors {
 public:
  Colors() = default;
  explicit Colors(const ColorRamp& r) {
    const D32 d;
    acc_ = hn::Add(hn::Set(d, r.c), hn::Mul(hn::Iota(d, 0), hn::Set(d, r.dc)));
    step_ = hn::Set(d, static_cast<std::int32_t>(static_cast<std::uint32_t>(r.dc) * hn::Lanes(d)));
  }

  HWY_INLINE hn::Vec<DU32> next() {
    const D32 d;
    const auto c = hn::Min(hn::Max(hn::ShiftRight<22>(acc_), hn::Zero(d)), hn::Set(d, 255));
    acc_ = hn::Add(acc_, step_);
    return hn::BitCast(DU32(), c);
  }

 private:
  hn::Vec<D32> acc_;
  hn::Vec<D32> step_;
};

// Mask of the lanes from `x` that still belong to the span.
HWY_INLINE hn::Mask<D32> lanes_left(int x, int count) { return hn::FirstN(D32(), static_cast<std::size_t>(count - x)); }

// The class of the pixels that `nearer` says.
HWY_INLINE void put_class(const ClassSpan& classes, int x, hn::Mask<DU32> nearer) {
  const DU32 du;
  if (classes.at == nullptr) return;
  const auto old = hn::LoadU(du, classes.at + x);
  hn::StoreU(hn::IfThenElse(nearer, hn::Set(du, classes.value), old), du, classes.at + x);
}

void OpFlat(const DepthRamp& ramp, int count, std::int32_t* HWY_RESTRICT zb, std::uint32_t* HWY_RESTRICT attr,
            std::uint32_t value, const ClassSpan& classes) {
  const D32 d;
  const DU32 du;
  Depths depths(ramp);
  const auto v = hn::Set(du, value);
  const int n = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += n) {
    const auto z = depths.next();
    const auto old = hn::LoadU(d, zb + x);
    auto nearer = hn::Lt(z, old);
    if (count - x < n) nearer = hn::And(nearer, lanes_left(x, count));
    hn::StoreU(hn::IfThenElse(nearer, z, old), d, zb + x);
    const auto mask_u = hn::RebindMask(du, nearer);
    hn::StoreU(hn::IfThenElse(mask_u, v, hn::LoadU(du, attr + x)), du, attr + x);
    put_class(classes, x, mask_u);
  }
}

void OpSmooth(const DepthRamp& ramp, int count, std::int32_t* HWY_RESTRICT zb, std::uint32_t* HWY_RESTRICT attr,
              std::uint32_t value, const ColorRamp* color, int channels, const ClassSpan& classes) {
  const D32 d;
  const DU32 du;
  Depths depths(ramp);
  Colors c0(color[0]);
  Colors c1(color[channels > 1 ? 1 : 0]);
  Colors c2(color[channels > 1 ? 2 : 0]);
  const auto v = hn::Set(du, value);
  const int n = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += n) {
    const auto z = depths.next();
    const auto old = hn::LoadU(d, zb + x);
    auto nearer = hn::Lt(z, old);
    if (count - x < n) nearer = hn::And(nearer, lanes_left(x, count));
    hn::StoreU(hn::IfThenElse(nearer, z, old), d, zb + x);
    auto a = hn::Or(v, c0.next());
    if (channels > 1) a = hn::Or(a, hn::Or(hn::ShiftLeft<8>(c1.next()), hn::ShiftLeft<16>(c2.next())));
    const auto mask_u = hn::RebindMask(du, nearer);
    hn::StoreU(hn::IfThenElse(mask_u, a, hn::LoadU(du, attr + x)), du, attr + x);
    put_class(classes, x, mask_u);
  }
}

void Sp(const DepthRamp& ramp, int count, const std::int32_t* HWY_RESTRICT zb, std::uint32_t* HWY_RESTRICT dsf,
        std::uint32_t w) {
  const D32 d;
  const DU32 du;
  Depths depths(ramp);
  const auto v = hn::Set(du, w);
  const int n = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += n) {
    auto nearer = hn::Lt(depths.next(), hn::LoadU(d, zb + x));
    if (count - x < n) nearer = hn::And(nearer, lanes_left(x, count));
    hn::StoreU(hn::Add(hn::LoadU(du, dsf + x), hn::IfThenElseZero(hn::RebindMask(du, nearer), v)), du, dsf + x);
  }
}

void Ev(int count, std::uint32_t* HWY_RESTRICT dsf, std::uint32_t* HWY_RESTRICT fsf, std::uint32_t bias,
        std::uint32_t mask) {
  const D32 d;
  const DU32 du;
  const auto b = hn::Set(du, bias);
  const auto m = hn::Set(du, mask);
  const int n = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += n) {
    auto in = hn::FirstN(du, static_cast<std::size_t>(count - x));
    const auto old = hn::LoadU(du, dsf + x);
    const auto inside = hn::And(in, hn::Ne(hn::And(hn::Add(old, b), m), hn::Zero(du)));
    hn::StoreU(hn::Or(hn::LoadU(du, fsf + x), hn::IfThenElseZero(inside, hn::Set(du, 1))), du, fsf + x);
    hn::StoreU(hn::IfThenZeroElse(in, old), du, dsf + x);
  }
}

void Es(int count, std::uint32_t* HWY_RESTRICT flag, std::uint32_t* HWY_RESTRICT counts, std::uint32_t bias,
        std::uint32_t mask, std::uint32_t most) {
  const DU32 du;
  const auto b = hn::Set(du, bias);
  const auto m = hn::Set(du, mask);
  const int n = static_cast<int>(hn::Lanes(du));
  for (int x = 0; x < count; x += n) {
    const auto in = hn::FirstN(du, static_cast<std::size_t>(count - x));
    const auto old = hn::LoadU(du, flag + x);
    const auto sum = hn::LoadU(du, counts + x);
    const auto shadowed = hn::And(hn::Ne(hn::And(hn::Add(old, b), m), hn::Zero(du)), hn::Lt(sum, hn::Set(du, most)));
    const auto one = hn::IfThenElseZero(hn::And(in, shadowed), hn::Set(du, 1));
    hn::StoreU(hn::Add(sum, one), du, counts + x);
    hn::StoreU(hn::IfThenZeroElse(in, old), du, flag + x);
  }
}

// The pixels from `x` on that a mask has, which has some.
HWY_INLINE void add_lanes(PixelRange& pixels, int x, hn::Mask<D32> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(D32(), mask, bytes.data());
  const auto bits = std::bit_cast<std::uint64_t>(bytes);
  pixels.add(x + std::countr_zero(bits), x + static_cast<int>(std::bit_width(bits)));
}

void Resolve(int count, const std::int32_t* HWY_RESTRICT zb, std::int32_t clear, const std::uint32_t* HWY_RESTRICT flag,
             std::uint32_t bias, std::uint32_t mask, std::uint32_t* HWY_RESTRICT attr, const Darkening& darkening) {
  const D32 d;
  const DU32 du;
  const auto b = hn::Set(du, bias);
  const auto m = hn::Set(du, mask);
  const auto lit = hn::Set(du, 1U << 24);
  const auto byte = hn::Set(du, 255U);
  const auto keep = hn::Set(du, darkening.keep);
  const auto half = hn::Set(du, darkening.half);
  const int n = static_cast<int>(hn::Lanes(du));
  for (int x = 0; x < count; x += n) {
    const auto old = hn::LoadU(du, attr + x);
    auto takes = hn::Ne(hn::And(hn::Add(hn::LoadU(du, flag + x), b), m), hn::Zero(du));
    takes = hn::And(takes, hn::TestBit(old, lit));
    takes = hn::And(takes, hn::FirstN(du, static_cast<std::size_t>(count - x)));
    takes = hn::And(takes, hn::RebindMask(du, hn::Ne(hn::LoadU(d, zb + x), hn::Set(d, clear))));
    if (hn::AllFalse(du, takes)) continue;
    const auto darkened = [&](hn::Vec<DU32> channel) {
      return hn::ShiftRightSame(hn::Add(hn::Mul(hn::And(channel, byte), keep), half), darkening.shift);
    };
    const auto low = darkened(old);
    const auto middle = hn::ShiftLeft<8>(darkened(hn::ShiftRight<8>(old)));
    const auto high = hn::ShiftLeft<16>(darkened(hn::ShiftRight<16>(old)));
    hn::StoreU(hn::IfThenElse(takes, hn::Or(hn::Or(low, middle), hn::Or(high, lit)), old), du, attr + x);
  }
}

PixelRange InFront(const DepthRamp& ramp, int count, const std::int32_t* HWY_RESTRICT zb) {
  const D32 d;
  Depths depths(ramp);
  const int n = static_cast<int>(hn::Lanes(d));
  PixelRange pixels;
  for (int x = 0; x < count; x += n) {
    const auto nearer = hn::And(lanes_left(x, count), hn::Lt(depths.next(), hn::LoadU(d, zb + x)));
    if (hn::AllFalse(d, nearer)) continue;
    add_lanes(pixels, x, nearer);
  }
  return pixels;
}

Before Count(const DepthRamp& ramp, int count, const std::int32_t* HWY_RESTRICT zb, std::uint8_t* HWY_RESTRICT dsf,
             std::uint8_t w) {
  const D32 d;
  const hn::Rebind<std::uint8_t, D32> d8;
  Depths depths(ramp);
  const auto v = hn::Set(d, w);
  const int n = static_cast<int>(hn::Lanes(d));
  Before before;
  for (int x = 0; x < count; x += n) {
    const auto at = hn::LoadU(d, zb + x);
    const auto in = hn::And(lanes_left(x, count), hn::Gt(at, hn::Zero(d)));
    const auto nearer = hn::And(in, hn::Lt(depths.next(), at));
    before.all &= hn::AllFalse(d, hn::AndNot(nearer, in));
    if (hn::AllFalse(d, nearer)) continue;
    add_lanes(before.pixels, x, nearer);
    const auto more = hn::DemoteTo(d8, hn::IfThenElseZero(nearer, v));
    hn::StoreU(hn::Add(hn::LoadU(d8, dsf + x), more), d8, dsf + x);
  }
  return before;
}

bool Flag(int count, const std::int32_t* HWY_RESTRICT zb, std::uint8_t* HWY_RESTRICT dsf,
          std::uint8_t* HWY_RESTRICT flag, std::uint8_t mask) {
  const D32 d;
  const hn::Rebind<std::uint8_t, D32> d8;
  const auto m = hn::Set(d, mask);
  const auto zero = hn::Zero(d);
  const int n = static_cast<int>(hn::Lanes(d));
  bool found = false;
  for (int x = 0; x < count; x += n) {
    const auto in = hn::And(lanes_left(x, count), hn::Gt(hn::LoadU(d, zb + x), zero));
    const auto inside = hn::And(in, hn::Ne(hn::And(hn::PromoteTo(d, hn::LoadU(d8, dsf + x)), m), zero));
    const auto old = hn::PromoteTo(d, hn::LoadU(d8, flag + x));
    found = found || !hn::AllFalse(d, hn::And(inside, hn::Eq(old, zero)));
    hn::StoreU(hn::DemoteTo(d8, hn::IfThenElse(inside, hn::Set(d, 1), old)), d8, flag + x);
  }
  for (int x = 0; x < count; ++x) dsf[x] = 0;
  return found;
}

// The old channel from bit `at` of attr, and the new value, blended into the same place.
HWY_INLINE hn::Vec<DU32> blend(hn::Vec<DU32> attr, int at, hn::Vec<DU32> value, hn::Vec<D32> alpha) {
  const D32 d;
  const DU32 du;
  const auto old = hn::BitCast(d, hn::And(hn::ShiftRightSame(attr, at), hn::Set(du, 255U)));
  // 255 old + alpha (new - old) + 128 is at least 128 and less than 2^16; adding its own 1/256 makes the division by
  // 256 one by 255, rounded.
  const auto difference = hn::Sub(hn::BitCast(d, value), old);
  const auto sum = hn::Add(hn::Add(hn::Sub(hn::ShiftLeft<8>(old), old), hn::Set(d, 128)), hn::Mul(difference, alpha));
  return hn::ShiftLeftSame(hn::BitCast(du, hn::ShiftRight<8>(hn::Add(sum, hn::ShiftRight<8>(sum)))), at);
}

void Tp(const DepthRamp& ramp, int count, const std::int32_t* HWY_RESTRICT zb, std::uint32_t* HWY_RESTRICT attr,
        const ColorRamp* color, int channels, int alpha) {
  const D32 d;
  const DU32 du;
  Depths depths(ramp);
  Colors c0(color[0]);
  Colors c1(color[1]);
  Colors c2(color[2]);
  const auto a = hn::Set(d, alpha);
  const auto rest = hn::Set(du, channels > 1 ? 0xFF000000U : 0xFFFFFF00U);
  const int n = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += n) {
    auto in_front = hn::Lt(depths.next(), hn::LoadU(d, zb + x));
    if (count - x < n) in_front = hn::And(in_front, lanes_left(x, count));
    const auto old = hn::LoadU(du, attr + x);
    auto mixed = hn::Or(hn::And(old, rest), blend(old, 0, c0.next(), a));
    if (channels > 1) mixed = hn::Or(mixed, hn::Or(blend(old, 8, c1.next(), a), blend(old, 16, c2.next(), a)));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(du, in_front), mixed, old), du, attr + x);
  }
}

void Bytes(int count, const std::int32_t* HWY_RESTRICT zb, const std::uint32_t* HWY_RESTRICT value, std::int32_t clear,
           std::uint32_t background, int channels, std::uint8_t* HWY_RESTRICT out) {
  const D32 d;
  const DU32 du;
  const hn::Rebind<std::uint8_t, DU32> d8;
  const auto mask = hn::Set(du, 255U);
  const int n = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + n <= count; x += n) {
    const auto is_clear = hn::RebindMask(du, hn::Eq(hn::LoadU(d, zb + x), hn::Set(d, clear)));
    const auto v = hn::IfThenElse(is_clear, hn::Set(du, background), hn::LoadU(du, value + x));
    const auto low = hn::U8FromU32(hn::And(v, mask));
    if (channels == 1) {
      hn::StoreU(low, d8, out + x);
      continue;
    }
    const auto middle = hn::U8FromU32(hn::And(hn::ShiftRight<8>(v), mask));
    hn::StoreInterleaved3(low, middle, hn::U8FromU32(hn::And(hn::ShiftRight<16>(v), mask)), d8,
                          out + std::ptrdiff_t{3} * x);
  }
  for (; x < count; ++x) {
    const std::uint32_t v = zb[x] == clear ? background : value[x];
    for (int c = 0; c < channels; ++c) out[channels * x + c] = static_cast<std::uint8_t>(v >> (8 * c));
  }
}

}  // namespace kage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kage {

HWY_EXPORT(OpFlat);
HWY_EXPORT(OpSmooth);
HWY_EXPORT(Sp);
HWY_EXPORT(Ev);
HWY_EXPORT(Es);
HWY_EXPORT(Tp);
HWY_EXPORT(Resolve);
HWY_EXPORT(InFront);
HWY_EXPORT(Count);
HWY_EXPORT(Flag);
HWY_EXPORT(Bytes);

void span_op_flat(const DepthRamp& ramp, int count, std::int32_t* zb, std::uint32_t* attr, std::uint32_t value,
                  const ClassSpan& classes) {
  KAGE_DISPATCH(OpFlat)(ramp, count, zb, attr, value, classes);
}
void span_op_smooth(const DepthRamp& ramp, int count, std::int32_t* zb, std::uint32_t* attr, std::uint32_t value,
                    const ColorRamp* color, int channels, const ClassSpan& classes) {
  KAGE_DISPATCH(OpSmooth)(ramp, count, zb, attr, value, color, channels, classes);
}
void span_sp(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint32_t* dsf, std::uint32_t w) {
  KAGE_DISPATCH(Sp)(ramp, count, zb, dsf, w);
}
void span_ev(int count, std::uint32_t* dsf, std::uint32_t* fsf, std::uint32_t bias, std::uint32_t mask) {
  KAGE_DISPATCH(Ev)(count, dsf, fsf, bias, mask);
}
void span_es(int count, std::uint32_t* flag, std::uint32_t* counts, std::uint32_t bias, std::uint32_t mask,
             std::uint32_t most) {
  KAGE_DISPATCH(Es)(count, flag, counts, bias, mask, most);
}
void span_tp(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint32_t* attr, const ColorRamp* color,
             int channels, int alpha) {
  KAGE_DISPATCH(Tp)(ramp, count, zb, attr, color, channels, alpha);
}
void span_resolve(int count, const std::int32_t* zb, std::int32_t clear, const std::uint32_t* flag, std::uint32_t bias,
                  std::uint32_t mask, std::uint32_t* attr, const Darkening& darkening) {
  KAGE_DISPATCH(Resolve)(count, zb, clear, flag, bias, mask, attr, darkening);
}
PixelRange span_before(const DepthRamp& ramp, int count, const std::int32_t* zb) {
  return KAGE_DISPATCH(InFront)(ramp, count, zb);
}
Before span_count(const DepthRamp& ramp, int count, const std::int32_t* zb, std::uint8_t* dsf, std::uint8_t w) {
  return KAGE_DISPATCH(Count)(ramp, count, zb, dsf, w);
}
bool span_flag(int count, const std::int32_t* zb, std::uint8_t* dsf, std::uint8_t* flag, std::uint8_t mask) {
  return KAGE_DISPATCH(Flag)(count, zb, dsf, flag, mask);
}
void line_bytes(int count, const std::int32_t* zb, const std::uint32_t* value, std::int32_t clear,
                std::uint32_t background, int channels, std::uint8_t* out) {
  KAGE_DISPATCH(Bytes)(count, zb, value, clear, background, channels, out);
}

}  // namespace kage
#endif
