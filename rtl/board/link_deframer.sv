// SPDX-License-Identifier: Apache-2.0
// Takes the frames of docs/link.md out of a stream of bytes: flags, escapes, length and CRC-16.
//
// Handshake: a byte comes with in_valid_i, and is always taken. Output byte_valid_o marks a byte of a body, at place
//   byte_at_o, while that is less than 256. Output end_o marks the end of a body that is not empty. Both last one
//   clock and wait for nobody.
// The bytes of a body, its CRC's among them, come out before it is known whether they are right. At end_o, good_o says
//   so, and size_o is their number, 257 for more than 256. A good body has 4 to 256 bytes and the right CRC, and no
//   escape stood before the flag.
// Latency: 1 clock. Throughput: a byte a clock.
// Cost: 65 LUT and 46 flip-flops of an iCE40, the CRC of a byte among them.
`default_nettype none

module link_deframer (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic       in_valid_i,
    input wire logic [7:0] in_data_i,

    output logic       byte_valid_o,
    output logic [7:0] byte_o,
    output logic [7:0] byte_at_o,

    output logic       end_o,
    output logic       good_o,
    output logic [8:0] size_o
);
  `include "kage_link.svh"
  `include "kage_crc.svh"

  // size_q: bytes of the body so far, 257 at most. Whatever came before, a flag leaves the state of reset.
  logic [ 8:0] size_q;
  logic [15:0] crc_q;
  logic escaped_q, is_flag, is_escape;
  logic [7:0] plain;
  assign is_flag   = in_data_i == Flag;
  assign is_escape = in_data_i == Escape && !escaped_q;
  assign plain     = escaped_q ? in_data_i ^ 8'h20 : in_data_i;

  always_ff @(posedge clk_i) begin
    byte_valid_o <= 1'b0;
    end_o <= 1'b0;
    if (!rst_ni) begin
      size_q <= '0;
      crc_q <= '1;
      escaped_q <= 1'b0;
    end else if (in_valid_i) begin
      escaped_q <= is_escape;
      if (is_flag) begin
        size_q <= '0;
        crc_q  <= '1;
        end_o  <= size_q != '0 || escaped_q;
      end else if (!is_escape) begin
        if (size_q != 9'd257) size_q <= size_q + 9'd1;
        crc_q <= crc16_next(crc_q, plain);
        byte_valid_o <= !size_q[8];
      end
    end
    byte_o <= plain;
    byte_at_o <= size_q[7:0];
    size_o <= size_q;
    good_o <= crc_q == Crc16Good && size_q >= 9'd4 && size_q <= 9'd256 && !escaped_q;
  end

endmodule

`default_nettype wire
