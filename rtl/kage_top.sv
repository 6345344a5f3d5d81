// SPDX-License-Identifier: Apache-2.0
// kage: a span-stream rendering core. Frames of tokens in, video out; docs/stream.md is the contract, docs/rtl.md the
// guide.
//
//   s_axis -> token_reader -> frame_control -> pixel_core -> line_out -> m_axis
//                                    \---- lines ----^          registers on s_axil
//                     frame_control -> tree_core -> pixel_core      (UNITS > 0)
//
// Clocking: one clock, synchronous reset, active low. All outputs depend on registers only, but for the readies of
//   s_axis and s_axil, which rst_ni keeps low.
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
    input  wire logic        s_axil_awvalid_i,
    output logic             s_axil_awready_o,
    input  wire logic [ 7:0] s_axil_awaddr_i,
    input  wire logic        s_axil_wvalid_i,
    output logic             s_axil_wready_o,
    input  wire logic [31:0] s_axil_wdata_i,
    input  wire logic [ 3:0] s_axil_wstrb_i,
    output logic             s_axil_bvalid_o,
    input  wire logic        s_axil_bready_i,
    output logic      [ 1:0] s_axil_bresp_o,
    input  wire logic        s_axil_arvalid_i,
    output logic             s_axil_arready_o,
    input  wire logic [ 7:0] s_axil_araddr_i,
    output logic             s_axil_rvalid_o,
    input  wire logic        s_axil_rready_i,
    output logic      [31:0] s_axil_rdata_o,
    output logic      [ 1:0] s_axil_rresp_o,

    output logic irq_o
);
  `include "generated/kage_layout.svh"

  // ---- legal parameters --------------------------------------------------------------------------------------------
  `include "generated/kage_checks.svh"

  localparam int FrontWords = TokenWords > HeaderWords ? TokenWords : HeaderWords;
  localparam int ExitLanes = ARRANGEMENT == 1 ? LANES : 1;

  // ---- words to tokens ---------------------------------------------------------------------------------------------
  logic token_valid, token_ready, token_header, token_lacking, token_cut, token_final, token_at_last;
  logic [FrontWords*32-1:0] token;
  logic drop, dropping, reader_busy, reader_moving;

  token_reader #(
      `include "generated/kage_pixel_param_map.svh"
      .BEAT_WORDS (BEAT_WORDS),
      .TOKEN_WORDS(FrontWords)
  ) u_reader (
      .clk_i,
      .rst_ni,
      .s_valid_i      (s_axis_tvalid_i),
      .s_ready_o      (s_axis_tready_o),
      .s_data_i       (s_axis_tdata_i),
      .s_last_i       (s_axis_tlast_i),
      .token_valid_o  (token_valid),
      .token_ready_i  (token_ready),
      .token_o        (token),
      .token_header_o (token_header),
      .token_lacking_o(token_lacking),
      .token_cut_o    (token_cut),
      .token_final_o  (token_final),
      .token_at_last_o(token_at_last),
      .drop_i         (drop),
      .dropping_o     (dropping),
      .busy_o         (reader_busy),
      .moving_o       (reader_moving)
  );

  // ---- tokens to commands and lines --------------------------------------------------------------------------------
  logic cmd_valid, cmd_ready;
  logic [3:0] cmd_kind;
  logic [X_BITS-1:0] cmd_xl, cmd_xr;
  logic [CountBits-1:0] cmd_count;
  logic [DepthBits-1:0] cmd_z, cmd_dz;
  logic [ColorBits-1:0] cmd_color;
  logic [SlopeBits-1:0] cmd_dcolor;
  logic [ShareBits-1:0] cmd_share;

  localparam int LineBits = 4 + X_BITS + RgbBits + SHADE_FRAC + 1;
  logic line_valid, line_ready, line_first, line_blank, line_load, line_painted;
  logic [  X_BITS-1:0] line_width;
  logic [ RgbBits-1:0] line_background;
  logic [SHADE_FRAC:0] line_shade;
  logic queue_valid, queue_ready, queue_first, queue_blank, queue_load, queue_painted;
  logic [  X_BITS-1:0] queue_width;
  logic [ RgbBits-1:0] queue_background;
  logic [SHADE_FRAC:0] queue_shade;

  logic table_free, table_valid, load_valid, load_ready, load_last, loads_done;
  logic [    CLASS_BITS-1:0] table_class;
  logic [     LightBits-1:0] table_light;
  logic [EntryShareBits-1:0] table_share;
  logic [        X_BITS-1:0] load_x;
  logic [       RgbBits-1:0] load_color;

  // A line is under way from its EOL until its last pixel has left: at most 4 in the queue, 1 being sent, and, if each
  // has one pixel, 5 + LightStages in line_out's pipeline and 2 behind it. So is one that comes back as loads, until
  // its last has been taken.
  localparam int LinesBits = COUNT_BITS > 0 ? 5 : 4;
  logic [LinesBits-1:0] lines_q;

  logic tree_frame_start, tree_frame_ready, tree_flush, tree_claim, tree_face_valid, tree_seg_valid, tree_seg_ready;
  logic [ UnitBits-1:0] tree_unit;
  logic [FACE_BITS-1:0] tree_face;
  logic [EntryBits-1:0] tree_entry;
  logic [DepthBits-1:0] tree_seg_z;
  logic [  DX_BITS-1:0] tree_dx;

  logic frame_open, hungry, draining, painting, frame_end, error;
  logic behind;
  logic [5:0] error_unit, behind_unit;
  logic [14:0] behind_line;
  logic [ 3:0] error_code;
  logic [31:0] error_frame, error_token;
  logic [15:0] error_line;

  frame_control #(
      `include "generated/kage_pixel_param_map.svh"
      .MAX_WIDTH  (MAX_WIDTH),
      .TOKEN_WORDS(FrontWords)
  ) u_control (
      .clk_i,
      .rst_ni,
      .token_valid_i     (token_valid),
      .token_ready_o     (token_ready),
      .token_i           (token),
      .token_header_i    (token_header),
      .token_lacking_i   (token_lacking),
      .token_cut_i       (token_cut),
      .token_final_i     (token_final),
      .token_at_last_i   (token_at_last),
      .drop_o            (drop),
      .dropping_i        (dropping),
      .cmd_valid_o       (cmd_valid),
      .cmd_ready_i       (cmd_ready),
      .cmd_kind_o        (cmd_kind),
      .cmd_xl_o          (cmd_xl),
      .cmd_xr_o          (cmd_xr),
      .cmd_count_o       (cmd_count),
      .cmd_z_o           (cmd_z),
      .cmd_dz_o          (cmd_dz),
      .cmd_color_o       (cmd_color),
      .cmd_dcolor_o      (cmd_dcolor),
      .cmd_share_o       (cmd_share),
      .loads_done_i      (loads_done),
      .line_valid_o      (line_valid),
      .line_ready_i      (line_ready),
      .line_first_o      (line_first),
      .line_blank_o      (line_blank),
      .line_load_o       (line_load),
      .line_painted_o    (line_painted),
      .line_width_o      (line_width),
      .line_background_o (line_background),
      .line_shade_o      (line_shade),
      .table_free_i      (table_free),
      .table_valid_o     (table_valid),
      .table_class_o     (table_class),
      .table_light_o     (table_light),
      .table_share_o     (table_share),
      .tree_frame_start_o(tree_frame_start),
      .tree_frame_ready_i(tree_frame_ready),
      .tree_flush_o      (tree_flush),
      .tree_claim_o      (tree_claim),
      .tree_face_valid_o (tree_face_valid),
      .tree_seg_valid_o  (tree_seg_valid),
      .tree_seg_ready_i  (tree_seg_ready),
      .tree_unit_o       (tree_unit),
      .tree_face_o       (tree_face),
      .tree_entry_o      (tree_entry),
      .tree_z_o          (tree_seg_z),
      .tree_dx_o         (tree_dx),
      .open_o            (frame_open),
      .hungry_o          (hungry),
      .draining_o        (draining),
      .painting_o        (painting),
      .frame_end_o       (frame_end),
      .error_o           (error),
      .error_code_o      (error_code),
      .error_frame_o     (error_frame),
      .error_line_o      (error_line),
      .error_token_o     (error_token),
      .error_unit_o      (error_unit),
      .behind_o          (behind),
      .behind_unit_o     (behind_unit),
      .behind_line_o     (behind_line)
  );

  // Lines under way between control and way out: two in the buffers, one in its pass, one waiting for a buffer.
  stream_fifo #(
      .BITS (LineBits),
      .DEPTH(4)
  ) u_lines (
      .clk_i,
      .rst_ni,
      .in_valid_i (line_valid),
      .in_ready_o (line_ready),
      .in_data_i  ({line_first, line_blank, line_load, line_painted, line_width, line_background, line_shade}),
      .out_valid_o(queue_valid),
      .out_ready_i(queue_ready),
      .out_data_o ({queue_first, queue_blank, queue_load, queue_painted, queue_width, queue_background, queue_shade})
  );

  // ---- faces and segments to the tree's lines ----------------------------------------------------------------------
  logic tree_valid, tree_ready, tree_last, tree_drop, tree_moving;
  logic [CLASS_BITS-1:0] tree_class;
  logic [Z_BITS-1:0] tree_z;
  logic [RgbBits-1:0] tree_color;
  if (UNITS > 0) begin : gen_tree
    tree_core #(
        .X_BITS(X_BITS),
        .Z_BITS(Z_BITS),
        .Z_FRAC(Z_FRAC),
        .CHANNELS(CHANNELS),
        .DSF_BITS(DSF_BITS),
        .CLASS_BITS(CLASS_BITS),
        .UNITS(UNITS),
        .FACE_BITS(FACE_BITS),
        .DX_BITS(DX_BITS),
        .SEG_BITS(SEG_BITS),
        .ORDER_BITS(ORDER_BITS),
        .CLASSIC(CLASSIC)
    ) u_tree (
        .clk_i,
        .rst_ni,
        .frame_start_i(tree_frame_start),
        .frame_ready_o(tree_frame_ready),
        .flush_i      (tree_flush),
        .claim_i      (tree_claim),
        .width_i      (line_width),
        .face_valid_i (tree_face_valid),
        .face_unit_i  (tree_unit),
        .face_number_i(tree_face),
        .face_entry_i (tree_entry),
        .seg_valid_i  (tree_seg_valid),
        .seg_ready_o  (tree_seg_ready),
        .seg_unit_i   (tree_unit),
        .seg_z_i      (tree_seg_z),
        .seg_dx_i     (tree_dx),
        .seg_face_i   (tree_face),
        .line_valid_o (tree_valid),
        .line_ready_i (tree_ready),
        .line_z_o     (tree_z),
        .line_class_o (tree_class),
        .line_color_o (tree_color),
        .line_last_o  (tree_last),
        .drop_o       (tree_drop),
        .moving_o     (tree_moving)
    );
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = ^{tree_frame_start, tree_flush, tree_claim, tree_face_valid, tree_seg_valid, tree_unit,
                           tree_face,
                           tree_entry, tree_seg_z, tree_dx, tree_ready};
    assign {tree_frame_ready, tree_seg_ready, tree_valid, tree_z, tree_class, tree_color, tree_last, tree_drop} = '0;
    assign tree_moving = 1'b0;
  end

  // ---- commands to pixels ------------------------------------------------------------------------------------------
  logic exit_free, exit_take, exit_valid, exit_last, pixels_moving, out_moving;
  logic [ExitLanes*ExitBits-1:0] exit_data;
  logic pixel_valid, pixel_ready;
  logic [3:0] pixel_kind;
  logic [X_BITS-1:0] pixel_xl, pixel_xr;
  logic [ColorBits-1:0] pixel_color;
  logic [SlopeBits-1:0] pixel_dcolor;

  pixel_loads #(
      .X_BITS(X_BITS),
      .CHANNELS(CHANNELS),
      .SMOOTH(SMOOTH),
      .COLOR_FRAC(COLOR_FRAC),
      .COUNT_BITS(COUNT_BITS),
      .TRANSLUCENCY(TRANSLUCENCY)
  ) u_loads (
      .in_valid_i  (cmd_valid),
      .in_ready_o  (cmd_ready),
      .in_kind_i   (cmd_kind),
      .in_xl_i     (cmd_xl),
      .in_xr_i     (cmd_xr),
      .in_color_i  (cmd_color),
      .in_dcolor_i (cmd_dcolor),
      .load_valid_i(load_valid),
      .load_ready_o(load_ready),
      .load_x_i    (load_x),
      .load_color_i(load_color),
      .load_last_i (load_last),
      .done_o      (loads_done),
      .out_valid_o (pixel_valid),
      .out_ready_i (pixel_ready),
      .out_kind_o  (pixel_kind),
      .out_xl_o    (pixel_xl),
      .out_xr_o    (pixel_xr),
      .out_color_o (pixel_color),
      .out_dcolor_o(pixel_dcolor)
  );

  pixel_core #(
      `include "generated/kage_pixel_param_map.svh"
      .ARRANGEMENT(ARRANGEMENT),
      .LANES(LANES),
      .MAX_WIDTH(MAX_WIDTH)
  ) u_pixels (
      .clk_i,
      .rst_ni,
      .cmd_valid_i (pixel_valid),
      .cmd_ready_o (pixel_ready),
      .cmd_kind_i  (pixel_kind),
      .cmd_xl_i    (pixel_xl),
      .cmd_xr_i    (pixel_xr),
      .cmd_count_i (cmd_count),
      .cmd_z_i     (cmd_z),
      .cmd_dz_i    (cmd_dz),
      .cmd_color_i (pixel_color),
      .cmd_dcolor_i(pixel_dcolor),
      .cmd_share_i (cmd_share),
      .tree_valid_i(tree_valid),
      .tree_ready_o(tree_ready),
      .tree_z_i    (tree_z),
      .tree_class_i(tree_class),
      .tree_color_i(tree_color),
      .tree_last_i (tree_last),
      .tree_drop_i (tree_drop),
      .exit_free_i (exit_free),
      .exit_take_o (exit_take),
      .exit_valid_o(exit_valid),
      .exit_last_o (exit_last),
      .exit_data_o (exit_data),
      .moving_o    (pixels_moving)
  );

  line_out #(
      `include "generated/kage_pixel_param_map.svh"
      .LANES(ExitLanes),
      .MAX_WIDTH(MAX_WIDTH)
  ) u_out (
      .clk_i,
      .rst_ni,
      .exit_free_o      (exit_free),
      .exit_take_i      (exit_take),
      .exit_valid_i     (exit_valid),
      .exit_last_i      (exit_last),
      .exit_data_i      (exit_data),
      .line_valid_i     (queue_valid),
      .line_ready_o     (queue_ready),
      .line_first_i     (queue_first),
      .line_blank_i     (queue_blank),
      .line_load_i      (queue_load),
      .line_painted_i   (queue_painted),
      .line_width_i     (queue_width),
      .line_background_i(queue_background),
      .line_shade_i     (queue_shade),
      .table_valid_i    (table_valid),
      .table_class_i    (table_class),
      .table_light_i    (table_light),
      .table_share_i    (table_share),
      .load_valid_o     (load_valid),
      .load_ready_i     (load_ready),
      .load_x_o         (load_x),
      .load_color_o     (load_color),
      .load_last_o      (load_last),
      .m_valid_o        (m_axis_tvalid_o),
      .m_ready_i        (m_axis_tready_i),
      .m_data_o         (m_axis_tdata_o),
      .m_user_o         (m_axis_tuser_o),
      .m_last_o         (m_axis_tlast_o),
      .moving_o         (out_moving)
  );

  // ---- status ------------------------------------------------------------------------------------------------------
  logic line_gone, in_frame, frame_here, waiting_input, waiting_output, progress;
  assign table_free = lines_q == '0;
  assign line_gone  = m_axis_tvalid_o && m_axis_tready_i && m_axis_tlast_o;
  logic told_q;  // a token has been taken in the clock before: which unit is waited for is known a clock after it
  always_ff @(posedge clk_i) begin
    told_q <= rst_ni && UNITS > 0 && token_valid && token_ready;
    if (!rst_ni) lines_q <= '0;
    else lines_q <= lines_q + LinesBits'(line_valid) - LinesBits'(line_gone) - LinesBits'(loads_done);
  end
  assign in_frame = reader_busy || frame_open;
  assign frame_here = in_frame || lines_q != '0;
  assign waiting_input = in_frame && hungry && !token_valid && s_axis_tready_o && !s_axis_tvalid_i;
  assign waiting_output = m_axis_tvalid_o && !m_axis_tready_i;
  // Whatever moves is progress. So nothing but the ports can keep a frame waiting (assertion 1), and the watchdog bites
  // only if one of them does.
  assign progress = (s_axis_tvalid_i && s_axis_tready_o) || reader_moving || (token_valid && token_ready) ||
      told_q || painting || frame_end || line_valid || (pixel_valid && pixel_ready) || pixels_moving || out_moving ||
      tree_moving || (m_axis_tvalid_o && m_axis_tready_i);

  registers #(
      `include "generated/kage_pixel_param_map.svh"
      `include "generated/kage_impl_param_map.svh"
  ) u_registers (
      .clk_i,
      .rst_ni,
      .awvalid_i       (s_axil_awvalid_i),
      .awready_o       (s_axil_awready_o),
      .awaddr_i        (s_axil_awaddr_i),
      .wvalid_i        (s_axil_wvalid_i),
      .wready_o        (s_axil_wready_o),
      .wdata_i         (s_axil_wdata_i),
      .wstrb_i         (s_axil_wstrb_i),
      .bvalid_o        (s_axil_bvalid_o),
      .bready_i        (s_axil_bready_i),
      .bresp_o         (s_axil_bresp_o),
      .arvalid_i       (s_axil_arvalid_i),
      .arready_o       (s_axil_arready_o),
      .araddr_i        (s_axil_araddr_i),
      .rvalid_o        (s_axil_rvalid_o),
      .rready_i        (s_axil_rready_i),
      .rdata_o         (s_axil_rdata_o),
      .rresp_o         (s_axil_rresp_o),
      .irq_o,
      .open_i          (frame_here),
      .draining_i      (draining),
      .waiting_input_i (waiting_input),
      .waiting_output_i(waiting_output),
      .progress_i      (progress),
      .frame_end_i     (frame_end),
      .error_i         (error),
      .error_code_i    (error_code),
      .error_frame_i   (error_frame),
      .error_line_i    (error_line),
      .error_token_i   (error_token),
      .error_unit_i    (error_unit),
      .behind_i        (behind),
      .behind_unit_i   (behind_unit),
      .behind_line_i   (behind_line)
  );

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. A frame that does not move waits for one of the ports: for input until that is done, or for output.
      assert (!frame_here || progress || (in_frame && s_axis_tready_o && !s_axis_tvalid_i) || waiting_output);
      // 2. The count of lines under way stays within its bits.
      assert (!(&lines_q) || !line_valid);
    end
  end
`endif

endmodule

`default_nettype wire
