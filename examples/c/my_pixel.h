/* SPDX-License-Identifier: Apache-2.0
 *
 * Stands for a pixel processor of your own, as a C model: flat colour, shadows by counting, no counters of samples, no
 * translucency. It knows nothing of kage's library, only docs/stream.md.
 */
#ifndef MY_PIXEL_H
#define MY_PIXEL_H

#include <stdint.h>

enum my_kind { MY_OP, MY_SP, MY_NC, MY_EV, MY_RESOLVE, MY_EOL };

enum my_defect { MY_SOUND, MY_DEPTH, MY_FLAG };

/* The values that all pixels share. */
struct my_line {
  int z_bits, z_frac, dsf_bits, shade_frac;
  uint32_t shade;
  uint32_t bias;
  enum my_defect defect;
};

/* A token that touches pixels; xl .. xr of RESOLVE and EOL is the line. */
struct my_token {
  enum my_kind kind;
  int xl, xr, w, lit;
  int64_t z, dz;
  int color[3];
};

struct my_pixel {
  uint32_t z;
  int color[3];
  int lit;
  uint32_t dsf, fsf;
};

/* Applies the token to the pixel at x. The line's bias is the caller's. */
void my_pixel_step(struct my_pixel* p, const struct my_line* line, const struct my_token* t, int x);

#endif
