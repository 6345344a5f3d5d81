// SPDX-License-Identifier: Apache-2.0
// Proof of line_out at its ports, for any pixels and any stalls of both ways out (verif/test/formal/run.sh).
// By induction (MODEL 0):
//   video.*, load_out.*  what waits stays as it is; reset silences it (stream_rules): m_axis of kage_top is this
//                output. The surroundings stop behind LINES lines, but the step begins in any state of the module
//                beside any count of lines, so it is for any number of them.
// To a bound of clocks (MODEL 1):
//   pixels       the video is the pixels of the lines whose load is 0, none lost, doubled or out of order, each
//                with the colour that the module's head gives: the background, its own, or its own times 1 - shade,
//                rounded once;
//   marks        TUSER is on a frame's first pixel only, TLAST on a line's last only;
//   loads        with counters and translucency a line whose load is 1 leaves by load_*: its places and its end,
//   load_pixels  and its colours; without them (no_loads) nothing does;
//   *_early      a line leaves only after it has been announced and has begun to come in;
//   lines        an announced line is taken only after it has begun to come in;
//   prompt       while a line is in and announced, a pixel leaves within MOST_WAIT clocks in which the ways out are
//                ready: no standstill;
//   buffers      a buffer is free while fewer than two lines are in or on their way;
//   moves        while neither moving_o nor a port moves, no valid changes: the watchdog misses nothing.
// The RTL's own assertions hold as well.
//
// How: LINES lines, free but fixed for the run, are the script. The surroundings bring them to both inputs, groups
// without stops behind exit_take_i, as pixel_core does, and the script says what must come out. Lines of a frame have
// one width, background and shade.
//
// Why small widths say it for all: pixels and channels are computed alike, each for itself; here is one channel. Script
// proofs.bash follows one bit of the colour through lines of up to three pixels in groups of one and two, and all eight
// bits of a line of one pixel.
`default_nettype none

module line_out_proof #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 2,
    parameter int MAX_WIDTH = 3,
    parameter int FOLLOWED = 1,  // bits of a colour that are looked at
    parameter int MODEL = 1,
    parameter int RESETS = 0,  // 1: a reset may come whenever it pleases
    parameter int STALLS = 1,  // 0: the ways out are ready at all times
    parameter int LINES = 2,
    parameter int MOST_WAIT = 9  // clocks of `prompt`
) (
    input wire logic                      clk_i,
    input wire logic                      rst_ni,
    input wire logic                      exit_take_i,
    input wire logic                      exit_begin_i,
    input wire logic [LANES*ExitBits-1:0] exit_data_i,
    input wire logic                      line_valid_i,
    input wire logic                      load_ready_i,
    input wire logic                      m_ready_i
);
  `include "generated/kage_buses.svh"

  // ---- the script --------------------------------------------------------------------------------------------------
  (* anyconst *) logic [LINES-1:0] first, blank, load, painted;
  (* anyconst *) logic [LINES*2-1:0] width;  // less 1
  (* anyconst *) logic [LINES*8-1:0] background;
  (* anyconst *) logic [LINES*FactorBits-1:0] shade;
  always_comb begin
    assume (first[0]);
    for (int l = 0; l < LINES; l++) begin
      assume (32'(width[2*l+:2]) < MAX_WIDTH);
      assume (shade[FactorBits*l+:FactorBits] <= FactorBits'(1 << SHADE_FRAC));
      if (l > 0) begin
        if (!first[l]) begin
          assume (width[2*l+:2] == width[2*l-2+:2]);
          assume (background[8*l+:8] == background[8*l-8+:8]);
          assume (shade[FactorBits*l+:FactorBits] == shade[FactorBits*(l-1)+:FactorBits]);
        end
      end
    end
  end

  // ---- where each port is in it ------------------------------------------------------------------------------------
  logic [2:0]
      taken_q, begun_q, in_q, told_q, left_q;  // lines: buffer taken, begun, wholly in, announced, left by either way
  logic [1:0] group_q;  // of the line that comes in
  logic exit_free, exit_valid, exit_last, line_ready, load_valid, m_valid, m_user, m_last, moving;
  load_t back;
  logic [X_BITS-1:0] back_x;
  logic [7:0] back_color, m_data;
  logic back_last;
  assign back_x = back.x;
  assign back_color = back.color;
  assign back_last = back.last;
  logic started_q = 1'b0;
  logic filling_q;
  logic [1:0] in_width, told_width;
  assign in_width   = width[2*in_q[1:0]+:2];
  assign told_width = width[2*told_q[1:0]+:2];
  assign exit_valid = filling_q || (exit_begin_i && begun_q != taken_q);
  assign exit_last  = 32'(group_q) == 32'(in_width) / LANES;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    if (!started_q) assume (!rst_ni);
    if (started_q && RESETS == 0) assume (rst_ni);
    if (STALLS == 0) assume (m_ready_i && load_ready_i);
    if (exit_take_i) assume (exit_free && taken_q != 3'(LINES) && rst_ni);
    if (!rst_ni) assume (!exit_begin_i);
    if (line_valid_i) assume (told_q != 3'(LINES));
  end

  // The line of each way out: the next one of its sort. A line that goes back may overtake pixels that wait at the
  // video port.
  logic [LINES-1:0] loaded;
  logic [2:0] video_from_q, load_from_q, video_line, load_line;
  logic [1:0] video_x_q, load_x_q, video_width, load_width;
  logic video_step, video_end, load_step, load_end;
  assign loaded = COUNT_BITS > 0 && TRANSLUCENCY > 0 ? load : '0;
  always_comb begin
    video_line = 3'(LINES);
    load_line  = 3'(LINES);
    for (int l = LINES - 1; l >= 0; l--) begin
      if (!loaded[l] && 3'(l) >= video_from_q) video_line = 3'(l);
      if (loaded[l] && 3'(l) >= load_from_q) load_line = 3'(l);
    end
  end
  assign video_width = width[2*video_line[1:0]+:2];
  assign load_width = width[2*load_line[1:0]+:2];
  assign video_step = m_valid && m_ready_i;
  assign load_step = load_valid && load_ready_i;
  assign video_end = video_step && video_x_q == video_width;
  assign load_end = load_step && load_x_q == load_width;

  logic [LINES*4*ExitBits-1:0] pixels_q;  // of the lines, 4 places each
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {taken_q, begun_q, in_q, told_q, left_q, group_q, filling_q} <= '0;
      {video_from_q, load_from_q, video_x_q, load_x_q} <= '0;
    end else begin
      taken_q <= taken_q + 3'(exit_take_i);
      begun_q <= begun_q + 3'(exit_valid && !filling_q);
      filling_q <= exit_valid && !exit_last;
      told_q <= told_q + 3'(line_valid_i && line_ready);
      if (exit_valid) begin
        group_q <= exit_last ? '0 : group_q + 1'b1;
        in_q <= in_q + 3'(exit_last);
        for (int l = 0; l < LINES; l++) begin
          for (int p = 0; p < 4; p++) begin
            if (in_q == 3'(l) && group_q == 2'(p / LANES)) begin
              pixels_q[(4*l+p)*ExitBits+:ExitBits] <= exit_data_i[(p%LANES)*ExitBits+:ExitBits];
            end
          end
        end
      end
      if (video_step) video_x_q <= video_end ? '0 : video_x_q + 1'b1;
      if (load_step) load_x_q <= load_end ? '0 : load_x_q + 1'b1;
      if (video_end) video_from_q <= video_line + 1'b1;
      if (load_end) load_from_q <= load_line + 1'b1;
      left_q <= left_q + 3'(video_end) + 3'(load_end);
    end
  end

  line_t announced;
  always_comb begin
    announced.first = first[told_q[1:0]];
    announced.blank = blank[told_q[1:0]];
    announced.load = load[told_q[1:0]];
    announced.painted = painted[told_q[1:0]];
    announced.width = X_BITS'(told_width) + 1'b1;
    announced.background = background[8*told_q[1:0]+:8];
    announced.shade = shade[FactorBits*told_q[1:0]+:FactorBits];
  end
  line_out #(
      .LANES(LANES),
      .MAX_WIDTH(MAX_WIDTH),
      `include "generated/kage_pixel_param_map.svh"
  ) dut (
      .clk_i,
      .rst_ni,
      .exit_free_o    (exit_free),
      .exit_take_i,
      .exit_valid_i   (exit_valid),
      .exit_last_i    (exit_last),
      .exit_data_i,
      .line_valid_i,
      .line_ready_o   (line_ready),
      .line_i         (announced),
      .table_valid_i  (1'b0),
      .table_i        ('0),
      .load_valid_o   (load_valid),
      .load_ready_i,
      .load_o         (back),
      .m_axis_tvalid_o(m_valid),
      .m_axis_tready_i(m_ready_i),
      .m_axis_tdata_o (m_data),
      .m_axis_tuser_o (m_user),
      .m_axis_tlast_o (m_last),
      .moving_o       (moving)
  );
  stream_rules #(
      .BITS(FOLLOWED + 2)
  ) video (
      .clk_i,
      .rst_ni,
      .valid_i(m_valid),
      .ready_i(m_ready_i),
      .data_i ({m_data[FOLLOWED-1:0], m_user, m_last})
  );

  // ---- the colour that must leave ----------------------------------------------------------------------------------
  localparam int ProductBits = 8 + FactorBits;
  localparam int DarkAt = COUNT_BITS > 0 ? ExitCountsAt : ExitDarkAt;
  localparam logic [FactorBits-1:0] One = 1 << SHADE_FRAC;
  function automatic logic [7:0] color(input logic [1:0] line, input logic [1:0] x);
    logic [ExitBits-1:0] pixel;
    logic [FactorBits-1:0] keep;
    logic [ProductBits-1:0] product;
    pixel = pixels_q >> (ExitBits * {line, x});
    keep  = One;
    if (DSF_BITS > 0 && pixel[DarkAt])
      keep = One - shade[FactorBits*line+:FactorBits];  // a count of 1 is what a flag is
    product = ProductBits'(pixel[ExitColorAt+:8]) * ProductBits'(keep) + ProductBits'(1 << (SHADE_FRAC - 1));
    color   = product >> SHADE_FRAC;
    if (blank[line] || !(pixel[ExitCoveredAt] || (TRANSLUCENCY > 0 && painted[line]))) color = background[8*line+:8];
  endfunction
  logic [7:0] video_color, loads_color;
  assign video_color = color(video_line[1:0], video_x_q);
  assign loads_color = color(load_line[1:0], load_x_q);

  logic [3:0] wait_q;  // clocks in which both ways were ready, a line was wholly in and announced, and no pixel left
  logic quiet_q, was_valid_q, was_load_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || video_step || load_step || in_q == left_q || (told_q == left_q && !line_valid_i)) wait_q <= '0;
    else if (m_ready_i && load_ready_i && !(&wait_q)) wait_q <= wait_q + 1'b1;
    quiet_q <= rst_ni && !moving && !video_step && !load_step && !exit_valid;
    {was_valid_q, was_load_q} <= {m_valid, load_valid};
  end
  if (MODEL > 0) begin : gen_model
    always_comb begin
      if (started_q && rst_ni) begin
        if (m_valid) begin
          video_early : assert (video_line < told_q && video_line < begun_q);
          pixels : assert (m_data[FOLLOWED-1:0] == video_color[FOLLOWED-1:0]);
          marks :
          assert (m_user == (first[video_line[1:0]] && video_x_q == '0) && m_last == (video_x_q == video_width));
        end
        if (line_valid_i && line_ready) lines : assert (told_q < begun_q);
        prompt : assert (wait_q < 4'(MOST_WAIT));
        if (quiet_q) moves : assert ({m_valid, load_valid} == {was_valid_q, was_load_q});
        buffers : assert (exit_free || taken_q - left_q >= 3'd2);
      end
    end
  end
  if (COUNT_BITS > 0 && TRANSLUCENCY > 0) begin : gen_loads
    stream_rules #(
        .BITS(FOLLOWED + X_BITS + 1)
    ) load_out (
        .clk_i,
        .rst_ni,
        .valid_i(load_valid),
        .ready_i(load_ready_i),
        .data_i ({back_color[FOLLOWED-1:0], back_x, back_last})
    );
    always_comb begin
      if (MODEL > 0 && started_q && rst_ni && load_valid) begin
        load_early : assert (load_line < told_q && load_line < begun_q);
        loads : assert (back_x == X_BITS'(load_x_q) && back_last == (load_x_q == load_width));
        load_pixels : assert (back_color[FOLLOWED-1:0] == loads_color[FOLLOWED-1:0]);
      end
    end
  end else begin : gen_no_loads
    always_comb if (started_q) no_loads : assert (!load_valid);
  end

  // ---- what the rules are about happens within the bound -----------------------------------------------------------
  if (MODEL == 0) begin : gen_held
    if (COUNT_BITS == 0) always_comb if (started_q && rst_ni) pixel_held : cover (m_valid && !m_ready_i);
    if (COUNT_BITS > 0) always_comb if (started_q && rst_ni) load_held : cover (load_valid && !load_ready_i);
  end else begin : gen_reached
    always_comb begin
      if (started_q && rst_ni) begin
        pixel_out : cover (video_end);
        if (RESETS == 0 && MAX_WIDTH > 2) whole_line : cover (video_end && video_width == 2'd2);
        if (STALLS > 0 && RESETS == 0 && DSF_BITS == 0)
          stalled : cover (m_valid && !m_ready_i && line_valid_i && in_q == 3'd2);
        if (RESETS == 0 && DSF_BITS == 0 && MAX_WIDTH == 2)
          two_lines : cover (left_q == 3'd1 && !first[1] && video_end);
        if (STALLS == 0) two_frames : cover (left_q == 3'd1 && first[1] && video_end);
        if (DSF_BITS > 0 && FOLLOWED == 8 && COUNT_BITS == 0) begin
          dark_pixel : cover (m_valid && m_data == 8'd4 && pixels_q[9:0] == 10'h305 && !blank[0]);
          half_rounds : cover (m_valid && m_data == 8'd2 && pixels_q[9:0] == 10'h303 && shade[FactorBits-1:0] == 3'd2);
        end
        if (COUNT_BITS > 0) begin
          line_loaded : cover (load_end && load_width == 2'd1);
          load_overtakes : cover (load_valid && m_valid && load_line > video_line);
        end
      end
    end
  end

endmodule

`default_nettype wire
