// SPDX-License-Identifier: Apache-2.0
// The tree's line in front of pixel_banked: a second line buffer, of what a pixel's state begins with: depth, colour
// and class. A TREE reads it group by group along with the state of the pixels.
//
// In: tree_* is valid/ready. A pixel comes in a clock, whether or not a TREE is near, until the line is in whole, with
//   `last` at its last pixel. The next line comes in right behind the pass that reads this one. Input drop_i forgets a
//   part of a line, and a pixel that is offered in the same clock.
// Out: here_o says that the line is in whole, so a pass may begin, by a clock of pass_i. A pass reads its groups in
//   order and without stops: rd_en_i asks for group rd_group_i, group 0 Levels + 1 clocks after pass_i. Each lane's
//   depth, colour and class are at z_o, color_o and class_o 2 clocks after rd_en_i.
// Latency: a line is here in the clock after its last pixel. Throughput: a pixel a clock in, a group a clock out.
// Hazards: the pass reads its group g Levels + 1 + g clocks after pass_i. The next line's first pixel may come in the
//   clock in which group 0 is read. Its group g, even if it ends there with one pixel, is written 2 + g clocks later at
//   the earliest, so the pass is ahead of it all the way. Until then full_q speaks of the old line.
// Cost: a RAM of ceil(MAX_WIDTH / LANES) words of LANES pixels, two registers of a word.
// Needs UNITS > 0: a core without units leaves it out.
`default_nettype none

module tree_line #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 4,
    parameter int MAX_WIDTH = 640,
    localparam int Groups = (MAX_WIDTH + LANES - 1) / LANES,
    localparam int AddrBits = Groups > 1 ? $clog2(Groups) : 1
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                     tree_valid_i,
    output logic                          tree_ready_o,
    input  wire logic [TreePixelBits-1:0] tree_i,
    input  wire logic                     drop_i,

    output logic                               here_o,
    input  wire logic                          pass_i,
    input  wire logic                          rd_en_i,
    input  wire logic [          AddrBits-1:0] rd_group_i,
    output logic      [      LANES*Z_BITS-1:0] z_o,
    output logic      [LANES*PixelRgbBits-1:0] color_o,
    output logic      [  LANES*CLASS_BITS-1:0] class_o,

    output logic moving_o  // a pixel comes in
);
  `include "generated/kage_buses.svh"

  localparam int Levels = $clog2(LANES);
  localparam int OffBits = LANES > 1 ? Levels : 1;
  localparam int PaintBits = Z_BITS + PixelRgbBits + ClassBits;  // of PixelBits

  tree_pixel_t tree;
  assign tree = tree_i;

  // The group's pixels gather in a register, which is written when it is complete.
  logic full_q, in_take, in_lane_end, in_write_q;
  logic [Levels:0] passes_q, passes;  // bit k: a pass of TREE began k clocks ago; q: k + 1
  logic [OffBits-1:0] in_lane_q;
  logic [AddrBits-1:0] in_group_q, in_addr_q;
  logic [PaintBits-1:0] in_pixel;
  logic [LANES*PaintBits-1:0] in_word_q, tree_word, tree_q;
  logic unused_class;
  assign unused_class = ^tree.normal_class;  // without shadows
  always_comb begin
    in_pixel = '0;
    in_pixel[PixelZAt+:Z_BITS] = tree.z;
    in_pixel[PixelColorAt+:PixelRgbBits] = tree.color;
    if (ClassBits > 0) in_pixel[PixelClassAt+:CLASS_BITS] = tree.normal_class;
  end
  assign tree_ready_o = !full_q;
  assign in_take = tree_valid_i && tree_ready_o && !drop_i;
  assign in_lane_end = in_lane_q == OffBits'(LANES - 1) || tree.last;
  assign moving_o = in_take;
  assign passes = (Levels + 1)'({passes_q, pass_i});
  assign here_o = full_q && passes_q == '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      full_q <= 1'b0;
      passes_q <= '0;
      in_write_q <= 1'b0;
      in_lane_q <= '0;
      in_group_q <= '0;
    end else begin
      passes_q   <= passes;
      in_write_q <= in_take && in_lane_end;
      if (in_take && tree.last) full_q <= 1'b1;
      else if (passes[Levels]) full_q <= 1'b0;
      if (drop_i || (in_take && tree.last)) begin
        in_lane_q  <= '0;
        in_group_q <= '0;
      end else if (in_take) begin
        in_lane_q <= in_lane_end ? '0 : in_lane_q + 1'b1;
        if (in_lane_end) in_group_q <= in_group_q + 1'b1;
      end
    end
    in_addr_q <= in_group_q;
    for (int l = 0; l < LANES; l++) begin
      if (in_take && in_lane_q == OffBits'(l)) in_word_q[l*PaintBits+:PaintBits] <= in_pixel;
    end
  end

  ram_1r1w #(
      .BITS (LANES * PaintBits),
      .WORDS(Groups)
  ) u_line (
      .clk_i,
      .wr_en_i  (in_write_q),
      .wr_addr_i(in_addr_q),
      .wr_data_i(in_word_q),
      .rd_en_i,
      .rd_addr_i(rd_group_i),
      .rd_data_o(tree_word)
  );
  always_ff @(posedge clk_i) tree_q <= tree_word;

  always_comb begin
    class_o = '0;
    for (int l = 0; l < LANES; l++) begin
      z_o[l*Z_BITS+:Z_BITS] = tree_q[l*PaintBits+PixelZAt+:Z_BITS];
      color_o[l*PixelRgbBits+:PixelRgbBits] = tree_q[l*PaintBits+PixelColorAt+:PixelRgbBits];
      if (ClassBits > 0) class_o[l*CLASS_BITS+:CLASS_BITS] = tree_q[l*PaintBits+PixelClassAt+:CLASS_BITS];
    end
  end

endmodule

`default_nettype wire
