// SPDX-License-Identifier: Apache-2.0
// Whether pixel_core gives the arrangement what it is given itself.
`default_nettype none

module pixel_core_monitor #(
    parameter int ARRANGEMENT = 1
) (
    input wire logic clk_i,
    input wire logic rst_ni
);
  `include "kage_trace.svh"

  logic same;
  if (ARRANGEMENT == 1) begin : gen_banked
    assign same = {
      pixel_core.gen_banked.u_pixels.cmd_valid_i,
      pixel_core.gen_banked.u_pixels.cmd_kind_i,
      pixel_core.gen_banked.u_pixels.cmd_xl_i,
      pixel_core.gen_banked.u_pixels.cmd_xr_i,
      pixel_core.gen_banked.u_pixels.cmd_count_i,
      pixel_core.gen_banked.u_pixels.cmd_z_i,
      pixel_core.gen_banked.u_pixels.cmd_dz_i,
      pixel_core.gen_banked.u_pixels.cmd_color_i,
      pixel_core.gen_banked.u_pixels.cmd_dcolor_i,
      pixel_core.gen_banked.u_pixels.cmd_share_i,
      pixel_core.gen_banked.u_pixels.tree_valid_i,
      pixel_core.gen_banked.u_pixels.tree_z_i,
      pixel_core.gen_banked.u_pixels.tree_class_i,
      pixel_core.gen_banked.u_pixels.tree_color_i,
      pixel_core.gen_banked.u_pixels.tree_last_i,
      pixel_core.gen_banked.u_pixels.tree_drop_i,
      pixel_core.gen_banked.u_pixels.exit_free_i
    } == {
      pixel_core.cmd_valid_i,
      pixel_core.cmd_kind_i,
      pixel_core.cmd_xl_i,
      pixel_core.cmd_xr_i,
      pixel_core.cmd_count_i,
      pixel_core.cmd_z_i,
      pixel_core.cmd_dz_i,
      pixel_core.cmd_color_i,
      pixel_core.cmd_dcolor_i,
      pixel_core.cmd_share_i,
      pixel_core.tree_valid_i,
      pixel_core.tree_z_i,
      pixel_core.tree_class_i,
      pixel_core.tree_color_i,
      pixel_core.tree_last_i,
      pixel_core.tree_drop_i,
      pixel_core.exit_free_i
    };
  end else begin : gen_systolic
    assign same = {
      pixel_core.gen_systolic.u_pixels.cmd_valid_i,
      pixel_core.gen_systolic.u_pixels.cmd_kind_i,
      pixel_core.gen_systolic.u_pixels.cmd_xl_i,
      pixel_core.gen_systolic.u_pixels.cmd_xr_i,
      pixel_core.gen_systolic.u_pixels.cmd_count_i,
      pixel_core.gen_systolic.u_pixels.cmd_z_i,
      pixel_core.gen_systolic.u_pixels.cmd_dz_i,
      pixel_core.gen_systolic.u_pixels.cmd_color_i,
      pixel_core.gen_systolic.u_pixels.cmd_dcolor_i,
      pixel_core.gen_systolic.u_pixels.cmd_share_i,
      pixel_core.gen_systolic.u_pixels.tree_valid_i,
      pixel_core.gen_systolic.u_pixels.tree_z_i,
      pixel_core.gen_systolic.u_pixels.tree_class_i,
      pixel_core.gen_systolic.u_pixels.tree_color_i,
      pixel_core.gen_systolic.u_pixels.tree_last_i,
      pixel_core.gen_systolic.u_pixels.tree_drop_i,
      pixel_core.gen_systolic.u_pixels.exit_free_i
    } == {
      pixel_core.cmd_valid_i,
      pixel_core.cmd_kind_i,
      pixel_core.cmd_xl_i,
      pixel_core.cmd_xr_i,
      pixel_core.cmd_count_i,
      pixel_core.cmd_z_i,
      pixel_core.cmd_dz_i,
      pixel_core.cmd_color_i,
      pixel_core.cmd_dcolor_i,
      pixel_core.cmd_share_i,
      pixel_core.tree_valid_i,
      pixel_core.tree_z_i,
      pixel_core.tree_class_i,
      pixel_core.tree_color_i,
      pixel_core.tree_last_i,
      pixel_core.tree_drop_i,
      pixel_core.exit_free_i
    };
  end
  always_ff @(posedge clk_i) if (rst_ni) trace_part(PartPixelCore, 512'd1, 512'(same));

endmodule

bind pixel_core pixel_core_monitor #(.ARRANGEMENT(ARRANGEMENT)) u_monitor (.*);

`default_nettype wire
