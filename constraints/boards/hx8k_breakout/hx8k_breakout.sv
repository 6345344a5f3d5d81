// SPDX-License-Identifier: Apache-2.0
// kage on Lattice's iCE40-HX8K breakout board: frames from block RAM, or straight from the host, whose line is the
// FTDI's UART; picture by VGA, through resistors on a header. README.md beside this file says how it is loaded and
// wired.
//
// Clocks: 12 MHz from the crystal, for the UART too. A PLL makes the core's, 12 MHz x (CORE_DIVF + 1) / 2^CORE_DIVQ.
//   With a screen, another makes the pixels', 12 x 67 / 32 = 25.125 MHz. They cross by async_fifo.
// Reset: until the PLLs have locked. The board has no button.
// VGA: two bits a colour, the highest of each channel; black outside of the picture. A core of one channel is grey.
`default_nettype none

module hx8k_breakout #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_impl_params.svh",
    parameter logic [31:0] BOARD_NAME = "HX8K",
    parameter int BAUD = 3_000_000,
    parameter int CORE_DIVF = 63,
    parameter int CORE_DIVQ = 4,
    parameter int MEMORY_WORDS = 2048,
    parameter int LINES = 256,
    parameter int CAPTURE = 1,
    parameter int SCREEN = 1,
    parameter int PIX_DIVF = 66,
    parameter int PIX_DIVQ = 5,
    parameter int H_ACTIVE = 640,
    parameter int H_FRONT = 16,
    parameter int H_SYNC = 96,
    parameter int H_BACK = 48,
    parameter int V_ACTIVE = 480,
    parameter int V_FRONT = 10,
    parameter int V_SYNC = 2,
    parameter int V_BACK = 33,
    parameter int LED_BITS = 21
) (
    input  wire logic       clk_12mhz,
    output logic      [7:0] led,

    input  wire logic rx,  // from the host
    output logic      tx,  // to the host

    output logic       vga_hsync,
    output logic       vga_vsync,
    output logic [1:0] vga_red,
    output logic [1:0] vga_green,
    output logic [1:0] vga_blue
);
  // ---- clocks and resets -------------------------------------------------------------------------------------------
  // The crystal's clock goes by a global net, whose delay is the same everywhere. By other wires a clock reaches some
  // flip-flops later than the data of others, which nextpnr does not see.
  logic crystal_clk, clk, pix_clk, core_locked, pix_locked;
  SB_GB u_crystal_clk (
      .USER_SIGNAL_TO_GLOBAL_BUFFER(clk_12mhz),
      .GLOBAL_BUFFER_OUTPUT        (crystal_clk)
  );
  SB_PLL40_CORE #(
      .FEEDBACK_PATH("SIMPLE"),
      .DIVR         (4'd0),
      .DIVF         (7'(CORE_DIVF)),
      .DIVQ         (3'(CORE_DIVQ)),
      .FILTER_RANGE (3'd1)
  ) u_core_pll (
      .REFERENCECLK(clk_12mhz),
      .PLLOUTGLOBAL(clk),
      .LOCK        (core_locked),
      .RESETB      (1'b1),
      .BYPASS      (1'b0)
  );
  if (SCREEN == 1) begin : gen_screen
    SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR         (4'd0),
        .DIVF         (7'(PIX_DIVF)),
        .DIVQ         (3'(PIX_DIVQ)),
        .FILTER_RANGE (3'd1)
    ) u_pix_pll (
        .REFERENCECLK(clk_12mhz),
        .PLLOUTGLOBAL(pix_clk),
        .LOCK        (pix_locked),
        .RESETB      (1'b1),
        .BYPASS      (1'b0)
    );
  end else begin : gen_no_screen
    assign pix_clk = clk;
    assign pix_locked = 1'b1;
    logic unused;
    assign unused = &{1'b0, 7'(PIX_DIVF), 3'(PIX_DIVQ)};
  end

  // Each LOCK has a flip-flop of its own, which lies beside its PLL: it reaches no others. The crystal runs always.
  logic core_locked_q, pix_locked_q, good;
  logic rst_n, uart_rst_n, pix_rst_n;
  always_ff @(posedge crystal_clk) begin
    core_locked_q <= core_locked;
    pix_locked_q  <= pix_locked;
    good          <= core_locked_q && pix_locked_q;
  end
  // Each 16 clocks: 1.3 us of the UART's, 640 ns of the pixels', which are three of the slowest and more.
  reset_release u_core_reset (
      .clk_i (clk),
      .good_i(good),
      .rst_no(rst_n)
  );
  reset_release u_uart_reset (
      .clk_i (crystal_clk),
      .good_i(good),
      .rst_no(uart_rst_n)
  );
  reset_release u_pix_reset (
      .clk_i (pix_clk),
      .good_i(good),
      .rst_no(pix_rst_n)
  );

  // ---- the board's core --------------------------------------------------------------------------------------------
  logic active, hsync, vsync;
  logic [23:0] rgb;
  logic cke, csn, rasn, casn, wen, dq_oe;
  logic [1:0] ba, dqm;
  logic [12:0] a;
  logic [15:0] dq;
  board_core #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh",
      .BOARD_NAME  (BOARD_NAME),
      .UART_HZ     (12_000_000),
      .BAUD        (BAUD),
      .MEMORY      (0),
      .MEMORY_WORDS(MEMORY_WORDS),
      .LINES       (LINES),
      .CAPTURE     (CAPTURE),
      .SCREEN      (SCREEN),
      .H_ACTIVE    (H_ACTIVE),
      .H_FRONT     (H_FRONT),
      .H_SYNC      (H_SYNC),
      .H_BACK      (H_BACK),
      .V_ACTIVE    (V_ACTIVE),
      .V_FRONT     (V_FRONT),
      .V_SYNC      (V_SYNC),
      .V_BACK      (V_BACK),
      .LED_BITS    (LED_BITS)
  ) u_board (
      .clk_i        (clk),
      .rst_ni       (rst_n),
      .uart_clk_i   (crystal_clk),
      .uart_rst_ni  (uart_rst_n),
      .rx_i         (rx),
      .tx_o         (tx),
      .mem_clk_i    (1'b0),
      .mem_rst_ni   (1'b0),
      .sdram_cke_o  (cke),
      .sdram_cs_no  (csn),
      .sdram_ras_no (rasn),
      .sdram_cas_no (casn),
      .sdram_we_no  (wen),
      .sdram_ba_o   (ba),
      .sdram_a_o    (a),
      .sdram_dqm_o  (dqm),
      .sdram_dq_o   (dq),
      .sdram_dq_oe_o(dq_oe),
      .sdram_dq_i   (16'd0),
      .pix_clk_i    (pix_clk),
      .pix_rst_ni   (pix_rst_n),
      .active_o     (active),
      .hsync_o      (hsync),
      .vsync_o      (vsync),
      .rgb_o        (rgb),
      .led_o        (led)
  );

  // ---- pads: from flip-flops, so that all come together -------------------------------------------------------------
  always_ff @(posedge pix_clk) begin
    vga_hsync <= hsync;
    vga_vsync <= vsync;
    vga_red   <= active ? rgb[7:6] : 2'b00;
    vga_green <= active ? rgb[15:14] : 2'b00;
    vga_blue  <= active ? rgb[23:22] : 2'b00;
  end

  logic unused;
  assign unused = &{1'b0, cke, csn, rasn, casn, wen, dq_oe, ba, dqm, a, dq, rgb};

endmodule

`default_nettype wire
