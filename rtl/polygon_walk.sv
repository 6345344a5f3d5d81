// SPDX-License-Identifier: Apache-2.0
// A polygon on a line: the span between its edges, and the polygon as it is on the next line.
//
// Handshake: a pipeline that moves each clock. By in_valid_i an item enters. With in_made_i it is a polygon, polygon_i,
//   that goes on to the next line if in_keep_i. Without, it has no span and passes at the same pace, and is a line's
//   end if in_swap_i. It leaves by out_valid_o, a polygon with span_o. flush_i: nothing is in here.
// Next line: write_o, one clock, for each polygon that goes on, in the order in which they came; next_o is the polygon;
//   swap_write_o, one clock, for each line's end.
// Latency: 6 clocks to the span, 2 to the next line. Throughput: a polygon a clock.
// Cost: the kernels edge_step (twice), plane_step and span_setup, with SMOOTH the latter two for each channel as well;
//   two registers of a polygon and four of what a span needs of it.
`default_nettype none

module polygon_walk #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int Stages = 6
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic flush_i,

    input wire logic [    X_BITS-1:0] width_i,
    input wire logic                  in_valid_i,
    input wire logic                  in_made_i,
    input wire logic                  in_keep_i,
    input wire logic                  in_swap_i,
    input wire logic [ActiveBits-1:0] polygon_i,

    output logic                    write_o,
    output logic [  ActiveBits-1:0] next_o,
    output logic                    swap_write_o,
    output logic                    out_valid_o,
    output logic [MadeSpanBits-1:0] span_o,
    output logic                    busy_o         // something is in here
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  localparam int SpanBits = X_BITS + 1;

  // ---- what is where -----------------------------------------------------------------------------------------------
  logic [Stages-1:0] valid_q;
  logic [1:0] keep_q, swap_q;
  assign out_valid_o = valid_q[Stages-1];
  assign busy_o = valid_q != '0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || flush_i) valid_q <= '0;
    else valid_q <= {valid_q[Stages-2:0], in_valid_i};
    keep_q <= {keep_q[0], in_made_i && in_keep_i};
    swap_q <= {swap_q[0], in_swap_i};
  end

  // ---- 0: the polygon, registered ----------------------------------------------------------------------------------
  logic [ActiveBits-1:0] polygon_q;
  always_ff @(posedge clk_i) polygon_q <= polygon_i;

  // ---- 1: crossings within the line, and edges one line further down -----------------------------------------------
  // The kernels' pipelines are always full and move each clock, so that they need no valid.
  function automatic logic [SpanBits-1:0] in_line(input logic [CrossingBits-1:0] x, input logic [X_BITS-1:0] width);
    if (x[CrossingBits-1]) in_line = '0;
    else if (x > CrossingBits'(width)) in_line = SpanBits'(width);
    else in_line = SpanBits'(x);
  endfunction

  logic [2*WalkedEdgeBits-1:0] stepped;
  logic [SpanBits-1:0] down, up;
  assign down = in_line(polygon_q[ActiveDownEdgeAt+WalkedEdgeXAt+:CrossingBits], width_i);
  assign up   = in_line(polygon_q[ActiveUpEdgeAt+WalkedEdgeXAt+:CrossingBits], width_i);
  for (genvar side = 0; side < 2; side++) begin : gen_edges
    localparam int At = side == 0 ? ActiveDownEdgeAt : ActiveUpEdgeAt;
    localparam int Out = side * WalkedEdgeBits;
    logic unused_ready, unused_valid;
    hls_edge_step u_step (
        .clk_i,
        .rst_ni,
        .in_valid_i (1'b1),
        .in_ready_o (unused_ready),
        .out_valid_o(unused_valid),
        .out_ready_i(1'b1),
        .x_i        (polygon_q[At+WalkedEdgeXAt+:CrossingBits]),
        .step_i     (polygon_q[At+WalkedEdgeStepAt+:CrossingBits]),
        .rest_i     (polygon_q[At+WalkedEdgeRestAt+:EdgeRestBits]),
        .rest_step_i(polygon_q[At+WalkedEdgeRestStepAt+:EdgeRestBits]),
        .dy_i       (polygon_q[At+WalkedEdgeDyAt+:EdgeRestBits]),
        .x_o        (stepped[Out+WalkedEdgeXAt+:CrossingBits]),
        .step_o     (stepped[Out+WalkedEdgeStepAt+:CrossingBits]),
        .rest_o     (stepped[Out+WalkedEdgeRestAt+:EdgeRestBits]),
        .rest_step_o(stepped[Out+WalkedEdgeRestStepAt+:EdgeRestBits]),
        .dy_o       (stepped[Out+WalkedEdgeDyAt+:EdgeRestBits])
    );
  end

  logic [ActiveBits-1:0] walked_q;  // but for its edges
  logic [X_BITS-1:0] xl_q, xr_q;
  logic turned_q, empty_q, single_q;
  logic turned;
  logic [SpanBits-1:0] pixels;
  assign turned = up < down;
  assign pixels = turned ? down - up : up - down;
  always_ff @(posedge clk_i) begin
    walked_q <= polygon_q;
    xl_q <= X_BITS'(turned ? up : down);
    xr_q <= X_BITS'(turned ? down : up);
    turned_q <= turned;
    empty_q <= pixels == '0;
    single_q <= pixels == SpanBits'(1);
  end

  // ---- the next line -----------------------------------------------------------------------------------------------
  assign write_o = valid_q[1] && keep_q[1];
  assign swap_write_o = valid_q[1] && swap_q[1];
  always_comb begin
    next_o = walked_q;
    next_o[ActiveDownEdgeAt+:WalkedEdgeBits] = stepped[0+:WalkedEdgeBits];
    next_o[ActiveUpEdgeAt+:WalkedEdgeBits] = stepped[WalkedEdgeBits+:WalkedEdgeBits];
    next_o[ActiveValueAt+:PlaneBits] = walked_q[ActiveValueAt+:PlaneBits] + walked_q[ActiveDownAt+:PlaneBits];
    if (SMOOTH > 0) begin
      for (int c = 0; c < CHANNELS; c++) begin
        next_o[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] =
            walked_q[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] +
            walked_q[ActiveGradientsAt+(3*c+2)*ColorPlaneBits+:ColorPlaneBits];
      end
    end
  end

  // ---- 2 to 5: planes at the span's first pixel, rounded -----------------------------------------------------------
  // What a span has of its polygon but its planes goes along.
  localparam int AlongBits = LookBits + 2 * X_BITS + 2;
  logic [4*AlongBits-1:0] along_q;
  logic [LookBits-1:0] out_look;
  logic [X_BITS-1:0] out_xl, out_xr;
  logic out_turned, out_empty;
  assign {out_look, out_xl, out_xr, out_turned, out_empty} = along_q[3*AlongBits+:AlongBits];
  always_ff @(posedge clk_i) begin
    along_q <= {along_q[0+:3*AlongBits], walked_q[ActiveLookAt+:LookBits], xl_q, xr_q, turned_q, empty_q};
  end

  logic [DepthBits-1:0] z, dz;
  plane_at #(
      .BITS (PlaneBits),
      .SHIFT(PlaneFrac - Z_FRAC),
      .FRAC (Z_FRAC),
      .FIELD(DepthBits)
  ) u_depth (
      .clk_i,
      .rst_ni,
      .value_i (walked_q[ActiveValueAt+:PlaneBits]),
      .right_i (walked_q[ActiveRightAt+:PlaneBits]),
      .down_i  (walked_q[ActiveDownAt+:PlaneBits]),
      .xl_i    (CrossingBits'(xl_q)),
      .single_i(single_q),
      .start_o (z),
      .step_o  (dz)
  );

  logic [ColorBits-1:0] color;
  logic [SlopeBits-1:0] dcolor;
  if (SMOOTH > 0) begin : gen_smooth
    for (genvar c = 0; c < CHANNELS; c++) begin : gen_channels
      localparam int At = ActiveGradientsAt + 3 * c * ColorPlaneBits;
      plane_at #(
          .BITS (ColorPlaneBits),
          .SHIFT(PlaneFrac - COLOR_FRAC),
          .FRAC (COLOR_FRAC),
          .FIELD(SmoothBits)
      ) u_color (
          .clk_i,
          .rst_ni,
          .value_i (walked_q[At+:ColorPlaneBits]),
          .right_i (walked_q[At+ColorPlaneBits+:ColorPlaneBits]),
          .down_i  (walked_q[At+2*ColorPlaneBits+:ColorPlaneBits]),
          .xl_i    (CrossingBits'(xl_q)),
          .single_i(single_q),
          .start_o (color[c*SmoothBits+:SmoothBits]),
          .step_o  (dcolor[c*SmoothBits+:SmoothBits])
      );
    end
  end else begin : gen_flat
    assign color  = out_look[LookBits-1-:RgbBits];
    assign dcolor = '0;
  end

  made_span_t span;
  assign span_o = span;
  assign span.empty = out_empty;
  assign span.xl = out_xl;
  assign span.xr = out_xr;
  assign span.turned = out_turned;
  assign span.look = out_look;
  assign span.z = z;
  assign span.dz = dz;
  assign span.color = color;
  assign span.dcolor = dcolor;

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic [1:0] made_q;  // a polygon
  always @(posedge clk_i) begin
    made_q <= {made_q[0], in_made_i};
    if (rst_ni && !flush_i && valid_q[1]) begin
      if (made_q[1]) begin
        // 1. A span lies within the line, its left end first.
        assert (xl_q <= xr_q && xr_q <= width_i);
        // 2. The flags on its number of pixels are right.
        assert (empty_q == (xl_q == xr_q) && single_q == (xr_q - xl_q == X_BITS'(1)));
      end
      // 3. A place of the walk is a polygon's or a line's end.
      assert (!(write_o && swap_write_o));
    end
  end
`endif

endmodule

`default_nettype wire
