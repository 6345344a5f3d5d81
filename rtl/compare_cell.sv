// SPDX-License-Identifier: Apache-2.0
// A cell of the compare tree: comparator, multiplexer and pipeline register, two pixels in, one out. [Ohno 1985]
//
// Result: the side with the lesser key, the upper KEY_BITS of the data; on equal keys the left one.
// Handshake: valid/ready on all sides. The pixels of both sides are taken in the same clock; left_ready_o and
//   right_ready_o depend on both valids and on out_ready_i. Output out_data_o is stable while out_valid_o waits. A
//   line ends (last) on both sides at once.
// Latency: 1 clock. Throughput: a pixel a clock. rst_ni low empties the cell.
// Cost: a comparator of KEY_BITS, a multiplexer and a register of DATA_BITS, 2 more flip-flops.
`default_nettype none

module compare_cell #(
    parameter int KEY_BITS  = 32,
    parameter int DATA_BITS = 57
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                 left_valid_i,
    output logic                      left_ready_o,
    input  wire logic [DATA_BITS-1:0] left_data_i,
    input  wire logic                 left_last_i,

    input  wire logic                 right_valid_i,
    output logic                      right_ready_o,
    input  wire logic [DATA_BITS-1:0] right_data_i,
    input  wire logic                 right_last_i,

    output logic                      out_valid_o,
    input  wire logic                 out_ready_i,
    output logic      [DATA_BITS-1:0] out_data_o,
    output logic                      out_last_o
);

  logic free, take, right_wins;
  assign free = !out_valid_o || out_ready_i;
  assign take = free && left_valid_i && right_valid_i;
  assign left_ready_o = take;
  assign right_ready_o = take;
  assign right_wins = right_data_i[DATA_BITS-1-:KEY_BITS] < left_data_i[DATA_BITS-1-:KEY_BITS];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) out_valid_o <= 1'b0;
    else if (free) out_valid_o <= take;
    if (free) begin
      out_data_o <= right_wins ? right_data_i : left_data_i;
      out_last_o <= left_last_i;
    end
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. Both sides have lines of the same width.
      assert (!take || left_last_i == right_last_i);
    end
  end
`else
  logic unused_last;
  assign unused_last = right_last_i;
`endif

endmodule

`default_nettype wire
