// SPDX-License-Identifier: Apache-2.0
//
// Clocks that the whole core takes: per token within a line, per change of line, per frame. Prints them and exits 1 if
// one is more than docs/rtl.md promises, or if a core hangs or sends wrong pixels: a core that leaves its work out is
// fast.
//
// usage: core_clocks MODEL.so...
#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "cosim/model/driver/rtl_model.h"
#include "kage/core.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;

struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a frame has of units: faces of each, and segments of each one's line; without segments it has no tree.
struct Units {
  int faces = 0;
  int segments = 0;
};

/// What a frame has of light: entries of its table, and in each line so many samples, each of an NC and an EV of a
/// pixel and an ES [0, es_xr), and so many TPs of a pixel.
struct Light {
  int entries = 0;
  int samples = 0;
  int es_xr = 1;
  int translucent = 0;
};

/// Clocks for a frame of lines of this width with `tokens` spans [xl, xr) each, from the first beat to the last pixel.
std::uint64_t clocks(const kage_rtl_table& api, const Config& c, int width, int height, int tokens, int xl, int xr,
                     int frames = 1, const Units& units = {}, const Light& light = {}) {
  std::vector<std::uint32_t> words;
  TokenWriter out(c, words);
  out.header({width, height, 0, 1});
  SpanToken s;
  s.xl = xl;
  s.xr = xr;
  s.z = std::int64_t{1} << (c.z_bits + c.z_frac - 1);  // the middle, whatever the width
  for (int i = 0; i < light.entries; ++i) out.table({i / c.lights + 1, i % c.lights, {}});
  SegmentToken face;
  for (face.unit = 0; face.unit < c.units; ++face.unit)
    for (face.face = 0; face.face < units.faces; ++face.face) out.face(face);
  SegmentToken seg;
  seg.face = (1 << c.face_bits) - 1;
  const auto segments = [&] {
    for (seg.unit = 0; seg.unit < c.units; ++seg.unit) {
      for (int i = 0; i < units.segments; ++i) {
        seg.sync = i == 0;
        seg.dx = width * (i + 1) / units.segments - width * i / units.segments;
        out.seg(seg);
      }
    }
  };
  if (units.segments > 0) segments();
  for (int y = 0; y < height; ++y) {
    if (units.segments > 0 && y + 1 < height) segments();  // a line ahead, as a front end writes them
    if (units.segments > 0) out.tree();
    for (int i = 0; i < tokens; ++i) out.op(s);
    for (int i = 0; i < light.samples; ++i) {
      out.nc(0, 1, 1);
      if (c.fsf != 0) out.ev(0, 1);
      out.es(0, light.es_xr, 0);
    }
    if (light.samples > 0) out.resolve();
    SpanToken glass = s;
    glass.xl = 0;
    glass.xr = 1;
    for (int i = 0; i < light.translucent; ++i) out.tp(glass);
    out.eol(y);
  }
  out.end();
  kage_rtl* m = api.create(1);
  api.run(m, UINT64_MAX, 4 * static_cast<std::uint64_t>(c.max_width));  // past the sweep after reset
  api.clear_stats(m);
  for (int i = 0; i < frames; ++i) {
    api.submit(m, words.data(), words.size(), 1);
    api.expect(m, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * static_cast<std::uint64_t>(frames);
  const int why = api.run(m, pixels, 100'000'000);
  kage_rtl_stats stats;
  api.stats(m, &stats);
  std::uint64_t count = 0;
  const std::uint8_t* const drawn = api.pixels(m, &count);
  const std::vector<std::uint8_t> actual(drawn, drawn + count * static_cast<std::uint64_t>(c.channels));
  api.destroy(m);
  if (why != KAGE_RTL_PIXELS)
    throw Wrong("the core sends " + std::to_string(count) + " pixels of " + std::to_string(pixels) + " and no more");
  // The same frame again and again, so each has the golden core's pixels.
  std::vector<std::uint8_t> expected;
  GoldenCore golden(c);
  const LineSink line = [&](int, std::span<const std::uint8_t> p) {
    expected.insert(expected.end(), p.begin(), p.end());
  };
  for (int i = 0; i < frames; ++i) golden.frame(words, line);
  if (actual != expected) throw Wrong("the core sends other pixels than the golden core");
  return stats.cycles;
}

/// Prints the clocks of a model, and whether they are as promised.
bool measure(const kage_rtl_table& api) {
  bool good = true;
  Config c;
  for (std::uint32_t p = 0; p < api.param_count; ++p)
    for (const ParamInfo& info : kParams)
      if (info.name == api.param_names[p]) c.*info.member = api.param_values[p];
  const Layout layout(c);
  const int op_words = layout.words[static_cast<std::size_t>(Kind::OP)];
  const bool banked = c.arrangement == 1;
  const int lanes = banked ? c.lanes : 1;
  const int width = std::min(c.max_width, 256);

  // A token more in a line: the difference of two runs, per token.
  struct Range {
    int xl, xr;
  };
  for (const Range r : {Range{0, 1}, Range{std::max(0, lanes - 1), std::min(width, lanes + 1)}, Range{0, width}}) {
    const int few = 100, many = 1100;
    const auto extra =
        static_cast<double>(clocks(api, c, width, 1, many, r.xl, r.xr) - clocks(api, c, width, 1, few, r.xl, r.xr)) /
        (many - few);
    const int groups = banked ? (r.xr - 1) / lanes - r.xl / lanes + 1 : 1;
    const double promised = std::max({1.0, static_cast<double>(groups), static_cast<double>(op_words) / c.beat_words});
    std::printf("  OP [%d, %d): %.3f clocks, promised %.3f\n", r.xl, r.xr, extra, promised);
    good = good && extra <= promised * 1.001;
  }
  // Changing lines: tokens enough that the video port does not limit; clocks of a line less clocks of its tokens.
  const int tokens = 3 * width;
  const double per_token = std::max(1.0, static_cast<double>(op_words) / c.beat_words);
  const auto line =
      static_cast<double>(clocks(api, c, width, 21, tokens, 0, 1) - clocks(api, c, width, 1, tokens, 0, 1)) / 20;
  std::printf("  changing lines, %d pixels wide: %.1f clocks\n", width, line - tokens * per_token);
  good = good && line - tokens * per_token <= (banked ? (width + lanes - 1) / lanes : 0) + 2;
  // Empty lines: the video port is the limit.
  const auto empty = static_cast<double>(clocks(api, c, width, 21, 0, 0, 1) - clocks(api, c, width, 1, 0, 0, 1)) / 20;
  std::printf("  empty lines, %d pixels wide: %.1f clocks\n", width, empty);
  good = good && empty <= width + 1;
  const auto frame = static_cast<double>(clocks(api, c, 1, 1, 0, 0, 1, 21) - clocks(api, c, 1, 1, 0, 0, 1, 1)) / 20;
  // A header by words, or the way out, which a counter makes longer by 2 clocks and a table by 5.
  const int light_stages = c.count_bits == 0 ? 0 : c.class_bits > 1 ? 5 : 2;
  const int least = std::max(c.beat_words == 1 ? 10 : 7, 7 + light_stages);
  std::printf("  a frame of one pixel: %.1f clocks, promised %d\n", frame, least);
  good = good && frame <= least;
  const auto words_of = [&](Kind k) { return static_cast<double>(layout.words[static_cast<std::size_t>(k)]); };
  const auto report = [&](const char* what, double extra, double promised) {
    std::printf("  %s: %.3f clocks, promised %.3f\n", what, extra, promised);
    good = good && extra <= promised * 1.001;
  };
  if (c.count_bits > 0) {
    const auto of = [&](int height, const Light& light) {
      return static_cast<double>(clocks(api, c, width, height, 0, 0, 1, 1, {}, light));
    };
    const auto of_token = [&](Kind k, int groups) {
      return std::max({1.0, static_cast<double>(banked ? groups : 1), words_of(k) / c.beat_words});
    };
    const int groups = (width + lanes - 1) / lanes;
    const double volume = of_token(Kind::NC, 1) + (c.fsf != 0 ? of_token(Kind::EV, 1) : 0);
    report("a sample, ES of a pixel", (of(1, {0, 1100, 1, 0}) - of(1, {0, 100, 1, 0})) / 1000,
           volume + of_token(Kind::ES, 1));
    report("a sample, ES of the line", (of(1, {0, 1100, width, 0}) - of(1, {0, 100, width, 0})) / 1000,
           volume + of_token(Kind::ES, groups));
    const int entries = ((1 << c.class_bits) - 1) * c.lights;
    if (c.class_bits > 1)
      report("TABLE", (of(1, {entries, 0, 1, 0}) - of(1, {1, 0, 1, 0})) / (entries - 1), of_token(Kind::TABLE, 1));
    if (c.translucency > 0) {
      // The way out sends the line twice, to the video and back to the pixels; loads also wait for two passes, that
      // of the line before and their own.
      const int passes = banked ? 2 * groups : 2;
      report("a line that comes back as loads", (of(21, {0, 1, 1, 1}) - of(1, {0, 1, 1, 1})) / 20,
             width + std::max(width, passes) + 32);
      report("a line with TP but without RESOLVE", (of(21, {0, 0, 1, 1}) - of(1, {0, 0, 1, 1})) / 20,
             std::max(width, passes) + 1);
    }
  }
  if (c.units == 0) return good;

  // Faces, segments, TREE: between tokens enough that neither the video port nor the tree's pixel a clock limits.
  const auto lines = [&](const Units& u) {
    return static_cast<double>(clocks(api, c, width, 21, tokens, 0, 1, 1, u) -
                               clocks(api, c, width, 1, tokens, 0, 1, 1, u)) /
           20;
  };
  const int faces = (1 << c.face_bits) - 1;
  const auto with_faces = clocks(api, c, width, 1, 0, 0, 1, 1, {faces, 0});
  report("FACE", static_cast<double>(with_faces - clocks(api, c, width, 1, 0, 0, 1)) / (faces * c.units),
         std::max(1.0, words_of(Kind::FACE) / c.beat_words));
  const int longest = (1 << c.dx_bits) - 1;
  const int few = (width + longest - 1) / longest, many = std::min(1 << c.seg_bits, width);
  const double one_seg = std::max(1.0, words_of(Kind::SEG) / c.beat_words);
  const double with_few = lines({0, few});
  report("SEG", (lines({0, many}) - with_few) / ((many - few) * c.units), one_seg);
  const int groups = banked ? (width + lanes - 1) / lanes : 1;
  report("TREE", with_few - line - few * c.units * one_seg, groups);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    void* library = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
    const auto function =
        library == nullptr ? nullptr : reinterpret_cast<kage_rtl_api_function>(dlsym(library, KAGE_RTL_API_SYMBOL));
    if (function == nullptr) {
      std::fprintf(stderr, "core_clocks: %s: no RTL model\n", argv[i]);
      return 2;
    }
    std::printf("%s\n", argv[i]);
    try {
      good = measure(*function()) && good;
    } catch (const Wrong& e) {
      std::printf("  FAILED: %s\n", e.what());
      good = false;
    }
  }
  return good ? 0 : 1;
}
