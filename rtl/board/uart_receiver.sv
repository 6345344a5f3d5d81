// SPDX-License-Identifier: Apache-2.0
// Bytes of a serial line: 8 data bits, lowest first, no parity, one stop bit (8N1).
//
// Handshake: valid_o is high for one clock with a byte, and nothing holds the byte back: whoever cannot take it loses
//   it. The line changes at any time; two flip-flops stand before its first use.
// Timing: a phase accumulator counts bits, so CLOCK_HZ need not be a multiple of BAUD. CLOCK_HZ must be at least 4 x
//   BAUD. A bit is read within one clock of its middle, counted from the start bit's edge, whatever the phase of the
//   line. Half a clock each way is for the moment at which the edge is seen, and half for the moment of reading. The
//   stop bit, read at 9.5 bits, ends 10 of the sender's bits behind the edge and begins 9 behind it. A sender's bits
//   may therefore differ by (0.5 - BAUD / CLOCK_HZ) / 10, less 0.03 % for the accumulator's rounding: 2.4 % at 4 clocks
//   a bit, 3.7 % at 8.33, 4.9 % at many.
// No byte: a low shorter than half a bit is ignored. After a stop bit that is low (framing_error_o, one clock) the byte
//   is dropped, and the line must be high before a start bit counts; a break is one framing error. After reset the line
//   must be high first, too.
// Latency: three clocks from the middle of the stop bit. Throughput: the line's; the next start bit may come nearly
//   half a bit early.
// Cost: 21 LUT and 20 flip-flops of an iCE40 for 3 Mbaud at 12 MHz, 32 and 32 at 25 MHz, 36 and 36 for 115,200 baud
//   at 100 MHz.
`default_nettype none
`include "kage_illegal.svh"

module uart_receiver #(
    parameter int CLOCK_HZ = 12000000,
    parameter int BAUD = 115200
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic rx_i,

    output logic       valid_o,
    output logic [7:0] data_o,
    output logic       framing_error_o
);
  if (BAUD < 115200 || BAUD > 3000000) begin : gen_bad_baud
    `KAGE_ILLEGAL("BAUD must be of 115200 to 3000000")
  end
  if (CLOCK_HZ / 4 < BAUD) begin : gen_bad_clock
    `KAGE_ILLEGAL("CLOCK_HZ must be four clocks a bit at least")
  end

  // The share of a bit that a clock is, as a fraction of PhaseBits bits, rounded: 2^11 at least, so within 1/4096.
  localparam int PhaseBits = 12 + $clog2(CLOCK_HZ / BAUD);
  localparam logic [63:0] Clock = 64'(CLOCK_HZ);
  localparam logic [63:0] Share = ((64'(BAUD) << PhaseBits) + Clock / 2) / Clock;
  localparam logic [PhaseBits-1:0] Step = PhaseBits'(Share);
  // The start bit's edge was half a clock ago on the average, and a bit ends half a clock early on the average: a
  // clock.
  localparam logic [PhaseBits-1:0] Begin = PhaseBits'((64'd1 << (PhaseBits - 1)) + Share);

  // rx_q[1] is the line; rx_q[0] may be undecided for a while.
  logic [1:0] rx_q;
  logic line;
  assign line = rx_q[1];

  // A byte is under way: bit_q is the bit that is waited for, 0 the start bit, 9 the stop bit. Where none is, armed_q
  // says that the line has been high, so that a low is a start bit.
  logic busy_q, armed_q, starting_q, bit_over;
  logic [3:0] bit_q;
  logic [PhaseBits-1:0] phase_q;
  logic [PhaseBits:0] phase_sum;
  assign phase_sum = {1'b0, phase_q} + {1'b0, Step};
  assign bit_over  = phase_sum[PhaseBits];

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      rx_q <= '0;
      busy_q <= 1'b0;
      armed_q <= 1'b0;
      valid_o <= 1'b0;
      framing_error_o <= 1'b0;
    end else begin
      rx_q <= {rx_q[0], rx_i};
      valid_o <= 1'b0;
      framing_error_o <= 1'b0;
      if (!busy_q) begin
        armed_q <= armed_q || line;
        busy_q  <= armed_q && !line;
      end else if (line && (bit_q == 4'd0 || starting_q)) begin
        // Half a bit takes one clock more than bit 0 lasts: a low that is seen shorter is no start bit.
        busy_q <= 1'b0;
      end else if (bit_over && bit_q == 4'd9) begin
        busy_q <= 1'b0;
        armed_q <= line;
        valid_o <= line;
        framing_error_o <= !line;
      end
    end
    starting_q <= busy_q && bit_q == 4'd0;
    if (!busy_q) begin
      bit_q   <= 4'd0;
      phase_q <= Begin;
    end else begin
      phase_q <= phase_sum[PhaseBits-1:0];
      if (bit_over) bit_q <= bit_q + 4'd1;
      if (bit_over && bit_q != 4'd9) data_o <= {line, data_o[7:1]};
    end
  end

endmodule

`default_nettype wire
