/* SPDX-License-Identifier: Apache-2.0 */
/** @file
 * What the library of a board in simulation offers (build_board.py makes it, sim_board.cpp loads it). Times are
 * picoseconds since power-up. Nothing runs by itself: time passes within these functions. */
#ifndef KAGE_BOARD_MODEL_H
#define KAGE_BOARD_MODEL_H

#include <stddef.h>
#include <stdint.h>

#define KAGE_BOARD_ABI 2u

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kage_board kage_board;

/** Takes the wires of the screen's socket, as wires_o of constraints/boards/sim has them, in the middle of each bit of
 * a DVI link, or of each pixel of VGA. */
typedef void (*kage_board_video)(void* context, unsigned wires);

typedef struct {
  uint32_t abi;
  /** Powers the board up; `seed` decides what its flip-flops hold. The host's line has `baud`; 0: the board's own. */
  kage_board* (*open)(unsigned seed, unsigned baud);
  void (*close)(kage_board*);
  uint64_t (*now)(const kage_board*);
  /** Puts bytes behind those that wait to go out on the line, and takes no time. */
  void (*send)(kage_board*, const uint8_t* bytes, size_t count);
  /** Bytes that have not gone out whole. */
  size_t (*sending)(const kage_board*);
  /** Lets time pass until a byte has come from the board, or until `deadline`, and gives the bytes that came. */
  size_t (*receive)(kage_board*, uint8_t* bytes, size_t room, uint64_t deadline);
  /** A pressed button resets the board until it is let go. */
  void (*button)(kage_board*, int pressed);
  /** Presses it for so many picoseconds, which pass. Bytes that the board sends meanwhile are there for receive(). */
  void (*tap)(kage_board*, uint64_t picoseconds);
  void (*video)(kage_board*, kage_board_video, void* context);
  uint32_t (*leds)(const kage_board*);
  /** The broken rule at which a chip stopped the simulation, so that time stands still; empty: none. */
  const char* (*stopped)(const kage_board*);
} kage_board_functions;

/** The only symbol that the library has. */
const kage_board_functions* kage_board_model(void);

#ifdef __cplusplus
}
#endif
#endif
