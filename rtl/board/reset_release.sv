// SPDX-License-Identifier: Apache-2.0
// A clock's own reset: asserted while good_i, of any clock or none (a PLL's lock, a button), is low, and released by
// two flip-flops of this clock. A pulse of good_i shorter than a clock may be seen or not: where several clocks must be
// reset together, as async_fifo wants it, one of these in one clock drives good_i of all others.
// Reset is asserted for CLOCKS clocks of this clock at least, so that the resets of all clocks overlap: choose CLOCKS
// so that it is longer than three clocks of the slowest.
// Latency: 3 clocks from good_i's fall to rst_no's, 3 + CLOCKS from rise to rise. Throughput: a good_i that falls for a
//   clock asserts the reset for CLOCKS + 1.
// Cost: 3 flip-flops and a counter.
`default_nettype none
`include "kage_illegal.svh"

module reset_release #(
    parameter int CLOCKS = 16
) (
    input  wire logic clk_i,
    input  wire logic good_i,
    output logic      rst_no
);
  // The synchronizer may begin with anything, which shows for two clocks.
  if (CLOCKS < 3) begin : gen_bad_clocks
    `KAGE_ILLEGAL("CLOCKS must be at least 3")
  end

  localparam int Bits = $clog2(CLOCKS + 1);

  // An FPGA begins with these, so that the reset is asserted from power-up on.
  logic rst_n_q = 1'b0;
  logic [Bits-1:0] count_q = '0;
  logic good;
  synchronizer u_good (
      .clk_i,
      .rst_ni(1'b1),
      .in_i  (good_i),
      .out_o (good)
  );
  assign rst_no = rst_n_q;
  always_ff @(posedge clk_i) begin
    if (!good) count_q <= '0;
    else if (count_q != Bits'(CLOCKS)) count_q <= count_q + 1'b1;
    rst_n_q <= good && count_q == Bits'(CLOCKS);
  end

endmodule

`default_nettype wire
