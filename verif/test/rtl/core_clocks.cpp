// SPDX-License-Identifier: Apache-2.0
//
// Clocks that the whole core takes: per token within a line, per change of line, per frame. Prints them and exits 1 if
// one is more than docs/rtl.md promises, or if a core hangs or sends wrong pixels: a core that leaves its work out is
// fast.
//
// usage: core_clocks MODEL.so...
#include <algorithm>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "contract/derived.hpp"
#include "extremes/rtl_models.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;
using Words = std::vector<std::uint32_t>;

struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The units' part of a frame: faces of each unit, and segments of each one's line; without segments it has no tree.
struct Units {
  int faces = 0;
  int segments = 0;
};

/// The light's part of a frame: entries of its table, and `translucent` TPs of a pixel in each line. Each line also has
/// `samples` samples, each of an NC and an EV of a pixel and an ES [0, es_xr).
struct Light {
  int entries = 0;
  int samples = 0;
  int es_xr = 1;
  int translucent = 0;
};

/// Frames, all equal: lines of this width with `tokens` spans [xl, xr) each.
struct Work {
  int width = 1;
  int height = 1;
  int tokens = 0;
  int xl = 0, xr = 1;
  int frames = 1;
  Units units{};
  Light light{};
};

/// A frame is written by tokens of all the sorts that the core has. Each of them shows in the picture, so that a core
/// which leaves its work out sends wrong pixels.
class FrameWriter {
 public:
  FrameWriter(const Config& c, const Work& w) : c_(c), w_(w), out_(c, words_) {
    span_.z = std::int64_t{1} << (c.z_bits + c.z_frac - 1);  // the middle, whatever the width
    const int frac = c.color_frac;
    span_.color = {200 << frac, 150 << frac, 100 << frac};
    // Lit where there is a table for it, or where it takes none.
    span_.normal_class = !derived::has_table(c) || w.light.entries >= c.lights ? 1 : 0;
    span_.alpha = 128;
  }

  Words write() {
    out_.header({w_.width, w_.height, 0xC0A080U & ((1U << 8 * c_.channels) - 1), 1});
    const std::uint32_t share = derived::whole_share(c_) / 4;
    if (w_.light.samples > 0 && !derived::has_table(c_)) out_.shade(share);
    for (int i = 0; i < w_.light.entries; ++i) out_.table({i / c_.lights + 1, i % c_.lights, {share, share, share}});
    SegmentToken face;
    face.color = {30, 90, 150};
    for (face.unit = 0; face.unit < c_.units; ++face.unit)
      for (face.face = 0; face.face < faces(); ++face.face) out_.face(face);
    segments();
    for (int y = 0; y < w_.height; ++y) line(y);
    out_.end();
    return words_;
  }

 private:
  /// Faces of each unit: a segment has one.
  [[nodiscard]] int faces() const { return std::max(w_.units.faces, w_.units.segments > 0 ? 1 : 0); }

  /// The segments of a line, unit by unit; none in a frame without a tree.
  void segments() {
    SegmentToken seg;
    seg.z = std::int64_t{1} << (c_.z_bits + c_.z_frac - 2);
    for (seg.unit = 0; seg.unit < c_.units; ++seg.unit) {
      for (int i = 0; i < w_.units.segments; ++i) {
        seg.sync = i == 0;
        seg.dx = w_.width * (i + 1) / w_.units.segments - w_.width * i / w_.units.segments;
        out_.seg(seg);
      }
    }
  }

  void line(int y) {
    if (y + 1 < w_.height) segments();  // a line ahead, as a front end writes them
    if (w_.units.segments > 0) out_.tree();
    span_.xl = w_.xl;
    span_.xr = w_.xr;
    for (int i = 0; i < w_.tokens; ++i) out_.op(span_);
    if (w_.light.samples + w_.light.translucent > 0) wall();
    for (int i = 0; i < w_.light.samples; ++i) {
      out_.nc(0, 1, 1);
      if (c_.fsf != 0) out_.ev(0, 1);
      out_.es(0, w_.light.es_xr, 0);
    }
    if (w_.light.samples > 0) out_.resolve();
    span_.xl = 0;
    span_.xr = 1;
    for (int i = 0; i < w_.light.translucent; ++i) out_.tp(span_);
    out_.eol(y);
  }

  /// An OP of a pixel, on which samples and TPs are seen.
  void wall() {
    SpanToken s = span_;
    s.xl = 0;
    s.xr = 1;
    s.z += std::int64_t{1} << (c_.z_bits + c_.z_frac - 2);
    out_.op(s);
  }

  const Config& c_;
  const Work& w_;
  Words words_;
  TokenWriter out_;
  SpanToken span_;
};

/// Throws Wrong unless the pixels are the golden core's of this frame, again and again.
void hold_pixels(const Config& c, const Words& words, int frames, const std::vector<std::uint8_t>& actual) {
  std::vector<std::uint8_t> expected;
  GoldenCore golden(c);
  const LineSink line = [&](int, std::span<const std::uint8_t> p) {
    expected.insert(expected.end(), p.begin(), p.end());
  };
  for (int i = 0; i < frames; ++i) golden.frame(words, line);
  if (actual != expected) throw Wrong("the core sends other pixels than the golden core");
}

/// Clocks for the frames, from the first beat to the last pixel.
double clocks(const verif::CoreModel& model, const Work& w) {
  const kage_rtl_table& api = *model.api;
  const Words words = FrameWriter(model.config, w).write();
  kage_rtl* m = api.create(1);
  api.run(m, UINT64_MAX, 4 * static_cast<std::uint64_t>(model.config.max_width));  // past the sweep after reset
  api.clear_stats(m);
  for (int i = 0; i < w.frames; ++i) {
    api.submit(m, words.data(), words.size(), 1);
    api.expect(m, static_cast<std::uint32_t>(w.width), static_cast<std::uint32_t>(w.height));
  }
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(w.width) * static_cast<std::uint64_t>(w.height) * static_cast<std::uint64_t>(w.frames);
  const int why = api.run(m, pixels, 100'000'000);
  kage_rtl_stats stats;
  api.stats(m, &stats);
  std::uint64_t count = 0;
  const std::uint8_t* const drawn = api.pixels(m, &count);
  const std::vector<std::uint8_t> actual(drawn, drawn + count * static_cast<std::uint64_t>(model.config.channels));
  api.destroy(m);
  if (why != KAGE_RTL_PIXELS)
    throw Wrong("the core sends " + std::to_string(count) + " pixels of " + std::to_string(pixels) + " and no more");
  hold_pixels(model.config, words, w.frames, actual);
  return static_cast<double>(stats.cycles);
}

/// Prints the clocks of a model, and whether they are as promised.
class Measurement {
 public:
  explicit Measurement(const verif::CoreModel& model) : model_(model) {}

  bool run() {
    spans();
    lines();
    frames();
    if (c_.count_bits > 0) samples();
    if (c_.count_bits > 0 && c_.translucency > 0) loads();
    if (c_.units > 0) units();
    return good_;
  }

 private:
  [[nodiscard]] double of(const Work& w) const { return clocks(model_, w); }
  [[nodiscard]] int groups(int xl, int xr) const { return banked_ ? (xr - 1) / lanes_ - xl / lanes_ + 1 : 1; }
  /// The clocks of a token of this kind that touches this number of groups.
  [[nodiscard]] double of_token(Kind k, int groups) const {
    const int words = layout_.words[static_cast<std::size_t>(k)];
    return std::max({1.0, static_cast<double>(groups), static_cast<double>(words) / c_.beat_words});
  }
  void report(const std::string& what, double extra, double promised) {
    std::printf("  %s: %.3f clocks, promised %.3f\n", what.c_str(), extra, promised);
    good_ = good_ && extra <= promised * 1.001;
  }

  /// A token more in a line: the difference of two runs, per token.
  void spans() {
    struct Range {
      int xl, xr;
    };
    for (const Range r :
         {Range{0, 1}, Range{std::max(0, lanes_ - 1), std::min(width_, lanes_ + 1)}, Range{0, width_}}) {
      const int few = 100, many = 1100;
      const double extra = of({width_, 1, many, r.xl, r.xr}) - of({width_, 1, few, r.xl, r.xr});
      report("OP [" + std::to_string(r.xl) + ", " + std::to_string(r.xr) + ")", extra / (many - few),
             of_token(Kind::OP, groups(r.xl, r.xr)));
    }
  }

  void lines() {
    // Changing lines: tokens enough that the video port does not limit; clocks of a line less clocks of its tokens.
    line_ = busy_line({});
    const double change = line_ - tokens_ * of_token(Kind::OP, 1);
    std::printf("  changing lines, %d pixels wide: %.1f clocks\n", width_, change);
    good_ = good_ && change <= (banked_ ? (width_ + lanes_ - 1) / lanes_ : 0) + 2;
    // Empty lines: the video port is the limit.
    const double empty = (of({width_, 21}) - of({width_, 1})) / 20;
    std::printf("  empty lines, %d pixels wide: %.1f clocks\n", width_, empty);
    good_ = good_ && empty <= width_ + 1;
  }

  void frames() {
    const double frame = (of({.frames = 21}) - of({.frames = 1})) / 20;
    // A header by words, or the way out, which a counter makes longer by 2 clocks and a table by 5.
    const int least = std::max(c_.beat_words == 1 ? 10 : 7, 7 + derived::light_stages(c_));
    std::printf("  a frame of one pixel: %.1f clocks, promised %d\n", frame, least);
    good_ = good_ && frame <= least;
  }

  [[nodiscard]] double lit(int height, const Light& light) const {
    return of({.width = width_, .height = height, .light = light});
  }

  void samples() {
    const double volume = of_token(Kind::NC, 1) + (c_.fsf != 0 ? of_token(Kind::EV, 1) : 0);
    report("a sample, ES of a pixel", (lit(1, {table_, 1100, 1, 0}) - lit(1, {table_, 100, 1, 0})) / 1000,
           volume + of_token(Kind::ES, 1));
    report("a sample, ES of the line", (lit(1, {table_, 1100, width_, 0}) - lit(1, {table_, 100, width_, 0})) / 1000,
           volume + of_token(Kind::ES, groups(0, width_)));
    const int entries = derived::most_class(c_) * c_.lights;
    if (derived::has_table(c_))
      report("TABLE", (lit(1, {entries, 0, 1, 0}) - lit(1, {1, 0, 1, 0})) / (entries - 1), of_token(Kind::TABLE, 1));
  }

  /// The way out sends the line twice, to the video and back to the pixels; loads also wait for two passes, that of the
  /// line before and their own.
  void loads() {
    const int passes = 2 * groups(0, width_);
    report("a line that comes back as loads", (lit(21, {table_, 1, 1, 1}) - lit(1, {table_, 1, 1, 1})) / 20,
           width_ + std::max(width_, passes) + 32 + of_token(Kind::OP, 1));
    report("a line with TP but without RESOLVE", (lit(21, {table_, 0, 1, 1}) - lit(1, {table_, 0, 1, 1})) / 20,
           std::max(width_, passes) + 1 + of_token(Kind::OP, 1));
  }

  /// Clocks of a line with tokens enough that neither the video port nor the tree's pixel a clock limits.
  [[nodiscard]] double busy_line(const Units& u) const {
    Work w{width_, 21, tokens_};
    w.units = u;
    const double many = of(w);
    w.height = 1;
    return (many - of(w)) / 20;
  }

  /// Faces, segments, TREE.
  void units() {
    const int faces = derived::blank_face(c_);
    const double with_faces = of({.width = width_, .units = {faces, 0}});
    report("FACE", (with_faces - of({width_, 1})) / (faces * c_.units), of_token(Kind::FACE, 1));
    const int longest = derived::most_dx(c_);
    const int few = (width_ + longest - 1) / longest, many = std::min(derived::most_segments(c_), width_);
    const double one_seg = of_token(Kind::SEG, 1);
    const double with_few = busy_line({0, few});
    report("SEG", (busy_line({0, many}) - with_few) / ((many - few) * c_.units), one_seg);
    report("TREE", with_few - line_ - few * c_.units * one_seg, groups(0, width_));
  }

  const verif::CoreModel& model_;
  const Config& c_ = model_.config;
  Layout layout_{c_};
  bool banked_ = c_.arrangement == 1;
  int lanes_ = banked_ ? c_.lanes : 1;
  int width_ = std::min(c_.max_width, 256);
  int tokens_ = 3 * width_;
  int table_ = derived::has_table(c_) ? c_.lights : 0;  // entries for one class
  double line_ = 0;                                     // of tokens_ spans
  bool good_ = true;
};

}  // namespace

int main(int argc, char** argv) try {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const verif::CoreModel model = verif::load_core(argv[i]);
    std::printf("%s\n", argv[i]);
    try {
      good = Measurement(model).run() && good;
    } catch (const Wrong& e) {
      std::printf("  FAILED: %s\n", e.what());
      good = false;
    }
  }
  return good ? 0 : 1;
} catch (const kage::Error& e) {
  std::fprintf(stderr, "core_clocks: %s\n", e.what());
  return 2;
}
