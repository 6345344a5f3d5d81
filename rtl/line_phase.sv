// SPDX-License-Identifier: Apache-2.0
// The phases of a line (docs/stream.md, "Order in a line") and its bias: whether a token may stand where it does.
// token_check asks about the token that comes in; nothing here waits.
//
// Question: kind_i. in_order_o, combinational. Tokens that belong to no line (kage_order.svh) always get 1.
// Acts: start_i, one clock, when a line begins, and then take_i does not count; take_i, one clock, when the token has
//   been taken, with IF's w_i and RESOLVE's samples_i. After one that was out of order nothing but start_i counts.
// State: bias_o, as the token finds it. EV and ES clear it, and so does the line's first TP: the line is painted for
//   it, with the bias that it finds. Output resolved_o: the line is behind its RESOLVE, and
//   no volume has come since. Output pass_o, with linear light: of the light of that RESOLVE {samples, or without
//   counters the bias that it found, pass}; passes count modulo 2.
// Latency: answer 0, state 1 clock. Throughput: a token a clock.
// Cost: DSF_BITS + 3 flip-flops; with counters one more; with linear light PassBits more.
`default_nettype none

module line_phase #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int BiasBits = DsfBits,  // the bias counts as DSF does
    localparam int SamplesBits = COUNT_BITS > 0 ? COUNT_BITS : 1
) (
    input wire logic clk_i,

    input  wire logic                   start_i,
    input  wire logic                   take_i,
    input  wire logic [   KindBits-1:0] kind_i,
    input  wire logic [   BiasBits-1:0] w_i,
    input  wire logic [SamplesBits-1:0] samples_i,
    output logic                        in_order_o,
    output logic                        resolved_o,
    output logic      [   PassBits-1:0] pass_o,
    output logic      [   BiasBits-1:0] bias_o
);
  `include "generated/kage_layout.svh"

  `include "generated/kage_order.svh"

  logic [PhaseBits-1:0] phase_q;
  logic [Marks-1:0] marks_q;
  logic [BiasBits-1:0] bias_q;

  logic [Phases-1:0] phases;  // in which the token may stand
  logic [Marks-1:0] with_marks, without_marks;
  assign phases = order_in(kind_i);
  assign with_marks = order_with(kind_i);
  assign without_marks = order_without(kind_i);
  assign in_order_o = phases[phase_q] && (marks_q & with_marks) == with_marks && (marks_q & without_marks) == '0;
  assign resolved_o = phase_q == PhaseResolved;
  assign bias_o = bias_q;

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      phase_q <= PhaseOpaque;
      marks_q <= '0;
      bias_q  <= '0;
    end else if (take_i) begin
      phase_q <= order_to(kind_i, phase_q);
      marks_q <= (marks_q & ~order_clears(kind_i)) | order_sets(kind_i);
      if (DSF_BITS > 0 && kind_i == KindIf) bias_q <= bias_q + w_i;
      if (FSF > 0 && kind_i == KindEv) bias_q <= '0;
      if (COUNT_BITS > 0 && kind_i == KindEs) bias_q <= '0;
      if (TRANSLUCENCY > 0 && kind_i == KindTp) bias_q <= '0;
      if (LINEAR_BITS > 0 && kind_i == KindResolve) bias_q <= '0;
    end
  end

  if (LINEAR_BITS > 0) begin : gen_pass
    logic [PassBits-1:0] pass_q;
    logic [PassRestBits-1:0] rest;
    assign pass_o = pass_q;
    if (COUNT_BITS > 0) begin : gen_samples
      assign rest = samples_i;
    end else begin : gen_bias
      logic unused_samples;
      assign unused_samples = ^samples_i;
      assign rest = bias_q;
    end
    always_ff @(posedge clk_i) begin
      if (start_i) pass_q <= '0;
      else if (take_i && kind_i == KindResolve) begin
        pass_q <= {rest, !pass_q[0]};
      end
    end
  end else begin : gen_no_pass
    logic unused_samples;
    assign unused_samples = ^samples_i;
    assign pass_o = '0;
  end

endmodule

`default_nettype wire
