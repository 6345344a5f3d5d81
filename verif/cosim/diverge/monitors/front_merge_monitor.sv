// SPDX-License-Identifier: Apache-2.0
// front_merge from its ports alone: which of the token at hand and the list's first goes on, and as what.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module front_merge_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter  int IN_WORDS  = 6,
    parameter  int OUT_WORDS = 5,
    localparam int ItemBits  = 2 + FamilyBits + 32 + FlagsBits + OUT_WORDS * 32
) (
    input wire logic                      clk_i,
    input wire logic                      flush_i,
    input wire logic                      head_valid_i,
    input wire logic                      head_ready_o,
    input wire logic [   IN_WORDS*32-1:0] head_i,
    input wire logic [     FlagsBits-1:0] flags_i,
    input wire logic [      RoleBits-1:0] role_i,
    input wire logic [     PlaceBits-1:0] place_i,
    input wire logic                      edge_valid_i,
    input wire logic                      edge_ready_o,
    input wire logic [WalkedEdgeBits-1:0] edge_i,
    input wire logic                      list_valid_i,
    input wire logic [    ActiveBits-1:0] list_i,
    input wire logic                      list_left_i,
    input wire logic                      list_room_i,
    input wire logic                      list_before_i,
    input wire logic                      list_same_i,
    input wire logic                      list_goes_on_i,
    input wire logic                      swap_ready_i,
    input wire logic                      pop_o,
    input wire logic                      keep_o,
    input wire logic                      swap_o,
    input wire logic                      clear_o,
    input wire logic [   EndLineBits-1:0] next_line_o,
    input wire logic                      room_i,
    input wire logic [        X_BITS-1:0] width_o,
    input wire logic                      item_valid_o,
    input wire logic [      ItemBits-1:0] item_o,
    input wire logic                      made_o,
    input wire logic                      goes_on_o,
    input wire logic                      ends_line_o,
    input wire logic [    ActiveBits-1:0] polygon_o
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  localparam int BITS = ActiveBits;
  `include "kage_trace_word.svh"

  localparam int OutBits = OUT_WORDS * 32;
  localparam int MostEnd = (1 << (EndLineBits - 1)) - 1;  // of a polygon whose last edges have not come

  role_t head;
  flags_t flags, item_flags, flags_out;
  assign head  = role_i;
  assign flags = flags_i;

  // State of the frame that the module keeps: known from the first header on.
  bit known_q, begun_q, end_known_q, end_goes_on_q;
  bit [1:0] side_known_q;
  int width_q, next_line_q;
  logic [31:0] index_q, index;
  logic [EndLineBits-1:0] end_q;
  logic [WalkedEdgeBits-1:0] sides_q[2];
  logic [ActiveBits-1:0] begun_polygon_q, polygon;

  // The list's first goes on ahead of the token; the token leaves; a polygon begins its way by it; a token goes on.
  bit list_first, pop, leaves, wrong, full, begins, passes, goes_on, whole;
  logic plain_out, whole_out;
  logic [FamilyBits-1:0] family, family_out;
  logic [31:0] index_out;
  logic [OutBits-1:0] token_out;
  assign {plain_out, whole_out, family_out, index_out, flags_out, token_out} = item_o;

  always_comb begin
    list_first = head_valid_i && head.flushes && !begun_q && list_left_i;
    if (list_valid_i) begin
      if (head.polygon) list_first = list_first && (list_before_i || list_same_i);
      else if (!head.eol) list_first = list_first && list_before_i;
    end
    pop   = list_first && list_valid_i && room_i;
    // Behind POLYGON come its GRADIENTs and EDGEs; an EDGE goes to a polygon that begins, or to the list's first.
    wrong = head.misplaced;
    if (head.of_level && begun_q) wrong = wrong || !(head.edge_token || head.gradient);
    if (!begun_q) wrong = wrong || head.gradient || (head.edge_token && !(list_valid_i && list_same_i));
    begins = head.edge_token && begun_q && side_known_q[!head.side];
    full   = begins && !list_room_i;
    leaves = head_valid_i && room_i && !list_first;
    if (head.edge_token) leaves = leaves && edge_valid_i;
    if (head.eol) leaves = leaves && swap_ready_i;
    passes = leaves && (wrong || full || head.at_once || head.eol || head.span);
    begins = begins && leaves && !wrong && !full;
    index = flags.header ? '0 : index_q + 32'd1;
    item_flags = flags;
    item_flags.fault = ErrNone;
    if (wrong) item_flags.fault = ErrPlace;
    if (full) item_flags.fault = ErrActiveFull;
    whole = head.span && !wrong && head_i[KindBits-1:0] == KindNc && head_i[RangeXlLsb+:X_BITS] == '0 &&
        32'(head_i[RangeXrLsb+:X_BITS]) == width_q;
    family = list_first ? list_i[ActivePlaceAt+RankBits+:FamilyBits] : place_i[RankBits+:FamilyBits];

    // The polygon, with the edges that have come for it on this line, and its end by the one that has it.
    polygon = pop ? list_i : begun_polygon_q;
    goes_on = pop ? list_goes_on_i : 1'b1;
    if (!pop) begin
      polygon[ActivePlaceAt+:PlaceBits] = place_i;
      polygon[ActiveEndAt+:EndLineBits] = EndLineBits'(MostEnd);
    end
    if (end_known_q) begin
      polygon[ActiveEndAt+:EndLineBits] = end_q;
      goes_on = end_goes_on_q;
    end
    if (side_known_q[0]) polygon[ActiveDownEdgeAt+:WalkedEdgeBits] = sides_q[0];
    if (side_known_q[1]) polygon[ActiveUpEdgeAt+:WalkedEdgeBits] = sides_q[1];
    if (!pop && begins) begin
      if (head.side) polygon[ActiveUpEdgeAt+:WalkedEdgeBits] = edge_i;
      else polygon[ActiveDownEdgeAt+:WalkedEdgeBits] = edge_i;
      if (head.last) begin
        polygon[ActiveEndAt+:EndLineBits] = head.end_line;
        goes_on = head.goes_on;
      end
    end
  end

  always @(posedge clk_i) begin
    if (flush_i) begin
      {known_q, begun_q, end_known_q, side_known_q} = '0;
    end else if (known_q || (head_valid_i && flags.header)) begin
      trace_module(
          PartFrontMerge, {
          503'd0,
          leaves,
          leaves && head.edge_token,
          pop,
          (pop || begins) && goes_on,
          leaves && head.eol && !wrong,
          leaves && flags.header,
          pop || begins || passes,
          pop || begins,
          passes && head.eol && !wrong
          }, {503'd0, head_ready_o, edge_ready_o, pop_o, keep_o, swap_o, clear_o, item_valid_o, made_o, ends_line_o});
      if (known_q)
        trace_module(PartFrontMerge, 512'({X_BITS'(width_q), EndLineBits'(next_line_q)}), 512'({width_o, next_line_o}));
      if (pop || begins) begin
        trace_module(PartFrontMerge, 512'({goes_on, 1'b0, family, index}), 512'({
                     goes_on_o, plain_out, family_out, index_out}));
        trace_module(PartFrontMerge, folded(polygon), folded(polygon_o));
      end else if (passes) begin
        trace_module(PartFrontMerge, 512'({head.at_once || wrong || full, whole, family, index, item_flags}), 512'({
                     plain_out, whole_out, family_out, index_out, flags_out}));
        trace_module(PartFrontMerge, 512'(head_i[OutBits-1:0]), 512'(token_out));
      end
      if (pop) {side_known_q, end_known_q} = '0;
      if (leaves) begin
        index_q = index;
        if (flags.header) begin
          known_q = 1'b1;
          width_q = 32'(head_i[HeaderWidthLsb+:X_BITS]);
          next_line_q = 1;
          {begun_q, end_known_q, side_known_q} = '0;
        end else if (wrong || full) begin
          known_q = 1'b0;  // what comes does not matter
        end else if (head.eol) begin
          next_line_q = next_line_q + 1;
          {begun_q, end_known_q, side_known_q} = '0;
        end else if (head.polygon) begin
          begun_q = 1'b1;
          {end_known_q, side_known_q} = '0;
          begun_polygon_q = '0;
          begun_polygon_q[ActiveLookAt+:LookBits] = head_i[PolygonClassLsb+:LookBits];
          begun_polygon_q[ActiveValueAt+:3*PlaneBits] = head_i[PolygonValueLsb+:3*PlaneBits];
          for (int c = 0; c < CHANNELS && SMOOTH > 0; c++)
          begun_polygon_q[ActiveGradientsAt+3*c*ColorPlaneBits+PlaneFrac+:8] = head_i[PolygonColorLsb+8*c+:8];
        end else if (head.gradient) begin
          for (int c = 0; c < CHANNELS && SMOOTH > 0; c++) begin
            if (32'(head_i[GradientChannelLsb+:2]) == c)
              begun_polygon_q[ActiveGradientsAt+3*c*ColorPlaneBits+:3*ColorPlaneBits] =
                  head_i[GradientValueLsb+:3*ColorPlaneBits];
          end
        end else if (begins) begin
          begun_q = 1'b0;
          {end_known_q, side_known_q} = '0;
        end else if (head.edge_token) begin
          sides_q[head.side] = edge_i;
          side_known_q[head.side] = 1'b1;
          if (head.last) begin
            end_known_q = 1'b1;
            end_q = head.end_line;
            end_goes_on_q = head.goes_on;
          end
        end
      end
    end
  end

endmodule

bind front_merge front_merge_monitor #(
    .IN_WORDS (IN_WORDS),
    .OUT_WORDS(OUT_WORDS),
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
