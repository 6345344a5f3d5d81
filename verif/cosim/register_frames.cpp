// SPDX-License-Identifier: Apache-2.0
#include "cosim/register_frames.hpp"

#include <algorithm>

#include "contract/derived.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {
namespace {

constexpr int kWidth = 8;
constexpr int kHeight = 8;
constexpr std::uint32_t kErrorNumber = 0x600DF00D;  // of the frame with an error
constexpr int kMostFaces = 3;                       // that every unit's table holds

/// Blank pixels, in segments as long as DX_BITS allows.
void blank(TokenWriter& w, const Config& c, int unit, int pixels, bool line_begins) {
  SegmentToken s;
  s.unit = unit;
  s.face = derived::blank_face(c);
  s.sync = line_begins;
  for (; pixels > 0; pixels -= s.dx) {
    s.dx = std::min(pixels, derived::most_dx(c));
    w.seg(s);
    s.sync = false;
  }
}

/// The words of all beats but the last.
std::size_t but_last_beat(const Config& c, std::size_t words) {
  const auto beat = static_cast<std::size_t>(c.beat_words);
  return (words - 1) / beat * beat;
}

/// With so many faces, which move what comes behind them within its beat.
FrameInParts unit_behind(const Config& c, int faces, bool& whole) {
  const int width = register_frame_width(c);
  const int half = width / 2;
  FrameInParts f;
  TokenWriter w(c, f.words);
  w.header({width, 2, 0, 0});
  SegmentToken face;
  for (; face.face < faces; ++face.face) w.face(face);
  blank(w, c, 0, width, true);
  const std::size_t complete = f.words.size();
  blank(w, c, 0, width, true);  // line 1, so that a whole beat has line 0
  for (int unit = 1; unit < c.units; ++unit) blank(w, c, unit, half, true);
  const auto beat = static_cast<std::size_t>(c.beat_words);
  f.first = f.words.size() / beat * beat;
  whole = f.first >= complete;
  for (int unit = 1; unit < c.units; ++unit) blank(w, c, unit, width - half, half == 0);
  for (int unit = 1; unit < c.units; ++unit) blank(w, c, unit, width, true);
  for (int y = 0; y < 2; ++y) {
    w.tree();
    w.eol(y);
  }
  w.end();
  return f;
}

}  // namespace

int register_frame_width(const Config& config) { return std::min(kWidth, config.max_width); }

std::vector<std::uint32_t> one_line(const Config& config) {
  std::vector<std::uint32_t> words;
  TokenWriter w(config, words);
  w.header({register_frame_width(config), 1, 0, 0});
  w.eol(0);
  w.end();
  return words;
}

FrameInParts eight_lines(const Config& config) {
  FrameInParts f;
  TokenWriter w(config, f.words);
  const int width = register_frame_width(config);
  w.header({width, kHeight, 0, 0});
  std::vector<std::size_t> ends;
  for (int y = 0; y < kHeight; ++y) {
    SpanToken s;
    s.xr = width;
    w.op(s);
    w.eol(y);
    ends.push_back(f.words.size());
  }
  w.end();
  f.first = but_last_beat(config, f.words.size());
  f.lines = static_cast<int>(std::ranges::count_if(ends, [&](std::size_t end) { return end <= f.first; }));
  return f;
}

FrameInParts early_error(const Config& config) {
  FrameInParts f;
  TokenWriter w(config, f.words);
  w.header({register_frame_width(config), kHeight, 0, kErrorNumber});
  w.eol(0);
  w.eol(0);
  const auto beat = static_cast<std::size_t>(config.beat_words);
  const std::size_t enough = f.words.size() + 5 * beat;
  while (f.words.size() < enough) w.eol(1);
  w.end();
  f.first = but_last_beat(config, f.words.size());
  f.lines = 1;
  return f;
}

std::vector<std::uint32_t> early_end(const Config& config) {
  std::vector<std::uint32_t> words;
  TokenWriter w(config, words);
  w.header({register_frame_width(config), 2, 0, kErrorNumber});
  w.eol(0);
  w.end();
  return words;
}

FrameInParts unit_behind(const Config& config) {
  for (int faces = 0; faces <= kMostFaces; ++faces) {
    bool whole = false;
    FrameInParts f = unit_behind(config, faces, whole);
    if (whole) return f;
  }
  throw Error("register check: no frame whose beats part one unit from another");
}

}  // namespace kage::cosim
