// SPDX-License-Identifier: Apache-2.0
// The command that frame_control gives the pixels, made of the token at hand, and the buffer that holds it until they
// take it.
//
// Handshake: free_o says that a command may be made, and depends on registers only. In a clock in which it is high,
//   make_i may be high: from the next clock on the command is in cmd_*, which is valid/ready. Token, width, share, bias
//   and background are those of that clock.
// Commands: of the token, which has a range; CmdLight in place of an OP if lit_i is high. Or, by the first of eol_i,
//   paint_i, out_i, tree_i that is high, over the whole line: EOL, RESOLVE with the background as its colour, CmdOut,
//   TREE. They say what it would be, whether or not it is made, so that the many bits of a command do not wait for
//   make_i.
// Latency: 1 clock. Throughput: a command a clock.
// Cost: a stream_fifo of two commands, the choice among the places of fields.
`default_nettype none

module token_command #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int TOKEN_WORDS = 5
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic [TOKEN_WORDS*32-1:0] token_i,
    input wire logic [        X_BITS-1:0] width_i,
    input wire logic [     ShareBits-1:0] share_i,      // what RESOLVE takes
    input wire logic [       DsfBits-1:0] bias_i,
    input wire logic                      lit_i,        // the token is an OP behind a RESOLVE of linear light,
    input wire logic [      PassBits-1:0] pass_i,       // which brings this
    input wire logic [       RgbBits-1:0] background_i,

    output logic      free_o,
    input  wire logic make_i,
    input  wire logic eol_i,
    input  wire logic paint_i,
    input  wire logic out_i,
    input  wire logic tree_i,

    output logic                        cmd_valid_o,
    input  wire logic                   cmd_ready_i,
    output logic      [CommandBits-1:0] cmd_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  logic [KindBits-1:0] kind;
  logic is_tp, whole, unused_token;
  assign unused_token = ^token_i;  // a header, and other tokens, may be longer
  assign kind = token_i[KindBits-1:0];
  assign is_tp = TRANSLUCENCY > 0 && kind == KindTp;
  assign whole = eol_i || paint_i || out_i || tree_i;

  // The background's colour as a span has it.
  logic [ColorBits-1:0] background;
  always_comb begin
    for (int c = 0; c < CHANNELS; c++) begin
      background[c*RampBits+:RampBits] = RampBits'(background_i[c*8+:8]) << COLOR_FRAC;
    end
  end

  // TP's fields lie beyond the longest token of a core without it.
  logic [DepthBits-1:0] tp_z, tp_dz;
  logic [ColorBits-1:0] tp_color;
  logic [SlopeBits-1:0] tp_dcolor;
  logic [ShareBits-1:0] tp_share;
  if (TRANSLUCENCY > 0) begin : gen_tp
    assign tp_z = token_i[TpZLsb+:DepthBits];
    assign tp_dz = token_i[TpDzLsb+:DepthBits];
    assign tp_color = token_i[TpColorLsb+:ColorBits];
    assign tp_dcolor = SMOOTH > 0 ? token_i[TpDcolorLsb+:SlopeBits] : '0;
    assign tp_share = ShareBits'(token_i[TpAlphaLsb+:8]);
  end else begin : gen_no_tp
    assign {tp_z, tp_dz, tp_color, tp_dcolor, tp_share} = '0;
  end

  logic [CountBits-1:0] count;
  always_comb begin
    unique case (kind)
      KindOp:  count = LINEAR_BITS > 0 ? CountBits'(pass_i) : CountBits'(token_i[OpClassLsb+:CLASS_BITS]);
      KindEv:  count = CountBits'(bias_i);
      KindEs:  count = LIGHTS > 1 ? CountBits'(token_i[EsLightLsb+:LightBits]) << LightAt : '0;
      default: count = CountBits'(token_i[WeightLsb+:DsfBits]);
    endcase
    if (kind == KindEs && FSF == 0) count[DsfBits-1:0] = bias_i;
    if (eol_i || paint_i) count = CountBits'(bias_i);
    if (DSF_BITS == 0) count = '0;
  end

  command_t cmd;
  always_comb begin
    cmd.kind = eol_i ? KindEol : paint_i ? KindResolve : out_i ? CmdOut : lit_i ? CmdLight : kind;
    cmd.xl = whole ? '0 : token_i[RangeXlLsb+:X_BITS];
    cmd.xr = whole ? width_i : token_i[RangeXrLsb+:X_BITS];
    cmd.z = token_i[OpZLsb+:DepthBits];
    cmd.dz = token_i[OpDzLsb+:DepthBits];
    cmd.color = token_i[OpColorLsb+:ColorBits];
    cmd.dcolor = SMOOTH > 0 ? token_i[OpDcolorLsb+:SlopeBits] : '0;
    cmd.share = is_tp && !paint_i ? tp_share : share_i;
    cmd.count = count;
    if (DSF_BITS > 0 && kind == KindSp) begin
      cmd.z  = token_i[SpZLsb+:DepthBits];
      cmd.dz = token_i[SpDzLsb+:DepthBits];
    end
    if (is_tp) begin
      cmd.z = tp_z;
      cmd.dz = tp_dz;
      cmd.color = tp_color;
      cmd.dcolor = tp_dcolor;
    end
    if (paint_i) begin
      cmd.color  = background;
      cmd.dcolor = '0;
    end
  end

  // So free_o, and with it what takes tokens, does not depend on what the pixels take in this clock; and what they take
  // moves two pointers, not the bits of a command.
  stream_fifo #(
      .BITS (CommandBits),
      .DEPTH(2)
  ) u_buffer (
      .clk_i,
      .rst_ni,
      .in_valid_i (make_i),
      .in_ready_o (free_o),
      .in_data_i  (cmd),
      .out_valid_o(cmd_valid_o),
      .out_ready_i(cmd_ready_i),
      .out_data_o (cmd_o)
  );

endmodule

`default_nettype wire
