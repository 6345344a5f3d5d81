// SPDX-License-Identifier: Apache-2.0
// frame_control with the facts of its token found by token_facts, as token_reader finds them: what its test is about.
`default_nettype none

module judged_control #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int MAX_WIDTH   = 640,
    parameter int TOKEN_WORDS = 5
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from token_reader
    input  wire logic                      token_valid_i,
    output logic                           token_ready_o,
    input  wire logic [TOKEN_WORDS*32-1:0] token_i,
    input  wire logic [     FlagsBits-1:0] token_flags_i,
    output logic                           drop_o,
    input  wire logic                      dropping_i,

    // to the pixels
    output logic                        cmd_valid_o,
    input  wire logic                   cmd_ready_i,
    output logic      [CommandBits-1:0] cmd_o,
    input  wire logic                   loads_done_i,

    // to the way out: the lines in order
    output logic                     line_valid_o,
    input  wire logic                line_ready_i,
    output logic      [LineBits-1:0] line_o,

    // to the way out: entries of the light table
    input  wire logic                      table_free_i,
    output logic                           table_valid_o,
    output logic      [TableEntryBits-1:0] table_o,

    // to the units and the tree; the width is line_o's
    output logic      [TreeCallBits-1:0] tree_call_o,
    input  wire logic                    tree_frame_ready_i,
    output logic                         tree_seg_valid_o,
    input  wire logic                    tree_seg_ready_i,
    output logic      [   PieceBits-1:0] tree_piece_o,        // of FACE and SEG

    // to the registers
    output logic open_o,  // a frame's header has been taken and the frame has not ended
    output logic hungry_o,  // waits for a token or for TLAST
    output logic draining_o,  // input is being dropped after an error
    output logic painting_o,  // one clock: a TP waits while the RESOLVE or CmdOut before it becomes a command
    output logic frame_end_o,  // one clock
    output logic error_valid_o,  // one clock, with the next
    output logic [ErrorBits-1:0] error_o,
    output logic behind_valid_o,  // a unit has less of the frame than another; 1 clock late
    output logic [BehindBits-1:0] behind_o
);

  logic [FactsBits-1:0] facts;
  token_facts #(
      .MAX_WIDTH  (MAX_WIDTH),
      .TOKEN_WORDS(TOKEN_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_facts (
      .token_i,
      .facts_o(facts)
  );
  frame_control #(
      .TOKEN_WORDS(TOKEN_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_control (
      .token_facts_i(facts),
      .*
  );

endmodule

`default_nettype wire
