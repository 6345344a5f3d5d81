// SPDX-License-Identifier: Apache-2.0
// plane_at from its ports alone: the plane's value by a product, rounded.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module plane_at_monitor #(
    parameter int BITS  = 50,
    parameter int SHIFT = 13,
    parameter int FRAC  = 11,
    parameter int FIELD = 37
) (
    input wire logic             clk_i,
    input wire logic [ BITS-1:0] value_i,
    input wire logic [ BITS-1:0] right_i,
    input wire logic [ BITS-1:0] down_i,
    input wire logic [     16:0] xl_i,
    input wire logic             single_i,
    input wire logic [FIELD-1:0] start_o,
    input wire logic [FIELD-1:0] step_o
);
  `include "kage_trace.svh"

  localparam int Delay = 4;
  localparam longint Half = SHIFT > 0 ? 64'd1 << (SHIFT - 1) : 0;  // rounds to nearest, halves up
  localparam longint HalfLsb = FRAC > 0 ? 64'd1 << (SHIFT + FRAC - 1) : 0;  // half of a whole step of depth
  longint at, start, step;
  assign at = 64'(value_i) + 64'(down_i) + 64'(right_i) * 64'($signed(xl_i));
  assign start = at + Half + HalfLsb;
  assign step = single_i ? 0 : 64'(right_i) + Half;
  logic [2*Delay*FIELD-1:0] fields_q;
  int clocks_q = 0;  // since the start: what leaves has come in

  always_ff @(posedge clk_i) begin
    fields_q <= (2 * Delay * FIELD)'({fields_q, start[SHIFT+:FIELD], step[SHIFT+:FIELD]});
    if (clocks_q <= Delay) clocks_q <= clocks_q + 1;
    if (clocks_q > Delay)
      trace_module(PartPlaneAt, 512'(fields_q[2*(Delay-1)*FIELD+:2*FIELD]), 512'({start_o, step_o}));
  end

endmodule

bind plane_at plane_at_monitor #(
    .BITS (BITS),
    .SHIFT(SHIFT),
    .FRAC (FRAC),
    .FIELD(FIELD)
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
