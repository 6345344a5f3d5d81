// SPDX-License-Identifier: Apache-2.0
// The ULX3S as a whole, for simulation: its top, and the SDRAM at its pins with the delays of pads and chip. Crystal,
// host and screen are outside, in verif/board/sim.
//
// dq_late  the chip's data, which reach the FPGA's flip-flop LATE_PS picoseconds after the clock left it. The default
// is
//          3 ns for the clock's way out, 6 for the chip (t_AC), 2 for the way in.
// wires_o  wires of the DVI socket, from bit 0 on: blue, green, red and the clock
// bits_o, periods_o  bits_o bits go over the DVI link in periods_o periods of the crystal, by the PLL's parameters. The
//                    model's screen samples the wires by them.
`default_nettype none

module board_sim #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_impl_params.svh",
    parameter int BAUD = 3_000_000,
    parameter int REF_DIV = 1,
    parameter int FB_DIV = 5,
    parameter int BIT_DIV = 6,
    parameter int CORE_DIV = 12,
    parameter int MEM_DIV = 10,
    parameter int READ_RISING = 0,
    parameter int LATE_PS = 11_000,
    parameter int LINES = 2048,
    parameter int T_INIT = 200_000,
    parameter int H_ACTIVE = 640,
    parameter int H_FRONT = 16,
    parameter int H_SYNC = 96,
    parameter int H_BACK = 48,
    parameter int V_ACTIVE = 480,
    parameter int V_FRONT = 10,
    parameter int V_SYNC = 2,
    parameter int V_BACK = 33,
    parameter int H_POSITIVE = 0,
    parameter int V_POSITIVE = 0,
    parameter int LED_BITS = 22
) (
    input  wire logic       clk_i,
    input  wire logic       button_ni,
    input  wire logic       rx_i,
    output logic            tx_o,
    output logic      [7:0] led_o,
    output logic      [7:0] wires_o,

    output logic [7:0] bits_o,
    output logic [7:0] periods_o
);
  localparam int MemHz = 25_000_000 * FB_DIV / REF_DIV * BIT_DIV / MEM_DIV;
  assign wires_o[7:4] = '0;
  assign bits_o    = 8'(2 * FB_DIV);  // two in a clock
  assign periods_o = 8'(REF_DIV);

  logic sdram_clk, cke, csn, rasn, casn, wen, wifi;
  logic [1:0] ba, dqm;
  logic [12:0] a;
  wire  [15:0] d;
  logic [15:0] dq, dq_late;
  logic dq_oe, dq_oe_late;
  ulx3s #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh",
      .BAUD       (BAUD),
      .REF_DIV    (REF_DIV),
      .FB_DIV     (FB_DIV),
      .BIT_DIV    (BIT_DIV),
      .CORE_DIV   (CORE_DIV),
      .MEM_DIV    (MEM_DIV),
      .READ_RISING(READ_RISING),
      .LINES      (LINES),
      .T_INIT     (T_INIT),
      .H_ACTIVE   (H_ACTIVE),
      .H_FRONT    (H_FRONT),
      .H_SYNC     (H_SYNC),
      .H_BACK     (H_BACK),
      .V_ACTIVE   (V_ACTIVE),
      .V_FRONT    (V_FRONT),
      .V_SYNC     (V_SYNC),
      .V_BACK     (V_BACK),
      .H_POSITIVE (H_POSITIVE),
      .V_POSITIVE (V_POSITIVE),
      .LED_BITS   (LED_BITS)
  ) u_board (
      .clk_25mhz (clk_i),
      .btn       ({6'b0, button_ni}),
      .led       (led_o),
      .ftdi_txd  (rx_i),
      .ftdi_rxd  (tx_o),
      .gpdi_dp   (wires_o[3:0]),
      .sdram_clk (sdram_clk),
      .sdram_cke (cke),
      .sdram_csn (csn),
      .sdram_rasn(rasn),
      .sdram_casn(casn),
      .sdram_wen (wen),
      .sdram_ba  (ba),
      .sdram_a   (a),
      .sdram_dqm (dqm),
      .sdram_d   (d),
      .wifi_gpio0(wifi)
  );

  assign d = dq_oe_late ? dq_late : 'z;
  always @(dq) dq_late <= #(LATE_PS) dq;
  always @(dq_oe) dq_oe_late <= #(LATE_PS) dq_oe;

  // The chip has its supply from its first clock on, and knows nothing before.
  logic power_q = 1'b0;
  always_ff @(posedge sdram_clk) power_q <= 1'b1;
  logic [31:0] lost;
  sdram_chip #(
      .INIT     (T_INIT / 1000 * (MemHz / 1_000_000)),
      .RETENTION(MemHz / 1000 * 64),
      .REFI     (MemHz / 128_000),
      .RCD      (2),
      .RP       (2),
      .RAS      (4),
      .RC       (5),
      .RFC      (6),
      .RRD      (2),
      .WR       (2),
      .MRD      (2),
      .RAS_MAX  (MemHz / 10_000)
  ) u_chip (
      .power_i    (power_q),
      .clk_i      (sdram_clk),
      .cke_i      (cke),
      .cs_ni      (csn),
      .ras_ni     (rasn),
      .cas_ni     (casn),
      .we_ni      (wen),
      .ba_i       (ba),
      .a_i        (a),
      .dqm_i      (dqm),
      .dq_driven_i(u_board.dq_oe_q),
      .dq_i       (d),
      .dq_o       (dq),
      .dq_oe_o    (dq_oe),
      .lost_o     (lost)
  );
  always @(posedge sdram_clk) if (lost != '0) $fatal(1, "the SDRAM: a row lost its charge before it was refreshed");

  // In this order: UART, core, memory, pixels.
  reset_check u_resets (
      .good_i(u_board.good),
      .clk_i ({u_board.pix_clk, u_board.mem_clk, u_board.clk, clk_i}),
      .rst_ni({u_board.pix_rst_n, u_board.mem_rst_n, u_board.rst_n, u_board.uart_rst_n})
  );

  logic unused;
  assign unused = &{1'b0, wifi};

endmodule

`default_nettype wire
