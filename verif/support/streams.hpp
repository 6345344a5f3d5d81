// SPDX-License-Identifier: Apache-2.0
//
// Random frames of tokens: valid ones, as files hold them or as a port takes them, and what can happen to them on the
// way.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "kage/stream.hpp"
#include "support/random.hpp"

namespace kage::verif {

/// What a frame is made of.
struct FrameStyle {
  int most_opaque = 8;     ///< OPs of a line
  int most_volumes = 3;    ///< of a line, with FSF
  int most_in_volume = 5;  ///< SP, NC and IF of a volume
  /// Spans as a port takes them: accumulators may wrap, which a file may not have, and many spans meet at the same few
  /// pixels and depths, which is what forwarding is for.
  bool port = false;
};

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

/// `home` is the pixel round which the spans of a crowded line meet.
inline SpanToken random_span(Random& random, const Config& c, int width, const FrameStyle& style = {}, int home = 0) {
  SpanToken s;
  s.xl = random.in(0, width);
  s.xr = random.chance(0.2)   ? width
         : random.chance(0.2) ? s.xl
         : random.chance(0.3) ? std::min(width, s.xl + random.in(0, 3))
                              : random.in(s.xl, width);
  if (random.chance(0.1)) s.xl = 0;
  const int count = s.xr - s.xl;
  const int depth_bits = c.z_bits + c.z_frac + 2;
  random_ramp(random, depth_bits, count, s.z, s.dz);
  s.lit = c.dsf_bits > 0 && random.chance(0.8);
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
    if (c.smooth == 0) {
      s.color[i] = random.in(0, 255);
      continue;
    }
    std::int64_t start = 0;
    std::int64_t step = 0;
    random_ramp(random, 10 + c.color_frac, count, start, step);
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
    s.color[i] = static_cast<std::int32_t>(random_field(random, 10 + c.color_frac));
    s.dcolor[i] = static_cast<std::int32_t>(random_field(random, 10 + c.color_frac));
  }
  return s;
}

inline int random_weight(Random& random, const Config& c) {
  return random.chance(0.8) ? (random.chance(0.5) ? 1 : -1) : random.in(-(1 << c.dsf_bits), (1 << c.dsf_bits) - 1);
}

/// Append a valid frame; returns how many tokens of each kind it has.
inline std::array<std::uint64_t, 16> random_frame(Random& random, const Config& c, int width, int height,
                                                  std::vector<std::uint32_t>& words, std::uint32_t number = 0,
                                                  const FrameStyle& style = {}) {
  width = std::min(width, c.max_width);
  std::array<std::uint64_t, 16> count{};
  const auto add = [&count](Kind k) { ++count[static_cast<std::size_t>(k)]; };
  TokenWriter w(c, words);
  w.header({width, height, static_cast<std::uint32_t>(random.in(0, 0xFFFFFF)), number});
  if (c.dsf_bits > 0 && random.chance(0.8)) {
    w.shade(static_cast<std::uint32_t>(random.in(0, 1 << c.shade_frac)));
    add(Kind::SHADE);
  }
  for (int y = 0; y < height; ++y) {
    const int home = style.port ? random.in(0, width - 1) : 0;
    for (int i = random.in(0, style.most_opaque); i > 0; --i) {
      w.op(random_span(random, c, width, style, home));
      add(Kind::OP);
    }
    const int volumes = c.dsf_bits == 0 ? 0 : c.fsf != 0 ? random.in(0, style.most_volumes) : random.in(0, 1);
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
    if (volumes > 0) {
      w.resolve();
      add(Kind::RESOLVE);
    }
    w.eol(y);
    add(Kind::EOL);
  }
  w.end();
  add(Kind::END);
  return count;
}

/// Damage a frame, once to three times: cut it, lengthen it, drop or double a word, flip a bit anywhere, in a kind or
/// in the header, put noise in a word's place, make it a little wider, narrower, higher or lower. It may even survive
/// that.
inline void damage(Random& random, std::vector<std::uint32_t>& words) {
  const auto noise = [&random] { return static_cast<std::uint32_t>(random.integer(0, UINT32_MAX)); };
  for (int i = random.in(1, 3); i > 0 && !words.empty(); --i) {
    const auto at = static_cast<std::ptrdiff_t>(random.integer(0, static_cast<std::int64_t>(words.size()) - 1));
    std::uint32_t& word = words[static_cast<std::size_t>(at)];
    switch (random.in(0, 9)) {
      case 0:
        words.resize(static_cast<std::size_t>(at));
        break;
      case 1:
        for (int n = random.chance(0.2) ? random.in(10, 40) : random.in(1, 9); n > 0; --n) words.push_back(noise());
        break;
      case 2:
        words.erase(words.begin() + at);
        break;
      case 3:
        words.insert(words.begin() + at, word);
        break;
      case 4:
        word ^= 1U << random.in(0, 3);
        break;
      case 5:
        words[std::min<std::size_t>(words.size() - 1, static_cast<std::size_t>(random.in(0, 2)))] ^=
            1U << random.in(0, 31);
        break;
      case 6:
        word = noise();
        break;
      case 7:
        if (words.size() > 1)
          words[1] = static_cast<std::uint32_t>(random.in(0, 6)) << 16 |
                     static_cast<std::uint32_t>(random.in(0, static_cast<int>(words[1] & 0xFFFFU) + 1));
        break;
      default:
        word ^= 1U << random.in(0, 31);
    }
  }
}

}  // namespace kage::verif
