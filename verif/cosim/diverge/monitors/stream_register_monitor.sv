// SPDX-License-Identifier: Apache-2.0
// stream_register from its ports alone: what was taken leaves, in order, and nothing else. One word fits.
`default_nettype none

module stream_register_monitor #(
    parameter int BITS = 8
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

  logic held_q, free;
  logic [BITS-1:0] word_q;
  assign free = !held_q || out_ready_i;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 1'b0;
    end else begin
      trace_module(PartStreamRegister, {510'd0, free, held_q}, {510'd0, in_ready_o, out_valid_o});
      if (held_q) trace_module(PartStreamRegister, folded(word_q), folded(out_data_o));
      if (free) held_q <= in_valid_i;
    end
    if (free) word_q <= in_data_i;
  end

endmodule

bind stream_register stream_register_monitor #(.BITS(BITS)) u_monitor (.*);

`default_nettype wire
