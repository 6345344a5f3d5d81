/* SPDX-License-Identifier: Apache-2.0 */
#include "kage_driver.h"

#include <kage/registers.h>
#include <string.h>

static uint32_t core_read(const struct kage_device* d, uint32_t reg) {
  return d->bus.read(d->bus.context, d->bus.core + reg);
}
static void core_write(const struct kage_device* d, uint32_t reg, uint32_t value) {
  d->bus.write(d->bus.context, d->bus.core + reg, value);
}
static uint32_t dma_read(const struct kage_device* d, uint32_t reg) {
  return d->bus.read(d->bus.context, d->bus.dma + reg);
}
static void dma_write(const struct kage_device* d, uint32_t reg, uint32_t value) {
  d->bus.write(d->bus.context, d->bus.dma + reg, value);
}

static const uint32_t kAllInterrupts = KAGE_IRQ_FRAME_END_MASK | KAGE_IRQ_ERROR_MASK | KAGE_IRQ_WATCHDOG_MASK;

enum kage_result kage_open(struct kage_device* device, const struct kage_bus* bus, uint32_t version,
                           uint32_t param_hash, uint32_t watchdog) {
  device->bus = *bus;
  device->watchdog = watchdog;
  if (core_read(device, KAGE_REG_ID) != KAGE_ID_VALUE) return KAGE_NO_CORE;
  const bool polygons = version == KAGE_VERSION_POLYGONS;
  if (core_read(device, KAGE_REG_VERSION) != (polygons ? KAGE_VERSION_SPANS : version)) return KAGE_WRONG_VERSION;
  if (polygons && !(core_read(device, KAGE_REG_CAPABILITY) & KAGE_CAPABILITY_POLYGONS_MASK)) return KAGE_NO_FRONT_END;
  if (core_read(device, KAGE_REG_PARAM_HASH) != param_hash) return KAGE_WRONG_PARAMETERS;
  const uint32_t beat_words = KAGE_FIELD(core_read(device, KAGE_REG_SHAPE), KAGE_SHAPE_BEAT_WORDS);
  if (dma_read(device, KAGE_DMA_BEAT_BYTES) != 4 * beat_words) return KAGE_WRONG_SHAPE;
  core_write(device, KAGE_REG_WATCHDOG, watchdog);
  core_write(device, KAGE_REG_IRQ, kAllInterrupts);
  /* ERROR is not asked for: the frame it is of ends too, and FRAME_END comes then. */
  core_write(device, KAGE_REG_CONTROL, KAGE_CONTROL_FRAME_END_MASK | KAGE_CONTROL_WATCHDOG_MASK);
  return KAGE_OK;
}

/* Waits for FRAME_END. */
static enum kage_result wait_for_end(struct kage_device* d, struct kage_outcome* outcome) {
  for (;;) {
    if (!d->bus.wait(d->bus.context)) return KAGE_TIMEOUT;
    const uint32_t irq = core_read(d, KAGE_REG_IRQ);
    core_write(d, KAGE_REG_IRQ, irq);
    if (irq & KAGE_IRQ_FRAME_END_MASK) return KAGE_OK;
    if (irq & KAGE_IRQ_WATCHDOG_MASK) {
      const uint32_t stall = core_read(d, KAGE_REG_STALL);
      outcome->stalled_on_input = KAGE_FIELD(stall, KAGE_STALL_ON_INPUT);
      outcome->stalled_on_output = KAGE_FIELD(stall, KAGE_STALL_ON_OUTPUT);
      outcome->stalled_line = KAGE_FIELD(stall, KAGE_STALL_LINE);
      return KAGE_STALLED;
    }
  }
}

/* Whether the capture ends by itself: while pixels come, it may. A step of a write takes less than the watchdog's
 * clocks. */
static bool capture_ends(struct kage_device* d) {
  uint32_t pixels = dma_read(d, KAGE_DMA_PIXELS);
  uint32_t since = core_read(d, KAGE_REG_CYCLES);
  while (dma_read(d, KAGE_DMA_STATUS) & KAGE_DMA_STATUS_CAPTURING) {
    const uint32_t now = core_read(d, KAGE_REG_CYCLES);
    const uint32_t pixels_now = dma_read(d, KAGE_DMA_PIXELS);
    if (pixels_now != pixels) {
      pixels = pixels_now;
      since = now;
    } else if (now - since > 4 * d->watchdog) {
      return false;
    }
  }
  return true;
}

/* The input is done: waits for the last pixels, and says how the frame went. */
static enum kage_result finish(struct kage_device* d, struct kage_outcome* outcome) {
  const bool was_in_error = core_read(d, KAGE_REG_ERRORS) != d->errors;
  if (was_in_error) {
    const uint32_t error = core_read(d, KAGE_REG_ERROR);
    outcome->error = KAGE_FIELD(error, KAGE_ERROR_CODE);
    outcome->line = KAGE_FIELD(error, KAGE_ERROR_LINE);
    outcome->token = core_read(d, KAGE_REG_ERROR_TOKEN);
    outcome->frame = core_read(d, KAGE_REG_ERROR_FRAME);
    outcome->unit = core_read(d, KAGE_REG_ERROR_UNIT);
  }
  /* A frame whose header was refused (token 0) has no pixels; of others all come, so the capture ends by itself. */
  const bool has_pixels = !was_in_error || outcome->token != 0;
  const bool ended = has_pixels && capture_ends(d);
  if (!ended) {
    dma_write(d, KAGE_DMA_CONTROL, KAGE_DMA_CONTROL_CANCEL);
    capture_ends(d);
  }
  outcome->frames = core_read(d, KAGE_REG_FRAMES);
  outcome->pixels = dma_read(d, KAGE_DMA_PIXELS);
  const uint32_t status = dma_read(d, KAGE_DMA_STATUS);
  /* An access that memory refused makes the frame malformed, so the memory error is reported first. */
  if (status & (KAGE_DMA_STATUS_FEED_FAILED | KAGE_DMA_STATUS_CAPTURE_FAILED)) return KAGE_MEMORY_ERROR;
  if (was_in_error) return KAGE_MALFORMED;
  return ended ? KAGE_OK : KAGE_WRONG_SIZE;
}

enum kage_result kage_draw(struct kage_device* device, const struct kage_job* job, struct kage_outcome* outcome) {
  memset(outcome, 0, sizeof *outcome);
  const uint32_t busy = KAGE_DMA_STATUS_FEEDING | KAGE_DMA_STATUS_CAPTURING;
  if ((dma_read(device, KAGE_DMA_STATUS) & busy) || (core_read(device, KAGE_REG_STATUS) & KAGE_STATUS_OPEN_MASK)) {
    return KAGE_BUSY;
  }
  device->errors = core_read(device, KAGE_REG_ERRORS);
  const uint32_t start = core_read(device, KAGE_REG_CYCLES);
  core_write(device, KAGE_REG_IRQ, kAllInterrupts);
  dma_write(device, KAGE_DMA_SOURCE, job->source);
  dma_write(device, KAGE_DMA_BEATS, job->beats);
  dma_write(device, KAGE_DMA_DESTINATION, job->destination);
  dma_write(device, KAGE_DMA_LINES, job->height);
  dma_write(device, KAGE_DMA_CONTROL, KAGE_DMA_CONTROL_FEED | KAGE_DMA_CONTROL_CAPTURE);
  enum kage_result result = wait_for_end(device, outcome);
  if (result == KAGE_OK) {
    result = finish(device, outcome);
    if (result == KAGE_OK && outcome->pixels != job->width * job->height) result = KAGE_WRONG_SIZE;
  }
  outcome->cycles = core_read(device, KAGE_REG_CYCLES) - start;
  return result;
}

enum kage_result kage_recover(struct kage_device* device, uint32_t clocks, struct kage_outcome* outcome) {
  memset(outcome, 0, sizeof *outcome);
  const uint32_t start = core_read(device, KAGE_REG_CYCLES);
  enum kage_result result = KAGE_OK;
  dma_write(device, KAGE_DMA_CONTROL, KAGE_DMA_CONTROL_DISCARD);
  /* Looked at again and again: FRAME_END may have come before the standstill, while pixels of the frame waited. */
  while (result == KAGE_OK && (core_read(device, KAGE_REG_STATUS) & KAGE_STATUS_OPEN_MASK)) {
    if (core_read(device, KAGE_REG_CYCLES) - start > clocks) result = KAGE_TIMEOUT;
  }
  if (result == KAGE_OK) result = finish(device, outcome);
  dma_write(device, KAGE_DMA_CONTROL, 0);
  outcome->cycles = core_read(device, KAGE_REG_CYCLES) - start;
  return result;
}

const char* kage_error_name(uint32_t error) {
#define NAME(error) [KAGE_ERR_##error] = #error
  static const char* const names[] = {
      NAME(NONE), NAME(HEADER),     NAME(SIZE),      NAME(PARAMS),  NAME(KIND),      NAME(ORDER),     NAME(RANGE),
      NAME(LINE), NAME(LAST_EARLY), NAME(LAST_LATE), NAME(SEGMENT), NAME(UNIT_LONG), NAME(UNIT_SHORT)};
#undef NAME
  return error < sizeof names / sizeof *names ? names[error] : "unknown";
}

const char* kage_result_text(enum kage_result result) {
  switch (result) {
    case KAGE_OK:
      return "drawn";
    case KAGE_NO_CORE:
      return "no core at this address";
    case KAGE_WRONG_VERSION:
      return "the core takes streams of another version";
    case KAGE_NO_FRONT_END:
      return "the frames are at the polygon level, and the core has no front end";
    case KAGE_WRONG_PARAMETERS:
      return "the frames are for a core with other parameters";
    case KAGE_WRONG_SHAPE:
      return "the DMA's beats are not the core's";
    case KAGE_BUSY:
      return "a frame is under way";
    case KAGE_MALFORMED:
      return "malformed";
    case KAGE_WRONG_SIZE:
      return "other pixels came than were asked for";
    case KAGE_STALLED:
      return "stalled";
    case KAGE_MEMORY_ERROR:
      return "memory answered with an error";
    case KAGE_TIMEOUT:
      return "no interrupt came";
  }
  return "unknown";
}
