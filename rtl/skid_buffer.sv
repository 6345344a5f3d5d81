// SPDX-License-Identifier: Apache-2.0
// A register for a valid/ready stream that cuts the path of `ready` as well as that of `valid`.
//
// Handshake: valid/ready on both sides; valid never waits for ready; out_data_o is stable while out_valid_o waits.
// Capacity: two words. Latency: 1 clock. Throughput: a word a clock. in_ready_o depends on registers only.
// Cost: 2 x BITS + 2 flip-flops.
`default_nettype none

module skid_buffer #(
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

  logic out_valid_q, spare_valid_q;
  logic [BITS-1:0] out_q, spare_q;
  logic out_free;

  assign in_ready_o = !spare_valid_q;
  assign out_valid_o = out_valid_q;
  assign out_data_o = out_q;
  assign out_free = !out_valid_q || out_ready_i;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      out_valid_q   <= 1'b0;
      spare_valid_q <= 1'b0;
    end else if (out_free) begin
      out_valid_q   <= spare_valid_q || in_valid_i;
      spare_valid_q <= 1'b0;
    end else if (in_valid_i && in_ready_o) begin
      spare_valid_q <= 1'b1;
    end
    if (out_free) out_q <= spare_valid_q ? spare_q : in_data_i;
    if (in_ready_o) spare_q <= in_data_i;
  end

endmodule

`default_nettype wire
