// SPDX-License-Identifier: Apache-2.0
// kage: a span-stream rendering core. Frames of tokens in, video out; docs/stream.md is the contract, docs/rtl.md the
// guide.
//
//    s_axis -> token_reader -> frame_control -> pixel_loads -> pixel_core -> line_out -> m_axis
//    token_reader -> front_end -> frame_control     polygons to spans                                    (ACTIVE > 0)
//    frame_control -> tree_core -> pixel_core       faces and segments, and lines of the tree        (UNITS > 0)
//    frame_control -> line_queue -> line_out        what a line is, in order
//    frame_control -> line_out                      the light table                                  (CLASS_BITS > 1)
//    line_out -> pixel_loads                        colours that come back     (counters or linear light, TRANSLUCENCY)
//    all of these -> registers on s_axil            status, errors, end of frame, what moves
//
// Clocking: one clock, synchronous reset, active low. All outputs depend on registers only, but for the readies of
//   s_axis and s_axil, which rst_ni keeps low.
// Latency: the sum of the modules' (docs/rtl.md), and the clocks that a line's spans take.
// Throughput: a token, a group of LANES pixels, a pixel out a clock each; the slowest of the three decides.
// Cost: docs/rtl.md has the cells of configurations, docs/timing.md their clocks on devices.
// Reset: at any time, for one clock or more; the input's next beat must then be the first of a frame. Nothing is taken
//   and lost in reset: no input is ready. The valids are low from the second clock of it on.
`default_nettype none
`include "kage_illegal.svh"

module kage_top #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // frame stream
    input  wire logic                     s_axis_tvalid_i,
    output logic                          s_axis_tready_o,
    input  wire logic [BEAT_WORDS*32-1:0] s_axis_tdata_i,
    input  wire logic                     s_axis_tlast_i,

    // video
    output logic                    m_axis_tvalid_o,
    input  wire logic               m_axis_tready_i,
    output logic      [RgbBits-1:0] m_axis_tdata_o,
    output logic                    m_axis_tuser_o,
    output logic                    m_axis_tlast_o,

    // registers
    `include "kage_axil_ports.svh"

    output logic irq_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  // ---- legal parameters --------------------------------------------------------------------------------------------
  `include "generated/kage_checks.svh"

  localparam int Polygons = ACTIVE > 0 ? 1 : 0;  // frames at the polygon level come too
  localparam int FrontWords = TokenWords > HeaderWords ? TokenWords : HeaderWords;
  localparam int ReaderWords = Polygons > 0 && PolygonTokenWords > FrontWords ? PolygonTokenWords : FrontWords;
  localparam int ExitLanes = ARRANGEMENT == 1 ? LANES : 1;

  // ---- words to tokens ---------------------------------------------------------------------------------------------
  // `.*` connects clock, reset, and the ports of kage_top that the comment behind it names.
  logic read_valid, read_ready;
  logic [ReaderWords*32-1:0] read;
  flags_t read_flags;
  logic reader_drop, reader_dropping, reader_busy, reader_moving;

  token_reader #(
      .BEAT_WORDS (BEAT_WORDS),
      .TOKEN_WORDS(ReaderWords),
      .POLYGONS   (Polygons),
      `include "generated/kage_pixel_param_map.svh"
  ) u_reader (
      .token_valid_o(read_valid),
      .token_ready_i(read_ready),
      .token_o      (read),
      .token_flags_o(read_flags),
      .drop_i       (reader_drop),
      .dropping_o   (reader_dropping),
      .busy_o       (reader_busy),
      .moving_o     (reader_moving),
      .*  // s_axis_*
  );

  // ---- polygons to spans -------------------------------------------------------------------------------------------
  logic token_valid, token_ready;
  logic [FrontWords*32-1:0] token;
  logic [31:0] token_index;
  flags_t flags;
  logic drop, dropping, front_busy, front_moving;
  if (Polygons > 0) begin : gen_front_end
    front_end #(
        .ACTIVE   (ACTIVE),
        .IN_WORDS (ReaderWords),
        .OUT_WORDS(FrontWords),
        `include "generated/kage_pixel_param_map.svh"
    ) u_front_end (
        .clk_i,
        .rst_ni,
        .token_valid_i(read_valid),
        .token_ready_o(read_ready),
        .token_i      (read),
        .token_flags_i(read_flags),
        .drop_o       (reader_drop),
        .dropping_i   (reader_dropping),
        .token_valid_o(token_valid),
        .token_ready_i(token_ready),
        .token_o      (token),
        .token_flags_o(flags),
        .token_index_o(token_index),
        .drop_i       (drop),
        .dropping_o   (dropping),
        .busy_o       (front_busy),
        .moving_o     (front_moving)
    );
  end else begin : gen_no_front_end
    assign token_valid = read_valid;
    assign read_ready = token_ready;
    assign token = read;
    assign flags = read_flags;
    assign token_index = '0;
    assign reader_drop = drop;
    assign dropping = reader_dropping;
    assign {front_busy, front_moving} = '0;
  end

  // ---- tokens to commands and lines --------------------------------------------------------------------------------
  logic cmd_valid, cmd_ready;
  command_t cmd;

  logic line_valid, line_ready, queue_valid, queue_ready, lines_moving;
  line_t line, queue_line;

  logic table_free, table_valid, load_valid, load_ready, loads_done;
  table_entry_t table_entry;
  load_t load;

  // A line is under way from its EOL until its last pixel has left, and one that comes back as loads until its last has
  // been taken. At most 4 are in the queue and 1 is being sent. If each has one pixel, 5 + LightStages are in
  // line_out's pipeline and 2 behind it.
  localparam int LinesBits = LightStages > 0 ? 5 : 4;
  logic [LinesBits-1:0] lines_q;

  logic tree_frame_ready, tree_seg_valid, tree_seg_ready;
  tree_call_t tree_call;
  piece_t tree_piece;

  logic frame_open, hungry, draining, control_moving, frame_end, error_valid, behind_valid;
  error_t  error;
  behind_t behind;

  frame_control #(
      .MAX_WIDTH  (MAX_WIDTH),
      .TOKEN_WORDS(FrontWords),
      .POLYGONS   (Polygons),
      `include "generated/kage_pixel_param_map.svh"
  ) u_control (
      .clk_i,
      .rst_ni,
      .token_valid_i     (token_valid),
      .token_ready_o     (token_ready),
      .token_i           (token),
      .token_flags_i     (flags),
      .token_index_i     (token_index),
      .drop_o            (drop),
      .dropping_i        (dropping),
      .cmd_valid_o       (cmd_valid),
      .cmd_ready_i       (cmd_ready),
      .cmd_o             (cmd),
      .loads_done_i      (loads_done),
      .line_valid_o      (line_valid),
      .line_ready_i      (line_ready),
      .line_o            (line),
      .table_free_i      (table_free),
      .table_valid_o     (table_valid),
      .table_o           (table_entry),
      .tree_call_o       (tree_call),
      .tree_frame_ready_i(tree_frame_ready),
      .tree_seg_valid_o  (tree_seg_valid),
      .tree_seg_ready_i  (tree_seg_ready),
      .tree_piece_o      (tree_piece),
      .open_o            (frame_open),
      .hungry_o          (hungry),
      .draining_o        (draining),
      .moving_o          (control_moving),
      .frame_end_o       (frame_end),
      .error_valid_o     (error_valid),
      .error_o           (error),
      .behind_valid_o    (behind_valid),
      .behind_o          (behind)
  );

  line_queue #(
      .BITS(LineBits)
  ) u_lines (
      .clk_i,
      .rst_ni,
      .in_valid_i (line_valid),
      .in_ready_o (line_ready),
      .in_data_i  (line),
      .out_valid_o(queue_valid),
      .out_ready_i(queue_ready),
      .out_data_o (queue_line),
      .moving_o   (lines_moving)
  );

  // ---- faces and segments to the tree's lines ----------------------------------------------------------------------
  logic tree_valid, tree_ready, tree_drop, tree_moving;
  tree_pixel_t tree_pixel;
  if (UNITS > 0) begin : gen_tree
    tree_core #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_tree (
        .clk_i,
        .rst_ni,
        .call_i       (tree_call),
        .frame_ready_o(tree_frame_ready),
        .seg_valid_i  (tree_seg_valid),
        .seg_ready_o  (tree_seg_ready),
        .piece_i      (tree_piece),
        .line_valid_o (tree_valid),
        .line_ready_i (tree_ready),
        .line_o       (tree_pixel),
        .drop_o       (tree_drop),
        .moving_o     (tree_moving)
    );
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = ^{tree_call, tree_seg_valid, tree_piece, tree_ready};
    assign {tree_frame_ready, tree_seg_ready, tree_valid, tree_pixel, tree_drop} = '0;
    assign tree_moving = 1'b0;
  end

  // ---- commands to pixels ------------------------------------------------------------------------------------------
  logic exit_free, exit_take, exit_valid, exit_last, pixels_moving, out_moving;
  logic [ExitLanes*ExitBits-1:0] exit_data;
  logic pixel_valid, pixel_ready;
  command_t pixel_cmd;

  pixel_loads #(
      `include "generated/kage_pixel_param_map.svh"
  ) u_loads (
      .in_valid_i  (cmd_valid),
      .in_ready_o  (cmd_ready),
      .in_i        (cmd),
      .load_valid_i(load_valid),
      .load_ready_o(load_ready),
      .load_i      (load),
      .done_o      (loads_done),
      .out_valid_o (pixel_valid),
      .out_ready_i (pixel_ready),
      .out_o       (pixel_cmd)
  );

  pixel_core #(
      .ARRANGEMENT(ARRANGEMENT),
      .LANES(LANES),
      .MAX_WIDTH(MAX_WIDTH),
      `include "generated/kage_pixel_param_map.svh"
  ) u_pixels (
      .clk_i,
      .rst_ni,
      .cmd_valid_i (pixel_valid),
      .cmd_ready_o (pixel_ready),
      .cmd_i       (pixel_cmd),
      .tree_valid_i(tree_valid),
      .tree_ready_o(tree_ready),
      .tree_i      (tree_pixel),
      .tree_drop_i (tree_drop),
      .exit_free_i (exit_free),
      .exit_take_o (exit_take),
      .exit_valid_o(exit_valid),
      .exit_last_o (exit_last),
      .exit_data_o (exit_data),
      .moving_o    (pixels_moving)
  );

  line_out #(
      .LANES(ExitLanes),
      .MAX_WIDTH(MAX_WIDTH),
      `include "generated/kage_pixel_param_map.svh"
  ) u_out (
      .exit_free_o  (exit_free),
      .exit_take_i  (exit_take),
      .exit_valid_i (exit_valid),
      .exit_last_i  (exit_last),
      .exit_data_i  (exit_data),
      .line_valid_i (queue_valid),
      .line_ready_o (queue_ready),
      .line_i       (queue_line),
      .table_valid_i(table_valid),
      .table_i      (table_entry),
      .load_valid_o (load_valid),
      .load_ready_i (load_ready),
      .load_o       (load),
      .moving_o     (out_moving),
      .*  // m_axis_*
  );

  // ---- status ------------------------------------------------------------------------------------------------------
  logic line_gone, in_frame, frame_here, waiting_input, waiting_output;
  assign table_free = lines_q == '0;
  assign line_gone  = m_axis_tvalid_o && m_axis_tready_i && m_axis_tlast_o;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) lines_q <= '0;
    else lines_q <= lines_q + LinesBits'(line_valid) - LinesBits'(line_gone) - LinesBits'(loads_done);
  end
  assign in_frame = reader_busy || front_busy || frame_open;
  assign frame_here = in_frame || lines_q != '0;
  // Unless front_moving, which registers is told apart.
  assign waiting_input = in_frame && hungry && !token_valid && s_axis_tready_o && !s_axis_tvalid_i;
  assign waiting_output = m_axis_tvalid_o && !m_axis_tready_i;
  // Whatever moves is progress. So nothing but the ports can keep a frame waiting (assertion 1), and the watchdog bites
  // only if one of them does.
  localparam int Parts = 10;
  logic [Parts-1:0] progress;
  assign progress = {
    s_axis_tvalid_i && s_axis_tready_o,
    m_axis_tvalid_o && m_axis_tready_i,
    reader_moving,
    front_moving,
    control_moving,
    lines_moving,
    pixel_valid && pixel_ready,
    pixels_moving,
    out_moving,
    tree_moving
  };

  registers #(
      .PARTS(Parts),
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh"
  ) u_registers (
      .open_i          (frame_here),
      .draining_i      (draining),
      .waiting_input_i (waiting_input),
      .coming_i        (front_moving),
      .waiting_output_i(waiting_output),
      .progress_i      (progress),
      .frame_end_i     (frame_end),
      .error_valid_i   (error_valid),
      .error_i         (error),
      .behind_valid_i  (behind_valid),
      .behind_i        (behind),
      .*  // s_axil_*, irq_o
  );

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. A frame without progress waits for input that has not all come, or for the sink to take a pixel.
      assert (!frame_here || progress != '0 || (in_frame && s_axis_tready_o && !s_axis_tvalid_i) || waiting_output);
      // 2. The count of lines under way stays within its bits.
      assert (!(&lines_q) || !line_valid);
    end
  end
`endif

endmodule

`default_nettype wire
