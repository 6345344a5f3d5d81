/* SPDX-License-Identifier: Apache-2.0
 *
 * The C interface of an RTL model: one shared library per configuration, made by build.py, opened with dlopen. Its one
 * symbol is kage_rtl_api, which gives the table below.
 *
 * A model is kage_top with a driver around it: queues of beats go in under a stall pattern, pixels come out under
 * another. Time passes only in run(), reset(), reg_read() and reg_write(). The same seed and the same calls give the
 * same clocks. One thread at a time per model; models are independent.
 */
#ifndef KAGE_RTL_MODEL_H
#define KAGE_RTL_MODEL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define KAGE_RTL_ABI 2u

typedef struct kage_rtl kage_rtl;

/* Why run() came back. */
enum {
  KAGE_RTL_PIXELS = 0, /* the pixels asked for are there */
  KAGE_RTL_IDLE = 1,   /* all input is taken and nothing moves any more */
  KAGE_RTL_LIMIT = 2,  /* the clocks allowed are used up */
  KAGE_RTL_STUCK = 3,  /* input is waiting, output is ready, and nothing moves: a hang */
  KAGE_RTL_ASSERT =
      4,           /* an assertion in the RTL failed (its message is on standard error); only destroy() may follow */
  KAGE_RTL_DRY = 5 /* every queued beat is taken */
};

/* All counts are since create() or clear_stats(). */
typedef struct {
  uint64_t cycles;        /* clocks outside reset */
  uint64_t input_starved; /* clocks in which the core was ready for a beat that is still queued, but none was offered */
  uint64_t output_blocked; /* clocks in which a pixel waited for ready */
  uint64_t beats;          /* taken by the core */
  uint64_t pixels;         /* delivered */
  uint64_t user_errors;    /* pixels whose TUSER was not that of the expected frame */
  uint64_t last_errors;    /* pixels whose TLAST was not that of the expected frame */
  uint64_t extra_pixels;   /* pixels that no expected frame has room for */
  uint64_t unstable;       /* clocks in which a waiting pixel changed or went away */
} kage_rtl_stats;

typedef struct {
  uint32_t abi; /* KAGE_RTL_ABI */

  /* What the model was built from: parameters by name, in the order of rtl/defs/kage.yaml, and the fault built in (""
   * if none). */
  uint32_t param_count;
  const char* const* param_names;
  const int32_t* param_values;
  const char* fault;

  /* A model out of reset, its registers and memories at random values that `seed` decides. NULL if out of memory. */
  kage_rtl* (*create)(uint64_t seed);
  void (*destroy)(kage_rtl*);

  /* Hold reset for `clocks` (at least 1). Queued beats, expected frames and a half-finished register access are
   * dropped; pixels already delivered stay. */
  void (*reset)(kage_rtl*, uint32_t clocks);

  /* Chance in 65536 that a beat is offered, and that a pixel is taken, per clock: 65536 is always. An offered beat
   * stays. */
  void (*stalls)(kage_rtl*, uint32_t input_chance, uint32_t output_chance, uint64_t seed);

  /* Queue words as whole beats; zeros fill the last beat. `last` puts TLAST on it. A frame may come in several calls.
   */
  void (*submit)(kage_rtl*, const uint32_t* words, size_t count, int last);

  /* Announce the size of a frame whose pixels are to come, for the checks of TUSER and TLAST. */
  void (*expect)(kage_rtl*, uint32_t width, uint32_t height);

  /* Let the clock run until the model holds at least `pixels` undelivered-to-you pixels, or for any other reason above.
   * With pixels = UINT64_MAX it runs until idle. */
  int (*run)(kage_rtl*, uint64_t pixels, uint64_t max_clocks);

  /* Let the clock run until every queued beat is taken, and not one clock more, so that a frame submitted piece by
   * piece takes the clocks it would have taken at once. Comes back with KAGE_RTL_DRY, LIMIT, STUCK or ASSERT. */
  int (*run_dry)(kage_rtl*, uint64_t max_clocks);

  /* The pixels that came since the last clear_pixels(): CHANNELS bytes each, channel 0 first. Valid until time passes.
   */
  const uint8_t* (*pixels)(kage_rtl*, uint64_t* count);
  void (*clear_pixels)(kage_rtl*);

  /* AXI4-Lite accesses; the streams go on meanwhile. Return the response (0 is OKAY), -1 if none came in 1000 clocks.
   */
  int (*reg_read)(kage_rtl*, uint32_t address, uint32_t* value);
  int (*reg_write)(kage_rtl*, uint32_t address, uint32_t value);
  int (*irq)(kage_rtl*);

  void (*stats)(kage_rtl*, kage_rtl_stats*);
  void (*clear_stats)(kage_rtl*);

  /* Write a waveform of all that follows; NULL ends it. -1: this model was built without tracing. */
  int (*trace)(kage_rtl*, const char* path);
} kage_rtl_table;

/* The library's only symbol, of this type. */
typedef const kage_rtl_table* (*kage_rtl_api_function)(void);
#define KAGE_RTL_API_SYMBOL "kage_rtl_api"

#ifdef __cplusplus
}
#endif
#endif
