// SPDX-License-Identifier: Apache-2.0
// compare_cell from its ports alone: of each pair of pixels the one with the lesser key, on equal keys the left.
`default_nettype none

module compare_cell_monitor #(
    parameter int KEY_BITS  = 32,
    parameter int DATA_BITS = 57
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 left_valid_i,
    input wire logic                 left_ready_o,
    input wire logic [DATA_BITS-1:0] left_data_i,
    input wire logic                 left_last_i,
    input wire logic                 right_valid_i,
    input wire logic                 right_ready_o,
    input wire logic [DATA_BITS-1:0] right_data_i,
    input wire logic                 out_valid_o,
    input wire logic                 out_ready_i,
    input wire logic [DATA_BITS-1:0] out_data_o,
    input wire logic                 out_last_o
);
  `include "kage_trace.svh"

  logic held_q, last_q, take;
  logic [DATA_BITS-1:0] data_q;
  assign take = left_valid_i && right_valid_i && (!held_q || out_ready_i);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 1'b0;
    end else begin
      trace_module(PartCompareCell, {509'd0, take, take, held_q}, {509'd0, left_ready_o, right_ready_o, out_valid_o});
      if (held_q) trace_module(PartCompareCell, 512'({last_q, data_q}), 512'({out_last_o, out_data_o}));
      if (!held_q || out_ready_i) held_q <= take;
    end
    if (take) begin
      data_q <= left_data_i[DATA_BITS-1-:KEY_BITS] <= right_data_i[DATA_BITS-1-:KEY_BITS] ? left_data_i : right_data_i;
      last_q <= left_last_i;
    end
  end

endmodule

bind compare_cell compare_cell_monitor #(
    .KEY_BITS (KEY_BITS),
    .DATA_BITS(DATA_BITS)
) u_monitor (.*);

`default_nettype wire
