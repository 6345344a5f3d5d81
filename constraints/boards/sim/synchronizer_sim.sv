// SPDX-License-Identifier: Apache-2.0
// rtl/board/synchronizer.sv as hardware has it: its first flip-flop takes a bit that changed less than WINDOW
// picoseconds ago as the old or the new one, each bit by itself and at random. A simulation of a board reads this file
// in its place, so that what crosses without Gray code, or by no synchronizer, comes to grief as it does on a bench.
`default_nettype none

module synchronizer #(
    parameter int BITS   = 1,
    parameter int WINDOW = 3000
) (
    input  wire logic            clk_i,
    input  wire logic            rst_ni,
    input  wire logic [BITS-1:0] in_i,
    output logic      [BITS-1:0] out_o
);
  logic [BITS-1:0] late, meta_q, seen_q, chosen;
  always @(in_i) late <= #(WINDOW) in_i;

  assign out_o = seen_q;
  always @(posedge clk_i) begin
    chosen = BITS'($urandom);
    if (!rst_ni) begin
      meta_q <= '0;
      seen_q <= '0;
    end else begin
      meta_q <= (late & chosen) | (in_i & ~chosen);
      seen_q <= meta_q;
    end
  end

endmodule

`default_nettype wire
