// SPDX-License-Identifier: Apache-2.0
// The synchronizer of rtl/board as a proof has to see it: its first flip-flop takes each bit that has just changed as
// the old or the new one, as it likes. A proof reads this file in place of rtl/board/synchronizer.sv.
//
// A step of the solver is the time within which flip-flops are undecided. A bit that changed in the step before the
// clock's edge may be caught either way. One that changes in the edge's own step is caught as the old one: there is a
// step later in which the edge would have caught it either way.
`default_nettype none

module synchronizer #(
    parameter int BITS = 1
) (
    input  wire logic            clk_i,
    input  wire logic            rst_ni,
    input  wire logic [BITS-1:0] in_i,
    output logic      [BITS-1:0] out_o
);
  (* gclk *) logic step;
  (* anyseq *) logic [BITS-1:0] old;
  logic [BITS-1:0] before_q, meta_q, seen_q;
  always_ff @(posedge step) before_q <= in_i;

  assign out_o = seen_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      meta_q <= '0;
      seen_q <= '0;
    end else begin
      meta_q <= (before_q & old) | (in_i & ~old);
      seen_q <= meta_q;
    end
  end

endmodule

`default_nettype wire
