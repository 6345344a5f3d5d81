// SPDX-License-Identifier: Apache-2.0
// The pixels of a line as a chain of processors, one a pixel, as in Matsumoto's line of pixel processors. Commands move
// one processor a clock, and a new one may enter every clock, whatever its length.
//
// Handshake: cmd_* is valid/ready; its contract is frame_control's. Only an EOL or CmdOut can be made to wait: for
//   exit_free_i, and for the line before it to have left. It takes the buffer by a clock of exit_take_o, and the line's
//   pixels then leave one a clock by exit_valid_o, without stops; the last with exit_last_o. The next line's commands
//   follow right behind the EOL.
// Tree (UNITS > 0): a TREE enters when tree_* offers its line's first pixel, and takes one a clock from then on, in
//   step with its way down the chain. The pixel taken a clock ago stands before all processors, and belongs to the one
//   TREE is at. So a TREE needs a line without bubbles, and no buffer. The next TREE waits until the line is through,
//   at most its width.
// Clocks of a processor: in the first the command's depth and colour at its pixel are clamped, in the second they are
//   compared and the pixel's state changes. The command has moved on by the second clock, so a processor reads its kind
//   and counts from the next one's register.
// Latency: command to first processor 1 clock, EOL at the first processor to its pixel at exit_data_o 3 clocks.
// Throughput: a command takes one clock; two EOLs are at least the line's width apart, the time in which the first
//   one's pixels leave.
// Reset: an EOL that nobody sees runs ahead of all commands, so that no state needs a reset and none is trusted.
//   Commands follow right behind it; the first line's EOL waits until it is through.
// Cost: MAX_WIDTH times a command, a depth adder, a comparison and a pixel's state. The loops below are over vectors in
//   one process: instances would simulate at half the speed.
`default_nettype none

module pixel_systolic #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter  int MAX_WIDTH = 64,
    localparam int ExitLanes = 1
) (
    `include "kage_pixel_ports.svh"
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "kage_pixel_next.svh"

  localparam int N = MAX_WIDTH;
  localparam int Segment = 16;  // pixels whose exits are joined in one clock
  localparam int Segments = (N + Segment - 1) / Segment;

  command_t cmd;
  assign cmd = cmd_i;

  // ---- entry -------------------------------------------------------------------------------------------------------
  logic is_leaving, enter, tree_here, tree_moving;  // a TREE may enter; its line moves
  logic [X_BITS-1:0] leaving_q;  // pixels of the leaving line that its EOL has not reached
  logic sweep_q;  // that EOL is the one of reset
  assign is_leaving = cmd.kind == KindEol || (HasLoads && cmd.kind == CmdOut);
  assign cmd_ready_o = (!is_leaving || (exit_free_i && leaving_q == '0)) &&
      (UNITS == 0 || cmd.kind != KindTree || tree_here);
  assign enter = cmd_valid_i && cmd_ready_o;
  assign exit_take_o = enter && is_leaving;

  // An EOL moves on every clock, so counting says where it is: no sign from the processors is needed.
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      leaving_q <= X_BITS'(N - 1);
      sweep_q   <= 1'b1;
    end else begin
      if (exit_take_o) leaving_q <= cmd.xr - 1'b1;
      else if (leaving_q != '0) leaving_q <= leaving_q - 1'b1;
      if (leaving_q == '0) sweep_q <= 1'b0;
    end
  end


  // ---- the chain ---------------------------------------------------------------------------------------------------
  // Processor i holds, in vectors with processor 0 lowest: the pixel's state, and the command at it with depth and
  // colour at this pixel. For the command of a clock ago it holds whether the pixel is in its range, and depth and
  // colour clamped. Fields that go along unchanged have a place more, for the last processor's second clock.
  logic [N-1:0] valid_q, hit, hit_q, opaque_d, opaque_q;
  logic [(N+1)*KindBits-1:0] kind_q;
  logic [N*X_BITS-1:0] xl_q, xr_q;
  logic [(N+1)*CountBits-1:0] count_q;
  logic [N*DepthBits-1:0] z_q, dz_q, z_d;
  logic [N*Z_BITS-1:0] depth_d, depth_q;
  logic [N*ColorBits-1:0] color_q, color_d;
  logic [N*LaneRgbBits-1:0] shown_d, shown_q;
  logic [(N+1)*ShareBits-1:0] weight_q;
  logic [N*PixelBits-1:0] pixel_q, pixel_d;
  logic [Segments*ExitBits-1:0] joined_d, joined_q;

  // Clamped depth, from an accumulator without its fraction.
  function automatic logic [Z_BITS-1:0] clamp_z(input logic signed [Z_BITS+1:0] whole);
    begin
      if (whole < (Z_BITS + 2)'(1)) clamp_z = Z_BITS'(1);
      else if (whole > $signed((Z_BITS + 2)'(MostDepth))) clamp_z = MostDepth;
      else clamp_z = whole[Z_BITS-1:0];
    end
  endfunction

  // Clamped colour, from the accumulators of all channels. Without SMOOTH they have 8 bits, and nothing is clamped.
  function automatic logic [LaneRgbBits-1:0] clamp_color(input logic [ColorBits-1:0] sums);
    logic [LaneLevelBits+1:0] whole;
    begin
      clamp_color = '0;
      whole = '0;
      for (int c = 0; c < CHANNELS; c++) begin
        whole = (LaneLevelBits + 2)'({2'b00, sums[c*RampBits+:RampBits]} >> (COLOR_FRAC + 8 - LaneLevelBits));
        if (whole[LaneLevelBits+1]) clamp_color[c*LaneLevelBits+:LaneLevelBits] = '0;
        else if (whole[LaneLevelBits]) clamp_color[c*LaneLevelBits+:LaneLevelBits] = '1;
        else clamp_color[c*LaneLevelBits+:LaneLevelBits] = whole[LaneLevelBits-1:0];
      end
    end
  endfunction

  // ---- the tree's line ---------------------------------------------------------------------------------------------
  logic [Z_BITS-1:0] tree_z;
  logic [LaneRgbBits-1:0] tree_color;
  logic [CountBits-1:0] tree_count;
  tree_pixel_t tree;
  assign tree = tree_i;
  if (UNITS > 0) begin : gen_tree
    logic flows_q, take;  // a line has begun to come and not ended
    logic [Z_BITS-1:0] z1_q, z2_q;
    logic [PixelRgbBits-1:0] color1_q, color2_q;
    logic [CLASS_BITS-1:0] class1_q, class2_q;
    logic unused_drop;
    assign unused_drop = tree_drop_i;  // nothing is taken ahead of its TREE
    assign tree_here = tree_valid_i && !flows_q;
    assign tree_ready_o = flows_q || (enter && cmd.kind == KindTree);
    assign tree_moving = flows_q;
    assign take = tree_valid_i && tree_ready_o;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) flows_q <= 1'b0;
      else if (take) flows_q <= !tree.last;
      {z2_q, z1_q} <= {z1_q, tree.z};
      {color2_q, color1_q} <= {color1_q, tree.color};
      {class2_q, class1_q} <= {class1_q, tree.normal_class};
    end
    assign tree_z = z2_q;
    assign tree_color = lane_color_of(color2_q);
    assign tree_count = CountBits'(class2_q);
`ifndef SYNTHESIS
    // 1. A line that has begun to come has no bubble.
    always @(posedge clk_i) if (rst_ni) assert (!flows_q || tree_valid_i);
`endif
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = ^{tree_valid_i, tree, tree_drop_i};
    assign tree_ready_o = 1'b0;
    assign {tree_here, tree_moving, tree_z, tree_color, tree_count} = '0;
  end

  // The processor that the loop is at, in its first clock.
  logic begins;
  logic [DepthBits-1:0] z;
  always_comb begin
    z_d = z_q;
    depth_d = depth_q;
    shown_d = shown_q;
    {begins, z} = '0;
    opaque_d = '0;
    for (int i = 0; i < N; i++) begin
      begins = (i > 0 && hit_q[i>0?i-1 : 0]) || xl_q[i*X_BITS+:X_BITS] == X_BITS'(i);
      opaque_d[i] = pixel_opaque(kind_q[i*KindBits+:KindBits]);
      hit[i] = valid_q[i] && begins && xr_q[i*X_BITS+:X_BITS] != X_BITS'(i);
      if (hit[i]) begin
        z = z_q[i*DepthBits+:DepthBits];
        z_d[i*DepthBits+:DepthBits] = z + dz_q[i*DepthBits+:DepthBits];
        depth_d[i*Z_BITS+:Z_BITS] = clamp_z(z[Z_FRAC+:Z_BITS+2]);
        shown_d[i*LaneRgbBits+:LaneRgbBits] = clamp_color(color_q[i*ColorBits+:ColorBits]);
      end
    end
  end

  // The same in its second clock.
  logic [KindBits-1:0] kind;
  logic [CountBits-1:0] count;
  logic [Z_BITS-1:0] depth;
  logic [LaneRgbBits-1:0] color;
  logic [PixelBits-1:0] pixel;
  logic in_front;
  logic [ShareBits-1:0] weight;
  logic [7:0] alpha;
  logic [KeepBits-1:0] keep;
  logic [AddedBits-1:0] added;
  logic [ExitBits-1:0] leaving;
  always_comb begin
    pixel_d = pixel_q;
    joined_d = '0;
    {kind, count, depth, color, pixel, in_front, weight, alpha, keep, added, leaving} = '0;
    for (int i = 0; i < N; i++) begin
      if (hit_q[i]) begin
        kind  = kind_q[(i+1)*KindBits+:KindBits];
        count = count_q[(i+1)*CountBits+:CountBits];
        depth = depth_q[i*Z_BITS+:Z_BITS];
        color = shown_q[i*LaneRgbBits+:LaneRgbBits];
        if (UNITS > 0 && kind == KindTree) {depth, color, count} = {tree_z, tree_color, tree_count};
        pixel = pixel_q[i*PixelBits+:PixelBits];
        in_front = pixel_in_front(depth, pixel[PixelZAt+:Z_BITS], pixel_lights(kind));
        weight = weight_q[(i+1)*ShareBits+:ShareBits];
        alpha = 8'(weight);
        keep = pixel_keep(kind, weight);
        added = pixel_added(kind, alpha, color);
        pixel_d[i*PixelBits+:PixelBits] = pixel_next(pixel, kind, opaque_q[i], in_front, depth, color, count);
        if (pixel_mixes(pixel, kind, in_front, count)) begin
          pixel_d[i*PixelBits+PixelColorAt+:PixelRgbBits] = pixel_mixed(pixel, kind, color, count, keep, added);
        end
        // Only one EOL or CmdOut in the chain is among its line's pixels, so the OR of all exits is that one's exit.
        if (kind == KindEol || (HasLoads && kind == CmdOut)) begin
          leaving = joined_d[(i/Segment)*ExitBits+:ExitBits] | pixel_exit(pixel, count[DsfBits-1:0]);
          joined_d[(i/Segment)*ExitBits+:ExitBits] = leaving;
        end
      end
    end
  end

  if (SMOOTH > 0) begin : gen_smooth
    logic [N*SlopeBits-1:0] dcolor_q;
    always_comb begin
      color_d = color_q;
      for (int i = 0; i < N; i++) begin
        for (int c = 0; c < CHANNELS; c++) begin
          if (hit[i]) begin
            color_d[i*ColorBits+c*RampBits+:RampBits] =
                color_q[i*ColorBits+c*RampBits+:RampBits] + dcolor_q[i*ColorBits+c*RampBits+:RampBits];
          end
        end
      end
    end
    always_ff @(posedge clk_i) dcolor_q <= (N * SlopeBits)'({dcolor_q, cmd.dcolor});
  end else begin : gen_flat
    logic unused_dcolor;
    assign unused_dcolor = ^cmd.dcolor;
    assign color_d = color_q;
  end

  always_ff @(posedge clk_i) begin
    // Only what says whether a command is there needs a reset. The first is the EOL that clears.
    if (!rst_ni) valid_q <= N'(1);
    else valid_q <= N'({valid_q, enter});
    if (!rst_ni) hit_q <= '0;
    else hit_q <= hit;
    kind_q   <= ((N + 1) * KindBits)'({kind_q, rst_ni ? cmd.kind : KindEol});
    xl_q     <= (N * X_BITS)'({xl_q, rst_ni ? cmd.xl : X_BITS'(0)});
    xr_q     <= (N * X_BITS)'({xr_q, rst_ni ? cmd.xr : X_BITS'(N)});
    count_q  <= ((N + 1) * CountBits)'({count_q, cmd.count});
    z_q      <= (N * DepthBits)'({z_d, cmd.z});
    dz_q     <= (N * DepthBits)'({dz_q, cmd.dz});
    color_q  <= (N * ColorBits)'({color_d, cmd.color});
    weight_q <= ((N + 1) * ShareBits)'({weight_q, pixel_weight(cmd.kind, cmd.share)});
    opaque_q <= opaque_d;
    depth_q  <= depth_d;
    shown_q  <= shown_d;
    pixel_q  <= pixel_d;
  end

  // ---- exit --------------------------------------------------------------------------------------------------------
  // EOL enters in clock t. It is at processor i in t + 1 + i and, for its second clock, in t + 2 + i. That pixel is in
  // joined_q in t + 3 + i, and in exit_data_o in t + 4 + i.
  logic [ExitBits-1:0] all;
  logic at_q, at2_q, joined_valid_q, at_last, at2_last_q, joined_last_q;
  always_comb begin
    all = '0;
    for (int s = 0; s < Segments; s++) all = all | joined_q[s*ExitBits+:ExitBits];
  end
  assign at_last  = leaving_q == '0;
  // Commands other than EOL need not be counted: nothing waits for them but the EOL behind them.
  assign moving_o = leaving_q != '0 || at_q || at2_q || joined_valid_q || exit_valid_o || tree_moving;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      at_q <= 1'b0;
      at2_q <= 1'b0;
      joined_valid_q <= 1'b0;
      exit_valid_o <= 1'b0;
    end else begin
      at_q <= exit_take_o || (leaving_q != '0 && !sweep_q);
      at2_q <= at_q;
      joined_valid_q <= at2_q;
      exit_valid_o <= joined_valid_q;
    end
    joined_q <= joined_d;
    at2_last_q <= at_last;
    joined_last_q <= at2_last_q;
    exit_last_o <= joined_last_q;
    exit_data_o <= all;
  end

endmodule

`default_nettype wire
