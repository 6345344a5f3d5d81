/* SPDX-License-Identifier: Apache-2.0
 *
 * Checks a pixel processor in C against kage's golden core, token by token: after each token every field of every
 * pixel, after each line the pixels that leave.
 *
 * usage: pixel_check FILE.kage [depth|flag]     (a defect to make, to see it told)
 * Exit code 0: the same. 1: different. 2: trouble.
 */
#include <kage/golden.h>
#include <stdio.h>
#include <string.h>

#include "my_pixel.h"

enum { MAX_WIDTH = 4096, SAME = 0, DIFFERENT = 1, TROUBLE = 2 };

static struct my_pixel pixels[MAX_WIDTH];
static struct my_line line;

/* The golden core's token as the processor takes it; 0 if it touches no pixel. */
static int token_of(kage_golden* core, struct my_token* t) {
  int c;
  t->xl = (int)kage_golden_token_field(core, KAGE_TOKEN_XL);
  t->xr = (int)kage_golden_token_field(core, KAGE_TOKEN_XR);
  t->z = kage_golden_token_field(core, KAGE_TOKEN_Z);
  t->dz = kage_golden_token_field(core, KAGE_TOKEN_DZ);
  t->w = (int)kage_golden_token_field(core, KAGE_TOKEN_W);
  t->lit = (int)kage_golden_token_field(core, KAGE_TOKEN_CLASS);
  for (c = 0; c < 3; ++c) t->color[c] = (int)kage_golden_token_field(core, KAGE_TOKEN_COLOR + c);
  switch (kage_golden_token_kind(core)) {
    case KAGE_KIND_OP:
      t->kind = MY_OP;
      return 1;
    case KAGE_KIND_SP:
      t->kind = MY_SP;
      return 1;
    case KAGE_KIND_NC:
      t->kind = MY_NC;
      return 1;
    case KAGE_KIND_EV:
      t->kind = MY_EV;
      return 1;
    case KAGE_KIND_RESOLVE:
      t->kind = MY_RESOLVE;
      break;
    case KAGE_KIND_HEADER:
    case KAGE_KIND_EOL:
      t->kind = MY_EOL; /* the header clears the line too */
      break;
    default:
      return 0;
  }
  t->xl = 0;
  t->xr = kage_golden_width(core);
  return 1;
}

static int differs(kage_golden* core, int frame, int x, const char* field, int expected, int actual) {
  printf("different: frame %d, line %d, token %d (%s), pixel %d, field %s: expected %d, got %d\n", frame,
         kage_golden_line(core), kage_golden_token_index(core), kage_golden_token_text(core), x, field, expected,
         actual);
  return DIFFERENT;
}

/* Every field of every pixel. */
static int compare(kage_golden* core, int frame, long* checked) {
  int x, field;
  for (x = 0; x < kage_golden_width(core); ++x) {
    const struct my_pixel* p = &pixels[x];
    const int mine[KAGE_PIXEL_COUNT] = {(int)p->z, p->color[0], p->color[1], p->color[2],
                                        p->lit,    (int)p->dsf, (int)p->fsf};
    for (field = 0; field < KAGE_PIXEL_COUNT; ++field) {
      const int expected = kage_golden_pixel(core, x, field);
      if (expected == KAGE_PIXEL_ABSENT || expected == KAGE_PIXEL_ANY) continue;
      ++*checked;
      if (mine[field] != expected) return differs(core, frame, x, kage_golden_pixel_name(field), expected, mine[field]);
    }
  }
  return SAME;
}

/* Compares the line at EOL, before the processor clears it: colours, or the background where nothing was drawn. */
static int compare_out(kage_golden* core, int frame) {
  const uint32_t clear = ((uint32_t)1 << line.z_bits) - 1;
  int x, c;
  for (x = 0; x < kage_golden_width(core); ++x)
    for (c = 0; c < 3; ++c) {
      const int background = (int)(kage_golden_background(core) >> (8 * c) & 255);
      const int mine = pixels[x].z == clear ? background : pixels[x].color[c];
      const int expected = kage_golden_out(core, x, c);
      if (mine != expected) return differs(core, frame, x, "pixel that leaves", expected, mine);
    }
  return SAME;
}

static int step(kage_golden* core, int frame, long* checked) {
  struct my_token t;
  const int kind = kage_golden_token_kind(core);
  const uint32_t mask = ((uint32_t)1 << line.dsf_bits) - 1;
  int x;
  if (kind == KAGE_KIND_HEADER) line.shade = 0;
  if (kind == KAGE_KIND_SHADE) line.shade = (uint32_t)kage_golden_token_field(core, KAGE_TOKEN_SHADE);
  if (kind == KAGE_KIND_EOL && compare_out(core, frame) != SAME) return DIFFERENT;
  if (token_of(core, &t))
    for (x = 0; x < kage_golden_width(core); ++x) my_pixel_step(&pixels[x], &line, &t, x);
  if (kind == KAGE_KIND_IF) line.bias = (line.bias + (uint32_t)t.w) & mask;
  if (kind == KAGE_KIND_EV || kind == KAGE_KIND_RESOLVE || kind == KAGE_KIND_EOL || kind == KAGE_KIND_HEADER)
    line.bias = 0;
  return compare(core, frame, checked);
}

static int trouble(kage_golden* core) {
  fprintf(stderr, "pixel_check: %s\n", kage_golden_error(core));
  return TROUBLE;
}

static int run(kage_golden* core, const char* path) {
  long tokens = 0, checked = 0;
  int frame, result = KAGE_GOLDEN_TOKEN;
  const int frames = kage_golden_open(core, path);
  if (frames < 0) return trouble(core);
  for (frame = 0; frame < frames; ++frame) {
    if (kage_golden_frame(core, frame) < 0) return trouble(core);
    while ((result = kage_golden_next(core)) == KAGE_GOLDEN_TOKEN) {
      if (kage_golden_width(core) > MAX_WIDTH) {
        fprintf(stderr, "pixel_check: %s: wider than %d pixels\n", path, MAX_WIDTH);
        return TROUBLE;
      }
      ++tokens;
      if (step(core, frame, &checked) != SAME) return DIFFERENT;
    }
    if (result == KAGE_GOLDEN_ERROR) return trouble(core);
    if (kage_golden_finish(core) != 0) {
      fprintf(stderr, "pixel_check: %s: %s\n", path, kage_golden_status_text(core));
      return TROUBLE;
    }
  }
  printf("same: %d frames, %ld tokens, %ld values checked\n", frames, tokens, checked);
  return SAME;
}

/* The parameters that this processor can do. */
static int suits(kage_golden* core) {
  static const struct {
    const char* name;
    int value;
  } needed[] = {{"CHANNELS", 3}, {"SMOOTH", 0}, {"FSF", 1}, {"COUNT_BITS", 0}, {"TRANSLUCENCY", 0}, {"UNITS", 0}};
  size_t i;
  for (i = 0; i < sizeof needed / sizeof needed[0]; ++i)
    if (kage_golden_parameter(core, needed[i].name) != needed[i].value) {
      fprintf(stderr, "pixel_check: %s is not %d, which is all that this processor can do\n", needed[i].name,
              needed[i].value);
      return 0;
    }
  line.z_bits = kage_golden_parameter(core, "Z_BITS");
  line.z_frac = kage_golden_parameter(core, "Z_FRAC");
  line.dsf_bits = kage_golden_parameter(core, "DSF_BITS");
  line.shade_frac = kage_golden_parameter(core, "SHADE_FRAC");
  return 1;
}

int main(int argc, char** argv) {
  int code;
  kage_golden* core;
  const char* defect = argc > 2 ? argv[2] : "";
  line.defect = strcmp(defect, "depth") == 0 ? MY_DEPTH : strcmp(defect, "flag") == 0 ? MY_FLAG : MY_SOUND;
  if (argc < 2 || argc > 3 || (argc == 3 && line.defect == MY_SOUND)) {
    fprintf(stderr, "usage: pixel_check FILE.kage [depth|flag]\n");
    return TROUBLE;
  }
  core = kage_golden_create(argv[1]);
  if (core == NULL) return trouble(NULL);
  code = suits(core) ? run(core, argv[1]) : TROUBLE;
  kage_golden_destroy(core);
  return code;
}
