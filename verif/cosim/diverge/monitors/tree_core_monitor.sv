// SPDX-License-Identifier: Apache-2.0
// The pixels that each expansion unit gives to the compare tree, as events (rtl/defs/stages.yaml); and whether each
// unit is given the faces and segments that are its own.
`default_nettype none

module tree_core_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int AllBits = UNITS * PointBits
) (
    input wire logic               clk_i,
    input wire logic               rst_ni,
    input wire logic               flush,
    input wire logic [  UNITS-1:0] px_valid,
    input wire logic [  UNITS-1:0] px_ready,
    input wire logic [AllBits-1:0] px_data
);
  `include "kage_trace.svh"

  function automatic void trace_point(input int u, input logic [PointBits-1:0] point);
    trace_unit(u, 64'(point[PointZAt+:Z_BITS]), 64'(point[PointIndexAt+:ORDER_BITS]),
               64'(point[PointColorAt+:PixelRgbBits]), ClassBits > 0 ? 64'(point[PointClassAt+:CLASS_BITS]) : 64'd0);
  endfunction

  for (genvar u = 0; u < UNITS; u++) begin : gen_unit
    always_ff @(posedge clk_i) begin
      if (rst_ni) begin
        trace_module(PartTreeCore, {
                     510'd0,
                     tree_core.call.face && 32'(tree_core.piece.unit) == u,
                     tree_core.held_valid && 32'(tree_core.held_piece.unit) == u
                     }, {510'd0, tree_core.gen_unit[u].u_unit.face_valid_i, tree_core.gen_unit[u].u_unit.seg_valid_i});
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && !flush) begin
      for (int u = 0; u < UNITS; u++) begin
        if (px_valid[u] && px_ready[u]) trace_point(u, px_data[u*PointBits+:PointBits]);
      end
    end
  end

endmodule

bind tree_core tree_core_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

`default_nettype wire
