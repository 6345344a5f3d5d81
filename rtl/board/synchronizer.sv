// SPDX-License-Identifier: Apache-2.0
// Two flip-flops that bring bits of another clock into this one. async_fifo uses it for its pointers; nothing else of
// kage may cross.
//
// The first flip-flop may see a bit while the bit changes, and then be undecided for a while; it has a clock to decide
// for the old or the new value. Each bit decides for itself, so of several bits at most one may change at a time.
// Latency: two clocks, or three for a bit that changed just before a clock. Throughput: BITS bits a clock.
// Cost: 2 BITS flip-flops.
`default_nettype none

module synchronizer #(
    parameter int BITS = 1
) (
    input  wire logic            clk_i,
    input  wire logic            rst_ni,
    input  wire logic [BITS-1:0] in_i,    // of another clock
    output logic      [BITS-1:0] out_o
);
  // In AMD's, Intel's and yosys' words: keep both, near each other, as flip-flops of their own.
  (* async_reg = "true", altera_attribute = "-name SYNCHRONIZER_IDENTIFICATION FORCED", keep *)
  logic [BITS-1:0] meta_q, seen_q;
  assign out_o = seen_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      meta_q <= '0;
      seen_q <= '0;
    end else begin
      meta_q <= in_i;
      seen_q <= meta_q;
    end
  end

endmodule

`default_nettype wire
