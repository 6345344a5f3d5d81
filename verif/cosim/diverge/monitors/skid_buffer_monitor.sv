// SPDX-License-Identifier: Apache-2.0
// skid_buffer from its ports alone: what was taken leaves, in order, and nothing else. Two words fit.
`default_nettype none

module skid_buffer_monitor #(
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

  logic [1:0] held_q;
  logic [BITS-1:0] first_q, second_q;
  logic push, pop;
  assign push = in_valid_i && held_q != 2'd2;
  assign pop  = out_ready_i && held_q != '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= '0;
    end else begin
      trace_module(PartSkidBuffer, {510'd0, held_q != 2'd2, held_q != '0}, {510'd0, in_ready_o, out_valid_o});
      if (held_q != '0) trace_module(PartSkidBuffer, folded(first_q), folded(out_data_o));
      held_q <= held_q + 2'(push) - 2'(pop);
      if (pop) first_q <= held_q == 2'd2 ? second_q : in_data_i;
      else if (push && held_q == '0) first_q <= in_data_i;
      if (push) second_q <= in_data_i;
    end
  end

endmodule

bind skid_buffer skid_buffer_monitor #(.BITS(BITS)) u_monitor (.*);

`default_nettype wire
