// SPDX-License-Identifier: Apache-2.0
// The role of a token in the front end, from itself and the tokens before it, and whether it is in its place
// (docs/stream.md, "The polygon level").
//
// Handshake: a register of a stream, in order: in_* is valid/ready, and out_valid_o offers the token, its flags and
//   role_o, a role_t, until out_ready_i. Input polygons_i: the token's frame is at the polygon level. Output place_o
//   is the place of the last AT up to the token that is out. flush_i: nothing is in here.
// Latency: 1 clock. Throughput: a token a clock.
// Cost: a register of a token and its flags, comparators of a place and of two numbers of lines.
`default_nettype none

module polygon_token #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int WORDS = 6  // of a token
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic flush_i,

    input wire logic polygons_i,

    input  wire logic                 in_valid_i,
    output logic                      in_ready_o,
    input  wire logic [ WORDS*32-1:0] token_i,
    input  wire logic [FlagsBits-1:0] flags_i,

    output logic                      out_valid_o,
    input  wire logic                 out_ready_i,
    output logic      [ WORDS*32-1:0] token_o,
    output logic      [FlagsBits-1:0] flags_o,
    output logic      [ RoleBits-1:0] role_o,
    output logic      [PlaceBits-1:0] place_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

  logic valid_q;
  logic [WORDS*32-1:0] token_q;
  flags_t flags, flags_q;
  role_t coming, role_q;
  logic placed_q;  // the line has had an AT
  logic [PlaceBits-1:0] place_q;  // the last one's
  logic [EndLineBits-1:0] line_below_q;  // the one behind the line of the token that comes

  assign out_valid_o = valid_q;
  assign in_ready_o = !valid_q || out_ready_i;
  assign token_o = token_q;
  assign flags_o = flags_q;
  assign role_o = role_q;
  assign place_o = place_q;

  logic [ KindBits-1:0] kind;
  logic [PlaceBits-1:0] place;
  logic [LayerBits-1:0] layer, layer_of_span;
  logic has_layer, has_light, of_light;
  logic [SubpixelBits:0] past_bottom;
  assign flags = flags_i;
  assign kind = token_i[KindBits-1:0];
  assign place = token_i[AtRankLsb+:PlaceBits];
  assign layer = place[PlaceBits-1-:LayerBits];
  assign has_layer = layer == 2'd0 || (layer == 2'd1 && DSF_BITS > 0) || (layer == 2'd2 && TRANSLUCENCY > 0);
  assign has_light = layer != 2'd1 || {1'b0, place[RankBits+VolumeBits+:LightPlaceBits]} < 4'(PlaceLights);
  // A light's own spans stand behind its volumes, in their layer.
  assign of_light = LINEAR_BITS > 0 && place_q[PlaceBits-1-:LayerBits] == 2'd1 && place_q[RankBits+VolumeBits];
  assign layer_of_span = kind == KindTp ? 2'd2 : kind == KindOp && !of_light ? 2'd0 : 2'd1;
  // A line is an edge's if its centre, half a pixel down, lies above the edge's bottom.
  assign past_bottom = {token_i[EdgeBottomYLsb+SubpixelBits-1], token_i[EdgeBottomYLsb+:SubpixelBits]} + 25'd127;

  always_comb begin
    coming.of_level = polygons_i && !flags.header && !flags.cut && !flags.lacking;
    coming.at_token = coming.of_level && kind == KindAt;
    coming.polygon = coming.of_level && kind == KindPolygon;
    coming.gradient = coming.of_level && SMOOTH > 0 && kind == KindGradient;
    coming.edge_token = coming.of_level && kind == KindEdge;
    coming.eol = coming.of_level && kind == KindEol;
    coming.span = coming.of_level && kind_has_range(kind) && kind != KindPolygon && kind != KindEdge;
    coming.at_once = !(coming.at_token || coming.polygon || coming.gradient || coming.edge_token || coming.eol ||
        coming.span);
    coming.misplaced = 1'b0;
    if (coming.at_token && (!has_layer || !has_light || (placed_q && place < place_q))) coming.misplaced = 1'b1;
    if ((coming.polygon || coming.edge_token || coming.span) && !placed_q) coming.misplaced = 1'b1;
    if (coming.span && (place_q[PlaceBits-1-:LayerBits] != layer_of_span || (of_light && kind != KindOp)))
      coming.misplaced = 1'b1;
    if (coming.gradient && token_i[GradientChannelLsb+:2] >= 2'(CHANNELS)) coming.misplaced = 1'b1;
    coming.flushes = (coming.polygon || coming.span || coming.eol || coming.edge_token) && !coming.misplaced;
    coming.side = token_i[EdgeSideLsb];
    coming.last = token_i[EdgeLastLsb];
    coming.end_line = past_bottom[SubpixelBits-:EndLineBits];
    coming.goes_on = $signed(coming.end_line) > $signed(line_below_q);
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni || flush_i) valid_q <= 1'b0;
    else if (in_ready_o) valid_q <= in_valid_i;
    if (in_ready_o) begin
      token_q <= token_i;
      flags_q <= flags_i;
      role_q  <= coming;
      if (in_valid_i) begin
        if (flags.header || coming.eol) placed_q <= 1'b0;
        else if (coming.at_token) placed_q <= 1'b1;
        if (coming.at_token) place_q <= place;
        if (flags.header) line_below_q <= EndLineBits'(1);
        else if (coming.eol) line_below_q <= line_below_q + 1'b1;
      end
    end
  end

  logic unused_bits;
  assign unused_bits = ^{token_i, flags, past_bottom};

endmodule

`default_nettype wire
