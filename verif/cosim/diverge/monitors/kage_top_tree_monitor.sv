// SPDX-License-Identifier: Apache-2.0
// Claims, faces and segments that frame_control gives to the tree, and the tree's pixels, as events
// (rtl/defs/stages.yaml). Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_tree_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic                     clk_i,
    input wire logic                     rst_ni,
    input wire logic [ TreeCallBits-1:0] tree_call,
    input wire logic                     tree_seg_valid,
    input wire logic                     tree_seg_ready,
    input wire logic [    PieceBits-1:0] tree_piece,
    input wire logic                     tree_valid,
    input wire logic                     tree_ready,
    input wire logic [TreePixelBits-1:0] tree_pixel
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  // The buses by their fields; events need no end of line, and not all calls.
  tree_call_t call;
  piece_t piece;
  tree_pixel_t pixel;
  logic unused_fields;
  assign piece = tree_piece;
  assign pixel = tree_pixel;
  assign call = tree_call;
  assign unused_fields = ^{pixel.last, call.start, call.flush};

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      if (call.claim) trace_claim(0);
      if (call.face) begin
        trace_face(32'(piece.unit), 64'(piece.face), 64'(piece.entry[EntryIndexAt+:ORDER_BITS]),
                   ClassBits > 0 ? 64'(piece.entry[EntryClassAt+:CLASS_BITS]) : 64'd0,
                   64'(piece.entry[EntryDzAt+:DepthBits]), 64'(piece.entry[EntryColorAt+:PixelRgbBits]));
      end
      if (tree_seg_valid && tree_seg_ready) begin
        trace_segment(32'(piece.unit), 64'(piece.z), 64'(piece.dx), 64'(piece.face), 64'(piece.completes));
      end
      if (tree_valid && tree_ready) begin
        trace_tree(0, 64'(pixel.z), 64'(pixel.color), 64'(pixel.normal_class));
      end
    end
  end

endmodule

bind kage_top kage_top_tree_monitor #(
    `include "generated/kage_impl_param_map.svh"
    `include "generated/kage_pixel_param_map.svh"
) u_tree_monitor (.*);

`default_nettype wire
