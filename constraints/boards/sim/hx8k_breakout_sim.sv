// SPDX-License-Identifier: Apache-2.0
// The iCE40-HX8K breakout board as a whole, for simulation: its top alone, since nothing lies at its pins. Crystal,
// host and screen are outside, in verif/board/sim. The board has no button: button_ni does nothing.
//
// wires_o  wires of the VGA socket, from bit 0 on: red, green and blue of two bits each, hsync, vsync
// bits_o, periods_o  bits_o pixels go out in periods_o periods of the crystal, by the PLL's parameters. The model's
// screen
//                    samples the wires by them.
`default_nettype none

module board_sim #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_impl_params.svh",
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
    input  wire logic       clk_i,
    input  wire logic       button_ni,
    input  wire logic       rx_i,
    output logic            tx_o,
    output logic      [7:0] led_o,
    output logic      [7:0] wires_o,

    output logic [7:0] bits_o,
    output logic [7:0] periods_o
);
  assign bits_o    = 8'(PIX_DIVF + 1);
  assign periods_o = 8'(2 ** PIX_DIVQ);

  hx8k_breakout #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh",
      .BAUD        (BAUD),
      .CORE_DIVF   (CORE_DIVF),
      .CORE_DIVQ   (CORE_DIVQ),
      .MEMORY_WORDS(MEMORY_WORDS),
      .LINES       (LINES),
      .CAPTURE     (CAPTURE),
      .SCREEN      (SCREEN),
      .PIX_DIVF    (PIX_DIVF),
      .PIX_DIVQ    (PIX_DIVQ),
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
      .clk_12mhz(clk_i),
      .led      (led_o),
      .rx       (rx_i),
      .tx       (tx_o),
      .vga_hsync(wires_o[6]),
      .vga_vsync(wires_o[7]),
      .vga_red  (wires_o[1:0]),
      .vga_green(wires_o[3:2]),
      .vga_blue (wires_o[5:4])
  );

  // In this order: UART, core, pixels.
  reset_check #(
      .CLOCKS(3)
  ) u_resets (
      .good_i(u_board.good),
      .clk_i ({u_board.pix_clk, u_board.clk, u_board.crystal_clk}),
      .rst_ni({u_board.pix_rst_n, u_board.rst_n, u_board.uart_rst_n})
  );

  logic unused;
  assign unused = &{1'b0, button_ni};

endmodule

`default_nettype wire
