// SPDX-License-Identifier: Apache-2.0
// A register for a valid/ready stream that cuts the path of `valid` and of the data, and lets `ready` through. Where
// the path of `ready` has to be cut as well: skid_buffer.
//
// Handshake: valid/ready on both sides; valid never waits for ready; out_data_o is stable while out_valid_o waits.
//   in_ready_o depends on out_ready_i.
// Capacity: one word. Latency: 1 clock. Throughput: a word a clock.
// Cost: BITS + 1 flip-flops.
`default_nettype none

module stream_register #(
    parameter int BITS = 8
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic            in_valid_i,
    output logic                 in_ready_o,
    input  wire logic [BITS-1:0] in_data_i,

    output logic                 out_valid_o,
    input  wire logic            out_ready_i,
    output logic      [BITS-1:0] out_data_o
);
  logic valid_q;
  logic [BITS-1:0] data_q;

  assign in_ready_o  = !valid_q || out_ready_i;
  assign out_valid_o = valid_q;
  assign out_data_o  = data_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= 1'b0;
    else if (in_ready_o) valid_q <= in_valid_i;
    if (in_ready_o) data_q <= in_data_i;
  end

endmodule

`default_nettype wire
