// SPDX-License-Identifier: Apache-2.0
// A word for each line that the core draws, beside its m_axis: the CRC-32 by which a host, or the board alone, tells a
// right line from a wrong one (docs/vectors.md: signatures.hex).
//
// Takes: a pixel that moves, beat_i. It is listened to and never held up.
// Signature: CRC-32 as zlib has it, over the pixels of the line from the left; each gives its channels, channel 0
//   first, and then a byte 2 TUSER + TLAST.
// A line's place is its number since clear_i, and begins anew behind wrap_i lines (0: never, not even where 16 bits no
//   longer count them). Lines whose place is LINES or more are counted, and neither kept nor compared. A pixel that
//   moves in the clock of clear_i belongs to no line.
// check_i 0: signatures are kept in the RAM. 1: they are compared with what the RAM has at their place.
// Host's port: a read's word comes a clock after its address. The host writes while nothing is drawn, or with check_i,
//   when lines that are drawn read; then its own reads give nothing of use.
// Latency: a line is counted and kept three clocks after its last pixel, compared four. Throughput: a pixel a clock,
//   lines of one pixel too.
// Cost: LINES words of block RAM, about 150 flip-flops, and a 32-bit CRC of four bytes, or two, in a clock.
`default_nettype none
`include "kage_illegal.svh"

module line_signature #(
    parameter int CHANNELS = 3,
    parameter int LINES = 512,
    localparam int PlaceBits = $clog2(LINES)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic                  beat_i,
    input wire logic [CHANNELS*8-1:0] data_i,
    input wire logic                  user_i,
    input wire logic                  last_i,

    input wire logic        clear_i,
    input wire logic        check_i,
    input wire logic [15:0] wrap_i,

    output logic [15:0] lines_o,          // lines since clear_i, modulo 65536
    output logic [15:0] mismatches_o,     // lines that differed, at most 65535
    output logic [15:0] mismatch_place_o, // of the first of them

    input  wire logic                 host_wr_en_i,
    input  wire logic [PlaceBits-1:0] host_addr_i,
    input  wire logic [         31:0] host_wr_data_i,
    output logic      [         31:0] host_rd_data_o
);
  `include "kage_crc.svh"

  if (CHANNELS != 1 && CHANNELS != 3) begin : gen_bad_channels
    `KAGE_ILLEGAL("CHANNELS is 1 or 3")
  end
  if (LINES < 2 || LINES > 32768) begin : gen_bad_lines
    `KAGE_ILLEGAL("LINES must lie in 2 .. 32768")
  end

  // ---- the line at hand --------------------------------------------------------------------------------------------
  // The pixel is registered first: the CRC of four bytes is a path of its own.
  logic beat_q, user_q, last_q;
  logic [CHANNELS*8-1:0] data_q;
  logic [31:0] crc_q, crc;
  function automatic logic [31:0] with_pixel(input logic [31:0] start, input logic [CHANNELS*8+7:0] bytes);
    begin
      with_pixel = start;
      for (int b = 0; b <= CHANNELS; b++) with_pixel = crc32_next(with_pixel, bytes[b*8+:8]);
    end
  endfunction
  assign crc = with_pixel(crc_q, {6'b0, user_q, last_q, data_q});

  // ---- its end -----------------------------------------------------------------------------------------------------
  logic ended_q, compared_q, differs_q, kept_q, place_there;
  logic [31:0] signature_q, wanted_q, expected;
  logic [15:0] place_q, ended_place_q, compared_place_q, differing_place_q;
  logic [15:0] next_place;
  // All places behind the last one are alike: were 65535 followed by 0, a line there would be one that has no place.
  assign next_place  = place_q == '1 ? place_q : place_q + 16'd1;
  assign place_there = ended_place_q < 16'(LINES);

  always_ff @(posedge clk_i) begin
    data_q            <= data_i;
    user_q            <= user_i;
    last_q            <= last_i;
    signature_q       <= ~crc;
    ended_place_q     <= place_q;
    wanted_q          <= signature_q;
    compared_place_q  <= ended_place_q;
    differing_place_q <= compared_place_q;
    if (!rst_ni || clear_i) begin
      beat_q           <= 1'b0;
      crc_q            <= '1;
      ended_q          <= 1'b0;
      compared_q       <= 1'b0;
      differs_q        <= 1'b0;
      kept_q           <= 1'b0;
      place_q          <= '0;
      lines_o          <= '0;
      mismatches_o     <= '0;
      mismatch_place_o <= '0;
    end else begin
      beat_q  <= beat_i;
      ended_q <= beat_q && last_q;
      kept_q  <= ended_q;
      if (beat_q) crc_q <= last_q ? '1 : crc;
      if (beat_q && last_q) place_q <= next_place == wrap_i ? '0 : next_place;
      if (kept_q) lines_o <= lines_o + 16'd1;
      compared_q <= ended_q && check_i && place_there;
      // The RAM's output comes late in its clock. The comparison takes the rest of it; counting has a clock of its own.
      differs_q  <= compared_q && expected != wanted_q;
      if (differs_q) begin
        if (mismatches_o == '0) mismatch_place_o <= differing_place_q;
        if (mismatches_o != '1) mismatches_o <= mismatches_o + 16'd1;
      end
    end
  end

  // ---- the RAM: one port writes, the other reads, for the lines or for the host ------------------------------------
  logic keep, look;
  assign keep = ended_q && !check_i && place_there;
  assign look = check_i && ended_q;
  ram_1r1w #(
      .BITS (32),
      .WORDS(LINES)
  ) u_ram (
      .clk_i,
      .wr_en_i  (keep || host_wr_en_i),
      .wr_addr_i(keep ? ended_place_q[PlaceBits-1:0] : host_addr_i),
      .wr_data_i(keep ? signature_q : host_wr_data_i),
      .rd_en_i  (1'b1),
      .rd_addr_i(look ? ended_place_q[PlaceBits-1:0] : host_addr_i),
      .rd_data_o(expected)
  );
  assign host_rd_data_o = expected;

endmodule

`default_nettype wire
