// SPDX-License-Identifier: Apache-2.0
// The pixels that each expansion unit gives to the compare tree, as events (rtl/defs/stages.yaml); and whether each
// unit is given the faces and segments that are its own.
`default_nettype none

module tree_core_monitor #(
    parameter int Z_BITS = 24,
    parameter int CHANNELS = 3,
    parameter int UNITS = 1,
    parameter int ORDER_BITS = 8,
    parameter int POINT_BITS = 64,
    parameter int CLASS_BITS = 0  // of a pixel: 0 without shadows
) (
    input wire logic                        clk_i,
    input wire logic                        rst_ni,
    input wire logic                        flush,
    input wire logic [           UNITS-1:0] px_valid,
    input wire logic [           UNITS-1:0] px_ready,
    input wire logic [UNITS*POINT_BITS-1:0] px_data
);
  `include "kage_trace.svh"
  localparam int RgbBits = 8 * CHANNELS;
  localparam int ClassWidth = CLASS_BITS > 0 ? CLASS_BITS : 1;

  function automatic void trace_point(input int u, input logic [POINT_BITS-1:0] point);
    trace_unit(u, 64'(point[POINT_BITS-1-:Z_BITS]), 64'(point[POINT_BITS-Z_BITS-1-:ORDER_BITS]),
               64'(point[CLASS_BITS+:RgbBits]), CLASS_BITS > 0 ? 64'(point[ClassWidth-1:0]) : 64'd0);
  endfunction

  for (genvar u = 0; u < UNITS; u++) begin : gen_unit
    always_ff @(posedge clk_i) begin
      if (rst_ni) begin
        trace_module(PartTreeCore, {
                     510'd0,
                     tree_core.face_valid_i && 32'(tree_core.piece.unit) == u,
                     tree_core.seg_valid_i && 32'(tree_core.piece.unit) == u
                     }, {510'd0, tree_core.gen_unit[u].u_unit.face_valid_i, tree_core.gen_unit[u].u_unit.seg_valid_i});
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && !flush) begin
      for (int u = 0; u < UNITS; u++) begin
        if (px_valid[u] && px_ready[u]) trace_point(u, px_data[u*POINT_BITS+:POINT_BITS]);
      end
    end
  end

endmodule

bind tree_core tree_core_monitor #(
    .Z_BITS(Z_BITS),
    .CHANNELS(CHANNELS),
    .UNITS(UNITS),
    .ORDER_BITS(ORDER_BITS),
    .POINT_BITS(PointBits),
    .CLASS_BITS(ClassBits)
) u_monitor (.*);

`default_nettype wire
