// SPDX-License-Identifier: Apache-2.0
#include "extremes/depth.hpp"

#include <fmt/format.h>

#include <cmath>

#include "extremes/screen.hpp"
#include "frontend/span_setup.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "oracle/judge.hpp"
#include "oracle/simple_core.hpp"

namespace kage::verif {
namespace {

constexpr int kDepthWidth = 96;
constexpr int kMiddle = kDepthWidth / 2;
constexpr int kDepthHeight = 40;

/// Value of a plane at a pixel, in 2^-24, in 128 bits: the definition, without anything of the front end.
Int128 exact_value(const ScreenPlane& p, int x, int y) {
  return Int128{p.c} + Int128{p.a} * (x - p.x0) + Int128{p.b} * (y - p.y0);
}

double in_lsb(Int128 v) { return static_cast<double>(v) * 0x1p-24; }

/// The pixels of one line of words, as bytes.
std::vector<std::uint8_t> line_of(const Config& config, const std::vector<std::uint32_t>& words) {
  std::vector<std::uint8_t> line;
  const FrameStatus status = GoldenCore(config).frame(
      words, [&line](int, std::span<const std::uint8_t> p) { line.assign(p.begin(), p.end()); });
  if (status.error != ErrorCode::NONE) throw std::runtime_error("the golden core refuses the frame");
  return line;
}

}  // namespace

// ---- 15

void Ramp::set_fields(Fields& f, int least) {
  f.number("z_bits", z_bits, 4, 28, 24);
  f.number("frac", frac, 0, 16);
  f.number("count", count, least, 2000);
  f.number("x", x, 0, 30'000);
  f.number("anchor", anchor, -1000, 1000);
  f.real("from", from, 0, 1);
  f.real("to", to, 0, 1);
  f.number("a_low", a_low, -(1 << 24), 1 << 24);
  f.number("c_low", c_low, -(1 << 24), 1 << 24);
}

Outcome Ramp::errors(const Context& context, int first) const {
  const int bits = z_bits + frac + 2;
  const double top = std::ldexp(1.0, z_bits) - 2;
  const double begin = 1 + from * (top - 1);
  const double end = 1 + to * (top - 1);
  ScreenPlane p;
  p.x0 = x - anchor;
  p.a = static_cast<std::int64_t>((end - begin) / std::max(count - 1, 1) * (1 << kPlaneFrac));
  if (std::abs(end - begin) > 8) p.a += p.a > 0 ? -std::abs(a_low) % (p.a + 1) : std::abs(a_low) % (1 - p.a);
  p.c = static_cast<std::int64_t>(begin * (1 << kPlaneFrac)) - p.a * (x - p.x0);
  if (begin > 2 && begin < top - 2 && count == 1) p.c += c_low;
  SpanSetup::Ramp r = SpanSetup(frac, bits, frac).at(p, x, 0, count);
  if (context.injected(Injection::steep_step) && count > 1) ++r.step;
  const Int128 limit = static_cast<Int128>(1) << (bits - 1);
  const std::int64_t half = frac > 0 ? std::int64_t{1} << (frac - 1) : 0;
  Outcome o;
  for (int k = 0; k < count; ++k) {
    const Int128 sum = static_cast<Int128>(r.start) + static_cast<Int128>(r.step) * k;
    if (sum < -limit || sum >= limit) o.fail(fmt::format("the accumulator wraps after {} pixels", k));
    const Int128 error = ((sum - half) << (kPlaneFrac - frac)) - exact_value(p, x + k, 0);
    if (k >= first) o.measure(std::abs(in_lsb(error)), (k + 1) * std::ldexp(1.0, -frac - 1));
  }
  o.pixels = static_cast<std::uint64_t>(count);
  return o;
}

void PastEndCase::fields(Fields& f) {
  f.real("at", at, 1e6, 1.5e7);
  f.real("slope", slope, -1e6, 1e6, 1e5);
  f.number("frac", frac, 0, 12);
}

Outcome PastEndCase::check(const Context& context) const {
  // Depth 1 is nearest: what is nearer still stays in front, what is further than the end stays behind.
  Config config;
  config.z_frac = frac;
  FrameBuilder b(kDepthWidth, kDepthHeight);
  b.add(rectangle(0, 0, kDepthWidth, kDepthHeight), plane(at), {1, 1, 1});
  b.add(rectangle(0, 0, kDepthWidth, kDepthHeight), plane(at, slope, 0, kMiddle, 0), {2, 2, 2});
  auto p = draw(b.frame(), config);
  context.spoil(p);
  Outcome o;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const int x = static_cast<int>(i) % kDepthWidth;
    const double gap = (x - kMiddle) * slope;
    if (std::abs(gap) < 2 + (x + 1) * std::ldexp(1.0, -frac)) continue;  // the order is open
    const std::uint32_t expected = gap < 0 ? 0x020202U : 0x010101U;
    if (p[i] != expected)
      o.fail(fmt::format("pixel ({}, {}) shows {:06x}, not {:06x}", x, i / kDepthWidth, p[i], expected));
  }
  const Judgement j = judge(b.frame(), config);
  if (!j.good()) o.fail(j.text());
  o.pixels = j.pixels;
  return o;
}

// ---- 16

void WholeDepthCase::fields(Fields& f) {
  f.number("z_bits", z_bits, 22, 24, 24);
  f.number("frac", frac, 0, 12);
  const std::int64_t top = (std::int64_t{1} << z_bits) - 3;
  f.number("z", z, 2, top, top / 2);
  const std::int64_t slope_most = std::min<std::int64_t>({z - 2, top - z, 1 << 20}) / kDepthWidth;
  f.number("slope", slope, -slope_most, slope_most);
  f.number("offset", offset, -1, 1);
}

Outcome WholeDepthCase::check(const Context& context) const {
  Config config;
  config.z_bits = z_bits;
  config.z_frac = frac;
  FrameBuilder b(kDepthWidth, 2);
  b.add(rectangle(0, 0, kDepthWidth, 2), plane(z, slope, 0, kDepthWidth / 2), {1, 1, 1});
  b.add(rectangle(0, 0, kDepthWidth, 2), plane(z + offset, slope, 0, kDepthWidth / 2), {2, 2, 2});
  auto p = draw(b.frame(), config);
  context.spoil(p);
  Outcome o;
  // A surface one LSB behind is hidden, one at the same depth is hidden, one LSB in front is seen, at every pixel.
  for (std::size_t x = 0; x < p.size(); ++x)
    if (p[x] != (offset < 0 ? 0x020202U : 0x010101U)) o.fail(fmt::format("pixel {} shows {:06x}", x, p[x]));
  o.pixels = p.size();
  return o;
}

// ---- 17

void CoplanarCase::Face::fields(Fields& f) { f.number("color", color, 1, 255); }

void CoplanarCase::fields(Fields& f) {
  f.real("z", z, 1e6, 1.5e7);
  f.real("a", a, -1e4, 1e4);
  f.real("b", b, -1e4, 1e4);
  f.list("face", faces, 2, 12);
}

Outcome CoplanarCase::check(const Context& context) const {
  FrameBuilder builder(kDepthWidth, kDepthHeight);
  const ScreenPlane p = plane(z, a, b, 40, 20);
  for (const Face& face : faces) {
    const auto c = static_cast<std::uint8_t>(face.color);
    builder.add(rectangle(10, 5, 80, 30), p, {c, c, c});  // the same rectangle, so that all spans have the same start
  }
  auto picture = draw(builder.frame(), Config{});
  context.spoil(picture);
  Outcome o;
  for (int y = 5; y < 30; ++y)
    for (int x = 10; x < 80; ++x)
      if ((picture[pixel_index(x, y, kDepthWidth)] & 255U) != static_cast<unsigned>(faces[0].color))
        o.fail(fmt::format("pixel ({}, {}) does not show the first polygon", x, y));
  o.pixels = std::uint64_t{25} * 70;
  return o;
}

// ---- 18

void ClosePlanesCase::Face::fields(Fields& f) {
  f.number("left", left, 0, 40);
  f.number("right", right, 41, kDepthWidth, kDepthWidth);
  f.real("z", z, -4, 4);
  f.real("a", a, -0.25, 0.25);
  f.real("b", b, -0.25, 0.25);
}

void ClosePlanesCase::fields(Fields& f) {
  f.number("z_bits", z_bits, 10, 24, 24);
  f.number("frac", frac, 0, 12);
  f.real("at", at, 0.4, 0.6);
  f.real("a", a, -0.25, 0.25);
  f.real("b", b, -0.25, 0.25);
  f.list("face", faces, 2, 6);
}

Outcome ClosePlanesCase::check(const Context& context) const {
  Config config;
  config.z_bits = z_bits;
  config.z_frac = frac;
  const double all = std::ldexp(1.0, z_bits) - 2;
  FrameBuilder builder(kDepthWidth, kDepthHeight);
  std::vector<ScreenPlane> planes;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    // With no fraction bits errors are as large as a picture is wide.
    const double far = frac < 6 ? 96 >> frac : 1;
    planes.push_back(plane(at * all + face.z * far, (a * all + face.a * 100) / kDepthWidth,
                           (b * all + face.b * 100) / kDepthWidth, kDepthWidth / 2, kDepthHeight / 2));
    builder.add(rectangle(face.left, 0, face.right, kDepthHeight), planes.back(),
                {static_cast<std::uint8_t>(i + 1), 0, 0});
  }
  auto p = draw(builder.frame(), config);
  context.spoil(p);
  Outcome o;
  for (int y = 0; y < kDepthHeight; ++y)
    for (int x = 0; x < kDepthWidth; ++x) {
      // The nearest of those that cover the pixel, against the one that is shown.
      const auto seen = static_cast<std::size_t>(p[pixel_index(x, y, kDepthWidth)] & 255U);
      // A pixel stores no depth but those of 1 .. 2^Z_BITS - 2.
      const auto held = [&](std::size_t i) {
        const Int128 unit = Int128{1} << kPlaneFrac;
        return std::clamp(exact_value(planes[i], x, y), unit, (unit << z_bits) - 2 * unit);
      };
      Int128 nearest = 0;
      bool any = false;
      for (std::size_t i = 0; i < faces.size(); ++i) {
        if (x < faces[i].left || x >= faces[i].right) continue;
        const Int128 v = held(i);
        if (!any || v < nearest) nearest = v, any = true;
      }
      if (any != (seen > 0)) o.fail(fmt::format("pixel ({}, {}) shows a face where there is none, or none", x, y));
      if (!any || seen == 0) continue;
      const std::size_t i = seen - 1;
      if (x < faces[i].left || x >= faces[i].right) {
        o.fail(fmt::format("pixel ({}, {}) shows a face that is not there", x, y));
        continue;
      }
      // Both are rounded to whole LSB, and each may be off by what its span's sums are off.
      const double bound = 1 + ((x - faces[i].left + 1) + (x + 1)) * std::ldexp(1.0, -frac - 1);
      o.measure(in_lsb(held(i) - nearest), bound);
    }
  o.pixels = p.size();
  return o;
}

// ---- 19

void ColourCase::fields(Fields& f) {
  f.number("frac", frac, 0, 16);
  f.flag("grey", grey);
  f.number("width", width, 1, kDepthWidth);
  f.real("from", from, 0, 255);
  f.real("to", to, 0, 255, 255);
}

Outcome ColourCase::check(const Context& context) const {
  Config config;
  config.smooth = 1;
  config.color_frac = frac;
  config.channels = grey ? 1 : 3;
  FrameBuilder b(kDepthWidth, 1);
  b.add(rectangle(0, 0, width, 1), plane(1000));
  b.frame().polygons[0].color_planes = 0;
  const ScreenPlane colour = plane(from, width > 1 ? (to - from) / (width - 1) : 0);
  for (int c = 0; c < 3; ++c) b.frame().color_planes.push_back(colour);
  std::vector<std::uint32_t> words;
  make_frame(b.frame(), config, 0, words, {.threads = 1});
  check_frame(config, words, "front end", 0);
  auto line = line_of(config, words);
  context.spoil(line);
  Outcome o;
  int before = 0;
  for (int x = 0; x < width; ++x) {
    const int got = line[pixel_index(0, x, config.channels)];
    for (int c = 1; c < config.channels; ++c)
      if (line[pixel_index(c, x, config.channels)] != got) o.fail("channels of one plane differ");
    if (x > 0 && (to >= from ? got < before : got > before)) o.fail(fmt::format("it turns round at pixel {}", x));
    if (x == 0 && from == std::round(from) && got != static_cast<int>(from)) o.fail("a whole colour is not its own");
    before = got;
    const double exact = std::clamp(in_lsb(exact_value(colour, x, 0)), 0.0, 255.0);
    o.measure(std::abs(got - exact), (x + 1) * std::ldexp(1.0, -frac - 1) + 0.5);
  }
  o.pixels = static_cast<std::uint64_t>(width);
  return o;
}

// ---- 20

void Layers::Layer::fields(Fields& f) { f.number("color", color, 0, 255); }

void Layers::set_fields(Fields& f, int least) {
  f.number("alpha", alpha, 0, least > 0 ? 8 : 255);
  f.number("under", under, 0, 255);
  f.number("first_count", first_count, least, 900);
  f.number("first", first, 0, 255);
  f.list("layer", layers, 1, 100);
}

Outcome Layers::check(const Context& context) const {
  Config config;
  config.translucency = 1;
  std::vector<std::uint32_t> words;
  TokenWriter w(config, words);
  constexpr int kPixels = 8;
  w.header({kPixels, 1, 0, 0});
  SpanToken s;
  s.xr = kPixels;
  s.z = std::int64_t{1000} << config.z_frac;
  s.color = {under, under, under};
  w.op(s);
  s.z = std::int64_t{10} << config.z_frac;
  s.alpha = alpha;
  double exact = under;
  const int all = first_count + static_cast<int>(layers.size());
  for (int i = 0; i < all; ++i) {
    const int color = i < first_count ? first : layers[static_cast<std::size_t>(i - first_count)].color;
    s.color = {color, color, color};
    if (!(context.injected(Injection::lost_layer) && i == all - 1)) w.tp(s);
    exact += (color - exact) * alpha / 255.0;
  }
  w.eol(0);
  w.end();
  const auto line = line_of(config, words);
  Outcome o;
  for (const std::uint8_t v : line)
    if (v != line[0]) o.fail("pixels of one span differ");
  const double off = std::abs(line[0] - exact);
  if (alpha == 0 || alpha == 255) {
    if (off != 0) o.fail(fmt::format("alpha {} is no identity: off by {}", alpha, off));
  } else {
    // An error shrinks by 1 - alpha / 255 with every layer above it. Doubles are off by far less than 1e-9.
    o.measure(off, std::min(all / 2.0, 255.0 / (2 * alpha)) + 1e-9);
  }
  std::vector<std::uint8_t> plain;
  (void)simple_core(config, words, plain);
  if (plain != line) o.fail("the core that is written out pixel by pixel shows another colour");
  o.pixels = kPixels;
  return o;
}

void add_depth_families(Families& to) {
  add_family<RampCase>(to, {15, "15", "depth along a span: sums of a start and steps", "LSB", 40});
  add_family<LongRampCase>(to, {15, "15 long", "the same after 500 pixels and more", "LSB", 100, 0.5});
  add_family<PastEndCase>(to, {15, "15 end", "a plane past an end of depth is clamped"});
  add_family<WholeDepthCase>(to, {16, "16", "depth that is whole at every pixel"});
  add_family<CoplanarCase>(to, {17, "17", "coplanar polygons: the first drawn is seen"});
  add_family<ClosePlanesCase>(to, {18, "18", "close planes: a surface shown though another is nearer", "LSB", 60});
  add_family<ColourCase>(to, {19, "19", "colour along a span", "LSB", 40});
  add_family<LayersCase>(to, {20, "20", "translucent layers over each other", "LSB", 60});
  add_family<DeepLayersCase>(to,
                             {20, "20 deep", "the same with 300 layers and more of alpha 8 and less", "LSB", 60, 0.5});
}

}  // namespace kage::verif
