// SPDX-License-Identifier: Apache-2.0
// Ports of pixel_core and of both arrangements behind it: the one list. Included in a module that has the pixel
// parameters, kage_widths.svh and ExitLanes.
    input wire logic clk_i,
    input wire logic rst_ni,

    // from pixel_loads: frame_control's commands, and between them the colours that come back
    input  wire logic                   cmd_valid_i,
    output logic                        cmd_ready_o,
    input  wire logic [CommandBits-1:0] cmd_i,

    // from tree_core: the line that the next TREE takes. Without units nothing of this matters.
    input  wire logic                     tree_valid_i,
    output logic                          tree_ready_o,
    input  wire logic [TreePixelBits-1:0] tree_i,
    input  wire logic                     tree_drop_i,

    // to line_out
    input  wire logic                          exit_free_i,
    output logic                               exit_take_o,
    output logic                               exit_valid_o,
    output logic                               exit_last_o,
    output logic      [ExitLanes*ExitBits-1:0] exit_data_o,

    output logic moving_o  // something is on its way through here, though no command comes in
