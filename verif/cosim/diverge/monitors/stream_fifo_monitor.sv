// SPDX-License-Identifier: Apache-2.0
// stream_fifo from its ports alone: what was taken leaves, in order, and nothing else. DEPTH words fit.
`default_nettype none

module stream_fifo_monitor #(
    parameter int BITS  = 8,
    parameter int DEPTH = 4
) (
    input wire logic            clk_i,
    input wire logic            rst_ni,
    input wire logic            in_valid_i,
    input wire logic            in_ready_o,
    input wire logic [BITS-1:0] in_data_i,
    input wire logic            out_valid_o,
    input wire logic            out_ready_i,
    input wire logic [BITS-1:0] out_data_o
);
  `include "kage_trace.svh"
  `include "kage_trace_word.svh"

  int held_q, at_q;
  logic [BITS-1:0] words[DEPTH];
  logic push, pop;
  assign push = in_valid_i && held_q != DEPTH;
  assign pop  = out_ready_i && held_q != 0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 0;
      at_q   <= 0;
    end else begin
      trace_module(PartStreamFifo, {510'd0, held_q != DEPTH, held_q != 0}, {510'd0, in_ready_o, out_valid_o});
      if (held_q != 0) trace_module(PartStreamFifo, folded(words[at_q]), folded(out_data_o));
      if (push) words[(at_q+held_q)%DEPTH] <= in_data_i;
      if (pop) at_q <= (at_q + 1) % DEPTH;
      held_q <= held_q + 32'(push) - 32'(pop);
    end
  end

endmodule

bind stream_fifo stream_fifo_monitor #(
    .BITS (BITS),
    .DEPTH(DEPTH)
) u_monitor (.*);

`default_nettype wire
