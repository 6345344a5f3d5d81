// SPDX-License-Identifier: Apache-2.0
#include "stimulus/frames.hpp"

#include <algorithm>
#include <bit>

#include "stimulus/random_spans.hpp"
#include "stimulus/random_state.hpp"

namespace kage::verif {
namespace {

/// The volumes of a sample of a light, or of the only one there is; false if there are none.
bool random_sample(Random& random, const Config& c, int width, TokenWriter& w, std::array<std::uint64_t, kKinds>& count,
                   const FrameStyle& style, int home) {
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  const int volumes = c.fsf != 0 ? random.in(0, style.most_volumes) : random.in(0, 1);
  for (int v = 0; v < volumes; ++v) {
    for (int i = random.in(1, style.most_in_volume); i > 0; --i) {
      SpanToken s = random_span(random, c, width, style, home);
      s.w = random_weight(random, c);
      switch (random.in(0, 9)) {
        case 0:
          w.inside(s.w);
          add(Kind::IF);
          break;
        case 1:
        case 2:
          w.nc(s.xl, s.xr, s.w);
          add(Kind::NC);
          break;
        default:
          w.sp(s);
          add(Kind::SP);
      }
    }
    if (c.fsf != 0) {
      const SpanToken s = random_span(random, c, width, style, home);
      if (random.chance(0.6))
        w.ev(0, width);
      else
        w.ev(s.xl, s.xr);
      add(Kind::EV);
    }
  }
  if (volumes > 0 && c.count_bits != 0) {
    const SpanToken s = random_span(random, c, width, style, home);
    const int light = random.in(0, c.lights - 1);
    if (random.chance(0.7))
      w.es(0, width, light);
    else
      w.es(s.xl, s.xr, light);
    add(Kind::ES);
  }
  return volumes > 0;
}

/// A light's span for an opaque one: mostly its pixels and depth with another colour, sometimes less of it.
SpanToken random_light(Random& random, const Config& c, int width, const SpanToken& of, const FrameStyle& style,
                       int home) {
  SpanToken s = random_span(random, c, width, style, home);
  if (random.chance(0.1)) return s;
  const SpanToken look = s;
  s = of;
  // The colour of a span as wide as the other is: its ramp has to stay in range.
  if (style.port || look.xr - look.xl >= of.xr - of.xl) {
    s.color = look.color;
    s.dcolor = look.dcolor;
  }
  if (random.chance(0.1)) s.xr = random.in(s.xl, s.xr);
  return s;
}

/// Samples that each put the whole line in shadow, spread over the lights.
void dark_samples(const Config& c, int width, int samples, TokenWriter& w, std::array<std::uint64_t, kKinds>& count) {
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  for (int i = 0; i < samples; ++i) {
    w.inside(1);
    add(Kind::IF);
    if (c.fsf != 0) {
      w.ev(0, width);
      add(Kind::EV);
    }
    w.es(0, width, i % c.lights);
    add(Kind::ES);
  }
}

}  // namespace

int half_sum(const Config& c) {
  if (!derived::has_table(c)) return 0;
  const int samples = static_cast<int>(std::bit_ceil(static_cast<unsigned>(c.lights))) << (c.count_bits - 1);
  return samples > c.lights * static_cast<int>(derived::most_count(c)) ? 0 : samples;
}

std::array<std::uint64_t, kKinds> random_frame(Random& random, const Config& c, int width, int height,
                                               std::vector<std::uint32_t>& words, std::uint32_t number,
                                               const FrameStyle& style) {
  width = std::min(width, c.max_width);
  std::array<std::uint64_t, kKinds> count{};
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  TokenWriter w(c, words);
  w.header({width, height, static_cast<std::uint32_t>(random.in(0, 0xFFFFFF)), number});
  RandomState state(random, c, width, height, style, w, count);
  for (int y = 0; y < height; ++y) {
    state.begin_line(y);
    const int home = style.port ? random.in(0, width - 1) : 0;
    std::vector<SpanToken> opaque;
    for (int i = random.in(0, style.most_opaque); i > 0; --i) {
      opaque.push_back(random_span(random, c, width, style, home, state.classes()));
      w.op(opaque.back());
      add(Kind::OP);
    }
    const bool dark = style.dark_samples > 0 && derived::has_table(c) && random.chance(style.dark_lines);
    if (dark) dark_samples(c, width, style.dark_samples, w, count);
    bool any_volume = dark;
    const int samples = c.dsf_bits == 0 || style.dark_samples > 0 ? 0
                        : c.count_bits == 0                       ? 1
                                                                  : random.in(0, style.most_samples);
    for (int sample = 0; sample < samples; ++sample)
      any_volume |= random_sample(random, c, width, w, count, style, home);
    for (int light = c.linear_bits > 0 ? random.in(0, 3) : 0; light > 0; --light) {
      const auto full = static_cast<int>(derived::most_count(c));
      w.resolve(random.chance(0.5) ? std::min(full, samples) : random.in(0, full));
      add(Kind::RESOLVE);
      any_volume = false;
      for (const SpanToken& s : opaque) {
        if (random.chance(0.1)) continue;
        w.op(random_light(random, c, width, s, style, home));
        add(Kind::OP);
      }
      if (random.chance(0.5)) any_volume = random_sample(random, c, width, w, count, style, home);
    }
    if (any_volume) {
      w.resolve();
      add(Kind::RESOLVE);
    }
    for (int i = c.translucency != 0 && random.chance(0.7) ? random.in(0, style.most_translucent) : 0; i > 0; --i) {
      w.tp(random_translucent(random, c, width, style, home));
      add(Kind::TP);
    }
    w.eol(y);
    add(Kind::EOL);
  }
  w.end();
  add(Kind::END);
  return count;
}

}  // namespace kage::verif
