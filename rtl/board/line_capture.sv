// SPDX-License-Identifier: Apache-2.0
// Keeps the pixels of one line that the core draws, beside its m_axis: a host reads them when the line's signature was
// not the expected one, to see which pixel and channel it is.
//
// Takes: a pixel that moves, beat_i. It is listened to and never held up. line_i chooses the line, by its number since
//   clear_i, modulo 65536. A line with more than PIXELS pixels keeps its first ones; all are counted, to 65535. More
//   lines than 65536 make the chosen one come again, which counts as more pixels of it. A pixel that moves in the
//   clock of clear_i belongs to no line.
// Host's port: a read's word comes a clock after its address: colour in the lowest bits, TLAST in bit 24, TUSER in bit
//   25.
// Latency: a pixel is counted a clock after it moved, and there two. Throughput: a pixel a clock.
// Cost: PIXELS words of 26 bits of block RAM (10 with one channel), two counters and a comparator of 16 bits.
`default_nettype none
`include "kage_illegal.svh"

module line_capture #(
    parameter  int CHANNELS = 3,
    parameter  int PIXELS   = 640,
    localparam int AddrBits = $clog2(PIXELS)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic                  beat_i,
    input wire logic [CHANNELS*8-1:0] data_i,
    input wire logic                  user_i,
    input wire logic                  last_i,

    input  wire logic        clear_i,
    input  wire logic [15:0] line_i,
    output logic      [15:0] pixels_o, // of the line, so far

    input  wire logic [AddrBits-1:0] host_addr_i,
    output logic      [        31:0] host_rd_data_o
);
  if (CHANNELS != 1 && CHANNELS != 3) begin : gen_bad_channels
    `KAGE_ILLEGAL("CHANNELS is 1 or 3")
  end
  if (PIXELS < 2 || PIXELS > 32768) begin : gen_bad_pixels
    `KAGE_ILLEGAL("PIXELS must lie in 2 .. 32768")
  end

  localparam int Bits = CHANNELS * 8 + 2;

  logic [15:0] number_q;
  logic chosen_q, beat_q;
  logic [Bits-1:0] pixel_q, captured;

  always_ff @(posedge clk_i) begin
    pixel_q <= {user_i, last_i, data_i};
    if (!rst_ni || clear_i) begin
      beat_q   <= 1'b0;
      chosen_q <= line_i == '0;
      number_q <= '0;
      pixels_o <= '0;
    end else begin
      beat_q <= beat_i;
      // The comparison has a clock of its own.
      if (beat_i && last_i) number_q <= number_q + 16'd1;
      chosen_q <= number_q == line_i;
      if (beat_q && chosen_q && pixels_o != '1) pixels_o <= pixels_o + 16'd1;
    end
  end

  ram_1r1w #(
      .BITS (Bits),
      .WORDS(PIXELS)
  ) u_ram (
      .clk_i,
      .wr_en_i  (beat_q && chosen_q && pixels_o < 16'(PIXELS)),
      .wr_addr_i(pixels_o[AddrBits-1:0]),
      .wr_data_i(pixel_q),
      .rd_en_i  (1'b1),
      .rd_addr_i(host_addr_i),
      .rd_data_o(captured)
  );
  assign host_rd_data_o = {6'b0, captured[Bits-1-:2], 24'(captured[CHANNELS*8-1:0])};

endmodule

`default_nettype wire
