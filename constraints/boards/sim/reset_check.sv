// SPDX-License-Identifier: Apache-2.0
// Watches the resets of a board's clocks in simulation: none may be released before each clock has had three edges in reset,
// or an async_fifo between two of them begins with one side's pointers and not the other's. A reset that is early stops the
// simulation with its number.
`default_nettype none

module reset_check #(
    parameter int CLOCKS = 4
) (
    input wire logic [CLOCKS-1:0] clk_i,
    input wire logic [CLOCKS-1:0] rst_ni
);
  int edges[CLOCKS];
  for (genvar i = 0; i < CLOCKS; i++) begin : gen_clock
    initial edges[i] = 0;
    always @(posedge clk_i[i]) if (!rst_ni[i] && edges[i] < 3) edges[i] = edges[i] + 1;
    always @(negedge rst_ni[i]) edges[i] = 0;
    always @(posedge rst_ni[i])
      for (int j = 0; j < CLOCKS; j++)
        if (edges[j] < 3)
          $fatal(1, "reset %0d is released when clock %0d has had %0d edges in reset", i, j, edges[j]);
  end

endmodule

`default_nettype wire
