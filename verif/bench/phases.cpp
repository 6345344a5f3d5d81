// SPDX-License-Identifier: Apache-2.0
// Where the clocks of a frame go: each token's clocks by design (docs/rtl.md), summed by phase, beside the clocks that
// the RTL takes for the whole frame. 640x480, the first frame of each scene.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cosim/core.hpp"
#include "cosim/model.hpp"
#include "cosim/rtl.hpp"
#include "kage/config.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;

enum Phase : std::size_t { kState, kOpaque, kVolumes, kVolumeEnds, kSamples, kTranslucent, kOut, kPhases };

struct Sums {
  std::array<std::uint64_t, kPhases> clocks{};
  std::uint64_t video = 0;  // lines whose pixels take longer to leave than their tokens to come
  std::uint64_t shadow_spans = 0;
  std::uint64_t shadow_pixels = 0;
};

Sums sums_of(const Config& c, std::span<const std::uint32_t> words) {
  const Layout layout(c);
  Sums sums;
  std::uint64_t line = 0;
  for (std::size_t at = kHeaderWords; at < words.size();) {
    const Token t = decode(c, layout, words.subspan(at));
    const auto n = static_cast<std::uint64_t>(layout.words[static_cast<std::size_t>(t.kind)]);
    at += n;
    const auto beat = static_cast<std::uint64_t>(c.beat_words);
    std::uint64_t clocks = std::max<std::uint64_t>(1, (n + beat - 1) / beat);
    const int width = c.max_width < 640 ? c.max_width : 640;
    const auto groups = [&](int xl, int xr) {
      return static_cast<std::uint64_t>(xl == xr ? 1 : (xr - 1) / c.lanes - xl / c.lanes + 1);
    };
    Phase phase = kState;
    switch (t.kind) {
      case Kind::OP:
        phase = kOpaque;
        break;
      case Kind::SP:
      case Kind::NC:
        phase = kVolumes;
        ++sums.shadow_spans;
        sums.shadow_pixels += static_cast<std::uint64_t>(t.span.xr - t.span.xl);
        break;
      case Kind::EV:
        phase = kVolumeEnds;
        break;
      case Kind::ES:
        phase = kSamples;
        break;
      case Kind::TP:
        phase = kTranslucent;
        break;
      case Kind::EOL:
        phase = kOut;
        break;
      case Kind::IF:
        phase = kVolumes;
        break;
      default:
        break;
    }
    if (t.kind == Kind::EOL)
      clocks = groups(0, width);
    else if (phase != kState && t.kind != Kind::IF)
      clocks = std::max(clocks, groups(t.span.xl, t.span.xr));
    sums.clocks[phase] += clocks;
    line += clocks;
    if (t.kind == Kind::EOL) {
      if (line < static_cast<std::uint64_t>(width)) sums.video += static_cast<std::uint64_t>(width) - line;
      line = 0;
    }
  }
  return sums;
}

}  // namespace

int main() {
  fmt::print("{:<13} {:<8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>11} {:>9}\n", "scene", "config",
             "state", "opaque", "volumes", "EV", "ES", "TP", "line out", "video", "sum", "RTL clocks", "SP+NC/px");
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    const SceneFrame f = scene.frame(0, scene.frame_count());
    const std::string config = name == "penumbra"       ? "soft"
                               : name == "three-lights" ? "lights"
                               : name == "glass"        ? "glass"
                               : name == "knot"         ? "full"
                                                        : "default";
    const Config c = load_config(config).config;
    std::vector<std::uint32_t> words;
    make_frame(make_geometry(f, c, 640, 480), c, 0, words, 1);
    const Sums s = sums_of(c, words);
    std::uint64_t sum = s.video;
    for (const std::uint64_t k : s.clocks) sum += k;
    const auto rtl = cosim::make_rtl(cosim::find_model(c).library, c);
    const std::uint64_t cycles = rtl->frame(words, [](int, std::span<const std::uint8_t>) {}).cycles;
    fmt::print("{:<13} {:<8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>11} {:>9.2f}\n", name, config,
               s.clocks[kState], s.clocks[kOpaque], s.clocks[kVolumes], s.clocks[kVolumeEnds], s.clocks[kSamples],
               s.clocks[kTranslucent], s.clocks[kOut], s.video, sum, cycles,
               static_cast<double>(s.shadow_pixels) / (640.0 * 480));
  }
  return 0;
}
