// SPDX-License-Identifier: Apache-2.0
// Watches the resets of a board's clocks in simulation. good_i, of no clock, says when they may be released: each at
// least LEAST edges of its clock later. LEAST is reset_release's 16 clocks, two flip-flops that bring good_i across,
// and the reset's own. An edge at the very moment of good_i may count or not. A reset that is released earlier stops
// the simulation. So does one that is released before all have been asserted at once. good_i falls three clocks before
// the reset does: a reset that was due then is still released.
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
  // Whether all have been asserted at once since the first of them was.
  logic all_asserted = 1'b1;
  logic [CLOCKS-1:0] last = '0;
  always @(rst_ni) begin
    if (rst_ni == '0) all_asserted = 1'b1;
    else if (&last) all_asserted = 1'b0;
    last = rst_ni;
  end
  for (genvar i = 0; i < CLOCKS; i++) begin : gen_clock
    logic [2:0] fell = '0;
    initial edges[i] = 0;
    always @(posedge clk_i[i]) begin
      fell = {fell[1:0], !good_i};
      edges[i] = fell == '1 ? 0 : edges[i] + 1;
    end
    always @(posedge rst_ni[i]) begin
      if (edges[i] < LEAST)
        $fatal(1, "reset %0d is released after %0d clocks, at least %0d are due", i, edges[i], LEAST);
      if (!all_asserted) $fatal(1, "reset %0d is released, and not all clocks were in reset at once", i);
    end
  end

endmodule

`default_nettype wire
