// SPDX-License-Identifier: Apache-2.0
// kage on an ULX3S (Lattice ECP5): frames from the 32 MB SDRAM, picture by DVI on the GPDI socket, host by the FTDI's
// UART. README.md beside this file says how it is loaded and what the LEDs mean.
//
// Clocks: 25 MHz from the crystal, for the UART too; of it the PLL makes the bit clock of the DVI link, a fifth of it
//   for the pixels, the core's and the memory's. The bit clock and the pixels' are one family (tmds_shifter); all
//   others cross by async_fifo. As the parameters stand: 640x480 at 59.5 Hz. The row ulx3s_85f of boards.yaml makes it
//   1280x720 at 30.3 Hz.
// Reset: until the PLL has locked, and while button PWR (BTN0, low when pressed) is pressed. A pulse of any length
//   resets either all clocks or none: one flip-flop of the crystal's clock decides, and its reset is longer than three
//   clocks of each of the others.
// SDRAM: its clock is the memory's turned round, so that the chip takes commands in the middle of their clock. Read
//   data are taken at the memory's falling edge. At 75 MHz they are valid there from 2.3 ns before to 7.5 ns after that
//   edge. This counts 3 ns for the clock's way out, 6 for the chip (t_AC; t_OH 2.5), 2 for the way in. READ_RISING
//   1 takes them at the rising edge behind it, 6.7 ns later: for pads whose ways take 1 to 8 ns more than these 5. Chip
//   and flip-flops have one clock, so the phase of the PLL's output moves both, and no margin. A greater MEM_DIV widens
//   it. All pins but clock, data enable and constants have their flip-flop in the pad, so no placement changes their
//   delays.
`default_nettype none

module ulx3s #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_impl_params.svh",
    parameter logic [31:0] BOARD_NAME = "ULX3",
    parameter int BAUD = 3_000_000,
    // The PLL: the bit clock is 25 MHz / REF_DIV x FB_DIV, and 25 MHz / REF_DIV must be at least 10 MHz. The oscillator
    // runs BIT_DIV times as fast, at 400 to 800 MHz, and every clock is a part of it.
    parameter int REF_DIV = 1,
    parameter int FB_DIV = 5,
    parameter int BIT_DIV = 6,
    parameter int CORE_DIV = 12,
    parameter int MEM_DIV = 10,
    parameter int READ_RISING = 0,
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
    input  wire logic       clk_25mhz,
    input  wire logic [6:0] btn,
    output logic      [7:0] led,

    input  wire logic ftdi_txd,  // from the host
    output logic      ftdi_rxd,  // to the host

    output logic [3:0] gpdi_dp,  // blue, green, red, clock; the pads make the other half of each pair

    output logic        sdram_clk,
    output logic        sdram_cke,
    output logic        sdram_csn,
    output logic        sdram_rasn,
    output logic        sdram_casn,
    output logic        sdram_wen,
    output logic [ 1:0] sdram_ba,
    output logic [12:0] sdram_a,
    output logic [ 1:0] sdram_dqm,
    inout  wire  [15:0] sdram_d,

    output logic wifi_gpio0  // high: the ESP32 on the board leaves the FPGA alone
);
  assign wifi_gpio0 = 1'b1;

  // ---- clocks and resets -------------------------------------------------------------------------------------------
  localparam int VcoHz = 25_000_000 * FB_DIV / REF_DIV * BIT_DIV;
  logic bit_clk, pix_clk, clk, mem_clk, locked;
  // The analogue settings are ecppll's. Where they are left out nextpnr takes 0: no current in the charge pump.
  (* FREQUENCY_PIN_CLKI = "25", ICP_CURRENT = "12", LPF_RESISTOR = "8" *)
  (* MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
      .CLKI_DIV       (REF_DIV),
      .CLKFB_DIV      (FB_DIV),
      .FEEDBK_PATH    ("CLKOP"),
      .CLKOP_ENABLE   ("ENABLED"),
      .CLKOP_DIV      (BIT_DIV),
      .CLKOP_CPHASE   (BIT_DIV - 1),
      .CLKOP_FPHASE   (0),
      .CLKOS_ENABLE   ("ENABLED"),
      .CLKOS_DIV      (5 * BIT_DIV),
      .CLKOS_CPHASE   (5 * BIT_DIV - 1),
      .CLKOS_FPHASE   (0),
      .CLKOS2_ENABLE  ("ENABLED"),
      .CLKOS2_DIV     (CORE_DIV),
      .CLKOS2_CPHASE  (CORE_DIV - 1),
      .CLKOS2_FPHASE  (0),
      .CLKOS3_ENABLE  ("ENABLED"),
      .CLKOS3_DIV     (MEM_DIV),
      .CLKOS3_CPHASE  (MEM_DIV - 1),
      .CLKOS3_FPHASE  (0),
      .OUTDIVIDER_MUXA("DIVA"),
      .OUTDIVIDER_MUXB("DIVB"),
      .OUTDIVIDER_MUXC("DIVC"),
      .OUTDIVIDER_MUXD("DIVD")
  ) u_pll (
      .RST         (1'b0),
      .STDBY       (1'b0),
      .CLKI        (clk_25mhz),
      .CLKFB       (bit_clk),
      .CLKOP       (bit_clk),
      .CLKOS       (pix_clk),
      .CLKOS2      (clk),
      .CLKOS3      (mem_clk),
      .PHASESEL0   (1'b0),
      .PHASESEL1   (1'b0),
      .PHASEDIR    (1'b1),
      .PHASESTEP   (1'b1),
      .PHASELOADREG(1'b1),
      .PLLWAKESYNC (1'b0),
      .ENCLKOP     (1'b0),
      .LOCK        (locked)
  );

  // 16 clocks of the slowest clock, 640 ns, which all others see. Their own 16 clocks follow: 213 ns at 75 MHz, which
  // is five of the slowest.
  logic good, rst_n, uart_rst_n, mem_rst_n, pix_rst_n;
  reset_release u_good (
      .clk_i (clk_25mhz),
      .good_i(locked && btn[0]),
      .rst_no(good)
  );
  reset_release u_core_reset (
      .clk_i (clk),
      .good_i(good),
      .rst_no(rst_n)
  );
  reset_release u_uart_reset (
      .clk_i (clk_25mhz),
      .good_i(good),
      .rst_no(uart_rst_n)
  );
  reset_release u_mem_reset (
      .clk_i (mem_clk),
      .good_i(good),
      .rst_no(mem_rst_n)
  );
  reset_release u_pix_reset (
      .clk_i (pix_clk),
      .good_i(good),
      .rst_no(pix_rst_n)
  );

  // ---- the board's core --------------------------------------------------------------------------------------------
  logic active, hsync, vsync;
  logic [23:0] rgb;
  logic [35:0] mem_out, mem_out_q;
  logic [15:0] dq_in, dq_in_q;
  logic dq_oe, dq_oe_q;
  board_core #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh",
      .BOARD_NAME (BOARD_NAME),
      .UART_HZ    (25_000_000),
      .BAUD       (BAUD),
      .MEMORY     (1),
      .SDRAM_HZ   (VcoHz / MEM_DIV),
      .CAS_LATENCY(2),
      .READ_DELAY (3 + READ_RISING),  // the clock is turned round; a register out and one in
      .T_INIT     (T_INIT),
      .LINES      (LINES),
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
      .clk_i        (clk),
      .rst_ni       (rst_n),
      .uart_clk_i   (clk_25mhz),
      .uart_rst_ni  (uart_rst_n),
      .rx_i         (ftdi_txd),
      .tx_o         (ftdi_rxd),
      .mem_clk_i    (mem_clk),
      .mem_rst_ni   (mem_rst_n),
      .sdram_cke_o  (sdram_cke),
      .sdram_cs_no  (sdram_csn),
      .sdram_ras_no (mem_out[0]),
      .sdram_cas_no (mem_out[1]),
      .sdram_we_no  (mem_out[2]),
      .sdram_ba_o   (mem_out[4:3]),
      .sdram_a_o    (mem_out[17:5]),
      .sdram_dqm_o  (mem_out[19:18]),
      .sdram_dq_o   (mem_out[35:20]),
      .sdram_dq_oe_o(dq_oe),
      .sdram_dq_i   (dq_in_q),
      .pix_clk_i    (pix_clk),
      .pix_rst_ni   (pix_rst_n),
      .active_o     (active),
      .hsync_o      (hsync),
      .vsync_o      (vsync),
      .rgb_o        (rgb),
      .led_o        (led)
  );

  // ---- pads --------------------------------------------------------------------------------------------------------
  for (genvar i = 0; i < 36; i++) begin : gen_out
    // The three bits of the command are high, which is none, from configuration to the reset's end.
    (* syn_useioff, ioff_dir = "output" *)
    TRELLIS_FF #(
        .GSR   ("DISABLED"),
        .CEMUX ("CE"),
        .CLKMUX("CLK"),
        .LSRMUX("LSR"),
        .SRMODE("ASYNC"),
        .REGSET("SET")
    ) u_ff (
        .CLK(mem_clk),
        .LSR(1'b0),
        .CE (1'b1),
        .DI (mem_out[i] || (i < 3 && !mem_rst_n)),
        .Q  (mem_out_q[i])
    );
  end
  assign {sdram_dqm, sdram_a, sdram_ba, sdram_wen, sdram_casn, sdram_rasn} = mem_out_q[19:0];
  always_ff @(posedge mem_clk) dq_oe_q <= dq_oe;
  for (genvar i = 0; i < 16; i++) begin : gen_dq
    BB u_pad (
        .I(mem_out_q[20+i]),
        .T(!dq_oe_q),
        .O(dq_in[i]),
        .B(sdram_d[i])
    );
    (* syn_useioff, ioff_dir = "input" *)
    TRELLIS_FF #(
        .GSR   ("DISABLED"),
        .CEMUX ("CE"),
        .CLKMUX(READ_RISING > 0 ? "CLK" : "INV"),
        .LSRMUX("LSR"),
        .SRMODE("ASYNC"),
        .REGSET("RESET")
    ) u_ff (
        .CLK(mem_clk),
        .LSR(1'b0),
        .CE (1'b1),
        .DI (dq_in[i]),
        .Q  (dq_in_q[i])
    );
  end
  ODDRX1F u_sdram_clk (
      .D0  (1'b0),
      .D1  (1'b1),
      .SCLK(mem_clk),
      .RST (1'b0),
      .Q   (sdram_clk)
  );

  logic [29:0] words;
  logic [ 7:0] pairs;
  dvi_encoder u_dvi (
      .clk_i   (pix_clk),
      .rst_ni  (pix_rst_n),
      .active_i(active),
      .hsync_i (hsync),
      .vsync_i (vsync),
      .rgb_i   (rgb),
      .words_o (words)
  );
  tmds_shifter u_shifter (
      .pix_clk_i (pix_clk),
      .pix_rst_ni(pix_rst_n),
      .words_i   (words),
      .bit_clk_i (bit_clk),
      .pairs_o   (pairs)
  );
  for (genvar i = 0; i < 4; i++) begin : gen_gpdi
    ODDRX1F u_pad (
        .D0  (pairs[2*i]),
        .D1  (pairs[2*i+1]),
        .SCLK(bit_clk),
        .RST (1'b0),
        .Q   (gpdi_dp[i])
    );
  end

  logic unused;
  assign unused = &{1'b0, btn[6:1]};

endmodule

`default_nettype wire
