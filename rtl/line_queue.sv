// SPDX-License-Identifier: Apache-2.0
// The lines between frame_control and line_out, in their order. Under way are one in its pass through the pixels, one
// that waits for a buffer of line_out, and two in those buffers.
//
// Handshake: in_* and out_* are valid/ready. The queue's free place is written each clock, so an EOL's verdict does not
//   reach a write enable; the buffer behind it gives line_out a line from flip-flops.
// Capacity: four lines. Latency: 2 clocks. Throughput: a line a clock.
// Cost: a stream_fifo of two and a skid_buffer, LineBits wide.
`default_nettype none

module line_queue #(
    parameter int BITS = 8
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic            in_valid_i,
    output logic                 in_ready_o,
    input  wire logic [BITS-1:0] in_data_i,

    output logic                 out_valid_o,
    input  wire logic            out_ready_i,
    output logic      [BITS-1:0] out_data_o,

    output logic moving_o  // a line goes from the queue to the buffer
);

  logic told_valid, told_ready;
  logic [BITS-1:0] told;
  assign moving_o = told_valid && told_ready;
  stream_fifo #(
      .BITS (BITS),
      .DEPTH(2)
  ) u_lines (
      .clk_i,
      .rst_ni,
      .in_valid_i,
      .in_ready_o,
      .in_data_i,
      .out_valid_o(told_valid),
      .out_ready_i(told_ready),
      .out_data_o (told)
  );
  skid_buffer #(
      .BITS(BITS)
  ) u_next (
      .clk_i,
      .rst_ni,
      .in_valid_i(told_valid),
      .in_ready_o(told_ready),
      .in_data_i (told),
      .out_valid_o,
      .out_ready_i,
      .out_data_o
  );

endmodule

`default_nettype wire
