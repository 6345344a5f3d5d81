// SPDX-License-Identifier: Apache-2.0
// The frame: checks header and tokens as docs/stream.md demands, keeps line number, phase and bias, and turns tokens into
// commands for the pixels and lines for the way out. What is downstream never sees a malformed stream.
//
// Handshake: token_* and cmd_* are valid/ready. token_ready_o depends on cmd_ready_i and line_ready_i. line_valid_o waits for
//   line_ready_i, which must not depend on it: a line is passed on in the clock in which its EOL becomes a command, so lines and
//   EOL commands come in the same order.
// Commands: OP, SP, NC, EV, ES, TP with 0 <= xl < xr <= width, and TREE and EOL with xl = 0, xr = width. Empty spans, SHADE, IF and RESOLVE
//   take their clock here and go no further: cmd_count_o brings the line's bias with EV, ES and EOL. A line's first TP is preceded by the
//   command RESOLVE, which has no token: over the whole line, with the background as its colour. It costs a clock.
//   With counters, if there was a RESOLVE to do, it is preceded by the command CmdOut instead: the line's pixels leave, by a line that says
//   line_load_o, and come back as loads. Nothing is taken or given until loads_done_i, one clock, says that they have.
// Light table (CLASS_BITS > 1): TABLEs go to the way out by table_*, in the clock they are taken, and wait for table_free_i: that
//   nothing of the frame before is left there. table_check has the rules.
// Errors: the first one of a frame is reported by error_o for one clock. From then on the frame's lines are blank: EOL commands
//   clear the state and the line says that its pixels are background. Tokens are dropped by drop_o.
// Units (UNITS > 0): FACE and SEG go to the tree in the clock they are taken and need no command; a SEG waits for its unit by
//   tree_seg_ready_i, a header for tree_frame_ready_i, and neither of these may depend on a valid. A SEG whose unit is at fault goes
//   nowhere. tree_claim_o, one clock, says that a TREE became a command; tree_flush_o, one clock, that there will be no more of this
//   frame. segment_check has the rules. Without units these outputs are 0 and the inputs do not matter.
// Latency: 1 clock from token to command. Throughput: a token a clock.
`default_nettype none

module frame_control #(
    `include "kage_pixel_params.svh"
    `include "kage_widths.svh"
    parameter int MAX_WIDTH   = 640,
    parameter int TOKEN_WORDS = 5
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from token_reader
    input  wire logic                      token_valid_i,
    output logic                           token_ready_o,
    input  wire logic [TOKEN_WORDS*32-1:0] token_i,
    input  wire logic                      token_header_i,
    input  wire logic                      token_lacking_i,
    input  wire logic                      token_cut_i,
    input  wire logic                      token_final_i,
    input  wire logic                      token_at_last_i,
    output logic                           drop_o,
    input  wire logic                      dropping_i,

    // to the pixels
    output logic                      cmd_valid_o,
    input  wire logic                 cmd_ready_i,
    output logic      [          3:0] cmd_kind_o,
    output logic      [   X_BITS-1:0] cmd_xl_o,
    output logic      [   X_BITS-1:0] cmd_xr_o,
    output logic      [CountBits-1:0] cmd_count_o,   // as pixel_next has it
    output logic      [DepthBits-1:0] cmd_z_o,
    output logic      [DepthBits-1:0] cmd_dz_o,
    output logic      [ColorBits-1:0] cmd_color_o,
    output logic      [SlopeBits-1:0] cmd_dcolor_o,
    output logic      [ShareBits-1:0] cmd_share_o,   // alpha of TP, shade of RESOLVE
    input  wire logic                 loads_done_i,

    // to the way out: the lines in order
    output logic                     line_valid_o,
    input  wire logic                line_ready_i,
    output logic                     line_first_o,       // of its frame
    output logic                     line_blank_o,       // background from its first pixel
    output logic                     line_load_o,        // not for the video: it comes back to the pixels
    output logic                     line_painted_o,     // every pixel has its colour: uncovered ones the background's
    output logic      [  X_BITS-1:0] line_width_o,
    output logic      [ RgbBits-1:0] line_background_o,
    output logic      [SHADE_FRAC:0] line_shade_o,

    // to the way out: entries of the light table
    input  wire logic                      table_free_i,
    output logic                           table_valid_o,
    output logic      [    CLASS_BITS-1:0] table_class_o,
    output logic      [     LightBits-1:0] table_light_o,
    output logic      [EntryShareBits-1:0] table_share_o,

    // to the units and the tree; the width is line_width_o
    output logic                      tree_frame_start_o,
    input  wire logic                 tree_frame_ready_i,
    output logic                      tree_flush_o,
    output logic                      tree_claim_o,
    output logic                      tree_face_valid_o,
    output logic                      tree_seg_valid_o,
    input  wire logic                 tree_seg_ready_i,
    output logic      [ UnitBits-1:0] tree_unit_o,         // of FACE and SEG, as the next
    output logic      [FACE_BITS-1:0] tree_face_o,
    output logic      [EntryBits-1:0] tree_entry_o,
    output logic      [DepthBits-1:0] tree_z_o,
    output logic      [  DX_BITS-1:0] tree_dx_o,

    // to the registers
    output logic        open_o,         // a frame's header has been taken and the frame has not ended
    output logic        hungry_o,       // waits for a token or for TLAST
    output logic        draining_o,     // input is being dropped after an error
    output logic        painting_o,     // one clock: a TP waits while the RESOLVE or CmdOut before it becomes a command
    output logic        frame_end_o,    // one clock
    output logic        error_o,        // one clock, with the next five
    output logic [ 3:0] error_code_o,
    output logic [31:0] error_frame_o,
    output logic [15:0] error_line_o,
    output logic [31:0] error_token_o,
    output logic [ 5:0] error_unit_o,
    output logic        behind_o,       // a unit has less of the frame than another, with the next two; 1 clock late
    output logic [ 5:0] behind_unit_o,
    output logic [14:0] behind_line_o   // its first line that is not whole; without units the line at hand
);
  `include "kage_layout.svh"

  localparam logic [1:0] StHeader = 2'd0;
  localparam logic [1:0] StBody = 2'd1;  // tokens of an error-free frame
  localparam logic [1:0] StBlank = 2'd2;  // after an error: the rest is background

  localparam logic [SHADE_FRAC:0] ShadeMost = {1'b1, {SHADE_FRAC{1'b0}}};

  // ---- state -------------------------------------------------------------------------------------------------------
  logic [1:0] state_q;
  logic painted_q;  // the line's colours are ready for TPs
  logic loading_q;  // they are on their way out and back
  logic [X_BITS-1:0] width_q;
  logic [14:0] height_q, line_q;
  logic [31:0] frame_q, index_q;
  logic [RgbBits-1:0] background_q;
  logic [SHADE_FRAC:0] shade_q;

  // ---- decode ------------------------------------------------------------------------------------------------------
  logic [3:0] kind;
  logic is_shade, is_op, is_sp, is_nc, is_ev, is_eol, is_end, is_span, is_tree, is_tp, is_es, is_table;
  logic [X_BITS-1:0] xl, xr;
  logic [SHADE_FRAC:0] shade;

  assign kind = token_i[3:0];
  assign is_shade = kind == KindShade;
  assign is_op = kind == KindOp;
  assign is_sp = kind == KindSp;
  assign is_nc = kind == KindNc;
  assign is_ev = kind == KindEv;
  assign is_eol = kind == KindEol;
  assign is_end = kind == KindEnd;
  assign is_tree = UNITS > 0 && kind == KindTree;
  assign is_tp = TRANSLUCENCY > 0 && kind == KindTp;
  assign is_es = COUNT_BITS > 0 && kind == KindEs;
  assign is_span = is_op || is_sp || is_nc || is_ev || is_es || is_tp;
  assign xl = token_i[OpXlLsb+:X_BITS];  // the place is the same in OP, SP, NC, EV, ES and TP
  assign xr = token_i[OpXrLsb+:X_BITS];
  assign shade = token_i[ShadeShadeLsb+:SHADE_FRAC+1];

  // ---- header ------------------------------------------------------------------------------------------------------
  logic [15:0] head_width, head_height;
  logic [3:0] head_error;
  assign head_width  = token_i[47:32];
  assign head_height = token_i[63:48];
  always_comb begin
    if (token_cut_i) head_error = ErrLastEarly;
    else if (token_i[31:0] != {16'(StreamMagic), 16'(StreamVersion)}) head_error = ErrHeader;
    else if (head_width == '0 || head_width > 16'(MAX_WIDTH)) head_error = ErrSize;
    else if (head_height == '0 || head_height[15]) head_error = ErrSize;
    else if (token_i[95:64] != ParamHash) head_error = ErrParams;
    else head_error = ErrNone;
  end

  // ---- order, range, line ------------------------------------------------------------------------------------------
  logic lines_done, in_phase, in_order, in_range, in_line, resolved;
  logic tree_order_error, tree_range_error, tree_error;  // those of FACE, SEG and TREE; see gen_tree below
  logic table_order_error, table_range_error, light_lacking;  // those of TABLE and classes, see gen_table; of ES
  logic [3:0] body_error, tree_code;
  logic shade_seen_q;
  assign lines_done = line_q == height_q;
  assign light_lacking = is_es && 32'(token_i[EsLightLsb+:LightBits]) >= 32'(LIGHTS);
  always_comb begin
    unique case (kind)
      KindShade: in_order = UNITS > 0 ? !shade_seen_q : index_q == 32'd1;
      KindTable: in_order = !table_order_error;
      default:   in_order = in_phase;
    endcase
    if ((lines_done && !is_end) || tree_order_error) in_order = 1'b0;
    in_range = !(is_span && (xl > xr || xr > width_q)) && !(is_shade && shade > ShadeMost) && !light_lacking;
    if (tree_range_error || table_range_error) in_range = 1'b0;
    in_line = !(is_eol && token_i[EolYLsb+:16] != 16'(line_q)) && !(is_end && !lines_done);
    if (token_cut_i) body_error = ErrLastEarly;
    else if (token_lacking_i) body_error = ErrKind;
    else if (!in_order) body_error = ErrOrder;
    else if (!in_range) body_error = ErrRange;
    else if (!in_line) body_error = ErrLine;
    else if (tree_error) body_error = tree_code;
    else if (is_end && !token_at_last_i) body_error = ErrLastLate;
    else body_error = ErrNone;
  end

  // ---- what happens in this clock ----------------------------------------------------------------------------------
  logic cmd_free, eol_free, accept, bad, good, body_eol, blank_eol, emit_eol, emit_span;
  logic emit_tree, emit_paint, emit_out, body_free, frame_free, must_paint;
  logic by_loads;
  logic [3:0] error_code;
  assign eol_free = cmd_free && line_ready_i;
  assign token_ready_o = (state_q == StHeader && frame_free) ||
      (state_q == StBody && body_free && (line_ready_i || !is_eol) && (table_free_i || !is_table) && !must_paint);
  assign accept = token_valid_i && token_ready_o;
  assign error_code = token_header_i ? head_error : body_error;
  assign bad = accept && error_code != ErrNone;
  assign good = accept && error_code == ErrNone;
  assign body_eol = good && !token_header_i && is_eol;
  assign blank_eol = state_q == StBlank && !lines_done && eol_free;
  assign emit_eol = body_eol || blank_eol;
  assign emit_span = good && !token_header_i && is_span && xl != xr;
  assign emit_tree = good && !token_header_i && is_tree;
  // Before a line's first TP a RESOLVE goes over it, even if that TP is malformed or empty: after the former the line is blank, and
  // to the latter it does no harm.
  assign must_paint = is_tp && !painted_q;
  assign emit_paint = must_paint && token_valid_i && state_q == StBody && cmd_free && !loading_q &&
      (line_ready_i || !by_loads);
  // With counters only the way out can darken; a line without RESOLVE has nothing to darken.
  assign by_loads = TRANSLUCENCY > 0 && COUNT_BITS > 0 && resolved;
  assign emit_out = emit_paint && by_loads;
  assign drop_o = bad && !token_final_i;

  assign line_valid_o = emit_eol || emit_out;
  assign line_load_o = emit_out;
  assign line_first_o = line_q == '0;
  assign line_blank_o = blank_eol;
  assign line_painted_o = painted_q;
  assign line_width_o = width_q;
  assign line_background_o = background_q;
  assign line_shade_o = shade_q;

  assign open_o = state_q != StHeader;
  assign hungry_o = state_q == StHeader || (state_q == StBody && cmd_free) || (state_q == StBlank && lines_done);
  assign painting_o = emit_paint;
  assign draining_o = state_q == StBlank && dropping_i;
  assign frame_end_o = (good && !token_header_i && is_end) || (state_q == StBlank && lines_done && !dropping_i);
  assign error_o = bad;
  assign error_code_o = error_code;
  assign error_frame_o = token_header_i ? (token_cut_i ? 32'd0 : token_i[159:128]) : frame_q;
  assign error_line_o = token_header_i ? 16'd0 : 16'(line_q);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= StHeader;
    end else begin
      if (good && token_header_i) state_q <= StBody;
      if (bad) state_q <= StBlank;
      if (frame_end_o) state_q <= StHeader;
    end
  end

  always_ff @(posedge clk_i) begin
    if (accept && token_header_i) begin
      width_q <= token_i[32+:X_BITS];
      height_q <= bad ? '0 : token_i[62:48];  // no lines after an error in the header
      background_q <= token_i[96+:RgbBits];
      frame_q <= token_i[159:128];
      line_q <= '0;
      index_q <= 32'd1;
      painted_q <= 1'b0;
      loading_q <= 1'b0;
      shade_q <= '0;
    end else begin
      if (good) index_q <= index_q + 32'd1;
      if (emit_eol) begin
        line_q <= line_q + 15'd1;
        painted_q <= 1'b0;
      end
      if (emit_paint) begin
        if (by_loads) loading_q <= 1'b1;
        else painted_q <= 1'b1;
      end
      if (TRANSLUCENCY > 0 && COUNT_BITS > 0 && loads_done_i) begin
        loading_q <= 1'b0;
        painted_q <= 1'b1;
      end
      if (DSF_BITS > 0 && good && is_shade) shade_q <= shade;
    end
  end

  logic [DsfBits-1:0] bias;
  line_phase #(
      .TRANSLUCENCY(TRANSLUCENCY),
      .DSF_BITS(DSF_BITS),
      .FSF(FSF),
      .COUNT_BITS(COUNT_BITS)
  ) u_phase (
      .clk_i,
      .start_i     ((accept && token_header_i) || emit_eol),
      .take_i      (good && !token_header_i),
      .clear_bias_i(emit_paint),
      .kind_i      (kind),
      .w_i         (token_i[IfWLsb+:DsfBits]),
      .in_order_o  (in_phase),
      .resolved_o  (resolved),
      .bias_o      (bias)
  );

  // ---- command register --------------------------------------------------------------------------------------------
  token_command #(
      `include "kage_pixel_param_map.svh"
      .TOKEN_WORDS(TOKEN_WORDS)
  ) u_command (
      .clk_i,
      .rst_ni,
      .token_i,
      .width_i     (width_q),
      .share_i     (TRANSLUCENCY > 0 && COUNT_BITS == 0 ? ShareBits'(shade_q) : '0),
      .bias_i      (bias),
      .background_i(background_q),
      .free_o      (cmd_free),
      .make_span_i (emit_span),
      .make_tree_i (emit_tree),
      .make_eol_i  (emit_eol),
      .make_paint_i(emit_paint && !emit_out),
      .make_out_i  (emit_out),
      .cmd_valid_o,
      .cmd_ready_i,
      .cmd_kind_o,
      .cmd_xl_o,
      .cmd_xr_o,
      .cmd_count_o,
      .cmd_z_o,
      .cmd_dz_o,
      .cmd_color_o,
      .cmd_dcolor_o,
      .cmd_share_o
  );

  // ---- light table -------------------------------------------------------------------------------------------------
  assign table_class_o = token_i[TableClassLsb+:CLASS_BITS];
  assign table_light_o = token_i[TableLightLsb+:LightBits];
  assign table_share_o = token_i[TableShareLsb+:EntryShareBits];
  if (CLASS_BITS > 1) begin : gen_table
    logic lacking, class_used, entry_error;
    logic [CLASS_BITS-1:0] span_class;
    assign is_table = kind == KindTable;
    if (UNITS > 0) begin : gen_faces
      assign class_used = is_op || kind == KindFace;
      assign span_class = is_op ? token_i[OpClassLsb+:CLASS_BITS] : token_i[FaceClassLsb+:CLASS_BITS];
    end else begin : gen_no_faces
      assign class_used = is_op;
      assign span_class = token_i[OpClassLsb+:CLASS_BITS];
    end
    assign table_valid_o = good && !token_header_i && is_table;
    table_check #(
        .SHADE_FRAC(SHADE_FRAC),
        .CHANNELS(CHANNELS),
        .LIGHTS(LIGHTS),
        .CLASS_BITS(CLASS_BITS)
    ) u_table (
        .clk_i,
        .frame_start_i(good && token_header_i),
        .take_table_i (table_valid_o),
        .take_other_i (good && !token_header_i && !is_table && !(UNITS > 0 && kind == KindFace)),
        .class_i      (table_class_o),
        .light_i      (table_light_o),
        .share_i      (table_share_o),
        .span_class_i (span_class),
        .order_error_o(table_order_error),
        .range_error_o(entry_error),
        .lacking_o    (lacking)
    );
    assign table_range_error = is_table ? entry_error : class_used && lacking;
  end else begin : gen_no_table
    logic unused_table;
    assign unused_table = table_free_i;
    assign {is_table, table_valid_o, table_order_error, table_range_error} = '0;
  end

  // ---- units and tree ----------------------------------------------------------------------------------------------
  if (UNITS > 0) begin : gen_tree
    logic is_face, is_seg, seg_pass, seg_goes, is_fault;
    logic [UnitBits-1:0] fault_unit, unit_of_behind;
    logic [1:0] ahead_of_behind;
    logic unit_behind;
    logic [31:0] fault_token;
    assign is_face = kind == KindFace;
    assign is_seg = kind == KindSeg;
    assign tree_unit_o = is_face ? token_i[FaceUnitLsb+:UnitBits] : token_i[SegUnitLsb+:UnitBits];
    assign tree_face_o = is_face ? token_i[FaceFaceLsb+:FACE_BITS] : token_i[SegFaceLsb+:FACE_BITS];
    assign tree_entry_o = token_i[FaceIndexLsb+:EntryBits];
    assign tree_z_o = DepthBits'(token_i[SegZLsb+:SegZBits]);
    assign tree_dx_o = token_i[SegDxLsb+:DX_BITS];

    assign tree_frame_start_o = good && token_header_i;
    assign tree_flush_o = bad && !token_header_i;
    assign tree_claim_o = emit_tree;
    assign tree_face_valid_o = good && !token_header_i && is_face;
    assign seg_goes = seg_pass && body_error == ErrNone;
    assign tree_seg_valid_o = token_valid_i && state_q == StBody && seg_goes;

    assign frame_free = tree_frame_ready_i;
    // FACE and SEG pass a command that waits: the units fill while the pixels work.
    assign body_free = is_seg ? !seg_goes || tree_seg_ready_i : is_face || cmd_free;

    // What a TREE raises has its own place.
    assign is_fault = !token_header_i && tree_error && error_code == tree_code;
    assign error_token_o = token_header_i ? 32'd0 : is_fault ? fault_token : index_q;
    assign error_unit_o = is_fault ? 6'(fault_unit) : '0;

    always_ff @(posedge clk_i) begin
      if (accept && token_header_i) shade_seen_q <= 1'b0;
      else if (good && is_shade) shade_seen_q <= 1'b1;
    end

    segment_check #(
        .X_BITS(X_BITS),
        .Z_BITS(Z_BITS),
        .Z_FRAC(Z_FRAC),
        .UNITS(UNITS),
        .FACE_BITS(FACE_BITS),
        .DX_BITS(DX_BITS),
        .SEG_BITS(SEG_BITS),
        .ORDER_BITS(ORDER_BITS),
        .CLASSIC(CLASSIC)
    ) u_check (
        .clk_i,
        .rst_ni,
        .frame_start_i (tree_frame_start_o),
        .take_i        (good && !token_header_i),
        .is_shade_i    (is_shade || is_table),
        .is_face_i     (is_face),
        .is_seg_i      (is_seg),
        .is_tree_i     (is_tree),
        .is_eol_i      (is_eol),
        .is_other_i    (!(is_shade || is_table || is_face || is_seg || is_tree || is_eol || is_end)),
        .width_i       (width_q),
        .lines_left_i  (height_q - line_q),
        .token_i       (index_q),
        .unit_i        (tree_unit_o),
        .face_i        (tree_face_o),
        .sync_i        (token_i[SegSyncLsb]),
        .dx_i          (tree_dx_o),
        .order_error_o (tree_order_error),
        .range_error_o (tree_range_error),
        .seg_pass_o    (seg_pass),
        .tree_error_o  (tree_error),
        .tree_code_o   (tree_code),
        .tree_unit_o   (fault_unit),
        .tree_token_o  (fault_token),
        // verilator lint_off PINCONNECTEMPTY
        .tree_o        (),
        .due_o         (),
        // verilator lint_on PINCONNECTEMPTY
        .behind_o      (unit_behind),
        .behind_unit_o (unit_of_behind),
        .behind_ahead_o(ahead_of_behind)
    );
    // None while a frame ends or is dropped: what the units hold then is not waited for.
    assign behind_o = unit_behind && state_q == StBody;
    assign behind_unit_o = 6'(unit_of_behind);
    assign behind_line_o = behind_o ? line_q + 15'(ahead_of_behind) : line_q;

  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = tree_frame_ready_i ^ tree_seg_ready_i;
    assign {tree_order_error, tree_range_error, tree_error, tree_code, shade_seen_q} = '0;
    assign {tree_frame_start_o, tree_flush_o, tree_claim_o, tree_face_valid_o, tree_seg_valid_o} = '0;
    assign {tree_unit_o, tree_face_o, tree_entry_o, tree_z_o, tree_dx_o} = '0;
    assign frame_free = 1'b1;
    assign body_free = cmd_free;
    assign error_token_o = token_header_i ? 32'd0 : index_q;
    assign {error_unit_o, behind_o, behind_unit_o} = '0;
    assign behind_line_o = line_q;
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. The header is the first token of a frame and no other.
      assert (!accept || token_header_i == (state_q == StHeader));
      // 2. A command has pixels.
      assert (!cmd_valid_o || cmd_xl_o < cmd_xr_o);
      // 3. The line number never passes the height.
      assert (state_q == StHeader || line_q <= height_q);
    end
  end
`endif

endmodule

`default_nettype wire
