// SPDX-License-Identifier: Apache-2.0
// Sends bytes on a serial line: 8 data bits, lowest first, no parity, one stop bit (8N1).
//
// Handshake: valid/ready; ready_o depends on registers only. tx_o is a flip-flop, high in reset and between bytes.
// Timing: a phase accumulator counts bits, so CLOCK_HZ need not be a multiple of BAUD. The edge at the end of a
//   byte's first n bits comes less than a clock late. It is never early, but for the accumulator's rounding (1/4096
//   of a bit's length).
// Latency: 1 clock from a byte's taking to its start bit. Throughput: 10 bits a byte, rounded up to whole clocks.
// Cost: 24 LUT and 15 flip-flops of an iCE40 for 3 Mbaud at 12 MHz, 35 and 26 at 25 MHz, 39 and 30 for 115,200 baud
//   at 100 MHz.
`default_nettype none
`include "kage_illegal.svh"

module uart_transmitter #(
    parameter int CLOCK_HZ = 12000000,
    parameter int BAUD = 115200
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic       valid_i,
    output logic            ready_o,
    input  wire logic [7:0] data_i,

    output logic tx_o = 1'b1
);
  if (BAUD < 115200 || BAUD > 3000000) begin : gen_bad_baud
    `KAGE_ILLEGAL("BAUD must be of 115200 to 3000000")
  end
  if (CLOCK_HZ / 4 < BAUD) begin : gen_bad_clock
    `KAGE_ILLEGAL("CLOCK_HZ must be four clocks a bit at least")
  end

  // As in uart_receiver.
  localparam int PhaseBits = 12 + $clog2(CLOCK_HZ / BAUD);
  localparam logic [63:0] Clock = 64'(CLOCK_HZ);
  localparam logic [63:0] Share = ((64'(BAUD) << PhaseBits) + Clock / 2) / Clock;
  localparam logic [PhaseBits-1:0] Step = PhaseBits'(Share);

  // left_q: the bits of a byte that have not ended, the start bit's and the stop bit's among them; 0 between bytes. A
  // byte's bits leave bits_q at its low end, and ones come behind them: the stop bit.
  logic [3:0] left_q;
  logic [7:0] bits_q;
  logic [PhaseBits-1:0] phase_q;
  logic [PhaseBits:0] phase_sum;
  logic bit_over, take;
  assign phase_sum = {1'b0, phase_q} + {1'b0, Step};
  assign bit_over = phase_sum[PhaseBits];
  assign ready_o = left_q == 4'd0 || (left_q == 4'd1 && bit_over);
  assign take = valid_i && ready_o;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      left_q <= 4'd0;
      tx_o   <= 1'b1;
    end else if (take) begin
      left_q <= 4'd10;
      tx_o   <= 1'b0;
    end else if (left_q != 4'd0 && bit_over) begin
      left_q <= left_q - 4'd1;
      tx_o   <= bits_q[0];
    end
    if (take) begin
      phase_q <= '0;
      bits_q  <= data_i;
    end else begin
      phase_q <= phase_sum[PhaseBits-1:0];
      if (bit_over) bits_q <= {1'b1, bits_q[7:1]};
    end
  end

endmodule

`default_nettype wire
