// SPDX-License-Identifier: Apache-2.0
// The phases of a line (docs/stream.md, "Order in a line") and its bias: whether a token may stand where it does. frame_control asks about the
// token it has and acts on the answer; nothing here waits.
//
// Question: kind_i. in_order_o, combinational, for OP, SP, NC, IF, EV, ES, RESOLVE, TP and EOL; 1 for all others, which are not of a line.
// Acts: start_i, one clock, when a line begins; take_i, one clock, when the token was good and has been taken, with IF's w_i; clear_bias_i.
// State: bias_o, as the token finds it; resolved_o: a RESOLVE was the line's last token.
// Latency: answer 0, state 1 clock. Throughput: a token a clock.
// Cost: DSF_BITS + 4 flip-flops; with counters one more.
`default_nettype none

module line_phase #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int KindBits = 4
) (
    input wire logic clk_i,

    input  wire logic                start_i,
    input  wire logic                take_i,
    input  wire logic                clear_bias_i,
    input  wire logic [KindBits-1:0] kind_i,
    input  wire logic [ DsfBits-1:0] w_i,
    output logic                     in_order_o,
    output logic                     resolved_o,
    output logic      [ DsfBits-1:0] bias_o
);
  `include "generated/kage_layout.svh"

  localparam logic [1:0] PhaseOpaque = 2'd0;
  localparam logic [1:0] PhaseVolume = 2'd1;
  localparam logic [1:0] PhaseResolved = 2'd2;
  localparam logic [1:0] PhaseTranslucent = 2'd3;

  logic [1:0] phase_q;
  logic volume_open_q;  // an SP, NC or IF came after the last EV
  logic sample_open_q;  // an SP, NC or IF came after the last ES
  logic [DsfBits-1:0] bias_q;

  logic in_volume, volume_done, sample_done;
  assign in_volume = phase_q == PhaseVolume;
  assign volume_done = FSF == 0 || !volume_open_q;
  assign sample_done = COUNT_BITS == 0 || !sample_open_q;
  assign resolved_o = phase_q == PhaseResolved;
  assign bias_o = bias_q;
  always_comb begin
    unique case (kind_i)
      KindOp: in_order_o = phase_q == PhaseOpaque;
      KindSp, KindNc, KindIf: in_order_o = phase_q == PhaseOpaque || in_volume;
      KindEv: in_order_o = in_volume && volume_open_q;
      KindEs: in_order_o = in_volume && volume_done && !sample_done;
      KindResolve: in_order_o = in_volume && volume_done && sample_done;
      KindTp, KindEol: in_order_o = !in_volume;
      default: in_order_o = 1'b1;
    endcase
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      phase_q <= PhaseOpaque;
      volume_open_q <= 1'b0;
      sample_open_q <= 1'b0;
      bias_q <= '0;
    end else begin
      if (clear_bias_i) bias_q <= '0;
      if (take_i && TRANSLUCENCY > 0 && kind_i == KindTp) phase_q <= PhaseTranslucent;
      if (take_i && DSF_BITS > 0) begin
        if (kind_i == KindSp || kind_i == KindNc || kind_i == KindIf) begin
          phase_q <= PhaseVolume;
          volume_open_q <= 1'b1;
          sample_open_q <= COUNT_BITS > 0;
        end
        if (kind_i == KindIf) bias_q <= bias_q + w_i;
        if (kind_i == KindResolve) phase_q <= PhaseResolved;
        if (FSF > 0 && kind_i == KindEv) begin
          volume_open_q <= 1'b0;
          bias_q <= '0;
        end
        if (COUNT_BITS > 0 && kind_i == KindEs) begin
          sample_open_q <= 1'b0;
          bias_q <= '0;
        end
      end
    end
  end

endmodule

`default_nettype wire
