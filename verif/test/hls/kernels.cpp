// SPDX-License-Identifier: Apache-2.0
// The kernels of hls/ against ref/, bit by bit: random vectors and corners. Compiled three times, with kage's own
// types, with Algorithmic C's and with AMD's (hls/types.hpp).
//
// usage: hls_kernels_TYPES [VECTORS [KERNEL]]: so many vectors a kernel, default 100000, of all kernels or of edge,
// span, plane, segment, cell, blend or pixel alone. From 10000000 on more widths of edges are tried whole. Exit code 1:
// a kernel gives another bit; 2: no such kernel.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <random>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/pixel_line.hpp"
#include "frontend/edge_walker.hpp"
#include "frontend/span_setup.hpp"
#include "kernels/compare_cell.hpp"
#include "kernels/edge_setup.hpp"
#include "kernels/edge_step.hpp"
#include "kernels/pixel_blend.hpp"
#include "kernels/pixel_next.hpp"
#include "kernels/plane_step.hpp"
#include "kernels/segment_make.hpp"
#include "kernels/span_kernels.hpp"
#include "kernels/span_setup.hpp"
#include "number/int128.hpp"

namespace {

using kage::EdgeWalker;
using kage::Int128;
using kage::ScreenVertex;

#if !defined(KAGE_HLS_AC) && !defined(KAGE_HLS_AP)
// Code that breaks the rule of hls/types.hpp does not compile: operands of two types, a result that goes on without a
// variable.
template <class A, class B>
concept Adds = requires(A a, B b) {
  a + b;
};
template <class A>
concept Goes = requires(A a) {
  (a + a) >> 1;
};
static_assert(Adds<hw::u<5>, hw::u<5>>);
static_assert(!Adds<hw::u<5>, hw::u<4>> && !Adds<hw::u<5>, hw::s<5>> && !Adds<hw::u<5>, int>);
static_assert(!Goes<hw::u<5>> && !std::is_convertible_v<hw::Result<5, false>, hw::u<6>>);
static_assert(!std::is_convertible_v<hw::u<4>, hw::u<5>> && !std::is_convertible_v<int, hw::u<5>>);
#endif

long vectors = 100000;
bool bad = false;

/// Says that a kernel is not what ref/ is, with the numbers that show it.
void differs(const char* kernel, std::initializer_list<std::int64_t> numbers) {
  std::printf("%s differs:", kernel);
  for (const std::int64_t n : numbers) std::printf(" %lld", static_cast<long long>(n));
  std::printf("\n");
  bad = true;
}

class Dice {
 public:
  std::uint64_t bits() { return engine_(); }
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % (static_cast<std::uint64_t>(high - low) + 1));
  }
  /// A number of a type of so many bits: of any size, or next to an end or to 0.
  std::int64_t of_bits(int bits, bool is_signed) {
    const std::int64_t least = is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
    const std::int64_t most = is_signed ? -(least + 1) : static_cast<std::int64_t>((std::uint64_t{1} << bits) - 1);
    const std::int64_t low = std::max(least, -(std::int64_t{1} << between(0, std::min(bits - 1, 62))));
    const std::int64_t high = std::min(most, std::int64_t{1} << between(0, std::min(bits, 62)));
    switch (between(0, 7)) {
      case 0:
        return least + between(0, 3);
      case 1:
        return most - between(0, 3);
      case 2:
        return std::clamp<std::int64_t>(between(-3, 3), least, most);
      default:
        return between(low, high);
    }
  }

 private:
  std::mt19937_64 engine_{20261127};
};

constexpr int kLimit = kage::kGuard * 256;

/// Corners of edges: ends of the guard band, pixels' centres and their neighbours, short ways and long ones.
std::int32_t coordinate(Dice& dice) {
  switch (dice.between(0, 5)) {
    case 0:
      return static_cast<std::int32_t>((dice.between(0, 1) == 0 ? -1 : 1) * (kLimit - dice.between(0, 300)));
    case 1:
      return static_cast<std::int32_t>(dice.between(-2000, 2000) * 256 + 128 + dice.between(-1, 1));
    case 2:
      return static_cast<std::int32_t>(dice.between(-600, 600));
    default:
      return static_cast<std::int32_t>(dice.between(-kLimit, kLimit));
  }
}

kage::hls::EdgeSetupIn setup_of(const ScreenVertex& a, const ScreenVertex& b, int line) {
  using kage::hls::Subpixel;
  const bool down = a.y < b.y;
  const ScreenVertex& top = down ? a : b;
  const ScreenVertex& bottom = down ? b : a;
  kage::hls::EdgeSetupIn in;
  in.top_x = Subpixel(top.x);
  in.top_y = Subpixel(top.y);
  in.bottom_x = Subpixel(bottom.x);
  in.bottom_y = Subpixel(bottom.y);
  in.line = kage::hls::Line(line);
  return in;
}

/// edge_setup and edge_step cross every line where EdgeWalker does.
void edges() {
  Dice dice;
  for (long done = 0; done < vectors;) {
    const ScreenVertex a{coordinate(dice), coordinate(dice)};
    ScreenVertex b{coordinate(dice), coordinate(dice)};
    if (dice.between(0, 3) == 0)
      b.y = static_cast<std::int32_t>(std::clamp<std::int64_t>(a.y + dice.between(-600, 600), -kLimit, kLimit));
    EdgeWalker walker(a, b);
    const int first = std::max(walker.first(), 0);
    const int end = std::min(walker.end(), kage::kMaxSize);
    if (first >= end) continue;
    int y = dice.between(0, 2) == 0 ? static_cast<int>(dice.between(first, end - 1)) : first;
    walker.start(y);
    kage::hls::Edge edge;
    kage::hls::edge_setup(setup_of(a, b, y), edge);
    for (const int last = std::min(end, y + 32); y < last; ++y, ++done) {
      if (hw::value(edge.x) != walker.x()) return differs("edge", {a.x, a.y, b.x, b.y, y, walker.x()});
      kage::hls::Edge next;
      kage::hls::edge_step(edge, next);
      edge = next;
      walker.next();
    }
  }
}

/// The same for every edge that there is with narrow coordinates, from each of its lines on. EdgeWalker has them as the
/// multiples of 2^(8 - FRAC) that they are in 16.8.
template <int WHOLE, int FRAC>
void every_edge() {
  constexpr int kBits = WHOLE + FRAC;
  constexpr int kMost = (1 << (kBits - 1)) - 1;
  constexpr int kScale = 1 << (8 - FRAC);
  using kage::hls::SubpixelOf;
  const auto setup = [](int ax, int ay, int bx, int by, int y) {
    kage::hls::EdgeSetupInOf<WHOLE, FRAC> in;
    in.top_x = SubpixelOf<WHOLE, FRAC>(ax);
    in.top_y = SubpixelOf<WHOLE, FRAC>(ay);
    in.bottom_x = SubpixelOf<WHOLE, FRAC>(bx);
    in.bottom_y = SubpixelOf<WHOLE, FRAC>(by);
    in.line = kage::hls::LineOf<WHOLE>(y);
    kage::hls::EdgeOf<WHOLE, FRAC> edge;
    kage::hls::edge_setup(in, edge);
    return edge;
  };
  long lines = 0;
  for (int ay = -kMost - 1; ay < kMost; ++ay)
    for (int by = ay + 1; by <= kMost; ++by)
      for (int ax = -kMost - 1; ax <= kMost; ++ax)
        for (int bx = -kMost - 1; bx <= kMost; ++bx) {
          EdgeWalker walker({ax * kScale, ay * kScale}, {bx * kScale, by * kScale});
          const int first = std::max(walker.first(), 0);
          if (first >= walker.end()) continue;
          walker.start(first);
          auto edge = setup(ax, ay, bx, by, first);
          for (int y = first; y < walker.end(); ++y, ++lines) {
            const auto begun = setup(ax, ay, bx, by, y);
            if (hw::value(edge.x) != walker.x() || hw::value(begun.x) != walker.x() ||
                hw::value(begun.rest) != hw::value(edge.rest) ||
                hw::value(begun.rest_step) != hw::value(edge.rest_step))
              return differs("edge", {WHOLE, FRAC, ax, ay, bx, by, y, walker.x()});
            kage::hls::EdgeOf<WHOLE, FRAC> next;
            kage::hls::edge_step(edge, next);
            edge = next;
            walker.next();
          }
        }
  std::printf("edges of %d.%d, every one: %ld lines\n", WHOLE, FRAC, lines);
}

/// The value of a plane's spans in an accumulator of BITS bits with FRAC of them a fraction.
template <int BITS, int FRAC>
void span_setup_is_ref() {
  constexpr int kPlane = BITS - FRAC + kage::kPlaneFrac;
  using Value = hw::s<kPlane>;
  Dice dice;
  const kage::SpanSetup setup(FRAC, BITS, FRAC);
  constexpr kage::hls::SpanRounding kRounding = kage::hls::span_rounding(FRAC);
  constexpr int kShift = kage::kPlaneFrac - FRAC;
  long held = 0;
  for (long i = 0; i < vectors; ++i) {
    const int count = static_cast<int>(dice.between(1, dice.between(0, 3) == 0 ? 3 : 2000));
    kage::ScreenPlane plane;
    plane.c = dice.of_bits(kPlane - 1, true);
    plane.a = dice.of_bits(kPlane - static_cast<int>(dice.between(1, 20)), true);
    int parts = 0;
    kage::SpanSetup::Ramp ramp{};
    setup.each(plane, 0, count, 0, [&](int, int, kage::SpanSetup::Ramp r) {
      ++parts;
      ramp = r;
    });
    // The spans that a polygon of the stream has: one part, which is neither clamped nor bent.
    const Int128 last = static_cast<Int128>(plane.c) + static_cast<Int128>(plane.a) * (count - 1);
    const Int128 limit = (static_cast<Int128>(1) << (kPlane - 1)) - (1 << 24);
    if (parts > 1 || plane.c >= limit || last >= limit || last < -limit) continue;
    if (count > 1 && ramp.step != setup.step(plane)) continue;
    ++held;
    kage::hls::SpanSetupIn<kPlane> in;
    in.value = Value(plane.c);
    in.slope = Value(plane.a);
    in.single = hw::u<1>(count == 1);
    in.start_rounding = Value(kRounding.start);
    in.step_rounding = Value(kRounding.step);
    kage::hls::SpanSetupOut<kPlane> out;
    kage::hls::span_setup(in, out);
    const std::int64_t start = hw::value(out.start) >> kShift;
    const std::int64_t step = hw::value(out.step) >> kShift;
    if (start != ramp.start || step != ramp.step)
      return differs("span_setup", {BITS, FRAC, plane.c, plane.a, count, ramp.start, ramp.step});
  }
  if (held < vectors / 8) return differs("span_setup is hardly tried", {BITS, FRAC, held});
}

/// span_setup rounds as SpanSetup.
void spans() {
  span_setup_is_ref<37, 11>();
  span_setup_is_ref<26, 8>();
  span_setup_is_ref<46, 16>();
  span_setup_is_ref<17, 0>();
  span_setup_is_ref<18, 8>();  // colours
  span_setup_is_ref<22, 12>();
}

/// plane_step gives a plane's value at the first pixel of the next span.
void planes() {
  constexpr int kBits = 50;
  using Value = hw::s<kBits>;
  Dice dice;
  for (long i = 0; i < vectors; ++i) {
    kage::ScreenPlane plane;
    plane.a = dice.of_bits(kBits, true);
    plane.b = dice.of_bits(kBits, true);
    plane.c = dice.of_bits(kBits, true);
    plane.x0 = static_cast<std::int32_t>(dice.between(0, kage::kMaxSize));
    const auto to = static_cast<std::int32_t>(dice.between(0, kage::kMaxSize));
    const Int128 next = kage::value_at(plane, to, 1);
    kage::hls::PlaneStepIn<kBits> in;
    in.value = Value(plane.c);
    in.right = Value(plane.a);
    in.down = Value(plane.b);
    in.move = hw::s<17>(to - plane.x0);
    kage::hls::PlaneStepOut<kBits> out;
    kage::hls::plane_step(in, out);
    // Modulo 2^50; where the value fits, it is the value.
    const auto low = static_cast<std::uint64_t>(next) << (64 - kBits);
    if (static_cast<std::int64_t>(low) >> (64 - kBits) != hw::value(out.value))
      return differs("plane_step", {plane.a, plane.b, plane.c, plane.x0, to});
  }
}

/// segment_make cuts a run as the front end does.
void segments() {
  constexpr int kX = 11;
  constexpr int kDx = 9;
  constexpr int kDepth = 37;
  Dice dice;
  for (long done = 0; done < vectors;) {
    const auto at = static_cast<int>(dice.between(0, 3) == 0 ? 0 : dice.between(0, (1 << kX) - 2));
    const auto end = static_cast<int>(dice.between(at + 1, (1 << kX) - 1));
    const std::int64_t step = dice.of_bits(kDepth - 12, true);
    const std::int64_t z = dice.of_bits(kDepth - 2, true);
    kage::hls::SegmentMakeIn<kX, kDepth> in;
    in.at = hw::u<kX>(at);
    in.end = hw::u<kX>(end);
    in.depth = hw::s<kDepth>(z);
    in.step = hw::s<kDepth>(step);
    // [ref/frontend/tree_layout.cpp: pieces of most_dx pixels from the run's first one on]
    for (int from = at; from < end; ++done) {
      kage::hls::SegmentMakeOut<kX, kDx, kDepth> out;
      kage::hls::segment_make(in, out);
      const int dx = std::min(end - from, (1 << kDx) - 1);
      const bool same = hw::value(out.sync) == (from == 0 ? 1 : 0) && hw::value(out.dx) == dx &&
                        hw::value(out.last) == (from + dx == end ? 1 : 0) && hw::value(out.at) == from + dx &&
                        hw::value(in.depth) == z + static_cast<std::int64_t>(from - at) * step;
      if (!same) return differs("segment_make", {at, end, from, z, step});
      in.at = out.at;
      in.depth = out.depth;
      from += dx;
    }
  }
}

/// compare_cell takes the lesser key, and the left one of equal keys.
void cells() {
  Dice dice;
  for (long i = 0; i < vectors; ++i) {
    const std::int64_t left = dice.of_bits(32, false);
    const std::int64_t right = dice.between(0, 2) == 0 ? left : dice.of_bits(32, false);
    kage::hls::CompareCellIn<32, 25> in;
    in.left.key = hw::u<32>(left);
    in.left.rest = hw::u<25>(1);
    in.right.key = hw::u<32>(right);
    in.right.rest = hw::u<25>(2);
    kage::hls::TreePoint<32, 25> out;
    kage::hls::compare_cell(in, out);
    if (hw::value(out.key) != std::min(left, right) || hw::value(out.rest) != (right < left ? 2 : 1))
      return differs("compare_cell", {left, right});
  }
}

template <int FRAC>
std::int64_t blended(int under, int over, int share, bool darkens) {
  kage::hls::PixelBlendIn<FRAC> in;
  in.under = hw::u<8>(under);
  in.over = hw::u<8>(over);
  in.share = hw::u<kage::hls::share_bits(FRAC)>(share);
  in.darkens = hw::u<1>(darkens);
  kage::hls::PixelBlendOut out;
  kage::hls::pixel_blend(in, out);
  return hw::value(out.color);
}

/// pixel_blend darkens as a line of the golden core, every colour with `shades` of the shades, evenly spread.
template <int FRAC>
void darkens(int shades) {
  kage::Config config;
  config.shade_frac = FRAC;
  config.z_frac = 0;
  config.channels = 1;
  config.translucency = 1;
  kage::PixelLine line(config);
  const int step = std::max(1, (1 << FRAC) / shades);
  for (int shade = 0; shade <= 1 << FRAC; shade += step) {
    line.start(256, 0);
    line.set_shade(static_cast<std::uint32_t>(shade));
    kage::SpanToken span;
    span.normal_class = 1;
    for (int c = 0; c < 256; ++c) {
      span.xl = c;
      span.xr = c + 1;
      span.z = 9;
      span.color[0] = c;
      line.op(span);
    }
    span.xl = 0;
    span.z = 5;
    span.w = 1;
    line.sp(span);
    line.ev(0, 256);
    line.resolve();
    for (int c = 0; c < 256; ++c)
      if (const int wanted = line.state(c).color[0]; blended<FRAC>(c, shade * 7 % 256, shade, true) != wanted)
        return differs("pixel_blend", {FRAC, c, shade, wanted});
    std::array<std::uint8_t, 256> out{};
    line.finish(false, out);
  }
}

/// pixel_blend blends as the golden core, for all colours and alphas, and darkens as it.
void blends() {
  const kage::DepthRamp ramp{0, 0, 0, 1};
  std::vector<std::int32_t> zb(256 + kage::kKernelSlack, 9);
  std::vector<std::uint32_t> colors(256 + kage::kKernelSlack);
  for (int alpha = 0; alpha < 256; ++alpha)
    for (int over = 0; over < 256; ++over) {
      for (std::uint32_t c = 0; c < 256; ++c) colors[c] = c;
      const kage::ColorRamp color{over << 22, 0};
      kage::span_tp(ramp, 256, zb.data(), colors.data(), &color, 1, alpha);
      for (int c = 0; c < 256; ++c)
        if (const std::int64_t wanted = colors[static_cast<std::size_t>(c)];
            blended<8>(c, over, alpha, false) != wanted)
          return differs("pixel_blend", {c, over, alpha, wanted});
    }
  const bool all = vectors >= 10000000;
  darkens<8>(256);
  darkens<12>(all ? 1 << 12 : 256);
  darkens<16>(all ? 1 << 16 : 256);
}

struct Soft {
  static constexpr int kZBits = 24, kChannels = 3, kDsfBits = 4, kFsf = 1, kCountBits = 4, kLights = 3, kClassBits = 8,
                       kTranslucency = 0, kUnits = 4;
};
struct Glass {
  static constexpr int kZBits = 16, kChannels = 3, kDsfBits = 1, kFsf = 1, kCountBits = 0, kLights = 1, kClassBits = 1,
                       kTranslucency = 1, kUnits = 0;
};
struct Grey {
  static constexpr int kZBits = 10, kChannels = 1, kDsfBits = 3, kFsf = 0, kCountBits = 2, kLights = 1, kClassBits = 1,
                       kTranslucency = 0, kUnits = 0;
};

template <class P>
kage::Config config_of() {
  kage::Config c;
  c.z_bits = P::kZBits;
  c.z_frac = 0;
  c.channels = P::kChannels;
  c.dsf_bits = P::kDsfBits;
  c.fsf = P::kFsf;
  c.count_bits = P::kCountBits;
  c.lights = P::kLights;
  c.class_bits = P::kClassBits;
  c.translucency = P::kTranslucency;
  c.units = P::kUnits;
  return c;
}

template <class P>
kage::PixelState state_of(const kage::hls::Pixel<P>& p) {
  kage::PixelState s;
  s.z = static_cast<std::uint32_t>(hw::value(p.z));
  for (std::size_t c = 0; c < P::kChannels; ++c) s.color[c] = static_cast<std::uint8_t>(hw::value(p.color[c]));
  s.normal_class = static_cast<std::uint32_t>(hw::value(p.lit_class));
  s.dsf = static_cast<std::uint32_t>(hw::value(p.dsf));
  s.fsf = static_cast<std::uint32_t>(hw::value(p.fsf));
  for (std::size_t l = 0; l < P::kLights; ++l) s.counts[l] = static_cast<std::uint32_t>(hw::value(p.count[l]));
  return s;
}

/// pixel_next is what the golden core's PixelLine does to the one pixel of a line, command by command.
template <class P>
void pixels() {
  using namespace kage::hls;
  Dice dice;
  kage::PixelLine line(config_of<P>());
  const auto most_z = (std::int64_t{1} << P::kZBits) - 2;
  const auto send = [](Pixel<P>& pixel, PixelNextIn<P>& in, int kind) {
    in.pixel = pixel;
    in.kind = hw::u<4>(kind);
    pixel_next(in, pixel);
  };
  for (long done = 0; done < vectors;) {
    line.start(1, 0x302010);
    PixelNextIn<P> in{};
    in.z = hw::u<P::kZBits>(0);
    in.lit_class = decltype(in.lit_class)(0);
    in.change = decltype(in.change)(0);
    in.light = hw::u<3>(0);
    Pixel<P> pixel{};
    for (int c = 0; c < P::kChannels; ++c) in.color[c] = in.blended[c] = pixel.color[c] = hw::u<8>(0);
    pixel.z = hw::u<P::kZBits>(0);
    pixel.lit_class = decltype(pixel.lit_class)(0);
    pixel.dsf = decltype(pixel.dsf)(0);
    pixel.fsf = hw::u<1>(0);
    for (int l = 0; l < P::kLights; ++l) pixel.count[l] = hw::u<at_least_one(P::kCountBits)>(0);
    send(pixel, in, kEndLine);
    for (auto left = dice.between(1, 40); left > 0; --left, ++done) {
      kage::SpanToken span;
      span.xr = 1;
      span.z = dice.between(0, 2) == 0 ? dice.between(1, 3) : dice.between(1, most_z);
      for (std::size_t c = 0; c < 3; ++c) span.color[c] = static_cast<std::int32_t>(dice.between(0, 255));
      span.normal_class = static_cast<int>(dice.between(0, (1 << P::kClassBits) - 1));
      span.w = static_cast<int>(dice.between(-(1 << P::kDsfBits) + 1, (1 << P::kDsfBits) - 1));
      span.alpha = static_cast<int>(dice.between(0, 255));
      const int light = static_cast<int>(dice.between(0, P::kLights - 1));
      in.z = hw::u<P::kZBits>(static_cast<int>(span.z));
      for (std::size_t c = 0; c < P::kChannels; ++c) in.color[c] = hw::u<8>(span.color[c]);
      in.lit_class = decltype(in.lit_class)(span.normal_class);
      in.change = decltype(in.change)(span.w);
      in.light = hw::u<3>(light);
      const auto bias = decltype(in.change)(static_cast<int>(line.bias()));
      int kind = 0;
      switch (dice.between(0, 7)) {
        case 0:
          kind = kOpaque;
          line.op(span);
          break;
        case 1:
        case 2:
          kind = kShadow;
          line.sp(span);
          break;
        case 3:
          kind = kNearCap;
          line.nc(0, 1, span.w);
          break;
        case 4:
          line.inside(span.w);  // no pixel is touched
          break;
        case 5:
          if (P::kFsf == 0) break;
          kind = kEndVolume;
          in.change = bias;
          line.ev(0, 1);
          break;
        case 6:
          if (P::kCountBits == 0) break;
          kind = kEndSample;
          in.change = bias;
          line.es(0, 1, light);
          break;
        default:
          if (P::kTranslucency == 0) break;
          kind = kTranslucent;
          line.tp(span);
          break;
      }
      if (kind == 0) continue;
      const kage::PixelState wanted = line.state(0);
      // The blender is cut out: what it gives is what the golden core has.
      for (std::size_t c = 0; c < P::kChannels; ++c) in.blended[c] = hw::u<8>(wanted.color[c]);
      // A pixel without a surface has the background's colour from a line's first TP on, whichever way it comes there.
      if (kind == kTranslucent && hw::value(pixel.z) == most_z + 1)
        for (std::size_t c = 0; c < P::kChannels; ++c) pixel.color[c] = in.blended[c];
      send(pixel, in, kind);
      if (!(state_of(pixel) == wanted))
        return differs("pixel_next",
                       {P::kZBits, kind, static_cast<std::int64_t>(wanted.z), wanted.dsf, wanted.fsf, done});
    }
    std::array<std::uint8_t, 4> out{};
    line.finish(false, std::span(out).first(P::kChannels));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) vectors = std::strtol(argv[1], nullptr, 10);
  const std::string_view kernel = argc > 2 ? argv[2] : "";
  bool tried = false;
  const auto wanted = [&](std::string_view name) {
    const bool is = kernel.empty() || kernel == name;
    tried |= is;
    return is;
  };
  if (wanted("edge")) {
    edges();
    every_edge<3, 2>();
    every_edge<2, 3>();
    if (vectors >= 10000000) {
      every_edge<4, 1>();
      every_edge<4, 2>();
      every_edge<3, 3>();
    }
  }
  if (wanted("span")) spans();
  if (wanted("plane")) planes();
  if (wanted("segment")) segments();
  if (wanted("cell")) cells();
  if (wanted("blend")) blends();
  if (wanted("pixel")) {
    pixels<Soft>();
    pixels<Glass>();
    pixels<Grey>();
  }
  if (!tried) {
    std::fprintf(stderr, "hls_kernels: %s: not edge, span, plane, segment, cell, blend or pixel\n", argv[2]);
    return 2;
  }
  std::printf("%ld vectors a kernel: %s\n", vectors, bad ? "not the same" : "the same");
  return bad ? 1 : 0;
}
