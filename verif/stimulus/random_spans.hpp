// SPDX-License-Identifier: Apache-2.0
//
// Fields of a random frame's spans.
#pragma once

#include <algorithm>
#include <cstdint>

#include "contract/derived.hpp"
#include "kage/token.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// A two's complement field of so many bits: any magnitude is as likely as any other.
inline std::int64_t random_field(Random& random, int bits) {
  const std::int64_t limit = std::int64_t{1} << (random.in(1, bits) - 1);
  return random.integer(-limit, limit - 1);
}

/// A span of a valid frame: any start and slope that stay within the accumulator.
inline void random_ramp(Random& random, int bits, int count, std::int64_t& start, std::int64_t& step) {
  const std::int64_t limit = std::int64_t{1} << (bits - 1);
  // Often within the range that is drawn, sometimes past it, sometimes all equal (ties).
  start = random.chance(0.8) ? random.integer(0, limit / 2) : random.integer(-limit, limit - 1);
  if (random.chance(0.2)) start = limit / 4;
  step = 0;
  if (count > 1 && random.chance(0.8)) {
    const std::int64_t up = std::min(limit - 1, (limit - 1 - start) / (count - 1));
    const std::int64_t down = std::max(-limit, -((start + limit) / (count - 1)));
    step = random.chance(0.1) ? (random.chance(0.5) ? up : down) : random.integer(down, up);
  }
}

/// A class that a table of so many has, or, without table, lit or not.
inline int random_class(Random& random, const Config& c, int classes) {
  if (c.dsf_bits == 0 || random.chance(0.2)) return 0;
  return !derived::has_table(c) ? 1 : random.in(0, classes);
}

/// `home` is the pixel round which the spans of a crowded line meet.
inline SpanToken random_span(Random& random, const Config& c, int width, const FrameStyle& style = {}, int home = 0,
                             int classes = 0) {
  SpanToken s;
  s.xl = random.in(0, width);
  s.xr = random.chance(0.2)   ? width
         : random.chance(0.2) ? s.xl
         : random.chance(0.3) ? std::min(width, s.xl + random.in(0, 3))
                              : random.in(s.xl, width);
  if (random.chance(0.1)) s.xl = 0;
  const int count = s.xr - s.xl;
  const int depth_bits = derived::depth_bits(c);
  random_ramp(random, depth_bits, count, s.z, s.dz);
  s.normal_class = random_class(random, c, classes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
    if (c.smooth == 0) {
      s.color[i] = random.in(0, 255);
      continue;
    }
    std::int64_t start = 0;
    std::int64_t step = 0;
    random_ramp(random, derived::ramp_bits(c), count, start, step);
    s.color[i] = static_cast<std::int32_t>(start);
    s.dcolor[i] = static_cast<std::int32_t>(step);
  }
  if (!style.port) return s;
  if (random.chance(0.35)) {
    s.xl = std::min(width, home + random.in(0, 2));
    s.xr = std::min(width, s.xl + random.in(0, 9));
  }
  if (random.chance(0.5)) {
    s.z = ((std::int64_t{1} << (c.z_bits - 1)) + random.in(-8, 8)) * (std::int64_t{1} << c.z_frac);
    s.dz = random_field(random, std::min(depth_bits, c.z_frac + 2));
  } else if (random.chance(0.3)) {
    s.z = random_field(random, depth_bits);
    s.dz = random_field(random, depth_bits);
  }
  for (std::size_t i = 0; c.smooth != 0 && i < static_cast<std::size_t>(c.channels); ++i) {
    if (!random.chance(0.3)) continue;
    s.color[i] = static_cast<std::int32_t>(random_field(random, derived::ramp_bits(c)));
    s.dcolor[i] = static_cast<std::int32_t>(random_field(random, derived::ramp_bits(c)));
  }
  return s;
}

/// A translucent span: any span, often one that is not blended at all or nothing but itself.
inline SpanToken random_translucent(Random& random, const Config& c, int width, const FrameStyle& style, int home) {
  SpanToken s = random_span(random, c, width, style, home);
  s.alpha = random.chance(0.3) ? random.in(0, 1) * 255 : random.in(0, 255);
  return s;
}

inline int random_weight(Random& random, const Config& c) {
  const auto most = static_cast<int>(derived::most_dsf(c));
  return random.chance(0.8) ? (random.chance(0.5) ? 1 : -1) : random.in(-most - 1, most);
}

}  // namespace kage::verif
