// SPDX-License-Identifier: Apache-2.0
// The CRC-32 of a run of words, as zlib has it of their bytes, the lowest first: by it a host knows that what reached
// the memory, or the core, is what it sent.
//
// Takes a word in each clock in which word_i is high. clear_i begins anew: no word counts that came up to its clock.
// Latency: 2 clocks from a word to crc_o. Throughput: a word a clock.
// Cost: 65 flip-flops and a 32-bit CRC of four bytes in a clock.
`default_nettype none

module crc32_words (
    input  wire logic        clk_i,
    input  wire logic        rst_ni,
    input  wire logic        clear_i,
    input  wire logic        word_i,
    input  wire logic [31:0] data_i,
    output logic      [31:0] crc_o
);
  `include "kage_crc.svh"

  logic word_q;
  logic [31:0] data_q, crc_q, crc;
  assign crc_o = ~crc_q;
  assign crc   = crc32_word(crc_q, data_q);
  always_ff @(posedge clk_i) begin
    data_q <= data_i;
    if (!rst_ni || clear_i) begin
      word_q <= 1'b0;
      crc_q  <= '1;
    end else begin
      word_q <= word_i;
      if (word_q) crc_q <= crc;
    end
  end

endmodule

`default_nettype wire
