/* SPDX-License-Identifier: Apache-2.0
 *
 * The golden core as a C library, libkage_golden.so: for test benches in C, for SystemVerilog by DPI-C, and for any
 * language that calls C. A frame's words go in; after each token the state of every pixel of the line can be read, and
 * each line's pixels as they leave. docs/benches.md has examples, docs/stream.md is the contract.
 *
 * Types are those that DPI-C maps: kage_golden* is chandle, int is int, unsigned int is int unsigned, long long is
 * longint, const char* is string, and a pointer to words is an unpacked array of int unsigned with a fixed size.
 *
 * Errors. No exception leaves the library. What cannot be done returns KAGE_GOLDEN_ERROR (or NULL), changes nothing
 * and leaves its cause for kage_golden_error(). An error in a frame's words is none of these: it is what the frame is
 * to have, KAGE_GOLDEN_FAILED with a status.
 *
 * With NULL for a core a function does nothing and returns KAGE_GOLDEN_ERROR, or what it returns where there is none of
 * what it is asked for.
 *
 * Threads. A core is for one thread at a time, its strings and pixels too. Different cores are independent.
 *
 * Strings that are returned are the core's own and valid until words are given to the core or another string is asked
 * of it; the pixels that a taker gets, until it returns.
 */
#ifndef KAGE_GOLDEN_H
#define KAGE_GOLDEN_H

#ifdef __cplusplus
extern "C" {
#endif

#define KAGE_GOLDEN_ABI 1

typedef struct kage_golden kage_golden;

/* What a word came to, and where in a frame a core is. */
enum {
  KAGE_GOLDEN_ERROR = -1, /* the call could not be done */
  KAGE_GOLDEN_MORE = 0,   /* the token is not whole yet */
  KAGE_GOLDEN_TOKEN = 1,  /* a token (or the header, token 0) is whole and has done what it does */
  KAGE_GOLDEN_END = 2,    /* END has come: what is fed before kage_golden_finish() is fill */
  KAGE_GOLDEN_FAILED = 3  /* the frame has an error: words are ignored until kage_golden_finish() */
};

/* Fields of a pixel's state. */
enum {
  KAGE_PIXEL_Z = 0,      /* all ones: clear */
  KAGE_PIXEL_COLOR = 1,  /* and 2, 3: by channel, 0 .. 255 */
  KAGE_PIXEL_CLASS = 4,  /* 0 is unlit; without a table 1 is lit */
  KAGE_PIXEL_DSF = 5,    /* 0 .. 2^DSF_BITS - 1 */
  KAGE_PIXEL_FSF = 6,    /* 0 or 1 */
  KAGE_PIXEL_COUNT = 7,  /* .. 14: by light */
  KAGE_PIXEL_FIELDS = 15 /* how many there are */
};

/* What kage_golden_pixel() gives instead of a value. */
enum {
  KAGE_PIXEL_ABSENT = -1, /* the configuration has no such field, the line no such pixel, or there is no line */
  KAGE_PIXEL_ANY = -2     /* never seen, so any value is right: class and (before a TP) colour of a clear pixel */
};

/* Fields of a token, as in the table of tokens in docs/stream.md. */
enum {
  KAGE_TOKEN_XL = 0,
  KAGE_TOKEN_XR = 1,
  KAGE_TOKEN_Z = 2,  /* signed, Z_FRAC fraction bits */
  KAGE_TOKEN_DZ = 3, /* signed */
  KAGE_TOKEN_W = 4,  /* signed */
  KAGE_TOKEN_CLASS = 5,
  KAGE_TOKEN_COLOR = 6,  /* .. 8: by channel */
  KAGE_TOKEN_DCOLOR = 9, /* .. 11: by channel, signed */
  KAGE_TOKEN_ALPHA = 12,
  KAGE_TOKEN_SHADE = 13,
  KAGE_TOKEN_LIGHT = 14,
  KAGE_TOKEN_SHARE = 15, /* .. 17: by channel */
  KAGE_TOKEN_Y = 18,
  KAGE_TOKEN_UNIT = 19,
  KAGE_TOKEN_FACE = 20,
  KAGE_TOKEN_INDEX = 21,
  KAGE_TOKEN_DX = 22,
  KAGE_TOKEN_SYNC = 23,
  KAGE_TOKEN_FIELDS = 24
};

/* Kinds of tokens, as kage_golden_token_kind() gives them. */
enum {
  KAGE_KIND_HEADER = 0,
  KAGE_KIND_SHADE = 1,
  KAGE_KIND_TABLE = 2,
  KAGE_KIND_FACE = 3,
  KAGE_KIND_SEG = 4,
  KAGE_KIND_TREE = 5,
  KAGE_KIND_OP = 6,
  KAGE_KIND_SP = 7,
  KAGE_KIND_NC = 8,
  KAGE_KIND_IF = 9,
  KAGE_KIND_EV = 10,
  KAGE_KIND_ES = 11,
  KAGE_KIND_RESOLVE = 12,
  KAGE_KIND_TP = 13,
  KAGE_KIND_EOL = 14,
  KAGE_KIND_END = 15
};

/* Fields of a frame's status. */
enum {
  KAGE_STATUS_ERROR = 0, /* the code of docs/stream.md, "Errors"; 0: none, and then the next four are 0 */
  KAGE_STATUS_FRAME = 1, /* number in the header */
  KAGE_STATUS_LINE = 2,  /* EOLs accepted before the error */
  KAGE_STATUS_TOKEN = 3, /* index of the token in its frame */
  KAGE_STATUS_UNIT = 4,
  KAGE_STATUS_WIDTH = 5, /* 0 after an error in the header */
  KAGE_STATUS_HEIGHT = 6,
  KAGE_STATUS_FIELDS = 7
};

/* KAGE_GOLDEN_ABI of the library. It grows when something here changes its meaning. */
int kage_golden_abi(void);

/* A core of a configuration: a name in rtl/defs/configs.yaml, a YAML file, or a stream file, whose own it then is. NULL
 * after an error, whose text kage_golden_error(NULL) has. */
kage_golden* kage_golden_create(const char* config);

/* A core of parameters as YAML: "{Z_BITS: 16, LANES: 1}". Those left out have their defaults; "{}" is all of them. */
kage_golden* kage_golden_create_parameters(const char* yaml);

/* NULL does nothing. */
void kage_golden_destroy(kage_golden* core);

/* Why the last call on this core returned an error, one line; of NULL: the last error of a create in this thread. ""
 * if there was none. */
const char* kage_golden_error(const kage_golden* core);

/* The value of a parameter ("Z_BITS"), KAGE_GOLDEN_ERROR if there is none of that name. */
int kage_golden_parameter(kage_golden* core, const char* name);

/* --- Words in ---------------------------------------------------------------------------------------------------- */

/* The next word of the frame at hand: MORE, TOKEN, END or FAILED. */
int kage_golden_word(kage_golden* core, unsigned int word);

/* Words in one piece, tokens not told apart: where in the frame the core is then, MORE (so far no end), END or
 * FAILED. Faster than word by word. */
int kage_golden_feed(kage_golden* core, const unsigned int* words, int count);

/* The frame's words have all been given, TLAST with the beat of the last. Returns the error code of the frame, 0 if it
 * has none. What is given next is the next frame. */
int kage_golden_finish(kage_golden* core);

/* Take words from a stream file, which must have this core's pixel parameters; no other program may make it shorter
 * meanwhile. Returns the number of its frames. */
int kage_golden_open(kage_golden* core, const char* path);

/* Frame `index` of that file is what kage_golden_next() reads, from its header on. A frame that was not finished is
 * forgotten. Returns 0. The frame's words are checked as strictly as kage info checks them. */
int kage_golden_frame(kage_golden* core, int index);

/* The next token of that frame: TOKEN, END or FAILED. Then, as with words, kage_golden_finish(). */
int kage_golden_next(kage_golden* core);

/* --- The last token that was accepted ---------------------------------------------------------------------------- */

int kage_golden_token_kind(kage_golden* core);                 /* KAGE_KIND_... */
int kage_golden_token_index(kage_golden* core);                /* in its frame; the header is 0. -1 before it */
int kage_golden_token_words(kage_golden* core);                /* how many it has */
unsigned int kage_golden_token_word(kage_golden* core, int i); /* the i-th of them, 0 if there is none */

/* A field, KAGE_TOKEN_...; 0 if the token has none of that name. */
long long kage_golden_token_field(kage_golden* core, int field);

/* "OP [12, 40) z 123.5 dz -0.25 color 10,20,30 lit". */
const char* kage_golden_token_text(kage_golden* core);

/* --- The line at hand, after that token -------------------------------------------------------------------------- */

int kage_golden_width(kage_golden* core); /* of the frame; 0 when there is none */
int kage_golden_height(kage_golden* core);
int kage_golden_line(kage_golden* core);                /* lines that have ended */
int kage_golden_bias(kage_golden* core);                /* 0 .. 2^DSF_BITS - 1 */
unsigned int kage_golden_background(kage_golden* core); /* channel c in bits 8c .. 8c + 7 */

/* A field of pixel x, KAGE_PIXEL_..., or KAGE_PIXEL_ABSENT or KAGE_PIXEL_ANY. After an EOL the line is clear. */
int kage_golden_pixel(kage_golden* core, int x, int field);

/* The name of a pixel's field for messages: "z", "color[0]", "class", "dsf", "fsf", "count[0]". "" if there is none. */
const char* kage_golden_pixel_name(int field);

/* --- Lines out --------------------------------------------------------------------------------------------------- */

/* The line that left last: its number, -1 before the frame's first, and channel `channel` of its pixel x, -1 if there
 * is none. After an error all lines that had not ended leave at once, as background. */
int kage_golden_out_line(kage_golden* core);
int kage_golden_out(kage_golden* core, int x, int channel);

/* Every line as it leaves: CHANNELS bytes a pixel. `taker` must not call this core, nor leave but by returning; NULL:
 * no one. `user` is passed on. */
typedef void (*kage_golden_taker)(void* user, int y, const unsigned char* pixels, int bytes);
void kage_golden_on_line(kage_golden* core, kage_golden_taker taker, void* user);

/* --- How a frame ended ------------------------------------------------------------------------------------------- */

/* A field, KAGE_STATUS_..., of the frame that was finished last, or has just failed; -1 if there is no such field. */
long long kage_golden_status(kage_golden* core, int field);

/* "no error", or name, meaning and place: "ORDER: a token where its phase does not allow it: frame 0, line 3, ...". */
const char* kage_golden_status_text(kage_golden* core);

#ifdef __cplusplus
}
#endif
#endif
