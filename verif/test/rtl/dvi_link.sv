// SPDX-License-Identifier: Apache-2.0
// dvi_encoder and tmds_shifter as a board has them, for the tests.
`default_nettype none

module dvi_link (
    input wire logic        clk_i,
    input wire logic        rst_ni,
    input wire logic        active_i,
    input wire logic        hsync_i,
    input wire logic        vsync_i,
    input wire logic [23:0] rgb_i,

    input  wire logic       bit_clk_i,
    output logic      [7:0] pairs_o
);
  logic [29:0] words;
  dvi_encoder i_encoder (
      .clk_i,
      .rst_ni,
      .active_i,
      .hsync_i,
      .vsync_i,
      .rgb_i,
      .words_o(words)
  );
  tmds_shifter i_shifter (
      .pix_clk_i (clk_i),
      .pix_rst_ni(rst_ni),
      .words_i   (words),
      .bit_clk_i,
      .pairs_o
  );
endmodule

`default_nettype wire
