// SPDX-License-Identifier: Apache-2.0
// The way out: two line buffers, so that the next line is worked on while this one leaves at a pixel a clock. In it are
// the multiplier of RESOLVE, or the display's curve, background where nothing was drawn, and AXI4-Stream video.
//
// Handshake: exit_free_o says that a buffer is free, exit_take_i takes it, then the line's groups come in order by
//   exit_valid_i (they cannot be stopped), the last with exit_last_i. Port line_* is valid/ready and brings each line's
//   width and colours, in the order of the lines. Port m_axis_* is AXI4-Stream: tuser on a frame's first pixel, tlast
//   on a line's last.
// Pixel: background if the line is blank, or the pixel not covered in a line that is not painted; else its colour. A
//   dark pixel's colour is times 1 - shade, rounded once: (c x (2^SHADE_FRAC - shade) + 2^(SHADE_FRAC-1)) >>
//   SHADE_FRAC. With counters every pixel has a factor of its own: light_resolve, which table_* loads.
//   Linear light is darkened already, and goes through display_curve unless the line is painted.
// Loads (counters or linear light, and translucency): a line with `load` leaves by load_*, valid/ready, not by
//   m_axis_*. They bring each pixel's place and colour.
// Throughput: a pixel a clock; lines of one frame follow each other without a gap. Video is a pixel a clock anyway, so
//   the one multiplier per channel here does the work of LANES of them in the pass that empties the line.
// Latency: 8 clocks from a line's first group to its first pixel, and with counters or linear light LightStages more.
// Cost: a RAM of 2 x ceil(MAX_WIDTH / LANES) groups, CHANNELS products of 8 x (SHADE_FRAC + 1) bits (none without
//   shadows or with linear light), light_resolve or display_curve.
`default_nettype none

module line_out #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 4,  // pixels of a group
    parameter int MAX_WIDTH = 640
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from the pixels
    output logic                           exit_free_o,
    input  wire logic                      exit_take_i,
    input  wire logic                      exit_valid_i,
    input  wire logic                      exit_last_i,
    input  wire logic [LANES*ExitBits-1:0] exit_data_i,

    // from frame_control
    input  wire logic                line_valid_i,
    output logic                     line_ready_o,
    input  wire logic [LineBits-1:0] line_i,

    // from frame_control: entries of the light table
    input wire logic                      table_valid_i,
    input wire logic [TableEntryBits-1:0] table_i,

    // back to the pixels
    output logic                     load_valid_o,
    input  wire logic                load_ready_i,
    output logic      [LoadBits-1:0] load_o,

    // video
    output logic                    m_axis_tvalid_o,
    input  wire logic               m_axis_tready_i,
    output logic      [RgbBits-1:0] m_axis_tdata_o,
    output logic                    m_axis_tuser_o,
    output logic                    m_axis_tlast_o,

    output logic moving_o  // pixels are on their way through here
);
  `include "generated/kage_buses.svh"

  localparam int Groups = (MAX_WIDTH + LANES - 1) / LANES;
  localparam int AddrBits = $clog2(2 * Groups);
  localparam int LaneBits = LANES > 1 ? $clog2(LANES) : 1;

  line_t line;
  assign line = line_i;

  // ---- buffers in use ----------------------------------------------------------------------------------------------
  logic [1:0] taken_q, begun_q;  // buffers not free; those whose line has begun to come in
  logic [1:0] taken;
  logic full_q;  // taken_q is 2
  logic filling_q, line_begins, line_complete, line_left;
  assign taken = taken_q + 2'(exit_take_i) - 2'(line_left);
  assign exit_free_o = !full_q;
  assign line_begins = exit_valid_i && !filling_q;
  assign line_complete = exit_valid_i && exit_last_i;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      taken_q   <= '0;
      full_q    <= 1'b0;
      begun_q   <= '0;
      filling_q <= 1'b0;
    end else begin
      taken_q <= taken;
      full_q  <= taken == 2'd2;
      begun_q <= begun_q + 2'(line_begins) - 2'(line_left);
      if (exit_valid_i) filling_q <= !exit_last_i;
    end
  end

  // ---- filling -----------------------------------------------------------------------------------------------------
  // Buffers lie behind each other in one RAM: the second one starts at Groups.
  logic [AddrBits-1:0] wr_addr_q, rd_addr_q;
  logic wr_second_q, rd_second_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      wr_addr_q   <= '0;
      wr_second_q <= 1'b0;
    end else if (line_complete) begin
      wr_addr_q   <= wr_second_q ? '0 : AddrBits'(Groups);
      wr_second_q <= !wr_second_q;
    end else if (exit_valid_i) begin
      wr_addr_q <= wr_addr_q + 1'b1;
    end
  end

  // ---- emptying: one pixel a clock goes into the pipeline ----------------------------------------------------------
  localparam int Depth = 5 + LightStages;  // RAM, register, lane, factor, product, colour
  logic go;  // the pipeline moves
  logic start, sending_q, issue, issue_first_q, issue_last_q;  // the pixel that is issued is the line's first, its last
  logic [  X_BITS-1:0] left_q;  // pixels of the line that have not been issued
  logic [LaneBits-1:0] lane_q;
  logic first_q, blank_q, load_q, painted_q;
  logic [RgbBits-1:0] background_q;
  logic [FactorBits-1:0] keep_q;  // 1 - shade; with counters shade
  logic [Depth-1:0] valid_q;

  // A line leaves as soon as it has begun to come in: its groups come without stops, so a pixel a clock cannot overtake
  // them. A frame's first line waits for the pipeline to drain, since background and shade are kept once, not per
  // stage.
  logic next_begun, may_start;
  assign next_begun = begun_q > 2'(sending_q);
  assign may_start = sending_q ? go && issue_last_q && !line.first : !line.first || valid_q == '0;
  assign start = line_valid_i && next_begun && may_start;
  assign line_ready_o = start;
  assign issue = sending_q;
  assign line_left = sending_q && go && issue_last_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) sending_q <= 1'b0;
    else if (start) sending_q <= 1'b1;
    else if (line_left) sending_q <= 1'b0;

    if (start) begin
      left_q <= line.width;
      issue_first_q <= 1'b1;
      issue_last_q <= line.width == X_BITS'(1);
      lane_q <= '0;
      first_q <= line.first;
      blank_q <= line.blank;
      painted_q <= TRANSLUCENCY > 0 && line.painted;
      if (line.first) background_q <= line.background;
      load_q <= HasLoads && line.load;
      if (line.first) keep_q <= COUNT_BITS > 0 ? line.shade : WholeShare - line.shade;
    end else if (go && issue) begin
      left_q <= left_q - 1'b1;
      issue_first_q <= 1'b0;
      issue_last_q <= left_q == X_BITS'(2);
      lane_q <= LANES > 1 ? lane_q + 1'b1 : '0;
    end

    if (!rst_ni) begin
      rd_addr_q   <= '0;
      rd_second_q <= 1'b0;
    end else if (line_left) begin
      rd_addr_q   <= rd_second_q ? '0 : AddrBits'(Groups);
      rd_second_q <= !rd_second_q;
    end else if (go && issue && lane_q == LaneBits'(LANES - 1)) begin
      rd_addr_q <= rd_addr_q + 1'b1;
    end
  end

  assign moving_o = start || (go && (sending_q || valid_q != '0));

  // Data that goes along with a pixel, one set of bits a stage, the first stage lowest.
  logic [Depth-1:0] user_q, last_q, load_at_q;
  logic [LightStages+2:0] blank_at_q, painted_at_q;
  logic [2*LaneBits-1:0] lane_at_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) valid_q <= '0;
    else if (go) valid_q <= {valid_q[Depth-2:0], issue};
    if (go) begin
      user_q <= {user_q[Depth-2:0], first_q && issue_first_q};
      last_q <= {last_q[Depth-2:0], issue_last_q};
      load_at_q <= {load_at_q[Depth-2:0], load_q};
      blank_at_q <= {blank_at_q[LightStages+1:0], blank_q};
      painted_at_q <= {painted_at_q[LightStages+1:0], painted_q};
      lane_at_q <= {lane_at_q[LaneBits-1:0], lane_q};
    end
  end

  // ---- stages 1 and 2: RAM, which holds a group while its lanes leave, and the register behind it ------------------
  logic [LANES*ExitBits-1:0] ram_data, group_q;
  ram_1r1w #(
      .BITS (LANES * ExitBits),
      .WORDS(2 * Groups)
  ) u_lines (
      .clk_i,
      .wr_en_i  (exit_valid_i),
      .wr_addr_i(wr_addr_q),
      .wr_data_i(exit_data_i),
      .rd_en_i  (go && issue && lane_q == '0),
      .rd_addr_i(rd_addr_q),
      .rd_data_o(ram_data)
  );
  always_ff @(posedge clk_i) if (go) group_q <= ram_data;

  // ---- stage 3: one lane -------------------------------------------------------------------------------------------
  logic [ExitBits-1:0] pixel_d, pixel_q;
  if (LANES > 1) begin : gen_lane
    always_comb begin
      pixel_d = '0;
      for (int l = 0; l < LANES; l++) begin
        if (lane_at_q[LaneBits+:LaneBits] == LaneBits'(l)) pixel_d = group_q[l*ExitBits+:ExitBits];
      end
    end
  end else begin : gen_one_lane
    logic unused_lane;
    assign unused_lane = lane_at_q[1];
    assign pixel_d = group_q;
  end
  always_ff @(posedge clk_i) if (go) pixel_q <= pixel_d;

  // ---- counts and class to factors ---------------------------------------------------------------------------------
  logic [RgbBits:0] colored;  // {covered, colour}
  logic is_dark;
  logic [CHANNELS*FactorBits-1:0] factor;
  if (LINEAR_BITS > 0) begin : gen_curve
    logic unused_light;
    assign unused_light = ^{table_valid_i, table_i, keep_q};
    display_curve #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_curve (
        .clk_i,
        .go_i   (go),
        .pixel_i(pixel_q[ExitCoveredAt:ExitColorAt]),
        .shown_i(painted_at_q[2]),
        .pixel_o(colored)
    );
    assign is_dark = 1'b0;
    assign factor  = '0;
  end else if (COUNT_BITS > 0) begin : gen_light
    light_resolve #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_light (
        .clk_i,
        .table_valid_i,
        .table_i,
        .shade_i (keep_q),
        .go_i    (go),
        .pixel_i (pixel_q),
        .pixel_o (colored),
        .factor_o(factor)
    );
    assign is_dark = 1'b1;  // by a factor of 1, if it is not
  end else begin : gen_dark
    logic unused_table;
    assign unused_table = ^{table_valid_i, table_i};
    assign colored = pixel_q[ExitCoveredAt:ExitColorAt];
    assign is_dark = DarkBits > 0 && pixel_q[ExitDarkAt];
    assign factor = {CHANNELS{keep_q}};
  end

  // ---- the last two stages: resolve, background --------------------------------------------------------------------
  logic [RgbBits-1:0] plain_q, dimmed, color_q;
  logic show_q, dark_q;  // the pixel has a colour, in a line that is not blank; and is in shadow
  if (DSF_BITS > 0 && LINEAR_BITS == 0) begin : gen_resolve
    logic [CHANNELS*(SHADE_FRAC+9)-1:0] product_q;
    always_ff @(posedge clk_i) begin
      if (go) begin
        dark_q <= is_dark;
        for (int c = 0; c < CHANNELS; c++) begin
          product_q[c*(SHADE_FRAC+9)+:SHADE_FRAC+9] <=
              (SHADE_FRAC + 9)'(colored[c*8+:8]) * (SHADE_FRAC + 9)'(factor[c*FactorBits+:FactorBits]);
        end
      end
    end
    // Rounded a clock behind the product, because product and sum in one clock would be the core's slowest path.
    always_comb begin
      for (int c = 0; c < CHANNELS; c++) begin
        dimmed[c*8+:8] = 8'((product_q[c*(SHADE_FRAC+9)+:SHADE_FRAC+9] + (SHADE_FRAC + 9)'(HalfShare)) >> SHADE_FRAC);
      end
    end
  end else begin : gen_no_resolve
    logic unused_keep;
    assign unused_keep = ^{factor, is_dark};
    assign dark_q = 1'b0;
    assign dimmed = '0;
  end
  always_ff @(posedge clk_i) begin
    if (go) begin
      plain_q <= colored[RgbBits-1:0];
      show_q  <= (colored[RgbBits] || painted_at_q[LightStages+2]) && !blank_at_q[LightStages+2];
      if (!show_q) color_q <= background_q;
      else color_q <= dark_q ? dimmed : plain_q;
    end
  end

  // ---- output ------------------------------------------------------------------------------------------------------
  logic  video_go;
  load_t load;
  assign load_o = load;
  if (HasLoads) begin : gen_loads
    logic [X_BITS-1:0] load_x_q;
    assign load_valid_o = valid_q[Depth-1] && load_at_q[Depth-1];
    assign load.x = load_x_q;
    assign load.color = color_q;
    assign load.last = last_q[Depth-1];
    assign go = load_valid_o ? load_ready_i : video_go;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) load_x_q <= '0;
      else if (load_valid_o && load_ready_i) load_x_q <= load.last ? '0 : load_x_q + 1'b1;
    end
  end else begin : gen_no_loads
    logic unused_load;
    assign unused_load = ^{load_ready_i, line.load};
    assign {load_valid_o, load} = '0;
    assign go = video_go;
  end
  skid_buffer #(
      .BITS(RgbBits + 2)
  ) u_out (
      .clk_i,
      .rst_ni,
      .in_valid_i (valid_q[Depth-1] && !load_at_q[Depth-1]),
      .in_ready_o (video_go),
      .in_data_i  ({last_q[Depth-1], user_q[Depth-1], color_q}),
      .out_valid_o(m_axis_tvalid_o),
      .out_ready_i(m_axis_tready_i),
      .out_data_o ({m_axis_tlast_o, m_axis_tuser_o, m_axis_tdata_o})
  );

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. No line comes without a buffer.
      assert (!exit_take_i || exit_free_o);
      // 2. No more lines have begun than buffers are taken.
      assert (begun_q <= taken_q);
    end
  end
`endif

endmodule

`default_nettype wire
