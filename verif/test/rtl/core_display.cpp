// SPDX-License-Identifier: Apache-2.0
//
// The whole core behind a display that takes a pixel when the beam is there and waits for nobody. With the clocks a
// line that needed_line() asks for no pixel may be late; with fewer, some must be. Prints, for each core, how late
// pixels came. Exits 1 if one was late that should not have been, or none that should.
//
// usage: core_display MODEL.so...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "contract/derived.hpp"
#include "cost/line_clocks.hpp"
#include "extremes/rtl_models.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;
using Words = std::vector<std::uint32_t>;

// The share of the needed clocks that is too few.
constexpr double kLess = 0.9;

/// The segments of a line of all units, of each as many as its length asks for, or a few more.
void segments(TokenWriter& out, const Config& c, int width, std::mt19937& random) {
  SegmentToken t;
  const int least = (width - 1) / ((1 << c.dx_bits) - 1) + 1;
  const int count = std::min(width, least + static_cast<int>(random() % 3));
  for (t.unit = 0; t.unit < c.units; ++t.unit)
    for (int i = 0; i < count; ++i) {
      t.sync = i == 0;
      t.dx = width * (i + 1) / count - width * i / count;
      t.z = std::int64_t{1 + t.unit} << c.z_frac;
      out.seg(t);
    }
}

/// A frame of lines with a few tokens and lines with many, single ones and runs of them; with `few`, of lines with few
/// alone. Each is over a line of the tree, if the core has units. With `comes_back`, some lines' colours come back
/// before their TPs.
Words frame_of(const Config& c, int width, int height, bool few, bool comes_back, std::mt19937& random) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Words words;
  TokenWriter out(c, words);
  out.header({width, height, 0, 1});
  const bool table = derived::has_table(c);
  const std::uint32_t share = derived::whole_share(c) / 4;
  if (table)
    for (int l = 0; l < c.lights; ++l) out.table({1, l, {share, share, share}});
  else if (c.dsf_bits > 0)
    out.shade(share);
  SpanToken span;
  span.z = std::int64_t{1} << (c.z_bits + c.z_frac - 1);
  span.normal_class = c.dsf_bits > 0 ? 1 : 0;
  span.alpha = 128;
  SegmentToken face;
  for (; face.unit < c.units; ++face.unit) out.face(face);
  if (c.units > 0) segments(out, c, width, random);
  int run = 0;
  int tokens = 0;
  for (int y = 0; y < height; ++y) {
    if (run-- == 0) {
      run = below(6);
      tokens = few || below(2) == 0 ? below(3) : below(12 * width);
    }
    if (c.units > 0) {
      if (y + 1 < height) segments(out, c, width, random);
      out.tree();
    }
    for (int i = 0; i < tokens; ++i) {
      span.xl = below(width);
      span.xr = span.xl + 1 + below(std::min(8, width - span.xl));
      out.op(span);
    }
    if (comes_back && below(3) == 0) {
      span.xl = 0;
      span.xr = width;
      out.op(span);
      out.nc(0, 1, 1);
      if (c.fsf != 0) out.ev(0, 1);
      out.es(0, 1, 0);
      out.resolve();
      for (int i = below(2 * width); i >= 0; --i) out.tp(span);
    }
    out.eol(y);
  }
  out.end();
  return words;
}

/// How many clocks the latest pixel comes after the beam, if a line of the display has `each` clocks, all of them for
/// pixels: the way out is as late empty as can be. The display begins when the core can do nothing more. Between them
/// is a FIFO of so many pixels.
double latest(const verif::CoreModel& model, const Words& words, int width, int height, double each, int fifo) {
  const kage_rtl_table& api = *model.api;
  kage_rtl* m = api.create(1);
  api.run(m, UINT64_MAX, 4 * static_cast<std::uint64_t>(model.config.max_width) + 100);  // past the sweep after reset
  api.submit(m, words.data(), words.size(), 1);
  api.expect(m, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  const int pixels = width * height;
  int taken = std::min(fifo, pixels);
  int why = api.run(m, static_cast<std::uint64_t>(taken), 10'000'000);
  api.stalls(m, 65536, 0, 1);
  api.run(m, UINT64_MAX, 50'000);  // it fills what it can, while the beam returns
  const auto start = static_cast<double>(api.clock(m));
  const auto due = [&](int pixel) { return std::floor(start + each * pixel / width); };
  double late = 0;
  for (; why == KAGE_RTL_PIXELS && taken < pixels; ++taken) {
    const double room = due(taken - fifo);  // the pixel leaves the FIFO that makes room for this one
    if (const auto now = static_cast<double>(api.clock(m)); room > now) {
      api.stalls(m, 65536, 0, 1);
      api.run(m, UINT64_MAX, static_cast<std::uint64_t>(room - now));
    }
    api.stalls(m, 65536, 65536, 1);
    why = api.run(m, static_cast<std::uint64_t>(taken) + 1, 100'000);
    late = std::max(late, static_cast<double>(api.clock(m)) - 1 - due(taken));
  }
  api.destroy(m);
  if (why != KAGE_RTL_PIXELS) throw Error("the core sends no more pixels");
  return late;
}

/// Frames of a core, whose display has the clocks that are needed for a line, and a tenth less.
bool hold(const verif::CoreModel& model, bool comes_back) {
  const Config& c = model.config;
  const int width = std::min(c.max_width, 64);
  const int height = 48;
  // A line whose colours come back waits until the one before has left: the lines of the way out do not help then, and
  // a FIFO behind the core has to, as video_out has one.
  const int fifo = comes_back ? 2 * width : 0;
  std::mt19937 random(7);
  double worst = 0;
  double less = 0;
  bool waits = c.units == 0 || c.arrangement == 0;  // seen to take more than a pixel a clock for the lines of a tree
  for (int i = 0; i < 4; ++i) {
    const Words words = frame_of(c, width, height, i == 0, comes_back, random);
    GoldenCore golden(c);
    if (golden.frame(words, [](int, std::span<const std::uint8_t>) {}).error != ErrorCode::NONE)
      throw Error("the golden core refuses the frame");
    LineClockCounter counter(c);
    counter.add(0, words);
    const double need = counter.sums().need.clocks;
    worst = std::max(worst, latest(model, words, width, height, need, fifo));
    less = std::max(less, latest(model, words, width, height, kLess * need, fifo));
    if (i == 0 && !waits) waits = need > width && latest(model, words, width, height, width, fifo) > 0;
  }
  std::printf("  %s: late by %.0f clocks; by %.0f where the display's line has a tenth less\n",
              comes_back     ? "colours that come back, FIFO of two lines"
              : c.units == 0 ? "spans"
                             : "spans over a tree",
              worst, less);
  // With beats of a word the core is ahead of what is promised: while long spans are drawn, words of short ones come.
  // A systolic core with units has up to all clocks of its segments less to wait than is counted.
  const bool exact = c.beat_words > 1 && !comes_back && (c.units == 0 || c.arrangement != 0);
  return worst <= 0 && (!exact || less > 0) && (waits || comes_back);
}

}  // namespace

int main(int argc, char** argv) try {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const verif::CoreModel model = verif::load_core(argv[i]);
    std::printf("%s\n", argv[i]);
    good = hold(model, false) && good;
    if (model.config.count_bits > 0 && model.config.translucency > 0) good = hold(model, true) && good;
  }
  return good ? 0 : 1;
} catch (const kage::Error& e) {
  std::fprintf(stderr, "core_display: %s\n", e.what());
  return 2;
}
