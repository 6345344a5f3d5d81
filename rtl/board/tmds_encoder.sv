// SPDX-License-Identifier: Apache-2.0
// One channel of DVI 1.0: eight bits of colour, or two of control in blanking, become ten for the cable (TMDS).
//
// Handshake: none; a word a clock. word_o goes out bit 0 first.
// Colour: the word is the chain of exclusive-ors or its complement, whichever has fewer changes (bit 8 says which). It
// goes out as it is or inverted, so that as many ones as zeros have gone out (bit 9 says which). The running disparity,
// ones less zeros since blanking, is even and lies in -8 .. 8; in blanking it is 0 again.
// Control: one of four fixed words that no colour has.
// Latency: 2 clocks. Throughput: a word a clock.
// Cost: 26 flip-flops, 67 LUTs of four inputs.
`default_nettype none

module tmds_encoder (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic       active_i,
    input  wire logic [7:0] data_i,
    input  wire logic [1:0] control_i,
    output logic      [9:0] word_o
);
  function automatic logic [3:0] ones(input logic [7:0] bits);
    ones = '0;
    for (int i = 0; i < 8; i++) ones = ones + {3'b0, bits[i]};
  endfunction

  // ---- the first clock: fewer changes ----
  // Bit i of the chain is the exclusive or of bits 0 .. i; in the complement every odd bit is turned.
  function automatic logic [7:0] chain_of(input logic [7:0] bits);
    logic so_far;
    so_far = 1'b0;
    for (int i = 0; i < 8; i++) begin
      so_far = so_far ^ bits[i];
      chain_of[i] = so_far;
    end
  endfunction

  logic [3:0] data_ones;
  logic inverted;
  logic [8:0] chain;
  assign data_ones = ones(data_i);
  assign inverted  = data_ones > 4'd4 || (data_ones == 4'd4 && !data_i[0]);
  assign chain     = {!inverted, chain_of(data_i) ^ (inverted ? 8'b10101010 : 8'b0)};

  logic active_q;
  logic [1:0] control_q;
  logic [8:0] chain_q;
  always_ff @(posedge clk_i) begin
    active_q  <= active_i && rst_ni;
    control_q <= control_i;
    chain_q   <= chain;
  end

  // ---- the second: as many ones as zeros ----
  // The standard's numbers are all even, so halves are kept: more_q is half the disparity. Signal excess is half
  // the difference of ones and zeros in eight bits, which is their ones less 4.
  logic signed [3:0] more_q, more_d, excess, step;
  logic flip, even;
  assign excess = $signed(ones(chain_q[7:0]) - 4'd4);
  assign even   = more_q == 4'sd0 || excess == 4'sd0;
  assign flip   = even ? !chain_q[8] : more_q[3] == excess[3];
  // Bits 8 and 9 count too where they are like each other, which they never are where even is true.
  assign step   = flip == chain_q[8] ? (flip ? 4'sd1 : -4'sd1) : 4'sd0;
  assign more_d = (flip ? more_q - excess : more_q + excess) + step;

  logic [9:0] word_q;
  assign word_o = word_q;
  always_ff @(posedge clk_i) begin
    if (active_q) begin
      word_q <= {flip, chain_q[8], chain_q[7:0] ^ {8{flip}}};
      more_q <= more_d;
    end else begin
      word_q <= control_q[1] ? (control_q[0] ? 10'b1010101011 : 10'b0101010100)
                             : (control_q[0] ? 10'b0010101011 : 10'b1101010100);
      more_q <= '0;
    end
  end

endmodule

`default_nettype wire
