/* SPDX-License-Identifier: Apache-2.0 */

/** @file
 * The golden core as a C library, libkage_golden.so: for testbenches in C, for SystemVerilog by DPI-C, and for any
 * language that calls C. A frame's words go in; after each token the state of every pixel of the line can be read, and
 * each line's pixels as they leave. docs/testbenches.md has examples, docs/stream.md is the contract.
 *
 * Types are those that DPI-C maps:
 * - kage_golden* is chandle,
 * - int is int, unsigned int is int unsigned, long long is longint,
 * - const char* is string,
 * - a pointer to words is an unpacked array of int unsigned with a fixed size.
 *
 * Errors. No exception leaves the library. A call that cannot be served returns KAGE_GOLDEN_ERROR (or NULL), changes
 * nothing and leaves its cause for kage_golden_error(). An error in a frame's words is none of these: it is the frame's
 * proper outcome, KAGE_GOLDEN_FAILED with a status.
 *
 * With NULL for a core a function does nothing and returns KAGE_GOLDEN_ERROR, or its value for "there is none".
 *
 * Threads. A core is for one thread at a time, its strings and pixels too. Different cores are independent.
 *
 * Strings that are returned are the core's own and valid until words are given to the core or another string is asked
 * of it; the pixels that a taker gets, until it returns.
 */
#ifndef KAGE_GOLDEN_H
#define KAGE_GOLDEN_H

#include "kage/golden_numbers.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Version of this interface. It rises when a declaration changes its meaning or goes. */
#define KAGE_GOLDEN_ABI 1

/** A core. */
typedef struct kage_golden kage_golden;

/** Result of giving a word, and the core's place in its frame. */
enum {
  KAGE_GOLDEN_ERROR = -1, /**< the call could not be done */
  KAGE_GOLDEN_MORE = 0,   /**< the token is not whole yet */
  KAGE_GOLDEN_TOKEN = 1,  /**< a token (or the header, token 0) is whole and has done what it does */
  KAGE_GOLDEN_END = 2,    /**< END has come: what is fed before kage_golden_finish() is fill */
  KAGE_GOLDEN_FAILED = 3  /**< the frame has an error: words are ignored until kage_golden_finish() */
};

/** Results of kage_golden_pixel() that stand for no value. */
enum {
  KAGE_PIXEL_ABSENT = -1, /**< the configuration has no such field, the line no such pixel, or there is no line */
  KAGE_PIXEL_ANY = -2     /**< never seen, so any value is right: class and (before a TP) colour of a clear pixel */
};

/** Fields of a frame's status. */
enum {
  KAGE_STATUS_ERROR = 0,  /**< the code of docs/stream.md, "Errors"; 0: none, and then the next four are 0 */
  KAGE_STATUS_FRAME = 1,  /**< number in the header */
  KAGE_STATUS_LINE = 2,   /**< EOLs accepted before the error */
  KAGE_STATUS_TOKEN = 3,  /**< index of the token in its frame */
  KAGE_STATUS_UNIT = 4,   /**< of an error of a unit */
  KAGE_STATUS_WIDTH = 5,  /**< 0 after an error in the header */
  KAGE_STATUS_HEIGHT = 6, /**< likewise */
  KAGE_STATUS_FIELDS = 7  /**< how many there are */
};

/** The library's KAGE_GOLDEN_ABI.
 * @return that of the header that it was built with */
int kage_golden_abi(void);

/** A core of a configuration.
 * @param config a name in rtl/defs/configs.yaml, a YAML file, or a stream file, whose own it then is
 * @return the core; NULL after an error, whose text kage_golden_error(NULL) has */
kage_golden* kage_golden_create(const char* config);

/** A core of parameters.
 * @param yaml "{Z_BITS: 16, LANES: 1}"; those left out have their defaults, "{}" is all of them
 * @return the core; NULL after an error, whose text kage_golden_error(NULL) has */
kage_golden* kage_golden_create_parameters(const char* yaml);

/** Ends a core.
 * @param core is gone after this; NULL does nothing */
void kage_golden_destroy(kage_golden* core);

/** Why the last call returned an error.
 * @param core whose call; NULL: the last create in this thread
 * @return one line; "" if there was none */
const char* kage_golden_error(const kage_golden* core);

/** The value of a parameter.
 * @param core whose configuration
 * @param name as in docs/stream.md, "Z_BITS"
 * @return the value, KAGE_GOLDEN_ERROR if there is none of that name */
int kage_golden_parameter(kage_golden* core, const char* name);

/* --- Words in ---------------------------------------------------------------------------------------------------- */

/** The next word of the frame at hand.
 * @param core gets it
 * @param word the word
 * @return KAGE_GOLDEN_MORE, KAGE_GOLDEN_TOKEN, KAGE_GOLDEN_END or KAGE_GOLDEN_FAILED */
int kage_golden_word(kage_golden* core, unsigned int word);

/** Words in one piece, tokens not told apart. Faster than word by word.
 * @param core gets them
 * @param words `count` of them
 * @param count at least 0
 * @return where in the frame the core is then: KAGE_GOLDEN_MORE (so far no end), KAGE_GOLDEN_END or KAGE_GOLDEN_FAILED
 */
int kage_golden_feed(kage_golden* core, const unsigned int* words, int count);

/** The frame's words have all been given, TLAST with the beat of the last. The next words are the next frame's.
 * @param core whose frame
 * @return the error code of the frame (docs/stream.md, "Errors"), 0 if it has none */
int kage_golden_finish(kage_golden* core);

/** Take words from a stream file, which must have this core's pixel parameters; no other program may make it shorter
 * meanwhile.
 * @param core reads them
 * @param path the file
 * @return the number of its frames */
int kage_golden_open(kage_golden* core, const char* path);

/** Choose the frame that kage_golden_next() reads, from its header on. A frame that was not finished is forgotten. The
 * frame's words are checked as strictly as kage info checks them.
 * @param core has the file open
 * @param index from 0
 * @return 0 */
int kage_golden_frame(kage_golden* core, int index);

/** The next token of that frame. After the last, as with words, kage_golden_finish().
 * @param core has the file open
 * @return KAGE_GOLDEN_TOKEN, KAGE_GOLDEN_END or KAGE_GOLDEN_FAILED */
int kage_golden_next(kage_golden* core);

/* --- The last token that was accepted ---------------------------------------------------------------------------- */

/** Which token it is.
 * @param core that accepted it
 * @return KAGE_KIND_... */
int kage_golden_token_kind(kage_golden* core);

/** Where in its frame it is.
 * @param core that accepted it
 * @return its index; the header is 0, -1 before it */
int kage_golden_token_index(kage_golden* core);

/** How long it is.
 * @param core that accepted it
 * @return how many words it has */
int kage_golden_token_words(kage_golden* core);

/** How many tokens of the span level it has come to: those that the front end makes of it, and itself if it goes on.
 * @param core that accepted it
 * @return their number; 0 of a frame at the span level, whose tokens are themselves */
int kage_golden_made(kage_golden* core);

/** Have the functions of this part tell of one of those, until words are given to the core. Its index is still that of
 * the stream's token.
 * @param core that accepted the stream's token
 * @param i from 0, in their order; -1: the stream's token again
 * @return 0, or KAGE_GOLDEN_ERROR if there is none of that number */
int kage_golden_choose_made(kage_golden* core, int i);

/** A word of it.
 * @param core that accepted it
 * @param i from 0
 * @return the i-th of its words, 0 if there is none */
unsigned int kage_golden_token_word(kage_golden* core, int i);

/** A field of it.
 * @param core that accepted it
 * @param field KAGE_TOKEN_...
 * @return its value; 0 if the token has none of that name */
long long kage_golden_token_field(kage_golden* core, int field);

/** The token in words.
 * @param core that accepted it
 * @return "OP [12, 40) z 123.5 dz -0.25 color 10,20,30 lit" */
const char* kage_golden_token_text(kage_golden* core);

/* --- The line at hand, after that token -------------------------------------------------------------------------- */

/** The frame's width.
 * @param core whose frame
 * @return pixels of a line; 0 when there is no frame */
int kage_golden_width(kage_golden* core);

/** The frame's height.
 * @param core whose frame
 * @return lines; 0 when there is no frame */
int kage_golden_height(kage_golden* core);

/** The line's number.
 * @param core whose frame
 * @return lines that have ended */
int kage_golden_line(kage_golden* core);

/** The line's bias.
 * @param core whose line
 * @return 0 .. 2^DSF_BITS - 1 */
int kage_golden_bias(kage_golden* core);

/** The frame's background.
 * @param core whose frame
 * @return channel c in bits 8c .. 8c + 7 */
unsigned int kage_golden_background(kage_golden* core);

/** A field of a pixel. After an EOL the line is clear.
 * @param core whose line
 * @param x from 0
 * @param field KAGE_PIXEL_...
 * @return its value, KAGE_PIXEL_ABSENT or KAGE_PIXEL_ANY */
int kage_golden_pixel(kage_golden* core, int x, int field);

/** The name of a pixel's field for messages.
 * @param field KAGE_PIXEL_...
 * @return "z", "color[0]", "class", "dsf", "fsf", "count[0]"; "" if there is none */
const char* kage_golden_pixel_name(int field);

/* --- Lines out --------------------------------------------------------------------------------------------------- */

/** The line that left last. After an error all lines that had not ended leave at once, as background.
 * @param core whose frame
 * @return its number, -1 before the frame's first */
int kage_golden_out_line(kage_golden* core);

/** A pixel of the line that left last.
 * @param core whose frame
 * @param x from 0
 * @param channel from 0
 * @return 0 .. 255, -1 if there is none */
int kage_golden_out(kage_golden* core, int x, int channel);

/** Gets every line as it leaves: its number `y` and its `pixels`, `bytes` of them, CHANNELS a pixel. It must not call
 * the core, nor leave but by returning. `user` is what kage_golden_on_line() was given. */
typedef void (*kage_golden_taker)(void* user, int y, const unsigned char* pixels, int bytes);

/** Have every line taken as it leaves.
 * @param core whose lines
 * @param taker gets them; NULL: no one
 * @param user is passed on */
void kage_golden_on_line(kage_golden* core, kage_golden_taker taker, void* user);

/* --- How a frame ended ------------------------------------------------------------------------------------------- */

/** A field of the frame that was finished last, or has just failed.
 * @param core whose frame
 * @param field KAGE_STATUS_...
 * @return its value; -1 if there is no such field */
long long kage_golden_status(kage_golden* core, int field);

/** How that frame ended, in words.
 * @param core whose frame
 * @return "no error", or name, meaning and place: "ORDER: a token where its phase does not allow it: frame 0, line 3,
 * ..." */
const char* kage_golden_status_text(kage_golden* core);

#ifdef __cplusplus
}
#endif
#endif
