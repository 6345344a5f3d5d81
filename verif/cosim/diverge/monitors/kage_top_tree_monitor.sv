// SPDX-License-Identifier: Apache-2.0
// What frame_control gives to the compare tree, and the tree's pixels, as events (rtl/defs/stages.yaml).
// Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_tree_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic                  clk_i,
    input wire logic                  rst_ni,
    input wire logic                  tree_claim,
    input wire logic                  tree_face_valid,
    input wire logic                  tree_seg_valid,
    input wire logic                  tree_seg_ready,
    input wire logic [  UnitBits-1:0] tree_unit,
    input wire logic [ FACE_BITS-1:0] tree_face,
    input wire logic [ EntryBits-1:0] tree_entry,
    input wire logic [ DepthBits-1:0] tree_seg_z,
    input wire logic [   DX_BITS-1:0] tree_dx,
    input wire logic                  tree_valid,
    input wire logic                  tree_ready,
    input wire logic [    Z_BITS-1:0] tree_z,
    input wire logic [CLASS_BITS-1:0] tree_class,
    input wire logic [   RgbBits-1:0] tree_color
);
  `include "kage_trace.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      if (tree_claim) trace_claim(0);
      if (tree_face_valid) begin
        trace_face(32'(tree_unit), 64'(tree_face), 64'(tree_entry[ORDER_BITS-1:0]),
                   ClassBits > 0 ? 64'(tree_entry[ORDER_BITS+:CLASS_BITS]) : 64'd0,
                   64'(tree_entry[ORDER_BITS+ClassBits+:DepthBits]), 64'(tree_entry[EntryBits-1-:RgbBits]));
      end
      if (tree_seg_valid && tree_seg_ready) begin
        trace_segment(32'(tree_unit), 64'(tree_seg_z), 64'(tree_dx), 64'(tree_face));
      end
      if (tree_valid && tree_ready) begin
        trace_tree(0, 64'(tree_z), 64'(tree_color), 64'(tree_class));
      end
    end
  end

endmodule

bind kage_top kage_top_tree_monitor #(
    `include "generated/kage_pixel_param_map.svh"
    `include "generated/kage_impl_param_map.svh"
) u_tree_monitor (.*);

`default_nettype wire
