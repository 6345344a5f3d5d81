// SPDX-License-Identifier: Apache-2.0
// ram_1r1w from its ports alone: a read gives what was written there last. Words never written, and reads of the word
// that is being written, are anybody's.
`default_nettype none

module ram_1r1w_monitor #(
    parameter int BITS = 8,
    parameter int WORDS = 256,
    parameter int ADDR_BITS = 8
) (
    input wire logic                 clk_i,
    input wire logic                 wr_en_i,
    input wire logic [ADDR_BITS-1:0] wr_addr_i,
    input wire logic [     BITS-1:0] wr_data_i,
    input wire logic                 rd_en_i,
    input wire logic [ADDR_BITS-1:0] rd_addr_i,
    input wire logic [     BITS-1:0] rd_data_o
);
  `include "kage_trace.svh"

  logic [BITS-1:0] words[WORDS];
  bit [WORDS-1:0] written;
  bit known_q;
  logic [BITS-1:0] expected_q;

  localparam int Pieces = (BITS + 511) / 512;
  logic [Pieces*512-1:0] expected, actual;
  assign expected = (Pieces * 512)'(expected_q);
  assign actual   = (Pieces * 512)'(rd_data_o);

  always_ff @(posedge clk_i) begin
    if (wr_en_i) begin
      words[wr_addr_i]   <= wr_data_i;
      written[wr_addr_i] <= 1'b1;
    end
    if (rd_en_i) begin
      expected_q <= words[rd_addr_i];
      known_q <= written[rd_addr_i] && !(wr_en_i && wr_addr_i == rd_addr_i);
    end
    if (known_q && rd_data_o != expected_q) begin
      for (int i = 0; i < Pieces; i++) trace_module(PartRam1r1w, expected[i*512+:512], actual[i*512+:512]);
    end
  end

endmodule

bind ram_1r1w ram_1r1w_monitor #(
    .BITS(BITS),
    .WORDS(WORDS),
    .ADDR_BITS(AddrBits)
) u_monitor (.*);

`default_nettype wire
