// SPDX-License-Identifier: Apache-2.0
// Watches the resets of a board's clocks in simulation. good_i, of no clock, says when they may be released: each LEAST
// edges of its clock later at least. Of reset_release's 16 clocks that is all, two flip-flops that bring good_i across,
// and the reset's own; an edge at the very moment of good_i may count or not. A reset that is released earlier stops
// the simulation.
`default_nettype none

module reset_check #(
    parameter int CLOCKS = 4,
    parameter int LEAST  = 19
) (
    input wire logic              good_i,
    input wire logic [CLOCKS-1:0] clk_i,
    input wire logic [CLOCKS-1:0] rst_ni
);
  int edges[CLOCKS];
  for (genvar i = 0; i < CLOCKS; i++) begin : gen_clock
    initial edges[i] = 0;
    always @(posedge clk_i[i]) edges[i] = good_i ? edges[i] + 1 : 0;
    always @(posedge rst_ni[i])
      if (edges[i] < LEAST)
        $fatal(1, "reset %0d is released after %0d clocks, at least %0d are due", i, edges[i], LEAST);
  end

endmodule

`default_nettype wire
