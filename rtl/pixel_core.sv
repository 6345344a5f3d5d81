// SPDX-License-Identifier: Apache-2.0
// The pixels of a line behind one interface, in the arrangement that the configuration names; contract and cost are those of
// pixel_banked or pixel_systolic. A group that leaves has ExitLanes pixels: LANES if banked, 1 if systolic.
`default_nettype none

module pixel_core #(
    `include "kage_pixel_params.svh"
    `include "kage_widths.svh"
    parameter int ARRANGEMENT = 1,
    parameter int LANES = 4,
    parameter int MAX_WIDTH = 640,
    localparam int ExitLanes = ARRANGEMENT == 1 ? LANES : 1
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from frame_control
    input  wire logic                 cmd_valid_i,
    output logic                      cmd_ready_o,
    input  wire logic [          3:0] cmd_kind_i,
    input  wire logic [   X_BITS-1:0] cmd_xl_i,
    input  wire logic [   X_BITS-1:0] cmd_xr_i,
    input  wire logic [CountBits-1:0] cmd_count_i,
    input  wire logic [DepthBits-1:0] cmd_z_i,
    input  wire logic [DepthBits-1:0] cmd_dz_i,
    input  wire logic [ColorBits-1:0] cmd_color_i,
    input  wire logic [SlopeBits-1:0] cmd_dcolor_i,

    // to line_out
    input  wire logic                          exit_free_i,
    output logic                               exit_take_o,
    output logic                               exit_valid_o,
    output logic                               exit_last_o,
    output logic      [ExitLanes*ExitBits-1:0] exit_data_o,

    output logic moving_o  // something is on its way through here, though no command comes in
);

  if (ARRANGEMENT == 1) begin : gen_banked
    pixel_banked #(
        `include "kage_pixel_param_map.svh"
        .LANES(LANES),
        .MAX_WIDTH(MAX_WIDTH)
    ) u_pixels (
        .clk_i,
        .rst_ni,
        .cmd_valid_i,
        .cmd_ready_o,
        .cmd_kind_i,
        .cmd_xl_i,
        .cmd_xr_i,
        .cmd_count_i,
        .cmd_z_i,
        .cmd_dz_i,
        .cmd_color_i,
        .cmd_dcolor_i,
        .exit_free_i,
        .exit_take_o,
        .exit_valid_o,
        .exit_last_o,
        .exit_data_o,
        .moving_o
    );
  end else begin : gen_systolic
    pixel_systolic #(
        `include "kage_pixel_param_map.svh"
        .MAX_WIDTH(MAX_WIDTH)
    ) u_pixels (
        .clk_i,
        .rst_ni,
        .cmd_valid_i,
        .cmd_ready_o,
        .cmd_kind_i,
        .cmd_xl_i,
        .cmd_xr_i,
        .cmd_count_i,
        .cmd_z_i,
        .cmd_dz_i,
        .cmd_color_i,
        .cmd_dcolor_i,
        .exit_free_i,
        .exit_take_o,
        .exit_valid_o,
        .exit_last_o,
        .exit_data_o,
        .moving_o
    );
  end

endmodule

`default_nettype wire
