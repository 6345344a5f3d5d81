// SPDX-License-Identifier: Apache-2.0
// Ten to one in steps of two bits: the three words of a DVI link and its clock, for output registers of double data
// rate.
//
// Handshake: none. Input words_i changes with pix_clk_i and comes from flip-flops. Output pairs_o changes with
// bit_clk_i, which is five times as fast: bits 1..0 are of channel 0, 3..2 of channel 1, 5..4 of channel 2, 7..6 of the
// link's clock. The lower bit of a pair goes out first, at the rising edge; the output register is the board's. The
// link's clock is high for the first five bits of a word.
// Crossing: the one crossing in kage without an async_fifo. Both clocks come from one PLL, and each edge of pix_clk_i
// is one of bit_clk_i. A path from pix_clk_i to bit_clk_i must take less than a clock of bit_clk_i: tools/fpga holds it
// against that, other tools need both clocks constrained as related. A flip-flop that toggles with pix_clk_i is watched
// in bit_clk_i. Its change is seen one bit clock after the words changed, and the words are taken at the next, with
// three more before they change again. Nothing counts to five by itself, so no reset need bring the clocks in step, and
// a step that is lost is found again in the next pixel.
// Latency: from the edge of pix_clk_i after which words_i is valid 3 clocks of bit_clk_i to the first pair.
// Throughput: three words and their clock every five clocks of bit_clk_i.
// Cost: 36 flip-flops, 28 LUTs of four inputs.
`default_nettype none

module tmds_shifter (
    input wire logic        pix_clk_i,
    input wire logic        pix_rst_ni,
    input wire logic [29:0] words_i,

    input  wire logic       bit_clk_i,
    output logic      [7:0] pairs_o
);
  logic phase_q;
  always_ff @(posedge pix_clk_i) begin
    if (!pix_rst_ni) phase_q <= 1'b0;
    else phase_q <= !phase_q;
  end

  logic seen_q, before_q, load;
  logic [9:0] blue_q, green_q, red_q, clock_q;
  assign load    = seen_q != before_q;
  assign pairs_o = {clock_q[1:0], red_q[1:0], green_q[1:0], blue_q[1:0]};

  always_ff @(posedge bit_clk_i) begin
    seen_q   <= phase_q;
    before_q <= seen_q;
    blue_q   <= load ? words_i[9:0] : {2'b00, blue_q[9:2]};
    green_q  <= load ? words_i[19:10] : {2'b00, green_q[9:2]};
    red_q    <= load ? words_i[29:20] : {2'b00, red_q[9:2]};
    clock_q  <= load ? 10'b0000011111 : {2'b00, clock_q[9:2]};
  end

endmodule

`default_nettype wire
