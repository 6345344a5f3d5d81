// SPDX-License-Identifier: Apache-2.0
// video_out with a DVI link behind it, as a board has them, for the tests.
`default_nettype none

module video_link #(
    parameter int H_ACTIVE = 640,
    parameter int H_FRONT  = 16,
    parameter int H_SYNC   = 96,
    parameter int H_BACK   = 48,
    parameter int V_ACTIVE = 480,
    parameter int V_FRONT  = 10,
    parameter int V_SYNC   = 2,
    parameter int V_BACK   = 33,
    parameter int LED_BITS = 22
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic        s_axis_tvalid_i,
    output logic             s_axis_tready_o,
    input  wire logic [23:0] s_axis_tdata_i,
    input  wire logic        s_axis_tuser_i,
    input  wire logic        s_axis_tlast_i,
    input  wire logic [15:0] lines_i,

    output logic             frame_req_valid_o,
    input  wire logic        frame_req_ready_i,
    output logic      [15:0] frames_shown_o,
    output logic      [15:0] late_frames_o,
    output logic      [15:0] underrun_frames_o,
    output logic      [15:0] underrun_lines_o,

    input  wire logic       pix_clk_i,
    input  wire logic       pix_rst_ni,
    input  wire logic       bit_clk_i,
    output logic      [7:0] pairs_o,
    output logic            led_o
);
  logic active, hsync, vsync;
  logic [23:0] rgb;
  video_out #(
      .H_ACTIVE(H_ACTIVE),
      .H_FRONT (H_FRONT),
      .H_SYNC  (H_SYNC),
      .H_BACK  (H_BACK),
      .V_ACTIVE(V_ACTIVE),
      .V_FRONT (V_FRONT),
      .V_SYNC  (V_SYNC),
      .V_BACK  (V_BACK),
      .LED_BITS(LED_BITS)
  ) i_out (
      .clk_i,
      .rst_ni,
      .s_axis_tvalid_i,
      .s_axis_tready_o,
      .s_axis_tdata_i,
      .s_axis_tuser_i,
      .s_axis_tlast_i,
      .lines_i,
      .frame_req_valid_o,
      .frame_req_ready_i,
      .frames_shown_o,
      .late_frames_o,
      .underrun_frames_o,
      .underrun_lines_o,
      .pix_clk_i,
      .pix_rst_ni,
      .active_o(active),
      .hsync_o (hsync),
      .vsync_o (vsync),
      .rgb_o   (rgb),
      .led_o
  );
  dvi_link i_link (
      .clk_i   (pix_clk_i),
      .rst_ni  (pix_rst_ni),
      .active_i(active),
      .hsync_i (hsync),
      .vsync_i (vsync),
      .rgb_i   (rgb),
      .bit_clk_i,
      .pairs_o
  );
endmodule

`default_nettype wire
