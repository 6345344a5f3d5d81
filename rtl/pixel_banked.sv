// SPDX-License-Identifier: Apache-2.0
// The pixels of a line in block RAM, LANES to a word: spans are walked one aligned group of LANES pixels a clock.
//
// Handshake: cmd_* is valid/ready; its contract is frame_control's. An EOL, or a CmdOut, starts its pass when
//   exit_free_i is high, and takes the buffer by a clock of exit_take_o. Then it brings the line's groups in order by
//   exit_valid_o, without stops, the last with exit_last_o. Pixels past the line's width in the last group are void.
// Tree (UNITS > 0): tree_line holds the tree's line, filled ahead of its TREE. A TREE waits until the line is in it
//   whole, then reads it group by group along with the state. tree_drop_i forgets a part of a line.
// Clocks: a command takes as many as the groups it touches, with none between commands. The pass of an EOL or CmdOut
//   takes one per group of the line; EOL leaves cleared state behind. After reset a sweep of all groups comes first:
//   what the RAM held never matters.
// Latency: set-up 2 clocks, or 3 where a group has more than four lanes, walker 1, lane values and RAM $clog2(LANES) +
//   2, what is found ahead 1, next state 1, write 1. Throughput: a group a clock.
// Hazards: a group is read 4 clocks before its next state is written, and the four results under way are forwarded. The
//   result right before is not there yet, so depth is compared twice, a clock early: with the stored depth, as if that
//   result changed nothing, and with the depth that it may bring. Bit moved_q selects the answer. Behind an EOL every
//   depth is in front; a blank pixel of the tree then draws what a clear pixel is. tree_line has its own hazards.
// Cost: one RAM of ceil(MAX_WIDTH / LANES) words, LANES x state bits wide, with one read and one write port; two
//   comparisons of depth a lane; with units tree_line.
`default_nettype none

module pixel_banked #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 4,
    parameter int MAX_WIDTH = 640,
    localparam int ExitLanes = LANES
) (
    `include "kage_pixel_ports.svh"
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "kage_pixel_next.svh"

  localparam int Groups = (MAX_WIDTH + LANES - 1) / LANES;
  localparam int AddrBits = Groups > 1 ? $clog2(Groups) : 1;
  localparam int Levels = $clog2(LANES);
  localparam int SomeXBits = X_BITS > Levels ? X_BITS : Levels + 1;  // a position's, where a line is less than a group
  localparam int OffBits = LANES > 1 ? Levels : 1;
  localparam int WordBits = LANES * PixelBits;
  localparam int Last = Levels + 3;  // the stage at which a group's next state is computed; the walker is stage 0

  command_t cmd;
  assign cmd = cmd_i;

  // ---- set-up stages -----------------------------------------------------------------------------------------------
  // Unchanged fields: {leaves, tree, kind, count, weight, colour, first group, last group, first lane, last lane}.
  localparam int FlatBits = SMOOTH > 0 ? 1 : RgbBits;
  localparam int SetBits = 2 + KindBits + CountBits + ShareBits + FlatBits + 2 * AddrBits + 2 * OffBits;
  // The last stage is a queue of two, and each lane_ramp has one of its own that moves with it. The walker, which knows
  // the end of a span late, moves only pointers; the enables of all stages ahead of it come from the queue's registers.
  // Ahead of it are as many stages as lane_ramp has there.
  localparam int SetStages = LANES > 4 ? 2 : 1;
  logic [SetBits-1:0] set_d, set_oldest;
  logic [SetStages*SetBits-1:0] set_q;
  logic [SetStages-1:0] set_valid_q, set_en;
  logic set_room, set_valid;
  logic [  X_BITS-1:0] x_last;
  logic [FlatBits-1:0] flat;
  logic [AddrBits-1:0] group_first, group_last;
  logic [OffBits-1:0] lane_first, lane_last;
  logic set_take, tree_here, tree_moving;  // the tree's line is in its buffer; something of it moves

  assign x_last = cmd.xr - 1'b1;
  assign flat = SMOOTH > 0 ? '0 : cmd.color[FlatBits-1:0];
  assign group_first = AddrBits'(SomeXBits'(cmd.xl) >> Levels);
  assign group_last = AddrBits'(SomeXBits'(x_last) >> Levels);
  assign lane_first = LANES > 1 ? OffBits'(cmd.xl) : '0;
  assign lane_last = LANES > 1 ? OffBits'(x_last) : '0;
  // A pass in which the line's pixels leave, of EOL or CmdOut; a TREE.
  logic cmd_leaves, cmd_tree;
  assign cmd_leaves = cmd.kind == KindEol || (HasLoads && cmd.kind == CmdOut);
  assign cmd_tree = UNITS > 0 && cmd.kind == KindTree;
  assign set_d = {
    cmd_leaves,
    cmd_tree,
    cmd.kind,
    cmd.count,
    pixel_weight(cmd.kind, cmd.share),
    flat,
    group_first,
    group_last,
    lane_first,
    lane_last
  };
  for (genvar k = 0; k < SetStages; k++) begin : gen_set_en
    assign set_en[k] = !(&set_valid_q[SetStages-1:k]) || set_room;
  end
  assign cmd_ready_o = set_en[0];
  // Place k is what stage k takes.
  logic [SetStages:0] set_has;
  logic [(SetStages+1)*SetBits-1:0] set_way;
  assign set_has = {set_valid_q, cmd_valid_i};
  assign set_way = {set_q, set_d};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      set_valid_q <= '0;
    end else begin
      for (int k = 0; k < SetStages; k++) if (set_en[k]) set_valid_q[k] <= set_has[k];
    end
    for (int k = 0; k < SetStages; k++) if (set_en[k]) set_q[k*SetBits+:SetBits] <= set_way[k*SetBits+:SetBits];
  end

  stream_fifo #(
      .BITS (SetBits),
      .DEPTH(2)
  ) u_set (
      .clk_i,
      .rst_ni,
      .in_valid_i (set_valid_q[SetStages-1]),
      .in_ready_o (set_room),
      .in_data_i  (set_way[SetStages*SetBits+:SetBits]),
      .out_valid_o(set_valid),
      .out_ready_i(set_take),
      .out_data_o (set_oldest)
  );

  // ---- walker, stage 0 ---------------------------------------------------------------------------------------------
  logic [ KindBits-1:0] next_kind;
  logic [CountBits-1:0] next_count;
  logic [ShareBits-1:0] next_weight;
  logic [ FlatBits-1:0] next_flat;
  logic [AddrBits-1:0] next_group, next_end;
  logic [OffBits-1:0] next_lane_first, next_lane_last;
  logic next_leaves, next_tree;
  assign {
    next_leaves,
    next_tree,
    next_kind,
    next_count,
    next_weight,
    next_flat,
    next_group,
    next_end,
    next_lane_first,
    next_lane_last
  } = set_oldest;

  logic walk_valid_q, walk_first_q, walk_at_end_q, walk_leaves_q, step;
  logic [ KindBits-1:0] walk_kind_q;
  logic [CountBits-1:0] walk_count_q;
  logic [ShareBits-1:0] walk_weight_q;
  logic [ FlatBits-1:0] walk_flat_q;
  logic [AddrBits-1:0] walk_group_q, walk_end_q;
  logic [OffBits-1:0] walk_lane_first_q, walk_lane_last_q;
  logic walk_eol;

  assign walk_eol = walk_kind_q == KindEol;
  assign step = walk_valid_q && !walk_at_end_q;
  assign set_take = set_valid && !step && (!next_leaves || exit_free_i) && (UNITS == 0 || !next_tree || tree_here);
  assign exit_take_o = set_take && next_leaves;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      // The sweep: an EOL over all groups whose pixels go nowhere.
      walk_valid_q <= 1'b1;
      walk_leaves_q <= 1'b0;
      walk_kind_q <= KindEol;
      walk_group_q <= '0;
      walk_end_q <= AddrBits'(Groups - 1);
      walk_at_end_q <= Groups == 1;
    end else if (step) begin
      walk_group_q  <= walk_group_q + 1'b1;
      walk_at_end_q <= walk_group_q + 1'b1 == walk_end_q;
      walk_first_q  <= 1'b0;
    end else begin
      walk_valid_q <= set_take;
      if (set_take) begin
        walk_first_q <= 1'b1;
        walk_leaves_q <= next_leaves;
        walk_kind_q <= next_kind;
        walk_count_q <= next_count;
        walk_weight_q <= next_weight;
        walk_flat_q <= next_flat;
        walk_group_q <= next_group;
        walk_end_q <= next_end;
        walk_at_end_q <= next_group == next_end;
        walk_lane_first_q <= next_lane_first;
        walk_lane_last_q <= next_lane_last;
      end
    end
  end

  // Lanes of this group that lie in the span; all of them at the end of a line, so that it leaves no pixel behind.
  logic [LANES-1:0] walk_lanes;
  always_comb begin
    walk_lanes = '0;
    for (int l = 0; l < LANES; l++) begin
      walk_lanes[l] = walk_eol || ((!walk_first_q || OffBits'(l) >= walk_lane_first_q) &&
                                   (!walk_at_end_q || OffBits'(l) <= walk_lane_last_q));
    end
  end

  // ---- ramps -------------------------------------------------------------------------------------------------------
  logic [LANES*Z_BITS-1:0] lane_z;
  lane_ramp #(
      .LANES(LANES),
      .BITS(DepthBits),
      .FRAC(Z_FRAC),
      .LO(1),
      .HI(32'(MostDepth)),
      .OUT_BITS(Z_BITS)
  ) u_depth (
      .clk_i,
      .rst_ni,
      .set_en_i(set_en),
      .put_i   (set_valid_q[SetStages-1]),
      .start_i (cmd.z),
      .slope_i (cmd.dz),
      .offset_i(lane_first),
      .load_i  (set_take),
      .step_i  (step),
      .value_o (lane_z)
  );

  logic [LANES*LaneRgbBits-1:0] lane_color;
  if (SMOOTH > 0) begin : gen_smooth
    logic unused_flat;
    assign unused_flat = ^walk_flat_q;
    for (genvar c = 0; c < CHANNELS; c++) begin : gen_channel
      logic [LANES*LaneLevelBits-1:0] value;
      lane_ramp #(
          .LANES(LANES),
          .BITS(RampBits),
          .FRAC(COLOR_FRAC + 8 - LaneLevelBits),
          .LO(0),
          .HI((1 << LaneLevelBits) - 1),
          .OUT_BITS(LaneLevelBits)
      ) u_color (
          .clk_i,
          .rst_ni,
          .set_en_i(set_en),
          .put_i   (set_valid_q[SetStages-1]),
          .start_i (cmd.color[c*RampBits+:RampBits]),
          .slope_i (cmd.dcolor[c*RampBits+:RampBits]),
          .offset_i(lane_first),
          .load_i  (set_take),
          .step_i  (step),
          .value_o (value)
      );
      for (genvar l = 0; l < LANES; l++) begin : gen_lane
        assign lane_color[l*LaneRgbBits+c*LaneLevelBits+:LaneLevelBits] = value[l*LaneLevelBits+:LaneLevelBits];
      end
    end
  end

  // ---- what goes along with a group, stage 1 .. Last ---------------------------------------------------------------
  // {count, weight, kind, lanes, address, last of its line, leaves}; the walker's flat colour likewise.
  localparam int InfoBits = KindBits + CountBits + ShareBits + LANES + AddrBits + 2;
  logic [Last*InfoBits-1:0] info_q;
  logic [Last:0] valid;  // bit k: stage k holds a group
  logic [Last-1:0] valid_q;
  logic [InfoBits-1:0] info_walk;
  assign info_walk = {walk_count_q, walk_weight_q, walk_kind_q, walk_lanes, walk_group_q, walk_at_end_q, walk_leaves_q};
  assign valid = {valid_q, walk_valid_q};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= valid[Last-1:0];
    info_q <= {info_q[(Last-1)*InfoBits-1:0], info_walk};
  end

  if (SMOOTH == 0) begin : gen_flat
    logic unused_dcolor;
    assign unused_dcolor = ^cmd.dcolor;
    logic [(Last-1)*RgbBits-1:0] flat_q;
    always_ff @(posedge clk_i) flat_q <= {flat_q[(Last-2)*RgbBits-1:0], walk_flat_q};
    assign lane_color = {LANES{flat_q[(Last-2)*RgbBits+:RgbBits]}};
  end

  // Address of the group at stage k, k = 1 .. Last: the walker's goes in at stage 1.
  localparam int AddrAt = 2;
  logic [AddrBits-1:0] addr_read, addr_ahead2, addr_ahead;  // stages Last - 3, Last - 2, Last - 1
  if (Last > 3) begin : gen_addr_read
    assign addr_read = info_q[(Last-4)*InfoBits+AddrAt+:AddrBits];
  end else begin : gen_addr_read_walk
    assign addr_read = walk_group_q;
  end
  assign addr_ahead2 = info_q[(Last-3)*InfoBits+AddrAt+:AddrBits];

  // The group whose next state is computed, and the one behind it.
  logic [KindBits-1:0] now_kind, ahead_kind;
  logic [CountBits-1:0] ahead_count;
  logic [ShareBits-1:0] ahead_weight;
  logic [LANES-1:0] now_lanes, ahead_lanes;
  logic [AddrBits-1:0] now_addr;
  logic now_at_end, now_leaves;
  logic [CountBits+ShareBits-1:0] unused_now;
  logic [1:0] unused_ahead;
  assign {unused_now, now_kind, now_lanes, now_addr, now_at_end, now_leaves} = info_q[(Last-1)*InfoBits+:InfoBits];
  assign {ahead_count, ahead_weight, ahead_kind, ahead_lanes, addr_ahead, unused_ahead} =
      info_q[(Last-2)*InfoBits+:InfoBits];

  // ---- the tree's line ---------------------------------------------------------------------------------------------
  // Depth, colour and count of each lane, a clock ahead: the span's, or what the tree has there.
  logic [LANES*Z_BITS-1:0] ahead_z;
  logic [LANES*LaneRgbBits-1:0] ahead_color;
  logic [LANES*CountBits-1:0] ahead_counts;

  if (UNITS > 0) begin : gen_tree
    logic [LANES*Z_BITS-1:0] tree_z;
    logic [LANES*PixelRgbBits-1:0] tree_color;
    logic [LANES*CLASS_BITS-1:0] tree_class;
    tree_line #(
        .LANES(LANES),
        .MAX_WIDTH(MAX_WIDTH),
        `include "generated/kage_pixel_param_map.svh"
    ) u_tree_line (
        .clk_i,
        .rst_ni,
        .tree_valid_i,
        .tree_ready_o,
        .tree_i,
        .drop_i    (tree_drop_i),
        .here_o    (tree_here),
        .pass_i    (set_take && next_tree),
        .rd_en_i   (valid[Last-3]),
        .rd_group_i(addr_read),
        .z_o       (tree_z),
        .color_o   (tree_color),
        .class_o   (tree_class),
        .moving_o  (tree_moving)
    );

    always_comb begin
      ahead_z = lane_z;
      ahead_color = lane_color;
      ahead_counts = {LANES{ahead_count}};
      if (ahead_kind == KindTree) begin
        ahead_z = tree_z;
        for (int l = 0; l < LANES; l++) begin
          ahead_color[l*LaneRgbBits+:LaneRgbBits] = lane_color_of(tree_color[l*PixelRgbBits+:PixelRgbBits]);
          if (ClassBits > 0) ahead_counts[l*CountBits+:CountBits] = CountBits'(tree_class[l*CLASS_BITS+:CLASS_BITS]);
        end
      end
    end
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = ^{tree_valid_i, tree_i, tree_drop_i};
    assign tree_ready_o = 1'b0;
    assign {tree_here, tree_moving} = '0;
    assign ahead_z = lane_z;
    assign ahead_color = lane_color;
    assign ahead_counts = {LANES{ahead_count}};
  end

  // ---- read, next state, write -------------------------------------------------------------------------------------
  logic [WordBits-1:0] ram_data, stored_q, recent_q, settled, word_q, word, next, done_q, done, done2_q;
  logic [LANES-1:0] mixes, word_mixes_q, done_mixes_q;
  logic [LANES*PixelRgbBits-1:0] mixed, mixed_q;
  logic [AddrBits-1:0] done_addr_q;
  logic done_valid_q;
  // The group computed 1 .. 4 clocks before is the same: for 1, 2 and 3 a bit for each lane that it changed, so that a
  // flip-flop selects few bits. Word recent_q is 3 or 4 clocks old, for the lanes of use_recent_q. The RAM's output
  // goes into stored_q as it is, because nothing else fits in the clock of a block RAM's output. `settled` is a pixel's
  // state after all groups but the one right before, a clock ahead; word is its state after all.
  logic [LANES-1:0] same1_q, same2_q, same3_q, use_recent_q;
  logic same4_q;

  ram_1r1w #(
      .BITS (WordBits),
      .WORDS(Groups)
  ) u_state (
      .clk_i,
      .wr_en_i  (done_valid_q),
      .wr_addr_i(done_addr_q),
      .wr_data_i(done),
      .rd_en_i  (valid[Last-3]),
      .rd_addr_i(addr_read),
      .rd_data_o(ram_data)
  );

  always_comb begin
    settled = stored_q;
    for (int l = 0; l < LANES; l++) begin
      if (same2_q[l]) settled[l*PixelBits+:PixelBits] = done[l*PixelBits+:PixelBits];
      else if (use_recent_q[l]) settled[l*PixelBits+:PixelBits] = recent_q[l*PixelBits+:PixelBits];
    end
  end

  always_ff @(posedge clk_i) begin
    // For the group that moves from stage Last - 3 to Last - 2; see the contract's hazards.
    same3_q <= valid[Last] && addr_read == now_addr ? now_lanes : '0;
    same4_q <= done_valid_q && addr_read == done_addr_q;
    // For the group that moves from stage Last - 2 to Last - 1.
    same1_q <= valid[Last-1] && addr_ahead2 == addr_ahead ? ahead_lanes : '0;
    same2_q <= valid[Last] && addr_ahead2 == now_addr ? now_lanes : '0;
    use_recent_q <= same3_q | {LANES{same4_q}};
    stored_q <= ram_data;
    recent_q <= done2_q;
    // For the group that moves from stage Last - 1 to Last.
    word_q <= settled;
    for (int l = 0; l < LANES; l++) begin
      if (same3_q[l]) recent_q[l*PixelBits+:PixelBits] <= done[l*PixelBits+:PixelBits];
      if (same1_q[l]) word_q[l*PixelBits+:PixelBits] <= next[l*PixelBits+:PixelBits];
    end
    word_mixes_q <= same1_q & mixes;
    done_mixes_q <= mixes;
    mixed_q <= mixed;
  end

  // A mixed colour is chosen a clock later: nothing stands between the products and their register.
  always_comb begin
    word = word_q;
    done = done_q;
    for (int l = 0; l < LANES; l++) begin
      if (Mixes && word_mixes_q[l]) begin
        word[l*PixelBits+PixelColorAt+:PixelRgbBits] = mixed_q[l*PixelRgbBits+:PixelRgbBits];
      end
      if (Mixes && done_mixes_q[l]) begin
        done[l*PixelBits+PixelColorAt+:PixelRgbBits] = mixed_q[l*PixelRgbBits+:PixelRgbBits];
      end
    end
  end

  // In each lane: the group right before has given the pixel a depth (moved_q). This group's depth is in front of that
  // one (before_new_q), or of the pixel's depth without it (before_old_q).
  logic [LANES-1:0] moved_q, before_new_q, before_old_q, in_front;
  logic now_opaque_q;  // of now_kind
  logic [LANES*Z_BITS-1:0] now_z;
  logic [LANES*LaneRgbBits-1:0] now_color;
  logic [LANES*CountBits-1:0] now_counts;
  logic [KeepBits-1:0] now_keep;
  logic [LANES*AddedBits-1:0] now_added;

  always_ff @(posedge clk_i) begin
    now_opaque_q <= pixel_opaque(ahead_kind);
    now_z <= ahead_z;
    now_color <= ahead_color;
    now_counts <= ahead_counts;
    now_keep <= pixel_keep(ahead_kind, ahead_weight);
    for (int l = 0; l < LANES; l++) begin
      now_added[l*AddedBits+:AddedBits] <= pixel_added(
          ahead_kind, 8'(ahead_weight), ahead_color[l*LaneRgbBits+:LaneRgbBits]
      );
      moved_q[l] <= same1_q[l] && ((now_opaque_q && in_front[l]) || now_kind == KindEol);
      before_new_q[l] <= now_kind == KindEol || pixel_in_front(
          ahead_z[l*Z_BITS+:Z_BITS], now_z[l*Z_BITS+:Z_BITS], pixel_lights(ahead_kind)
      );
      before_old_q[l] <= pixel_in_front(
          ahead_z[l*Z_BITS+:Z_BITS], settled[l*PixelBits+PixelZAt+:Z_BITS], pixel_lights(ahead_kind)
      );
    end
  end

  always_comb begin
    next = word;
    {mixes, mixed} = '0;
    for (int l = 0; l < LANES; l++) begin
      in_front[l] = moved_q[l] ? before_new_q[l] : before_old_q[l];
      if (now_lanes[l]) begin
        next[l*PixelBits+:PixelBits] = pixel_next(
          word[l*PixelBits+:PixelBits],
          now_kind,
          now_opaque_q,
          in_front[l],
          now_z[l*Z_BITS+:Z_BITS],
          now_color[l*LaneRgbBits+:LaneRgbBits],
          now_counts[l*CountBits+:CountBits]
        );
        mixes[l] = pixel_mixes(word[l*PixelBits+:PixelBits], now_kind, in_front[l], now_counts[l*CountBits+:CountBits]);
      end
      if (Mixes) begin
        mixed[l*PixelRgbBits+:PixelRgbBits] = pixel_mixed(
          word[l*PixelBits+:PixelBits],
          now_kind,
          now_color[l*LaneRgbBits+:LaneRgbBits],
          now_counts[l*CountBits+:CountBits],
          now_keep,
          now_added[l*AddedBits+:AddedBits]
        );
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      done_valid_q <= 1'b0;
    end else begin
      done_valid_q <= valid[Last];
    end
    done_addr_q <= now_addr;
    done_q      <= next;
    done2_q     <= done;
  end

  // ---- the line leaves ---------------------------------------------------------------------------------------------
  always_ff @(posedge clk_i) begin
    if (!rst_ni) exit_valid_o <= 1'b0;
    else exit_valid_o <= valid[Last] && now_leaves;
    exit_last_o <= now_at_end;
    for (int l = 0; l < LANES; l++) begin
      exit_data_o[l*ExitBits+:ExitBits] <= pixel_exit(word[l*PixelBits+:PixelBits], now_counts[l*CountBits+:DsfBits]);
    end
  end

  // Something is on its way: read, computed, written or leaving.
  assign moving_o = (set_has & {set_room, set_en}) >> 1 != '0 || set_take || valid != '0 || done_valid_q ||
      exit_valid_o || tree_moving;

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. The walker stays within the RAM.
      assert (!walk_valid_q || (walk_group_q <= walk_end_q && 32'(walk_end_q) < Groups));
      assert (!walk_valid_q || walk_at_end_q == (walk_group_q == walk_end_q));
      // 2. A line's pass never starts without a place for its pixels.
      assert (!exit_take_o || exit_free_i);
      // 3. Where the group right before is the same, it has found what that pixel has without it: so that one depth
      //    will do for before_old_q, whoever the group before is.
      for (int l = 0; l < LANES; l++) begin
        assert (!(valid[Last-1] && same1_q[l]) ||
                settled[l*PixelBits+PixelZAt+:Z_BITS] == word[l*PixelBits+PixelZAt+:Z_BITS]);
      end
    end
  end
`endif

endmodule

`default_nettype wire
