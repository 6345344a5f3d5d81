// SPDX-License-Identifier: Apache-2.0
// The front end's decision: which comes first, the token at hand or the first of the line's polygons, and what goes on
// of it. A POLYGON with its edges becomes a polygon of the line, a later EDGE goes to its polygon, a span is passed on.
//
//   polygon_token, hls_edge_setup, active_list -> front_merge -> polygon_walk, active_list and, by item_*, volume_ends
//
// Handshake: head_* is valid/ready: the token at hand with its flags, its role_t and the place of the line's last AT.
//   Port edge_*, valid/ready, brings an EDGE's crossing; list_* is active_list's reading side. An item leaves by
//   item_valid_o, one clock, only while room_i is high. With made_o it is polygon_o, which goes on to the next line
//   where goes_on_o says so; else it is a token, a line's end with ends_line_o. flush_i: nothing is in here.
// Item: as volume_ends has it: {plain, whole, family, index, flags, token}.
// Order: polygons of the list and tokens of the line go by place, the lesser first. At the same place a span goes
//   before the polygon that is there, and a polygon that begins behind it. A line's end goes behind all polygons of the
//   list.
// Faults: flags.fault of a token that is out of its place (ErrPlace), or a polygon too many (ErrActiveFull).
// To active_list: pop_o, keep_o, swap_o, clear_o as it has them; next_line_o: the line behind the one at hand.
// Latency: 0 clocks. Throughput: an item a clock.
// Cost: a register of a polygon's planes and look, two of an edge, an adder of 32 bits.
`default_nettype none

module front_merge #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter  int IN_WORDS  = 6,
    parameter  int OUT_WORDS = 5,
    localparam int ItemBits  = 2 + FamilyBits + 32 + FlagsBits + OUT_WORDS * 32
) (
    input wire logic clk_i,
    input wire logic flush_i,

    input  wire logic                      head_valid_i,
    output logic                           head_ready_o,
    input  wire logic [   IN_WORDS*32-1:0] head_i,
    input  wire logic [     FlagsBits-1:0] flags_i,
    input  wire logic [      RoleBits-1:0] role_i,
    input  wire logic [     PlaceBits-1:0] place_i,
    input  wire logic                      edge_valid_i,
    output logic                           edge_ready_o,
    input  wire logic [WalkedEdgeBits-1:0] edge_i,

    input  wire logic                   list_valid_i,
    input  wire logic [ ActiveBits-1:0] list_i,
    input  wire logic                   list_left_i,
    input  wire logic                   list_room_i,
    input  wire logic                   list_before_i,
    input  wire logic                   list_same_i,
    input  wire logic                   list_goes_on_i,
    input  wire logic                   swap_ready_i,
    output logic                        pop_o,
    output logic                        keep_o,
    output logic                        swap_o,
    output logic                        clear_o,
    output logic      [EndLineBits-1:0] next_line_o,

    input  wire logic                  room_i,
    output logic      [    X_BITS-1:0] width_o,       // of the frame
    output logic                       item_valid_o,
    output logic      [  ItemBits-1:0] item_o,
    output logic                       made_o,
    output logic                       goes_on_o,
    output logic                       ends_line_o,
    output logic      [ActiveBits-1:0] polygon_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

  localparam logic [EndLineBits-1:0] NoEnd = {1'b0, {EndLineBits - 1{1'b1}}};

  flags_t flags, item_flags;
  role_t head;
  assign flags = flags_i;
  assign head  = role_i;

  // ---- the frame and the line, as the head finds them --------------------------------------------------------------
  logic [X_BITS-1:0] width_q;
  logic [EndLineBits-1:0] next_line_q;
  logic [31:0] index_q, index;
  logic begun_q;  // a POLYGON waits for its edges
  logic [1:0] have_q;  // sides that have come of it, or of the list's first
  logic [WalkedEdgeBits-1:0] side_q[2];
  logic end_have_q, end_goes_on_q;
  logic [EndLineBits-1:0] end_q;
  logic [ ActiveBits-1:0] fresh_q;  // the POLYGON's look and planes
  assign index = flags.header ? '0 : index_q + 32'd1;

  // ---- merge -------------------------------------------------------------------------------------------------------
  logic misplaced, flushing, completes, fault, gives_fresh, gives_token, whole;
  logic [  CodeBits-1:0] code;
  logic [FamilyBits-1:0] family;
  assign misplaced = head.misplaced || (head.of_level && begun_q && !head.edge_token && !head.gradient) ||
      (head.gradient && !begun_q);
  // The list's polygons that come before the token are given first.
  assign flushing = head_valid_i && head.flushes && !begun_q && list_left_i &&
      (!list_valid_i || head.eol || list_before_i || (head.polygon && list_same_i));
  assign completes = head.edge_token && begun_q && have_q[!head.side];
  always_comb begin
    fault = misplaced;
    code  = ErrPlace;
    if (head.edge_token && !begun_q && (!list_valid_i || !list_same_i)) fault = 1'b1;
    if (completes && !list_room_i) begin
      fault = 1'b1;
      code  = ErrActiveFull;
    end
  end
  // All tokens wait for room, though some need none: whether one is at fault is known late.
  assign head_ready_o = head_valid_i && room_i && !flushing && (!head.edge_token || edge_valid_i) &&
      (!head.eol || swap_ready_i);
  assign gives_fresh = head_ready_o && completes && !fault;
  assign gives_token = head_ready_o && (head.at_once || head.eol || head.span || fault);
  assign pop_o = flushing && list_valid_i && room_i;
  assign made_o = pop_o || gives_fresh;
  assign item_valid_o = made_o || gives_token;
  assign edge_ready_o = head_ready_o && head.edge_token;
  assign swap_o = head_ready_o && head.eol && !fault;
  assign clear_o = flush_i || (head_ready_o && flags.header);

  // The polygon that goes to the walk.
  logic fresh;
  assign fresh = head.edge_token && begun_q;
  assign goes_on_o = fresh && head.last ? head.goes_on : end_have_q ? end_goes_on_q : fresh || list_goes_on_i;
  assign keep_o = goes_on_o && made_o;
  always_comb begin
    polygon_o = fresh ? fresh_q : list_i;
    if (fresh && head.last) polygon_o[ActiveEndAt+:EndLineBits] = head.end_line;
    else if (end_have_q) polygon_o[ActiveEndAt+:EndLineBits] = end_q;
    else if (fresh) polygon_o[ActiveEndAt+:EndLineBits] = NoEnd;
    if (have_q[0] || fresh) polygon_o[ActiveDownEdgeAt+:WalkedEdgeBits] = side_q[0];
    if (have_q[1] || fresh) polygon_o[ActiveUpEdgeAt+:WalkedEdgeBits] = side_q[1];
    if (fresh) begin
      polygon_o[ActivePlaceAt+:PlaceBits] = place_i;
      if (head.side) polygon_o[ActiveUpEdgeAt+:WalkedEdgeBits] = edge_i;
      else polygon_o[ActiveDownEdgeAt+:WalkedEdgeBits] = edge_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (head_ready_o) index_q <= index;
    if (head_ready_o && flags.header) begin
      width_q <= head_i[HeaderWidthLsb+:X_BITS];
      next_line_q <= EndLineBits'(1);
    end else if (swap_o) begin
      next_line_q <= next_line_q + 1'b1;
    end
    if (clear_o || swap_o) begin
      begun_q <= 1'b0;
      have_q <= 2'b00;
      end_have_q <= 1'b0;
    end else begin
      if (head_ready_o && head.polygon) begun_q <= 1'b1;
      else if (head_ready_o && completes) begun_q <= 1'b0;
      if (pop_o || (head_ready_o && (head.polygon || completes))) begin
        have_q <= 2'b00;
        end_have_q <= 1'b0;
      end else if (head_ready_o && head.edge_token) begin
        have_q[head.side] <= 1'b1;
        if (head.last) end_have_q <= 1'b1;
      end
    end
    // Written in each clock in which the token waits, because whether it leaves is known late. That loses nothing: a
    // polygon of the list that has yet to take its side from here goes first, so list_same_i is low until it has.
    if (head_valid_i && head.edge_token && (begun_q || (list_valid_i && list_same_i))) begin
      side_q[head.side] <= edge_i;
      if (head.last) begin
        end_q <= head.end_line;
        end_goes_on_q <= head.goes_on;
      end
    end
    if (head_valid_i && head.polygon) begin
      fresh_q[ActiveLookAt+:LookBits]   <= head_i[PolygonClassLsb+:LookBits];
      fresh_q[ActiveValueAt+:PlaneBits] <= head_i[PolygonValueLsb+:PlaneBits];
      fresh_q[ActiveRightAt+:PlaneBits] <= head_i[PolygonRightLsb+:PlaneBits];
      fresh_q[ActiveDownAt+:PlaneBits]  <= head_i[PolygonDownLsb+:PlaneBits];
      if (SMOOTH > 0) begin
        for (int c = 0; c < CHANNELS; c++) begin
          fresh_q[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] <=
              ColorPlaneBits'(head_i[PolygonColorLsb+8*c+:8]) << PlaneFrac;
          fresh_q[ActiveGradientsAt+(3*c+1)*ColorPlaneBits+:2*ColorPlaneBits] <= '0;
        end
      end
    end
    if (head_valid_i && head.gradient) begin
      for (int c = 0; c < CHANNELS; c++) begin
        if (head_i[GradientChannelLsb+:2] == 2'(c))
          fresh_q[ActiveGradientsAt+3*c*ColorPlaneBits+:3*ColorPlaneBits] <= head_i[GradientValueLsb+:3*ColorPlaneBits];
      end
    end
  end

  // ---- the item ----------------------------------------------------------------------------------------------------
  assign width_o = width_q;
  assign next_line_o = next_line_q;
  assign ends_line_o = gives_token && head.eol && !fault;
  always_comb begin
    item_flags = flags;
    item_flags.fault = gives_token && fault ? code : ErrNone;
  end
  assign whole = head.span && !fault && head_i[KindBits-1:0] == KindNc &&
      head_i[RangeXlLsb+:X_BITS] == '0 && head_i[RangeXrLsb+:X_BITS] == width_q;
  assign family = flushing ? list_i[ActivePlaceAt+RankBits+:FamilyBits] : place_i[RankBits+:FamilyBits];
  assign item_o = {gives_token && (head.at_once || fault), whole, family, index, item_flags, head_i[OUT_WORDS*32-1:0]};

  logic unused_bits;
  assign unused_bits = ^{head_i, head};

endmodule

`default_nettype wire
