// SPDX-License-Identifier: Apache-2.0
// polygon_walk from its ports alone: each polygon's span, and the polygon on the next line, by sums and products.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module polygon_walk_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int Stages = 6
) (
    input wire logic                    clk_i,
    input wire logic                    rst_ni,
    input wire logic                    flush_i,
    input wire logic [      X_BITS-1:0] width_i,
    input wire logic                    in_valid_i,
    input wire logic                    in_made_i,
    input wire logic                    in_keep_i,
    input wire logic                    in_swap_i,
    input wire logic [  ActiveBits-1:0] polygon_i,
    input wire logic                    write_o,
    input wire logic [  ActiveBits-1:0] next_o,
    input wire logic                    swap_write_o,
    input wire logic                    out_valid_o,
    input wire logic [MadeSpanBits-1:0] span_o
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"
  localparam int BITS = ActiveBits;
  `include "kage_trace_word.svh"

  // Where an edge crosses, brought back into the line.
  function automatic int crossing(input logic [WalkedEdgeBits-1:0] walked, input int width);
    crossing = 32'($signed(walked[WalkedEdgeXAt+:CrossingBits]));
    if (crossing < 0) crossing = 0;
    if (crossing > width) crossing = width;
  endfunction

  // The edge a line further down.
  function automatic logic [WalkedEdgeBits-1:0] below(input logic [WalkedEdgeBits-1:0] walked);
    logic [CrossingBits-1:0] x;
    int rest, height;
    rest = 32'(walked[WalkedEdgeRestAt+:EdgeRestBits]) + 32'(walked[WalkedEdgeRestStepAt+:EdgeRestBits]);
    height = 32'(walked[WalkedEdgeDyAt+:EdgeRestBits]);
    x = walked[WalkedEdgeXAt+:CrossingBits] + walked[WalkedEdgeStepAt+:CrossingBits];
    if (rest >= height) x = x + 1'b1;
    below = walked;
    below[WalkedEdgeXAt+:CrossingBits] = x;
    below[WalkedEdgeRestAt+:EdgeRestBits] = EdgeRestBits'(rest >= height ? rest - height : rest);
  endfunction

  // A plane's field at x and its step, of a plane at pixel 0 of the line above: {start, step} of FIELD bits, cut at
  // SHIFT.
  function automatic longint start_of(input longint value, input longint right, input longint down, input int x,
                                      input int frac);
    longint half;
    half = frac < PlaneFrac ? 64'd1 << (PlaneFrac - 1 - frac) : 0;
    start_of = (value + down + right * 64'(x) + half + (frac > 0 ? 64'd1 << (PlaneFrac - 1) : 0)) >> (PlaneFrac - frac);
  endfunction
  function automatic longint step_of(input longint right, input bit single, input int frac);
    longint half;
    half = frac < PlaneFrac ? 64'd1 << (PlaneFrac - 1 - frac) : 0;
    step_of = single ? 0 : (right + half) >> (PlaneFrac - frac);
  endfunction

  made_span_t span;
  logic [ActiveBits-1:0] next;
  int down, up;
  bit single;
  longint z, dz, color, dcolor;
  logic [RampBits-1:0] channel;
  always_comb begin
    down = crossing(polygon_i[ActiveDownEdgeAt+:WalkedEdgeBits], 32'(width_i));
    up = crossing(polygon_i[ActiveUpEdgeAt+:WalkedEdgeBits], 32'(width_i));
    span = '0;
    span.turned = up < down;
    span.xl = X_BITS'(up < down ? up : down);
    span.xr = X_BITS'(up < down ? down : up);
    span.empty = up == down;
    single = span.xr - span.xl == X_BITS'(1);
    span.look = polygon_i[ActiveLookAt+:LookBits];
    z = start_of(
      64'(polygon_i[ActiveValueAt+:PlaneBits]),
      64'(polygon_i[ActiveRightAt+:PlaneBits]),
      64'(polygon_i[ActiveDownAt+:PlaneBits]),
      32'(span.xl),
      Z_FRAC
    );
    dz = step_of(64'(polygon_i[ActiveRightAt+:PlaneBits]), single, Z_FRAC);
    span.z = DepthBits'(z);
    span.dz = DepthBits'(dz);
    span.color = ColorBits'(span.look[LookBits-1-:RgbBits]);
    next = polygon_i;
    next[ActiveDownEdgeAt+:WalkedEdgeBits] = below(polygon_i[ActiveDownEdgeAt+:WalkedEdgeBits]);
    next[ActiveUpEdgeAt+:WalkedEdgeBits] = below(polygon_i[ActiveUpEdgeAt+:WalkedEdgeBits]);
    next[ActiveValueAt+:PlaneBits] = polygon_i[ActiveValueAt+:PlaneBits] + polygon_i[ActiveDownAt+:PlaneBits];
    {color, dcolor, channel} = '0;
    if (SMOOTH > 0) begin
      span.color = '0;
      for (int c = 0; c < CHANNELS; c++) begin
        color = start_of(
          64'(polygon_i[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits]),
          64'(polygon_i[ActiveGradientsAt+(3*c+1)*ColorPlaneBits+:ColorPlaneBits]),
          64'(polygon_i[ActiveGradientsAt+(3*c+2)*ColorPlaneBits+:ColorPlaneBits]),
          32'(span.xl),
          COLOR_FRAC
        );
        dcolor = step_of(64'(polygon_i[ActiveGradientsAt+(3*c+1)*ColorPlaneBits+:ColorPlaneBits]), single, COLOR_FRAC);
        channel = color[RampBits-1:0];
        span.color = span.color | ColorBits'(channel) << (c * RampBits);
        channel = dcolor[RampBits-1:0];
        span.dcolor = span.dcolor | SlopeBits'(ColorBits'(channel) << (c * RampBits));
        next[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] =
            polygon_i[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] +
            polygon_i[ActiveGradientsAt+(3*c+2)*ColorPlaneBits+:ColorPlaneBits];
      end
    end
  end

  bit [Stages-1:0] valid_q, made_q;
  bit [1:0] keep_q, swap_q;
  logic [Stages*MadeSpanBits-1:0] spans_q;
  logic [2*ActiveBits-1:0] nexts_q;
  bit writes;
  assign writes = valid_q[1] && keep_q[1];
  always_ff @(posedge clk_i) begin
    if (rst_ni && !flush_i) begin
      trace_module(PartPolygonWalk, {509'd0, valid_q[Stages-1], writes, valid_q[1] && swap_q[1]}, {
                   509'd0, out_valid_o, write_o, swap_write_o});
      if (writes) trace_module(PartPolygonWalk, folded(nexts_q[ActiveBits+:ActiveBits]), folded(next_o));
      if (valid_q[Stages-1] && made_q[Stages-1])
        trace_module(PartPolygonWalk, 512'(spans_q[(Stages-1)*MadeSpanBits+:MadeSpanBits]), 512'(span_o));
    end
    valid_q <= rst_ni && !flush_i ? {valid_q[Stages-2:0], in_valid_i} : '0;
    made_q  <= {made_q[Stages-2:0], in_made_i};
    keep_q  <= {keep_q[0], in_made_i && in_keep_i};
    swap_q  <= {swap_q[0], in_swap_i};
    spans_q <= {spans_q[0+:(Stages-1)*MadeSpanBits], span};
    nexts_q <= {nexts_q[0+:ActiveBits], next};
  end

endmodule

bind polygon_walk polygon_walk_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
