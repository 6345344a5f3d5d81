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

/* Rises with every change of kage_rtl_table. A program refuses a model of another number: the table begins with it. */
#define KAGE_RTL_ABI 15u

typedef struct kage_rtl kage_rtl;

/* Why run() came back. */
enum {
  KAGE_RTL_PIXELS = 0, /* the pixels asked for are there */
  KAGE_RTL_IDLE = 1, /* all input is taken and nothing moves any more; pixels that no expect() announced do not count */
  KAGE_RTL_LIMIT = 2,  /* the clocks allowed are used up */
  KAGE_RTL_STUCK = 3,  /* input is waiting, output is ready, and nothing moves, likewise: a hang */
  KAGE_RTL_ASSERT = 4, /* an assertion in the RTL failed: see failure(); then only pixels() and destroy() */
  KAGE_RTL_DRY = 5     /* every queued beat is taken */
};

/* Results of a register access that gets no response. */
enum {
  KAGE_RTL_NO_ANSWER = -1, /* none came in 1000 clocks */
  KAGE_RTL_ENDED = -2,     /* an assertion failed, or $finish ended the simulation */
  KAGE_RTL_UNASKED = -3,   /* it came before address and data had been taken */
  KAGE_RTL_UNSTABLE = -4   /* it changed or went away while it waited for its ready */
};

/* An access of a register that takes its time. */
typedef struct {
  uint32_t address;
  uint32_t data;    /* what is written, or was read */
  unsigned strobes; /* of a write: a bit a byte */
  int answer;       /* the response, or what came in its place */
} kage_rtl_access;

/* Events that pass between the modules of the core, and within some, as the monitors tell them. The stages, and the
 * values of each, are in rtl/defs/stages.yaml. */
#define KAGE_RTL_EVENT_VALUES 13

typedef struct {
  uint64_t clock; /* since create(); the one at whose end it happens */
  int32_t stage;
  int32_t unit;
  uint64_t value[KAGE_RTL_EVENT_VALUES];
} kage_rtl_event;

#define KAGE_RTL_MARKS 9

/* All counts are since create() or clear_stats(). */
typedef struct {
  uint64_t cycles; /* clocks outside reset */
  /* Clocks by the mark of the first word of the next beat, mark(). starved: the core was ready for a beat that is
   * still queued but none was offered. blocked: a pixel waited for ready. */
  uint64_t starved[KAGE_RTL_MARKS];
  uint64_t blocked[KAGE_RTL_MARKS];
  uint64_t beats;        /* taken by the core */
  uint64_t pixels;       /* delivered */
  uint64_t user_errors;  /* pixels whose TUSER was not that of the expected frame */
  uint64_t last_errors;  /* pixels whose TLAST was not that of the expected frame */
  uint64_t extra_pixels; /* pixels that no expected frame has room for */
  uint64_t unstable;     /* clocks in which a waiting pixel changed or went away */
} kage_rtl_stats;

typedef struct {
  uint32_t abi; /* KAGE_RTL_ABI */

  /* Parameters that the model was built with, by name, in the order of rtl/defs/kage.yaml; and the fault built in
   * ("" if none). */
  uint32_t param_count;
  const char* const* param_names;
  const int32_t* param_values;
  const char* fault;
  int mutants; /* how many are built in, behind select(); 0: none */
  /* Monitors that do not fit the RTL and were left out, "a, b", "" if none, and a bit for each KAGE_STAGE_* of which
   * there are no events therefore. */
  const char* missing_monitors;
  uint32_t unwatched;
  int monitored; /* built with monitors; without, record() and handshakes() return -1 */

  /* A model out of reset, its registers and memories at random values that `seed` decides. NULL if out of memory. */
  kage_rtl* (*create)(uint64_t seed);
  void (*destroy)(kage_rtl*);

  /* Be mutant `mutant` (1 ..), or none (0), from the second clock of the next reset on. -1 if there is no such mutant.
   */
  int (*select)(kage_rtl*, int mutant);

  /* Whether assertions of the RTL are looked at; they are from create() on. */
  void (*assertions)(kage_rtl*, int on);

  /* Sends the RTL's text from now on, as of $display or an assertion that fails, to `text` with `user`, in pieces of
   * any size. Where `text` is NULL, it goes to standard error, as it does from create() on. */
  void (*on_text)(kage_rtl*, void (*text)(void* user, const char* piece), void* user);

  /* The file and line of the assertion that failed, "frame_control.sv:312"; "" if none has. Its message has gone where
   * on_text() says. */
  const char* (*failure)(kage_rtl*);

  /* Hold reset for `clocks` (at least 1). Queued beats, expected frames and a half-finished register access are
   * dropped; pixels already delivered stay. */
  void (*reset)(kage_rtl*, uint32_t clocks);

  /* The share of clocks, in 65536, in which the next beat is offered, and in which a pixel is taken: 65536 is always.
   * An offered beat stays; while none is offered, data and TLAST are noise. Stops come alone, in bursts, and now and
   * then last longer than any buffer; `seed` says when, from this call on. */
  void (*stalls)(kage_rtl*, uint32_t input_share, uint32_t output_share, uint64_t seed);

  /* Queue words as whole beats; zeros fill the last beat. `last` puts TLAST on it. A frame may come in several calls.
   */
  void (*submit)(kage_rtl*, const uint32_t* words, size_t count, int last);

  /* Marks, below KAGE_RTL_MARKS, for the words that the next submit() queues, one each; those without have 0. Once the
   * last beat of a frame is taken, the mark is KAGE_RTL_MARKS - 1. */
  void (*mark)(kage_rtl*, const uint8_t* marks, size_t count);

  /* Announce the size of a frame whose pixels are to come: TUSER and TLAST are checked by it, and those pixels count as
   * movement. */
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

  /* AXI4-Lite accesses; the streams go on meanwhile. Return the response (0 is OKAY), or a negative number as above.
   * Address and data come in the first clock, and a response is taken in the clock in which it comes. */
  int (*reg_read)(kage_rtl*, uint32_t address, uint32_t* value);
  int (*reg_write)(kage_rtl*, uint32_t address, uint32_t value);
  /* A write, a read (the other is NULL), or both at the same time, by a master that takes its time. A write's
   * address comes before its data, with it, or behind it. A read's address comes some clocks behind a write's.
   * Responses wait for their ready. The seed of stalls() says how long. */
  void (*reg_access)(kage_rtl*, kage_rtl_access* write, kage_rtl_access* read);
  int (*irq)(kage_rtl*);

  void (*stats)(kage_rtl*, kage_rtl_stats*);
  void (*clear_stats)(kage_rtl*);

  /* Clocks since create(), those in reset too. */
  uint64_t (*clock)(kage_rtl*);

  /* Record events from now on (on = 1) or no longer (0). Those recorded stay until clear_events(). */
  int (*record)(kage_rtl*, int on);
  const kage_rtl_event* (*events)(kage_rtl*, uint64_t* count);
  void (*clear_events)(kage_rtl*);

  /* Handshakes, as of the last clock that was recorded: who waits for whom. Pairs {valid, ready}, ready lower, from
   * the lowest: token, segment, tree, command (before pixel_loads), command (behind it), line, load, video. Then
   * three more pairs: a frame's header before the tree; a command that waits before the buffers of the way out; a
   * line that the way out has and shall send back. Then a bit: input is being dropped. */
  int64_t (*handshakes)(kage_rtl*);

  /* Write an FST waveform of the clocks `first` to `last` to `path`, which is there whole once they have passed or the
   * model is destroyed. One time unit is half a clock. -1: the model was not built for waveforms. */
  int (*wave)(kage_rtl*, const char* path, uint64_t first, uint64_t last);

  /* End the waveform where it stands. 0: it is whole; else the errno of what could not be written of it. */
  int (*end_wave)(kage_rtl*);

  /* Tell `point` of each line and branch of the RTL, "token_reader.sv:120 else", how often it has run since create();
   * of each module's instances and parameters once. -1: the model was not built to count them. */
  int (*lines)(kage_rtl*, void (*point)(void* user, const char* place, uint64_t count), void* user);
} kage_rtl_table;

/* The library's only symbol, of this type. */
typedef const kage_rtl_table* (*kage_rtl_api_function)(void);
#define KAGE_RTL_API_SYMBOL "kage_rtl_api"

#ifdef __cplusplus
}
#endif
#endif
