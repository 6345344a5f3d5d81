/* SPDX-License-Identifier: Apache-2.0 */
#include "my_pixel.h"

/* Depth of a span at x: the accumulator has Z_BITS + Z_FRAC + 2 bits, and the result is clamped. */
static uint32_t depth_at(const struct my_line* line, const struct my_token* t, int x) {
  const int bits = line->z_bits + line->z_frac + 2;
  const int64_t most = ((int64_t)1 << line->z_bits) - 2;
  const uint64_t sum = (uint64_t)t->z + (uint64_t)(x - t->xl) * (uint64_t)t->dz;
  const int64_t acc = (int64_t)(sum << (64 - bits)) >> (64 - bits);
  const int64_t z = acc >> line->z_frac;
  if (line->defect == MY_DEPTH) return (uint32_t)(z < 1 ? 1 : z + (x & 1) > most ? most : z + (x & 1));
  return (uint32_t)(z < 1 ? 1 : z > most ? most : z);
}

void my_pixel_step(struct my_pixel* p, const struct my_line* line, const struct my_token* t, int x) {
  const uint32_t clear = ((uint32_t)1 << line->z_bits) - 1;
  const uint32_t mask = ((uint32_t)1 << line->dsf_bits) - 1;
  int c;
  if (x < t->xl || x >= t->xr) return;
  switch (t->kind) {
    case MY_OP: {
      const uint32_t z = depth_at(line, t, x);
      if (z >= p->z) return;
      p->z = z;
      p->lit = t->lit;
      for (c = 0; c < 3; ++c) p->color[c] = t->color[c];
      return;
    }
    case MY_SP:
      if (depth_at(line, t, x) < p->z) p->dsf = (p->dsf + (uint32_t)t->w) & mask;
      return;
    case MY_NC:
      p->dsf = (p->dsf + (uint32_t)t->w) & mask;
      return;
    case MY_EV:
      if (((p->dsf + line->bias) & mask) != 0) p->fsf = 1;
      if (line->defect != MY_FLAG) p->dsf = 0;
      return;
    case MY_RESOLVE:
      for (c = 0; c < 3 && p->z != clear && p->lit && p->fsf; ++c) {
        const uint32_t keep = ((uint32_t)1 << line->shade_frac) - line->shade;
        const uint32_t half = (uint32_t)1 << (line->shade_frac - 1);
        p->color[c] = (int)(((uint32_t)p->color[c] * keep + half) >> line->shade_frac);
      }
      p->dsf = p->fsf = 0;
      return;
    case MY_EOL:
      p->z = clear;
      p->lit = 0;
      p->dsf = p->fsf = 0;
      return;
  }
}
