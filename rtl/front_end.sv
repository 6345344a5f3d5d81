// SPDX-License-Identifier: Apache-2.0
// Polygons to spans: tokens of a frame at the polygon level in, tokens of the span level out (docs/stream.md, "The
// polygon level"). Frames at the span level pass as they are.
//
//   token_* -> queue, and of EDGE -> hls_edge_setup -> merge -> polygon_walk -> volume_ends -> token_*
//   active_list -> merge, polygon_walk -> active_list         polygons that cross the line, by place
//
// How: the line's polygons lie in active_list by place, and so do the tokens that the line brings. merge compares the
//   two heads by their places, so that neither is ever searched.
// Handshake: both sides as token_reader's: valid/ready, token and flags stable while they wait. drop_i, from behind, is
//   high only in a clock in which a token is taken that does not end its frame: all that is here of the frame is
//   forgotten, and drop_o has the reader drop the rest of it. dropping_o: that is not done yet. token_ready_o depends on
//   registers only.
// Index: token_index_o is that of the token in the stream; what is made of a polygon has that of the token at hand.
// Faults: flags.fault of a token that is out of its place (ErrPlace), or a polygon too many (ErrActiveFull). After a
//   token at fault what comes does not matter.
// Latency: 8 clocks for a token; 28 from a polygon's second EDGE to its span. Throughput: a token a clock, a
//   polygon of the line a clock, each once a line; a polygon's tokens come on the line where it begins, and where one
//   of its edges does. A line costs 3 clocks at least.
// Cost: docs/rtl.md; the lists' block RAM, the queues of Depth tokens and edges, the kernels.
`default_nettype none
`include "kage_illegal.svh"

module front_end #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int ACTIVE = 512,
    parameter int IN_WORDS = 6,  // of a token that comes in
    parameter int OUT_WORDS = 5  // of one that leaves
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from token_reader
    input  wire logic                   token_valid_i,
    output logic                        token_ready_o,
    input  wire logic [IN_WORDS*32-1:0] token_i,
    input  wire logic [  FlagsBits-1:0] token_flags_i,
    output logic                        drop_o,
    input  wire logic                   dropping_i,

    // to frame_control
    output logic                         token_valid_o,
    input  wire logic                    token_ready_i,
    output logic      [OUT_WORDS*32-1:0] token_o,
    output logic      [   FlagsBits-1:0] token_flags_o,
    output logic      [            31:0] token_index_o,
    input  wire logic                    drop_i,
    output logic                         dropping_o,

    output logic busy_o,   // something of a frame is in here
    output logic moving_o  // and moves, though no token comes in
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

  if (ACTIVE < 1) begin : gen_bad_active
    `KAGE_ILLEGAL("ACTIVE must be at least 1 where there is a front end")
  end

  localparam int Depth = 32;  // of the queues: more than hls_edge_setup has stages, so that edges do not hold up tokens
  localparam int InBits = IN_WORDS * 32;
  localparam int OutBits = OUT_WORDS * 32;
  localparam int EndLineBits = 17;
  localparam logic [EndLineBits-1:0] NoEnd = 17'h0FFFF;

  // ---- dropping ----------------------------------------------------------------------------------------------------
  // From drop_i until the reader drops too and the edges on their way have come, everything here is empty.
  logic dropping_q, owed_q, flush, ended_q, push, edge_in, edge_out;
  logic [4:0] edges_q;  // on their way
  flags_t in_flags;
  assign in_flags = token_flags_i;
  assign flush = drop_i || dropping_q;
  assign drop_o = dropping_q && owed_q && token_valid_i && !in_flags.ends;
  assign dropping_o = dropping_q || dropping_i;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      dropping_q <= 1'b0;
      owed_q <= 1'b0;
      edges_q <= '0;
    end else begin
      edges_q <= edges_q + 5'(edge_in) - 5'(edge_out);
      if (drop_i) begin
        dropping_q <= 1'b1;
        owed_q <= !ended_q && !(push && in_flags.ends);
      end else if (dropping_q) begin
        if (token_valid_i) owed_q <= 1'b0;
        if ((!owed_q || token_valid_i) && edges_q == '0) dropping_q <= 1'b0;
      end
    end
  end

  // ---- the queue of tokens, and of edges ---------------------------------------------------------------------------
  // Behind a token that ends its frame none comes in until it has left, so all that is here is of one frame.
  logic queue_ready, head_valid, head_ready;
  logic [InBits-1:0] head;
  flags_t head_flags;
  logic polygons_in_q;  // the frame that comes in is at the polygon level
  logic [LineNumberBits-1:0] line_in_q;
  logic out_valid, out_ready;
  flags_t out_flags;
  assign token_ready_o = dropping_q ? owed_q : queue_ready && !ended_q;
  assign push = token_valid_i && queue_ready && !ended_q && !dropping_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) ended_q <= 1'b0;
    else if (push) ended_q <= in_flags.ends;
    else if (dropping_q || (out_valid && out_ready && out_flags.ends)) ended_q <= 1'b0;
    if (push && in_flags.header) begin
      polygons_in_q <= token_i[HeaderVersionLsb+:HeaderVersionBits] == HeaderVersionBits'(PolygonVersion);
      line_in_q <= '0;
    end else if (push && token_i[KindBits-1:0] == KindEol) begin
      line_in_q <= line_in_q + 1'b1;
    end
  end

  stream_fifo #(
      .BITS (InBits + FlagsBits),
      .DEPTH(Depth)
  ) u_tokens (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (push),
      .in_ready_o (queue_ready),
      .in_data_i  ({token_flags_i, token_i}),
      .out_valid_o(head_valid),
      .out_ready_i(head_ready),
      .out_data_o ({head_flags, head})
  );

  logic edge_room, edge_valid, edge_ready, unused_edge;
  logic [WalkedEdgeBits-1:0] edge_made, edge_at_head;
  assign edge_in = push && polygons_in_q && !in_flags.header && !in_flags.cut && token_i[KindBits-1:0] == KindEdge;
  hls_edge_setup u_edge (
      .clk_i,
      .rst_ni,
      .in_valid_i (edge_in),
      .in_ready_o (unused_edge),
      .out_valid_o(edge_out),
      .out_ready_i(1'b1),
      .top_x_i    (token_i[EdgeTopXLsb+:SubpixelBits]),
      .top_y_i    (token_i[EdgeTopYLsb+:SubpixelBits]),
      .bottom_x_i (token_i[EdgeBottomXLsb+:SubpixelBits]),
      .bottom_y_i (token_i[EdgeBottomYLsb+:SubpixelBits]),
      .line_i     (line_in_q),
      .x_o        (edge_made[0+:17]),
      .step_o     (edge_made[17+:17]),
      .rest_o     (edge_made[34+:24]),
      .rest_step_o(edge_made[58+:24]),
      .dy_o       (edge_made[82+:24])
  );
  // It has room for all edges, since each has its token in the queue.
  stream_fifo #(
      .BITS (WalkedEdgeBits),
      .DEPTH(Depth)
  ) u_edges (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (edge_out),
      .in_ready_o (edge_room),
      .in_data_i  (edge_made),
      .out_valid_o(edge_valid),
      .out_ready_i(edge_ready),
      .out_data_o (edge_at_head)
  );

  // ---- the frame and the line, as the token at the head finds them -------------------------------------------------
  logic polygons_q;
  logic [X_BITS-1:0] width_q;
  logic [LineNumberBits-1:0] line_q;
  logic [31:0] index_q, index;
  logic placed_q;  // the line has had an AT
  logic [PlaceBits-1:0] place_q;
  logic begun_q;  // a POLYGON waits for its edges
  logic [1:0] have_q;  // sides that have come of it, or of the list's first
  logic [WalkedEdgeBits-1:0] side_q[2];
  logic end_have_q;
  logic [EndLineBits-1:0] end_q;
  logic [ActiveBits-1:0] fresh_q;  // the POLYGON's look and planes

  // ---- the token at the head ---------------------------------------------------------------------------------------
  logic [KindBits-1:0] kind;
  logic of_level, is_at, is_polygon, is_gradient, is_edge, is_eol, is_span, at_once;
  logic [PlaceBits-1:0] place;
  logic [1:0] layer, layer_of_span;
  assign kind = head[KindBits-1:0];
  assign of_level = polygons_q && !head_flags.header && !head_flags.cut && !head_flags.lacking;
  assign is_at = of_level && kind == KindAt;
  assign is_polygon = of_level && kind == KindPolygon;
  assign is_gradient = of_level && SMOOTH > 0 && kind == KindGradient;
  assign is_edge = of_level && kind == KindEdge;
  assign is_eol = of_level && kind == KindEol;
  assign is_span = of_level && kind_has_range(kind) && !is_polygon && !is_edge;
  assign at_once = !is_at && !is_polygon && !is_gradient && !is_edge && !is_eol && !is_span;
  assign place = head[AtRankLsb+:PlaceBits];
  assign layer = place[PlaceBits-1-:2];
  assign layer_of_span = kind == KindOp ? 2'd0 : kind == KindTp ? 2'd2 : 2'd1;
  assign index = head_flags.header ? '0 : index_q + 32'd1;

  logic side, last;
  logic [EndLineBits-1:0] end_here;
  logic [ SubpixelBits:0] past_bottom;
  assign side = head[EdgeSideLsb];
  assign last = head[EdgeLastLsb];
  assign past_bottom = {head[EdgeBottomYLsb+SubpixelBits-1], head[EdgeBottomYLsb+:SubpixelBits]} + 25'd127;
  assign end_here = past_bottom[SubpixelBits-:EndLineBits];

  // ---- merge -------------------------------------------------------------------------------------------------------
  logic list_valid, list_left, list_room, swap_ready, list_pop, keep, swap, clear;
  logic [ActiveBits-1:0] list;
  logic [ PlaceBits-1:0] list_place;
  logic misplaced, sooner, up_to, flushing, completes, fault, act, item, go, early;
  logic gives_list, gives_fresh, gives_token, has_layer, has_light;
  logic [CodeBits-1:0] code;
  assign list_place = list[ActivePlaceAt+:PlaceBits];
  assign has_layer  = layer == 2'd0 || (layer == 2'd1 && DSF_BITS > 0) || (layer == 2'd2 && TRANSLUCENCY > 0);
  assign has_light  = layer != 2'd1 || {1'b0, place[RankBits+VolumeBits+:3]} < 4'(LIGHTS);
  // Known before the list is asked.
  always_comb begin
    misplaced = of_level && begun_q && !is_edge && !is_gradient;
    if (is_at && (!has_layer || !has_light || (placed_q && place < place_q))) misplaced = 1'b1;
    if ((is_polygon || is_edge || is_span) && !placed_q) misplaced = 1'b1;
    if (is_span && place_q[PlaceBits-1-:2] != layer_of_span) misplaced = 1'b1;
    if (is_gradient && (!begun_q || head[GradientChannelLsb+:2] >= 2'(CHANNELS))) misplaced = 1'b1;
  end
  assign sooner = list_place < place_q;
  assign up_to = is_polygon && list_place == place_q;
  // The list's polygons that come before the token are given first.
  assign flushing = !misplaced && (is_polygon || is_span || is_eol || (is_edge && !begun_q)) && list_left &&
      (!list_valid || is_eol || sooner || up_to);
  assign completes = is_edge && begun_q && have_q[!side];
  always_comb begin
    fault = misplaced;
    code  = ErrPlace;
    if (is_edge && !begun_q && (!list_valid || !list_left || list_place != place_q)) fault = 1'b1;
    if (completes && !list_room) begin
      fault = 1'b1;
      code  = ErrActiveFull;
    end
  end
  assign act = head_valid && !flushing && (!is_edge || edge_valid) && (!is_eol || swap_ready) &&
      (!head_flags.header || !early);
  assign gives_list = head_valid && flushing && list_valid;
  assign gives_fresh = act && completes && !fault;
  assign gives_token = act && (at_once || is_eol || is_span || fault);
  assign item = gives_list || gives_fresh || gives_token;
  assign head_ready = act && (!item || go);
  assign edge_ready = head_ready && is_edge;
  assign list_pop = gives_list && go;
  assign swap = head_ready && is_eol && !fault;
  assign clear = flush || (head_ready && head_flags.header);

  // The polygon that goes to the walk.
  logic [ActiveBits-1:0] polygon;
  logic [EndLineBits-1:0] polygon_end;
  logic goes_on;
  assign polygon_end = gives_list ? (end_have_q ? end_q : list[ActiveEndAt+:EndLineBits]) :
      last ? end_here : end_have_q ? end_q : NoEnd;
  assign goes_on = $signed(polygon_end) > $signed(EndLineBits'(line_q) + EndLineBits'(1));
  assign keep = (gives_list || gives_fresh) && goes_on && go;
  always_comb begin
    polygon = gives_list ? list : fresh_q;
    polygon[ActiveEndAt+:EndLineBits] = polygon_end;
    if (have_q[0] || !gives_list) polygon[ActiveDownEdgeAt+:WalkedEdgeBits] = side_q[0];
    if (have_q[1] || !gives_list) polygon[ActiveUpEdgeAt+:WalkedEdgeBits] = side_q[1];
    if (!gives_list) begin
      polygon[ActivePlaceAt+:PlaceBits] = place_q;
      if (side) polygon[ActiveUpEdgeAt+:WalkedEdgeBits] = edge_at_head;
      else polygon[ActiveDownEdgeAt+:WalkedEdgeBits] = edge_at_head;
    end
  end

  always_ff @(posedge clk_i) begin
    if (head_ready) index_q <= index;
    if (head_ready && head_flags.header) begin
      polygons_q <= head[HeaderVersionLsb+:HeaderVersionBits] == HeaderVersionBits'(PolygonVersion);
      width_q <= head[HeaderWidthLsb+:X_BITS];
      line_q <= '0;
    end else if (swap) begin
      line_q <= line_q + 1'b1;
    end
    if (clear || swap) begin
      placed_q <= 1'b0;
      begun_q <= 1'b0;
      have_q <= 2'b00;
      end_have_q <= 1'b0;
    end else begin
      if (head_ready && is_at) placed_q <= 1'b1;
      if (head_ready && is_polygon) begun_q <= 1'b1;
      else if (head_ready && completes) begun_q <= 1'b0;
      if (list_pop || (head_ready && (is_polygon || completes))) begin
        have_q <= 2'b00;
        end_have_q <= 1'b0;
      end else if (head_ready && is_edge) begin
        have_q[side] <= 1'b1;
        if (last) end_have_q <= 1'b1;
      end
    end
    if (head_ready && is_at) place_q <= place;
    if (head_ready && is_edge) begin
      side_q[side] <= edge_at_head;
      if (last) end_q <= end_here;
    end
    if (head_ready && is_polygon) begin
      fresh_q[ActiveLookAt+:LookBits]   <= head[PolygonClassLsb+:LookBits];
      fresh_q[ActiveValueAt+:PlaneBits] <= head[PolygonValueLsb+:PlaneBits];
      fresh_q[ActiveRightAt+:PlaneBits] <= head[PolygonRightLsb+:PlaneBits];
      fresh_q[ActiveDownAt+:PlaneBits]  <= head[PolygonDownLsb+:PlaneBits];
      if (SMOOTH > 0) begin
        for (int c = 0; c < CHANNELS; c++) begin
          fresh_q[ActiveGradientsAt+3*c*ColorPlaneBits+:ColorPlaneBits] <=
              ColorPlaneBits'(head[PolygonColorLsb+8*c+:8]) << PlaneFrac;
          fresh_q[ActiveGradientsAt+(3*c+1)*ColorPlaneBits+:2*ColorPlaneBits] <= '0;
        end
      end
    end
    if (head_ready && is_gradient) begin
      for (int c = 0; c < CHANNELS; c++) begin
        if (head[GradientChannelLsb+:2] == 2'(c))
          fresh_q[ActiveGradientsAt+3*c*ColorPlaneBits+:3*ColorPlaneBits] <= head[GradientValueLsb+:3*ColorPlaneBits];
      end
    end
  end

  // ---- the line's polygons -----------------------------------------------------------------------------------------
  logic list_write, swap_write;
  logic [ActiveBits-1:0] next_polygon;
  active_list #(
      .BITS  (ActiveBits),
      .ACTIVE(ACTIVE)
  ) u_list (
      .clk_i,
      .rst_ni,
      .clear_i        (clear),
      .polygon_valid_o(list_valid),
      .polygon_o      (list),
      .pop_i          (list_pop),
      .left_o         (list_left),
      .keep_i         (keep),
      .room_o         (list_room),
      .swap_i         (swap),
      .swap_ready_o   (swap_ready),
      .write_i        (list_write),
      .polygon_i      (next_polygon),
      .swap_write_i   (swap_write)
  );

  logic walk_valid, walk_made, walk_busy, item_ready, ending;
  logic [MadeSpanBits-1:0] span;
  assign go = !walk_valid || item_ready;
  polygon_walk #(
      `include "generated/kage_pixel_param_map.svh"
  ) u_walk (
      .clk_i,
      .rst_ni,
      .flush_i     (flush),
      .go_i        (go),
      .width_i     (width_q),
      .in_valid_i  (item),
      .in_made_i   (gives_list || gives_fresh),
      .in_keep_i   (goes_on),
      .in_swap_i   (gives_token && is_eol && !fault),
      .polygon_i   (polygon),
      .write_o     (list_write),
      .next_o      (next_polygon),
      .swap_write_o(swap_write),
      .early_o     (early),
      .out_valid_o (walk_valid),
      .out_made_o  (walk_made),
      .span_o      (span),
      .busy_o      (walk_busy)
  );

  // ---- what goes beside the walk, and the way out ------------------------------------------------------------------
  localparam int ItemBits = 1 + FamilyBits + 32 + FlagsBits + OutBits;
  logic [ItemBits-1:0] item_in, item_out;
  logic item_room, item_there, made_valid, made_ready;
  logic [OutBits-1:0] made;
  flags_t item_flags, made_flags;
  logic [31:0] made_index;
  logic [FamilyBits-1:0] family;
  always_comb begin
    item_flags = head_flags;
    item_flags.fault = gives_token && fault ? code : ErrNone;
  end
  assign family  = gives_list ? list[ActivePlaceAt+RankBits+:FamilyBits] : place_q[RankBits+:FamilyBits];
  assign item_in = {gives_token && (at_once || fault), family, index, item_flags, head[OutBits-1:0]};
  stream_fifo #(
      .BITS (ItemBits),
      .DEPTH(8)
  ) u_items (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (item && go),
      .in_ready_o (item_room),
      .in_data_i  (item_in),
      .out_valid_o(item_there),
      .out_ready_i(walk_valid && item_ready),
      .out_data_o (item_out)
  );

  volume_ends #(
      .TOKEN_WORDS(OUT_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_ends (
      .clk_i,
      .rst_ni,
      .flush_i      (flush),
      .width_i      (width_q),
      .item_valid_i (walk_valid),
      .item_ready_o (item_ready),
      .item_made_i  (walk_made),
      .item_i       (item_out),
      .span_i       (span),
      .moving_o     (ending),
      .token_valid_o(made_valid),
      .token_ready_i(made_ready),
      .token_o      (made),
      .token_flags_o(made_flags),
      .token_index_o(made_index)
  );

  skid_buffer #(
      .BITS(OutBits + FlagsBits + 32)
  ) u_out (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (made_valid),
      .in_ready_o (made_ready),
      .in_data_i  ({made_flags, made_index, made}),
      .out_valid_o(out_valid),
      .out_ready_i(out_ready),
      .out_data_o ({out_flags, token_index_o, token_o})
  );
  assign token_valid_o = out_valid;
  assign token_flags_o = out_flags;
  assign out_ready = token_ready_i;

  assign busy_o = head_valid || walk_busy || out_valid || dropping_q;
  assign moving_o = push || head_ready || list_pop || (list_left && !list_valid) || (go && walk_busy) || ending ||
      (dropping_q && (!owed_q || token_valid_i)) ||
      edges_q != '0 || !swap_ready;

  logic unused_bits;
  assign unused_bits = ^{head, token_i, in_flags, past_bottom};

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. Only a token that is taken and does not end its frame asks for the rest to be dropped.
      assert (!drop_i || (out_valid && out_ready && !out_flags.ends));
      // 2. There is room for what goes beside.
      assert (!edge_out || edge_room || flush);
      assert (!item || !go || item_room);
      assert (walk_valid == (item_there && walk_valid));
    end
  end
`endif

endmodule

`default_nettype wire
