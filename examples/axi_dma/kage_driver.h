/* SPDX-License-Identifier: Apache-2.0 */
/* A driver for kage_dma: opens the core, draws a frame, says what went wrong. C99, no allocation, no globals; the bus
 * is three functions, so the same code runs on a processor and in a simulation (sim.cpp). */
#ifndef KAGE_DRIVER_H
#define KAGE_DRIVER_H

#include <stdbool.h>
#include <stdint.h>

/* The DMA's registers (kage_dma.v), by byte addresses. */
#define KAGE_DMA_CONTROL 0x00u     /* write: what is to happen */
#define KAGE_DMA_STATUS 0x04u      /* read: what is happening */
#define KAGE_DMA_SOURCE 0x08u      /* of the frame's words, in bytes, a multiple of BEAT_BYTES */
#define KAGE_DMA_BEATS 0x0Cu       /* of the frame; TLAST is on the last */
#define KAGE_DMA_DESTINATION 0x10u /* of the pixels, in bytes, a multiple of 4 */
#define KAGE_DMA_LINES 0x14u       /* of the frame */
#define KAGE_DMA_PIXELS 0x18u      /* read: pixels taken since the capture began */
#define KAGE_DMA_BEAT_BYTES 0x1Cu  /* read: bytes of a beat */

#define KAGE_DMA_CONTROL_FEED 1u    /* read the frame */
#define KAGE_DMA_CONTROL_CAPTURE 2u /* write its pixels */
#define KAGE_DMA_CONTROL_CANCEL 4u  /* end the capture before its last line */
#define KAGE_DMA_CONTROL_DISCARD 8u /* until the next write: let pixels go that nobody captures */
#define KAGE_DMA_STATUS_FEEDING 1u
#define KAGE_DMA_STATUS_CAPTURING 2u
#define KAGE_DMA_STATUS_FEED_FAILED 4u    /* the memory answered a read with an error */
#define KAGE_DMA_STATUS_CAPTURE_FAILED 8u /* the same for a write */

/* How the driver reaches the hardware. */
struct kage_bus {
  void* context; /* what the functions get as their first argument */
  uint32_t core; /* address of the core's registers */
  uint32_t dma;  /* address of the DMA's registers */
  uint32_t (*read)(void* context, uint32_t address);
  void (*write)(void* context, uint32_t address, uint32_t value);
  /* Sleeps until the core's interrupt is high; false where it stays low for longer than a frame may take. */
  bool (*wait)(void* context);
};

/* How a call went. */
enum kage_result {
  KAGE_OK,
  KAGE_NO_CORE,          /* ID is not kage's: a wrong address, or clock or reset is missing */
  KAGE_WRONG_VERSION,    /* the core takes streams of another version */
  KAGE_NO_FRONT_END,     /* the frames are at the polygon level, and the core takes spans alone */
  KAGE_WRONG_PARAMETERS, /* the frames are for a core with other parameters */
  KAGE_WRONG_SHAPE,      /* the DMA's beats are not the core's */
  KAGE_BUSY,             /* a frame is under way */
  KAGE_MALFORMED,        /* the frame breaks a rule; kage_outcome says which, and where */
  KAGE_WRONG_SIZE,       /* other pixels came than were asked for */
  KAGE_STALLED,          /* the watchdog has bitten; kage_outcome says at which port */
  KAGE_MEMORY_ERROR,     /* memory answered the DMA with an error */
  KAGE_TIMEOUT           /* no interrupt came */
};

/* A frame to draw. */
struct kage_job {
  uint32_t source;      /* of its words */
  uint32_t beats;       /* how many: a frame's words, with zeros up to a whole beat */
  uint32_t destination; /* of its pixels, four bytes each */
  uint32_t width, height;
};

/* Outcome of a job. */
struct kage_outcome {
  uint32_t frames;                          /* ended since reset */
  uint32_t pixels;                          /* written */
  uint32_t cycles;                          /* clocks from the start to what ended the call */
  uint32_t error, line, token, frame, unit; /* KAGE_MALFORMED: KAGE_ERR_..., and where */
  bool stalled_on_input, stalled_on_output; /* KAGE_STALLED */
  uint32_t stalled_line;
};

struct kage_device {
  struct kage_bus bus;
  uint32_t watchdog; /* its clocks */
  uint32_t errors;   /* frames with an error before the one that is drawn */
};

#ifdef __cplusplus
extern "C" {
#endif

/* Looks whether the core is there and takes frames of this version and these parameters. A frame's header has them in
 * its first word (bits 15-0) and its third. watchdog: clocks without progress after which the core gives notice; more
 * than memory ever rests. */
enum kage_result kage_open(struct kage_device* device, const struct kage_bus* bus, uint32_t version,
                           uint32_t param_hash, uint32_t watchdog);

/* Draws a frame and returns once its pixels are in memory, or something went wrong. The outcome is filled in any case.
 */
enum kage_result kage_draw(struct kage_device* device, const struct kage_job* job, struct kage_outcome* outcome);

/* After KAGE_STALLED or KAGE_WRONG_SIZE: waits for the frame's end, for `clocks` clocks at most, captures the pixels
 * that can still be captured and drops others. KAGE_TIMEOUT: the core has not gone on, and only a reset of the design
 * helps. */
enum kage_result kage_recover(struct kage_device* device, uint32_t clocks, struct kage_outcome* outcome);

/* The name of an error of frames (KAGE_ERR_HEADER: "HEADER"), and a result in words. */
const char* kage_error_name(uint32_t error);
const char* kage_result_text(enum kage_result result);

#ifdef __cplusplus
}
#endif

#endif
