// SPDX-License-Identifier: Apache-2.0
// The golden core's vector kernels, each alone: every instruction set, every size from 0 to three vectors, in guarded
// memory, against the same pixel by pixel.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/span_kernels.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/guarded.hpp"
#include "test/support/simd.hpp"

namespace kage::verif {
namespace {

/// Pixels of a span, with what kernels may touch behind them.
class Pixels {
 public:
  Pixels(Random& random, int count, Edge edge)
      : zb(size(count), edge),
        attr(size(count), edge),
        classes(size(count), edge),
        flag(size(count), edge),
        sum(size(count), edge) {
    for (std::size_t i = 0; i < zb.size(); ++i) {
      zb[i] = random.in(0, 300);
      attr[i] = word(random);
      classes[i] = word(random);
      flag[i] = static_cast<std::uint32_t>(random.in(-3, 3));
      sum[i] = static_cast<std::uint32_t>(random.in(0, 9));
    }
  }
  Pixels(const Pixels& other, Edge edge)
      : zb(other.zb.values(), edge),
        attr(other.attr.values(), edge),
        classes(other.classes.values(), edge),
        flag(other.flag.values(), edge),
        sum(other.sum.values(), edge) {}

  static std::uint32_t word(Random& random) { return static_cast<std::uint32_t>(random.integer(0, 0xffffffff)); }

  bool operator==(const Pixels& other) const {
    return zb == other.zb && attr == other.attr && classes == other.classes && flag == other.flag && sum == other.sum;
  }

  Guarded<std::int32_t> zb;
  Guarded<std::uint32_t> attr, classes, flag, sum;

 private:
  static std::size_t size(int count) { return static_cast<std::size_t>(count) + kKernelSlack; }
};

/// Depths that go through 0 .. 300, past the ends of what a depth may be, and round the accumulator's own end.
DepthRamp random_depths(Random& random) {
  const int shift = random.in(0, 20);
  const auto unit = std::int64_t{1} << (32 + shift);
  const auto any = [&] {
    return static_cast<std::int64_t>(std::uint64_t{Pixels::word(random)} << 32U | Pixels::word(random));
  };
  if (random.chance(0.1)) return {any(), any(), shift, 250};
  return {random.integer(-20, 320) * unit + random.integer(0, unit - 1), random.integer(-9 * unit, 9 * unit), shift,
          250};
}

std::int32_t depth_at(const DepthRamp& r, int k) {
  const auto acc = static_cast<std::int64_t>(static_cast<std::uint64_t>(r.z) +
                                             static_cast<std::uint64_t>(k) * static_cast<std::uint64_t>(r.dz));
  const auto z = static_cast<std::int32_t>(acc >> 32) >> r.shift;
  return std::min(std::max(z, 1), r.z_max);
}

ColorRamp random_color(Random& random) {
  return {static_cast<std::int32_t>(random.integer(INT32_MIN, INT32_MAX)), random.in(-(1 << 27), 1 << 27)};
}

std::uint32_t color_at(const ColorRamp& r, int k) {
  const auto acc = static_cast<std::int32_t>(static_cast<std::uint32_t>(r.c) +
                                             static_cast<std::uint32_t>(k) * static_cast<std::uint32_t>(r.dc));
  return static_cast<std::uint32_t>(std::min(std::max(acc >> 22, 0), 255));
}

/// Calls test(target, count, edge) for all of them, some rounds each.
template <class Test>
void sweep(Test test) {
  int runs = 0;
  on_every_target([&](const simd::Target& target) {
    for (const Edge edge : kEdges)
      for (int count = 0; count <= kMostSize; ++count)
        for (int round = 0; round < 12; ++round, ++runs) {
          CAPTURE(target.name, count, edge == Edge::kEnd);
          test(count, edge);
        }
  });
  CHECK(runs >= 2 * 49 * 12);
}

}  // namespace

TEST_CASE("opaque spans, in one colour and smooth, with classes and without") {
  Random random(test_seed());
  CAPTURE(test_seed());
  sweep([&](int count, Edge edge) {
    const DepthRamp depths = random_depths(random);
    const bool smooth = random.chance(0.5);
    const int channels = random.chance(0.5) ? 3 : 1;
    const ColorRamp colors[3] = {random_color(random), random_color(random), random_color(random)};
    const std::uint32_t value = smooth ? 0xAB000000U : Pixels::word(random);
    const bool with_class = random.chance(0.5);
    Pixels given(random, count, edge);
    Pixels expected(given, edge);
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (depth_at(depths, k) >= expected.zb[i]) continue;
      expected.zb[i] = depth_at(depths, k);
      expected.attr[i] = value;
      for (int ch = 0; smooth && ch < channels; ++ch) expected.attr[i] |= color_at(colors[ch], k) << (8 * ch);
      if (with_class) expected.classes[i] = 5;
    }
    const ClassSpan classes{with_class ? given.classes.data() : nullptr, 5};
    if (smooth)
      span_op_smooth(depths, count, given.zb.data(), given.attr.data(), value, colors, channels, classes);
    else
      span_op_flat(depths, count, given.zb.data(), given.attr.data(), value, classes);
    REQUIRE(given == expected);
  });
}

TEST_CASE("shadow spans, ends of volumes, ends of samples") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  sweep([&](int count, Edge edge) {
    const DepthRamp depths = random_depths(random);
    const auto weight = static_cast<std::uint32_t>(random.in(-2, 2));
    const auto bias = static_cast<std::uint32_t>(random.in(-2, 2));
    const std::uint32_t mask = random.chance(0.5) ? 1 : 7;
    const auto most = static_cast<std::uint32_t>(random.in(1, 9));
    Pixels given(random, count, edge);
    Pixels expected(given, edge);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (depth_at(depths, static_cast<int>(i)) < expected.zb[i]) expected.flag[i] += weight;
    span_sp(depths, count, given.zb.data(), given.flag.data(), weight);
    REQUIRE(given == expected);

    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (((expected.flag[i] + bias) & mask) != 0) expected.attr[i] |= 1;
      expected.flag[i] = 0;
    }
    span_ev(count, given.flag.data(), given.attr.data(), bias, mask);
    REQUIRE(given == expected);

    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (((expected.attr[i] + bias) & mask) != 0 && expected.sum[i] < most) ++expected.sum[i];
      expected.attr[i] = 0;
    }
    span_es(count, given.attr.data(), given.sum.data(), bias, mask, most);
    REQUIRE(given == expected);
  });
}

TEST_CASE("what is lit and in shadow is darkened") {
  Random random(test_seed(6));
  CAPTURE(test_seed(6));
  sweep([&](int count, Edge edge) {
    const int shift = random.in(1, 16);
    const auto whole = std::uint32_t{1} << shift;
    const Darkening darkening{static_cast<std::uint32_t>(random.in(0, static_cast<int>(whole))), whole / 2, shift};
    const auto bias = static_cast<std::uint32_t>(random.in(-2, 2));
    const std::uint32_t mask = random.chance(0.5) ? 1 : 7;
    const std::int32_t clear = random.in(0, 9);
    Pixels given(random, count, edge);
    for (int k = 0; k < count; ++k)
      if (random.chance(0.3)) given.zb[static_cast<std::size_t>(k)] = clear;
    Pixels expected(given, edge);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const bool lit = (expected.attr[i] >> 24 & 1U) != 0;
      if (!lit || expected.zb[i] == clear || ((expected.flag[i] + bias) & mask) == 0) continue;
      std::uint32_t darkened = 1U << 24;
      for (int at = 0; at < 24; at += 8)
        darkened |= (((expected.attr[i] >> at & 255U) * darkening.keep + whole / 2) / whole) << at;
      expected.attr[i] = darkened;
    }
    span_resolve(count, given.zb.data(), clear, given.flag.data(), bias, mask, given.attr.data(), darkening);
    REQUIRE(given == expected);
  });
}

TEST_CASE("spans before a line's depths, and what they count there") {
  Random random(test_seed(5));
  CAPTURE(test_seed(5));
  sweep([&](int count, Edge edge) {
    const DepthRamp depths = random_depths(random);
    const auto weight = static_cast<std::uint8_t>(random.in(-2, 2));
    const std::uint8_t mask = random.chance(0.5) ? 1 : 255;
    Pixels given(random, count, edge);
    for (int k = 0; k < count; ++k)
      if (random.chance(0.3)) given.zb[static_cast<std::size_t>(k)] = 0;
    const std::size_t size = static_cast<std::size_t>(count) + kKernelSlack;
    Guarded<std::uint8_t> dsf(size, edge);
    Guarded<std::uint8_t> flags(size, edge);
    for (std::size_t i = 0; i < size; ++i) {
      dsf[i] = static_cast<std::uint8_t>(random.chance(0.5) ? 0 : random.in(0, 255));
      flags[i] = static_cast<std::uint8_t>(random.in(0, 1));
    }
    Guarded<std::uint8_t> counted(dsf.values(), edge);
    Guarded<std::uint8_t> flagged(flags.values(), edge);
    Pixels expected(given, edge);
    PixelRange before;
    bool all = true;
    bool found = false;
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const bool nearer = depth_at(depths, k) < given.zb[i];
      if (nearer) before.add(k, k + 1);
      all &= nearer || given.zb[i] == 0;
      counted[i] = static_cast<std::uint8_t>(counted[i] + (nearer ? weight : 0));
    }
    const PixelRange alone = span_before(depths, count, given.zb.data());
    const Before got = span_count(depths, count, given.zb.data(), dsf.data(), weight);
    REQUIRE(alone.first == before.first);
    REQUIRE(alone.end == before.end);
    REQUIRE(got.pixels.first == before.first);
    REQUIRE(got.pixels.end == before.end);
    REQUIRE(got.all == all);
    REQUIRE(given == expected);
    REQUIRE(dsf == counted);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const bool inside = given.zb[i] != 0 && (counted[i] & mask) != 0;
      found |= inside && flagged[i] == 0;
      if (inside) flagged[i] = 1;
      counted[i] = 0;
    }
    REQUIRE(span_flag(count, given.zb.data(), dsf.data(), flags.data(), mask) == found);
    REQUIRE(given == expected);
    REQUIRE(dsf == counted);
    REQUIRE(flags == flagged);
  });
}

TEST_CASE("translucent spans round once, to the nearest") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  sweep([&](int count, Edge edge) {
    const DepthRamp depths = random_depths(random);
    const int channels = random.chance(0.5) ? 3 : 1;
    const ColorRamp colors[3] = {random_color(random), random_color(random), random_color(random)};
    const int alpha = random.chance(0.2) ? 255 * random.in(0, 1) : random.in(0, 255);
    Pixels given(random, count, edge);
    Pixels expected(given, edge);
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (depth_at(depths, k) >= expected.zb[i]) continue;
      for (int ch = 0; ch < channels; ++ch) {
        const auto old = static_cast<int>(expected.attr[i] >> (8 * ch) & 255U);
        const int mixed = (2 * (old * (255 - alpha) + static_cast<int>(color_at(colors[ch], k)) * alpha) + 255) / 510;
        expected.attr[i] &= ~(255U << (8 * ch));
        expected.attr[i] |= static_cast<std::uint32_t>(mixed) << (8 * ch);
      }
    }
    span_tp(depths, count, given.zb.data(), given.attr.data(), colors, channels, alpha);
    REQUIRE(given == expected);
  });
}

TEST_CASE("a line's bytes, and not one more") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  sweep([&](int count, Edge edge) {
    const int channels = random.chance(0.5) ? 3 : 1;
    const std::int32_t clear = random.in(0, 300);
    const std::uint32_t background = Pixels::word(random);
    Pixels given(random, count, edge);
    for (int k = 0; k < count; ++k)
      if (random.chance(0.3)) given.zb[static_cast<std::size_t>(k)] = clear;
    Pixels expected(given, edge);
    Guarded<std::uint8_t> out(static_cast<std::size_t>(count) * static_cast<std::size_t>(channels), edge);
    line_bytes(count, given.zb.data(), given.attr.data(), clear, background, channels, out.data());
    REQUIRE(given == expected);
    int wrong = 0;
    for (int k = 0; k < count; ++k)
      for (int ch = 0; ch < channels; ++ch) {
        const auto i = static_cast<std::size_t>(k);
        const std::uint32_t v = expected.zb[i] == clear ? background : expected.attr[i];
        const std::size_t at = i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(ch);
        wrong += out[at] != (v >> (8 * ch) & 255U) ? 1 : 0;
      }
    REQUIRE(wrong == 0);
  });
}

}  // namespace kage::verif
