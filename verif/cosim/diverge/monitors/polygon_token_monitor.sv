// SPDX-License-Identifier: Apache-2.0
// polygon_token from its ports alone: what each token is to the front end, by the tokens before it (docs/stream.md,
// "The polygon level").
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module polygon_token_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int WORDS = 6
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 flush_i,
    input wire logic                 polygons_i,
    input wire logic                 in_valid_i,
    input wire logic                 in_ready_o,
    input wire logic [ WORDS*32-1:0] token_i,
    input wire logic [FlagsBits-1:0] flags_i,
    input wire logic                 out_valid_o,
    input wire logic                 out_ready_i,
    input wire logic [ WORDS*32-1:0] token_o,
    input wire logic [FlagsBits-1:0] flags_o,
    input wire logic [ RoleBits-1:0] role_o,
    input wire logic [PlaceBits-1:0] place_o
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"
  localparam int BITS = WORDS * 32;
  `include "kage_trace_word.svh"

  // State of the frame and the line, as the next token finds it.
  bit held_q, placed_q;
  int line_q;
  logic [PlaceBits-1:0] place_q;
  // State of the token that is out.
  logic [BITS-1:0] token_q;
  logic [FlagsBits-1:0] flags_q;
  role_t role_q, role_now;
  assign role_now = role_o;

  flags_t flags;
  assign flags = flags_i;

  function automatic role_t expected();
    logic [ KindBits-1:0] kind;
    logic [PlaceBits-1:0] place;
    logic [LayerBits-1:0] layer, of_span;
    longint bottom, end_line;
    logic level, of_light;
    expected = '0;
    kind = token_i[KindBits-1:0];
    place = token_i[AtRankLsb+:PlaceBits];
    layer = place[PlaceBits-1-:LayerBits];
    level = polygons_i && !flags.header && !flags.cut && !flags.lacking;
    expected.of_level = level;
    expected.at_once = !level;
    if (level) begin
      case (kind)
        KindAt: expected.at_token = 1'b1;
        KindPolygon: expected.polygon = 1'b1;
        KindEdge: expected.edge_token = 1'b1;
        KindEol: expected.eol = 1'b1;
        default: begin
          expected.gradient = SMOOTH > 0 && kind == KindGradient;
          expected.span = !expected.gradient && kind_has_range(kind);
          expected.at_once = !expected.gradient && !expected.span;
        end
      endcase
    end
    // With linear light: the place is of a light's own spans, which are OPs. A light above 1 is at fault before.
    of_light = LINEAR_BITS > 0 && place_q[PlaceBits-1-:LayerBits] == 2'd1 &&
        32'(place_q[RankBits+VolumeBits+:LightPlaceBits]) % 2 == 1;
    of_span = kind == KindOp && !of_light ? 2'd0 : kind == KindTp ? 2'd2 : 2'd1;
    if (expected.at_token) begin
      expected.misplaced = layer == 2'd3 || (layer == 2'd2 && TRANSLUCENCY == 0) || (layer == 2'd1 && DSF_BITS == 0) ||
          (placed_q && place < place_q);
      if (layer == 2'd1 && 32'(place[RankBits+VolumeBits+:LightPlaceBits]) >= LIGHTS + (LINEAR_BITS > 0 ? 1 : 0))
        expected.misplaced = 1'b1;
    end
    if (expected.polygon || expected.edge_token || expected.span) expected.misplaced = !placed_q;
    if (expected.span && place_q[PlaceBits-1-:LayerBits] != of_span) expected.misplaced = 1'b1;
    if (expected.span && of_light && kind != KindOp) expected.misplaced = 1'b1;
    if (expected.gradient) expected.misplaced = 32'(token_i[GradientChannelLsb+:2]) >= CHANNELS;
    expected.flushes = (expected.polygon || expected.edge_token || expected.span || expected.eol) &&
        !expected.misplaced;
    expected.side = token_i[EdgeSideLsb];
    expected.last = token_i[EdgeLastLsb];
    // The first line whose centre is not above the edge's bottom.
    bottom = 64'($signed(token_i[EdgeBottomYLsb+:SubpixelBits]));
    end_line = (bottom + 127) >>> 8;
    expected.end_line = EndLineBits'(end_line);
    expected.goes_on = end_line > 64'(line_q) + 1;
  endfunction

  // Which of a role matters: what an edge says is of edges alone.
  function automatic logic [RoleBits-1:0] looked_at(input role_t role);
    role_t r;
    r = role;
    if (!r.edge_token) {r.side, r.last, r.end_line, r.goes_on} = '0;
    looked_at = r;
  endfunction

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      held_q <= 1'b0;
    end else if (flush_i) begin
      held_q <= 1'b0;
    end else begin
      trace_module(PartPolygonToken, {510'd0, !held_q || out_ready_i, held_q}, {510'd0, in_ready_o, out_valid_o});
      if (held_q) begin
        trace_module(PartPolygonToken, folded(token_q), folded(token_o));
        trace_module(PartPolygonToken, 512'({flags_q, looked_at(role_q)}), 512'({flags_o, looked_at(role_now)}));
        if (placed_q) trace_module(PartPolygonToken, 512'(place_q), 512'(place_o));
      end
      if (!held_q || out_ready_i) held_q <= in_valid_i;
    end
    if (rst_ni && in_valid_i && in_ready_o) begin
      token_q <= token_i;
      flags_q <= flags_i;
      role_q  <= expected();
      if (flags.header) begin
        placed_q <= 1'b0;
        line_q   <= 0;
      end else if (polygons_i && !flags.cut && !flags.lacking) begin
        if (token_i[KindBits-1:0] == KindEol) begin
          placed_q <= 1'b0;
          line_q   <= line_q + 1;
        end
        if (token_i[KindBits-1:0] == KindAt) begin
          placed_q <= 1'b1;
          place_q  <= token_i[AtRankLsb+:PlaceBits];
        end
      end
    end
  end

endmodule

bind polygon_token polygon_token_monitor #(
    .WORDS(WORDS),
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
