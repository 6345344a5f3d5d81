// SPDX-License-Identifier: Apache-2.0
// kage_crc.svh with ports: both checks of the bytes that came since `start_i`.
`default_nettype none

module crc_bytes (
    input wire logic clk_i,

    input wire logic       start_i,
    input wire logic       valid_i,
    input wire logic [7:0] data_i,

    output logic [15:0] crc16_o,
    output logic [31:0] crc32_o,
    output logic        good_o
);
  `include "kage_crc.svh"

  logic [15:0] crc16_q;
  logic [31:0] crc32_q;
  assign crc16_o = ~crc16_q;
  assign crc32_o = ~crc32_q;
  assign good_o  = crc16_q == Crc16Good;
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      crc16_q <= '1;
      crc32_q <= '1;
    end else if (valid_i) begin
      crc16_q <= crc16_next(crc16_q, data_i);
      crc32_q <= crc32_next(crc32_q, data_i);
    end
  end

endmodule

`default_nettype wire
