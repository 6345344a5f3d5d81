// SPDX-License-Identifier: Apache-2.0
// Polygons to spans: tokens of a frame at the polygon level in, tokens of the span level out (docs/stream.md, "The
// polygon level"). Frames at the span level pass as they are.
//
//   token_* -> queue -> polygon_token -> front_merge -> polygon_walk -> queue -> volume_ends -> token_*
//   and of EDGE -> hls_edge_setup -> queue -> front_merge     its edge on the line
//   active_list -> front_merge, polygon_walk -> active_list   polygons that cross the line, by place
//
// How: the line's polygons lie in active_list by place, and the line's tokens come by place. Module front_merge
//   compares the two heads by their places, so that neither is ever searched. The result is a register: a token is
//   judged on its way to the head, a polygon on its way to the list's first place, and again when an AT has a new one.
// Handshake: both sides as token_reader's: valid/ready, token and flags stable while they wait. Input drop_i, from
//   behind, is high only in a clock in which a token is taken that does not end its frame. All that is here of the
//   frame is then forgotten, token_valid_o falls, and drop_o has the reader drop the rest of it. Output dropping_o is
//   high until that is done. Output token_ready_o depends on registers only.
// Index: token_index_o is the token's index in the stream; a token made of a polygon has that of the token at hand.
// Faults: flags.fault of a token that is out of its place (ErrPlace), or a polygon too many (ErrActiveFull). After a
//   token at fault the tokens that follow do not matter.
// Latency: 12 clocks for a token; 28 from a polygon's second EDGE to its span. Throughput: a token a clock, a
//   polygon of the line a clock, each once a line; a polygon's tokens come on the line where it begins, and where one
//   of its edges does. A line's EOL is one of its tokens. A line that is crossed by polygons from above waits 3 clocks
//   for the first and costs 6 at least, another one 3.
// Cost: docs/rtl.md; the lists' block RAM, the queues of Depth tokens and edges and of Under spans, the kernels.
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

  if (IN_WORDS < OUT_WORDS || IN_WORDS < PolygonTokenWords) begin : gen_bad_words
    `KAGE_ILLEGAL("IN_WORDS must be at least OUT_WORDS, and a polygon's")
  end

  localparam int Depth = 32;  // of the queues: more than hls_edge_setup has stages, so that edges do not hold up tokens
  localparam int Under = 16;  // items between merge and volume_ends: more than that takes clocks
  localparam int InBits = IN_WORDS * 32;
  localparam int OutBits = OUT_WORDS * 32;

  // ---- dropping ----------------------------------------------------------------------------------------------------
  // From the clock behind drop_i until the reader drops too and the edges on their way have come, everything here is
  // emptied.
  logic dropping_q, owed_q, ended_q, push, edge_in, edge_out;
  logic [4:0] edges_q;  // on their way
  flags_t in_flags;
  assign in_flags = token_flags_i;
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
  logic queue_ready, queue_there, queue_taken, next_valid, next_ready;
  logic [InBits+FlagsBits-1:0] queue_first;
  logic [InBits-1:0] next;
  flags_t next_flags;
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
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (push),
      .in_ready_o (queue_ready),
      .in_data_i  ({token_flags_i, token_i}),
      .out_valid_o(queue_there),
      .out_ready_i(queue_taken),
      .out_data_o (queue_first)
  );
  stream_register #(
      .BITS(InBits + FlagsBits)
  ) u_next (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (queue_there),
      .in_ready_o (queue_taken),
      .in_data_i  (queue_first),
      .out_valid_o(next_valid),
      .out_ready_i(next_ready),
      .out_data_o ({next_flags, next})
  );

  logic edge_room, edge_there, edge_taken, edge_valid, edge_ready, unused_edge;
  logic [WalkedEdgeBits-1:0] edge_made, edge_first, walked_edge;  // the last: of the next EDGE
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
      .x_o        (edge_made[WalkedEdgeXAt+:CrossingBits]),
      .step_o     (edge_made[WalkedEdgeStepAt+:CrossingBits]),
      .rest_o     (edge_made[WalkedEdgeRestAt+:EdgeRestBits]),
      .rest_step_o(edge_made[WalkedEdgeRestStepAt+:EdgeRestBits]),
      .dy_o       (edge_made[WalkedEdgeDyAt+:EdgeRestBits])
  );
  // It has room for all edges, since each has its token in the queue.
  stream_fifo #(
      .BITS (WalkedEdgeBits),
      .DEPTH(Depth)
  ) u_edges (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (edge_out),
      .in_ready_o (edge_room),
      .in_data_i  (edge_made),
      .out_valid_o(edge_there),
      .out_ready_i(edge_taken),
      .out_data_o (edge_first)
  );
  skid_buffer #(
      .BITS(WalkedEdgeBits)
  ) u_edge_next (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (edge_there),
      .in_ready_o (edge_taken),
      .in_data_i  (edge_first),
      .out_valid_o(edge_valid),
      .out_ready_i(edge_ready),
      .out_data_o (walked_edge)
  );

  // ---- the head ----------------------------------------------------------------------------------------------------
  logic head_valid, head_ready;
  logic [InBits-1:0] head_token;
  flags_t head_flags;
  role_t head;
  logic [PlaceBits-1:0] head_place;  // of the line's last AT
  polygon_token #(
      .WORDS(IN_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_head (
      .clk_i,
      .rst_ni,
      .flush_i    (dropping_q),
      .polygons_i (polygons_in_q),
      .in_valid_i (next_valid),
      .in_ready_o (next_ready),
      .token_i    (next),
      .flags_i    (next_flags),
      .out_valid_o(head_valid),
      .out_ready_i(head_ready),
      .token_o    (head_token),
      .flags_o    (head_flags),
      .role_o     (head),
      .place_o    (head_place)
  );

  // ---- merge -------------------------------------------------------------------------------------------------------
  localparam int ItemBits = 2 + FamilyBits + 32 + FlagsBits + OutBits;
  logic list_valid, list_left, list_room, list_before, list_same, list_goes_on, swap_ready, list_pop, keep, swap, clear;
  logic [ActiveBits-1:0] list, polygon;
  logic item, made_in, goes_on, ends_line, room_q;
  logic [ItemBits-1:0] item_in;
  logic [X_BITS-1:0] width;
  logic [EndLineBits-1:0] next_line;
  front_merge #(
      .IN_WORDS (IN_WORDS),
      .OUT_WORDS(OUT_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_merge (
      .clk_i,
      .flush_i       (dropping_q),
      .head_valid_i  (head_valid),
      .head_ready_o  (head_ready),
      .head_i        (head_token),
      .flags_i       (head_flags),
      .role_i        (head),
      .place_i       (head_place),
      .edge_valid_i  (edge_valid),
      .edge_ready_o  (edge_ready),
      .edge_i        (walked_edge),
      .list_valid_i  (list_valid),
      .list_i        (list),
      .list_left_i   (list_left),
      .list_room_i   (list_room),
      .list_before_i (list_before),
      .list_same_i   (list_same),
      .list_goes_on_i(list_goes_on),
      .swap_ready_i  (swap_ready),
      .pop_o         (list_pop),
      .keep_o        (keep),
      .swap_o        (swap),
      .clear_o       (clear),
      .next_line_o   (next_line),
      .room_i        (room_q),
      .width_o       (width),
      .item_valid_o  (item),
      .item_o        (item_in),
      .made_o        (made_in),
      .goes_on_o     (goes_on),
      .ends_line_o   (ends_line),
      .polygon_o     (polygon)
  );

  // ---- the line's polygons -----------------------------------------------------------------------------------------
  logic list_write, swap_write;
  logic [ActiveBits-1:0] next_polygon;
  active_list #(
      .BITS      (ActiveBits),
      .PLACE_AT  (ActivePlaceAt),
      .PLACE_BITS(PlaceBits),
      .END_AT    (ActiveEndAt),
      .END_BITS  (EndLineBits),
      .ACTIVE    (ACTIVE)
  ) u_list (
      .clk_i,
      .rst_ni,
      .clear_i        (clear),
      .place_i        (head_place),
      .renew_i        (head_valid && head.at_token),
      .line_i         (next_line),
      .polygon_valid_o(list_valid),
      .polygon_o      (list),
      .before_o       (list_before),
      .same_o         (list_same),
      .goes_on_o      (list_goes_on),
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

  logic walk_valid, walk_busy;
  logic [MadeSpanBits-1:0] walked;
  polygon_walk #(
      `include "generated/kage_pixel_param_map.svh"
  ) u_walk (
      .clk_i,
      .rst_ni,
      .flush_i     (dropping_q),
      .width_i     (width),
      .in_valid_i  (item),
      .in_made_i   (made_in),
      .in_keep_i   (goes_on),
      .in_swap_i   (ends_line),
      .polygon_i   (polygon),
      .write_o     (list_write),
      .next_o      (next_polygon),
      .swap_write_o(swap_write),
      .out_valid_o (walk_valid),
      .span_o      (walked),
      .busy_o      (walk_busy)
  );

  // ---- what goes beside the walk, the queue behind it, and the way out ---------------------------------------------
  // The walk never waits: an item enters when there is room for it in the queue behind.
  logic [ItemBits-1:0] item_next;
  logic [MadeSpanBits-1:0] span_next;
  logic item_room, item_there, made_room, made_there, made_next;
  logic out_next, item_ready, ending, made_valid, made_ready;
  logic [OutBits-1:0] made;
  logic [FlagsBits-1:0] made_flags;
  logic [31:0] made_index;
  localparam int UnderBits = $clog2(Under + 1);
  logic [UnderBits-1:0] under_q;
  stream_fifo #(
      .BITS (1 + ItemBits),
      .DEPTH(Under)
  ) u_items (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (item),
      .in_ready_o (item_room),
      .in_data_i  ({made_in, item_in}),
      .out_valid_o(item_there),
      .out_ready_i(out_next),
      .out_data_o ({made_next, item_next})
  );
  stream_fifo #(
      .BITS (MadeSpanBits),
      .DEPTH(Under)
  ) u_spans (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (walk_valid),
      .in_ready_o (made_room),
      .in_data_i  (walked),
      .out_valid_o(made_there),
      .out_ready_i(out_next),
      .out_data_o (span_next)
  );
  assign out_next = made_there && item_ready;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || dropping_q) begin
      under_q <= '0;
      room_q  <= 1'b1;
    end else begin
      under_q <= under_q + UnderBits'(item) - UnderBits'(out_next);
      // An item that leaves now makes room a clock later.
      room_q  <= under_q < UnderBits'(Under - 1) || (under_q == UnderBits'(Under - 1) && !item);
    end
  end

  volume_ends #(
      .TOKEN_WORDS(OUT_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_ends (
      .clk_i,
      .rst_ni,
      .flush_i      (dropping_q),
      .width_i      (width),
      .item_valid_i (made_there),
      .item_ready_o (item_ready),
      .item_made_i  (made_next),
      .item_i       (item_next),
      .span_i       (span_next),
      .moving_o     (ending),
      .token_valid_o(made_valid),
      .token_ready_i(made_ready),
      .token_o      (made),
      .token_flags_o(made_flags),
      .token_index_o(made_index)
  );

  logic out_waits;
  skid_buffer #(
      .BITS(OutBits + FlagsBits + 32)
  ) u_out (
      .clk_i,
      .rst_ni     (rst_ni && !dropping_q),
      .in_valid_i (made_valid),
      .in_ready_o (made_ready),
      .in_data_i  ({made_flags, made_index, made}),
      .out_valid_o(out_waits),
      .out_ready_i(out_ready),
      .out_data_o ({out_flags, token_index_o, token_o})
  );
  assign out_valid = out_waits && !dropping_q;
  assign token_valid_o = out_valid;
  assign token_flags_o = out_flags;
  assign out_ready = token_ready_i;

  assign busy_o = queue_there || next_valid || head_valid || under_q != '0 || ending || made_valid || out_valid ||
      dropping_q;
  assign moving_o = push || (queue_there && queue_taken) || (next_valid && next_ready) || head_ready || list_pop ||
      (list_left && !list_valid) || walk_busy || ending || (dropping_q && (!owed_q || token_valid_i)) ||
      edges_q != '0 || (edge_there && edge_taken) || !swap_ready || (!room_q && under_q < UnderBits'(Under));

  logic unused_bits;
  assign unused_bits = ^{head, token_i, in_flags};

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. Only a token that is taken and does not end its frame asks for the rest to be dropped.
      assert (!drop_i || (out_valid && out_ready && !out_flags.ends));
      // 2. There is room for what goes beside.
      assert (!edge_out || edge_room || dropping_q);
      assert (!edge_in || edges_q != '1);
      assert (!room_q || dropping_q || under_q < UnderBits'(Under));
      assert (!item || item_room);
      assert (!walk_valid || made_room);
      assert (!made_there || item_there);
      // 3. One thing goes on at a time: the list's first, or the token at hand.
      assert (!list_pop || !head_ready);
      // 4. A header finds nothing of the frame before in the walk, so nothing comes to be written to the list that it
      //    clears.
      assert (!(head_valid && head_flags.header) || (under_q == '0 && !walk_busy));
    end
  end
`endif

endmodule

`default_nettype wire
