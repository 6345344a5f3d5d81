// SPDX-License-Identifier: Apache-2.0
// The command that frame_control gives the pixels, made of the token at hand, and the register that holds it until they
// take it.
//
// Handshake: free_o says that a command may be made: in a clock in which it is high, at most one of make_*_i may be,
//   and that command is in cmd_* from the next clock on, which is valid/ready. Token, width, share, bias and background
//   are those of that clock.
// Commands: make_span_i, of the token, which has a range; make_tree_i, make_eol_i, make_paint_i and make_out_i, over
//   the whole line: TREE, EOL, RESOLVE with the background as its colour, and CmdOut.
// Latency: 1 clock. Throughput: a command a clock.
// Cost: a register of a command, the choice among the places of fields.
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
    input wire logic [       RgbBits-1:0] background_i,

    output logic      free_o,
    input  wire logic make_span_i,
    input  wire logic make_tree_i,
    input  wire logic make_eol_i,
    input  wire logic make_paint_i,
    input  wire logic make_out_i,

    output logic                        cmd_valid_o,
    input  wire logic                   cmd_ready_i,
    output logic      [CommandBits-1:0] cmd_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  logic [3:0] kind;
  logic is_tp, whole, unused_token;
  assign unused_token = ^token_i;  // a header, and other tokens, may be longer
  assign kind = token_i[3:0];
  assign is_tp = TRANSLUCENCY > 0 && kind == KindTp;
  assign whole = make_eol_i || make_tree_i || make_paint_i || make_out_i;
  assign free_o = !cmd_valid_o || cmd_ready_i;

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
      KindOp:  count = CountBits'(token_i[OpClassLsb+:CLASS_BITS]);
      KindEv:  count = CountBits'(bias_i);
      KindEs:  count = LIGHTS > 1 ? CountBits'(token_i[EsLightLsb+:LightBits]) << LightAt : '0;
      default: count = CountBits'(token_i[SpWLsb+:DsfBits]);  // at the same place in NC
    endcase
    if (kind == KindEs && FSF == 0) count[DsfBits-1:0] = bias_i;
    if (make_eol_i || make_paint_i) count = CountBits'(bias_i);
    if (DSF_BITS == 0) count = '0;
  end

  command_t cmd_q;
  assign cmd_o = cmd_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) cmd_valid_o <= 1'b0;
    else if (free_o) cmd_valid_o <= make_span_i || whole;
    if (free_o) begin
      cmd_q.kind <= make_eol_i ? KindEol : make_paint_i ? KindResolve : make_out_i ? CmdOut : kind;
      cmd_q.xl <= whole ? '0 : token_i[OpXlLsb+:X_BITS];  // at the same place in all tokens with a range
      cmd_q.xr <= whole ? width_i : token_i[OpXrLsb+:X_BITS];
      cmd_q.z <= token_i[OpZLsb+:DepthBits];
      cmd_q.dz <= token_i[OpDzLsb+:DepthBits];
      cmd_q.color <= token_i[OpColorLsb+:ColorBits];
      cmd_q.dcolor <= SMOOTH > 0 ? token_i[OpDcolorLsb+:SlopeBits] : '0;
      cmd_q.share <= is_tp && !make_paint_i ? tp_share : share_i;
      cmd_q.count <= count;
      if (DSF_BITS > 0 && kind == KindSp) begin
        cmd_q.z  <= token_i[SpZLsb+:DepthBits];
        cmd_q.dz <= token_i[SpDzLsb+:DepthBits];
      end
      if (is_tp) begin
        cmd_q.z <= tp_z;
        cmd_q.dz <= tp_dz;
        cmd_q.color <= tp_color;
        cmd_q.dcolor <= tp_dcolor;
      end
      if (make_paint_i) begin
        cmd_q.color  <= background;
        cmd_q.dcolor <= '0;
      end
    end
  end

endmodule

`default_nettype wire
