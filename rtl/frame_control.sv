// SPDX-License-Identifier: Apache-2.0
// The frame: has its tokens judged by token_stage, keeps the line's number, and turns tokens into commands for the
// pixels and lines for the way out. Modules behind frame_control see sound frames only.
//
// Handshake: token_* and cmd_* are valid/ready. Output token_ready_o depends on registers only. Output line_valid_o
//   waits for line_ready_i, which must not depend on it. A line is passed on in the clock in which its EOL becomes a
//   command, so lines and EOL commands come in the same order.
// Commands: OP, SP, NC, EV, ES, TP with 0 <= xl < xr <= width, and TREE and EOL with xl = 0, xr = width. Empty spans,
//   SHADE, IF and RESOLVE take their clock here and go no further: the command's count brings the line's bias with EV,
//   ES and EOL. A line's first TP is preceded by the command RESOLVE, which has no token: over the whole line, with the
//   background as its colour. It costs a clock. With linear light, and with counters if there was a RESOLVE to do, it
//   is preceded by the command CmdOut instead. The line's pixels leave, by a line that says `load`, and come back as
//   loads. The TP waits in token_stage and nothing is given until loads_done_i, one clock, says that they have.
// Light table (CLASS_BITS > 1): TABLEs go to the way out by table_*, in the clock they leave token_stage, and wait for
//   table_free_i: that nothing of the frame before is left there.
// Errors: the first one of a frame is reported by error_* for one clock. From then on the frame's lines are blank: EOL
//   commands clear the state and the line says that its pixels are background. Tokens are dropped by token_stage and
//   drop_o. A token at fault waits for nothing but, if it is a header, for tree_frame_ready_i.
// Units (UNITS > 0): FACE and SEG go to the tree in the clock they leave token_stage and need no command. A SEG waits
//   for room in the tree by tree_seg_ready_i, a header by tree_frame_ready_i, and neither may depend on a valid. A SEG
//   whose unit is at fault goes nowhere. Output tree_call_o says, for one clock each, that a header or a FACE left
//   token_stage, or that a TREE became a command. After an error it says that no more of this frame will come. Without
//   units these outputs are 0 and the inputs do not matter.
// Latency: 2 clocks from token to command. Throughput: a token a clock.
// Cost: token_stage, token_command, and the flip-flops of a header and of two counters of 15 bits.
`default_nettype none

module frame_control #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int MAX_WIDTH   = 640,
    parameter int TOKEN_WORDS = 5,
    parameter int POLYGONS    = 0   // front_end makes tokens, and numbers them
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // from token_reader, or front_end
    input  wire logic                      token_valid_i,
    output logic                           token_ready_o,
    input  wire logic [TOKEN_WORDS*32-1:0] token_i,
    input  wire logic [     FlagsBits-1:0] token_flags_i,
    input  wire logic [              31:0] token_index_i,  // with POLYGONS
    output logic                           drop_o,
    input  wire logic                      dropping_i,

    // to the pixels
    output logic                        cmd_valid_o,
    input  wire logic                   cmd_ready_i,
    output logic      [CommandBits-1:0] cmd_o,
    input  wire logic                   loads_done_i,

    // to the way out: the lines in order
    output logic                     line_valid_o,
    input  wire logic                line_ready_i,
    output logic      [LineBits-1:0] line_o,

    // to the way out: entries of the light table
    input  wire logic                      table_free_i,
    output logic                           table_valid_o,
    output logic      [TableEntryBits-1:0] table_o,

    // to the units and the tree; the width is line_o's
    output logic      [TreeCallBits-1:0] tree_call_o,
    input  wire logic                    tree_frame_ready_i,
    output logic                         tree_seg_valid_o,
    input  wire logic                    tree_seg_ready_i,
    output logic      [   PieceBits-1:0] tree_piece_o,        // of FACE and SEG

    // to the registers
    output logic open_o,  // a frame's header has been taken and the frame has not ended
    output logic hungry_o,  // waits for a token or for TLAST
    output logic draining_o,  // input is being dropped after an error
    output logic moving_o,  // a token comes in or is done with, a command is made, or what units lack is to be told
    output logic frame_end_o,  // one clock
    output logic error_valid_o,  // one clock, with the next
    output logic [ErrorBits-1:0] error_o,
    output logic behind_valid_o,  // a unit has less of the frame than another; 1 clock late
    output logic [BehindBits-1:0] behind_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  localparam logic [1:0] StHeader = 2'd0;
  localparam logic [1:0] StBody = 2'd1;  // tokens of an error-free frame
  localparam logic [1:0] StBlank = 2'd2;  // after an error: the rest is background

  // ---- state -------------------------------------------------------------------------------------------------------
  logic [1:0] state_q;
  logic painted_q;  // the line's colours are ready for TPs
  logic loading_q;  // they are on their way out and back
  logic [X_BITS-1:0] width_q;
  logic [LineNumberBits-1:0] line_q, left_q;  // lines that have ended, and those that have not
  logic lines_done_q;  // left_q is 0
  logic [31:0] frame_q;
  logic [RgbBits-1:0] background_q;
  logic [FactorBits-1:0] shade_q;

  // ---- the token at hand -------------------------------------------------------------------------------------------
  logic held_valid, held_ready, rest_comes, unit_behind;
  logic [TOKEN_WORDS*32-1:0] token;
  verdict_t verdict;
  behind_t behind_units;
  logic [UnitNumberBits-1:0] fault_unit;
  logic [31:0] fault_token;

  token_stage #(
      .MAX_WIDTH  (MAX_WIDTH),
      .TOKEN_WORDS(TOKEN_WORDS),
      .POLYGONS   (POLYGONS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_stage (
      .clk_i,
      .rst_ni,
      .token_valid_i,
      .token_ready_o,
      .token_i,
      .token_flags_i,
      .token_index_i,
      .drop_o,
      .held_valid_o (held_valid),
      .held_ready_i (held_ready),
      .held_o       (token),
      .verdict_o    (verdict),
      .fault_unit_o (fault_unit),
      .fault_token_o(fault_token),
      .dropping_o   (rest_comes),
      .unit_behind_o(unit_behind),
      .behind_o     (behind_units)
  );

  logic [KindBits-1:0] kind;
  assign kind = token[KindBits-1:0];

  // ---- what happens in this clock ----------------------------------------------------------------------------------
  // Each says by itself what it waits for, because a chain through held_ready would be the core's slowest path.
  logic accept, bad, sound, take_header, emit_eol, emit_paint, emit_span, emit_tree, emit_entry, resolved;
  logic cmd_free, eol_free, body_eol, blank_eol, body_free, frame_free, must_paint, blank_due_q, by_loads, dropping;
  assign eol_free = cmd_free && line_ready_i;
  assign sound = held_valid && verdict.good;
  assign take_header = held_valid && verdict.header && state_q == StHeader && frame_free;
  assign held_ready = verdict.header ? state_q == StHeader && frame_free : !verdict.good ||
      (body_free && (line_ready_i || !verdict.eol) && (table_free_i || !verdict.entry) && !must_paint);
  assign accept = held_valid && held_ready;
  assign bad = held_valid && !verdict.good && (!verdict.header || take_header);
  assign resolved = verdict.resolved;
  assign body_eol = sound && verdict.eol && eol_free;
  assign blank_eol = blank_due_q && eol_free;
  assign emit_eol = (blank_due_q || (sound && verdict.eol)) && eol_free;
  assign emit_span = sound && verdict.span && !must_paint && cmd_free;
  assign emit_tree = sound && verdict.tree && cmd_free;
  assign emit_entry = sound && verdict.entry && table_free_i && cmd_free;
  // A RESOLVE goes over the line before its first TP. An empty TP changes nothing, so it may have it.
  assign must_paint = verdict.tp && !painted_q;
  assign emit_paint = must_paint && sound && cmd_free && !loading_q && (line_ready_i || !by_loads);
  // With counters only the way out can darken; a line without RESOLVE has nothing to darken. Linear light is displayed
  // there, whatever has come to it.
  assign by_loads = HasLoads && (LINEAR_BITS > 0 || resolved);
  assign dropping = dropping_i || rest_comes;

  assign line_valid_o = emit_eol || (emit_paint && by_loads);
  line_t line;
  assign line_o = line;
  assign line.first = line_q == '0;
  assign line.blank = state_q == StBlank;
  assign line.load = state_q == StBody && must_paint;
  assign line.painted = painted_q;
  assign line.width = width_q;
  assign line.background = background_q;
  assign line.shade = LINEAR_BITS > 0 ? '0 : shade_q;

  assign open_o = state_q != StHeader || held_valid;
  assign hungry_o = !held_valid &&
      (state_q == StHeader || (state_q == StBody && cmd_free) || (state_q == StBlank && lines_done_q));
  assign draining_o = state_q == StBlank && dropping;
  assign frame_end_o = (sound && verdict.end_token && cmd_free) || (state_q == StBlank && lines_done_q && !dropping);

  logic told_q;  // a token has come in in the clock before: which unit is waited for is known a clock after it
  assign moving_o = (token_valid_i && token_ready_o) || told_q || accept || line_valid_o || emit_paint || frame_end_o;
  always_ff @(posedge clk_i) told_q <= rst_ni && UNITS > 0 && token_valid_i && token_ready_o;

  error_t error;
  assign error_valid_o = bad;
  assign error_o = error;
  assign error.code = verdict.code;
  assign error.frame = verdict.header ? (verdict.cut ? 32'd0 : token[HeaderFrameLsb+:32]) : frame_q;
  assign error.line = verdict.header ? 16'd0 : 16'(line_q);
  assign error.token = fault_token;
  assign error.unit = fault_unit;

  // behind_valid_o is low while a frame ends or is dropped, because nothing waits for the units then.
  behind_t behind;
  assign behind_valid_o = unit_behind && state_q == StBody;
  assign behind_o = behind;
  assign behind.unit = behind_units.unit;
  assign behind.line = behind_valid_o ? behind_units.line : line_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= StHeader;
    end else begin
      if (take_header) state_q <= StBody;
      if (bad) state_q <= StBlank;
      if (frame_end_o) state_q <= StHeader;
    end
  end

  // A blank line is due: the state is StBlank, and lines are left.
  always_ff @(posedge clk_i) begin
    if (!rst_ni) blank_due_q <= 1'b0;
    else if (bad) blank_due_q <= !verdict.header && !lines_done_q;
    else if (blank_eol && left_q == LineNumberBits'(1)) blank_due_q <= 1'b0;
  end

  always_ff @(posedge clk_i) begin
    if (take_header) begin
      width_q <= token[HeaderWidthLsb+:X_BITS];
      left_q <= !verdict.good ? '0 : token[HeaderHeightLsb+:LineNumberBits];  // no lines after an error in the header
      lines_done_q <= !verdict.good;
      background_q <= token[HeaderBackgroundLsb+:RgbBits];
      frame_q <= token[HeaderFrameLsb+:32];
      line_q <= '0;
      painted_q <= 1'b0;
      loading_q <= 1'b0;
      shade_q <= '0;
    end else begin
      if (emit_eol) begin
        line_q <= line_q + 1'b1;
        left_q <= left_q - 1'b1;
        lines_done_q <= left_q == LineNumberBits'(1);
        painted_q <= 1'b0;
      end
      if (emit_paint) begin
        if (by_loads) loading_q <= 1'b1;
        else painted_q <= 1'b1;
      end
      if (HasLoads && loads_done_i) begin
        loading_q <= 1'b0;
        painted_q <= 1'b1;
      end
      // No line of the frame has been given, and none of the one before is due: so it may be early.
      if (DSF_BITS > 0 && LINEAR_BITS == 0 && sound && !verdict.header && kind == KindShade)
        shade_q <= token[ShadeShadeLsb+:FactorBits];
    end
  end

  // ---- command register --------------------------------------------------------------------------------------------
  command_t cmd;
  assign cmd_o = cmd;
  token_command #(
      .TOKEN_WORDS(TOKEN_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_command (
      .clk_i,
      .rst_ni,
      .token_i     (token),
      .width_i     (width_q),
      .share_i     (TRANSLUCENCY > 0 && COUNT_BITS == 0 && LINEAR_BITS == 0 ? ShareBits'(shade_q) : '0),
      .bias_i      (verdict.bias),
      .lit_i       (LINEAR_BITS > 0 && kind == KindOp && resolved),
      .pass_i      (verdict.pass),
      .background_i(background_q),
      .free_o      (cmd_free),
      .make_i      (emit_eol || emit_paint || emit_tree || emit_span),
      .eol_i       (state_q == StBlank || verdict.eol),
      .paint_i     (must_paint && !by_loads),
      .out_i       (must_paint && by_loads),
      .tree_i      (verdict.tree),
      .cmd_valid_o,
      .cmd_ready_i,
      .cmd_o       (cmd)
  );

  // ---- light table -------------------------------------------------------------------------------------------------
  table_entry_t entry;
  assign table_o = entry;
  assign entry.normal_class = token[TableClassLsb+:CLASS_BITS];
  assign entry.light = token[TableLightLsb+:LightBits];
  assign entry.share = token[TableShareLsb+:EntryShareBits];
  assign table_valid_o = emit_entry;

  // ---- units and tree ----------------------------------------------------------------------------------------------
  piece_t piece;  // yosys 0.23 finds no fields of a struct that a generate block declares
  tree_call_t call;
  assign tree_piece_o = piece;
  assign tree_call_o  = call;
  if (UNITS > 0) begin : gen_tree
    assign piece.unit = verdict.face ? token[FaceUnitLsb+:UnitBits] : token[SegUnitLsb+:UnitBits];
    assign piece.face = verdict.face ? token[FaceFaceLsb+:FACE_BITS] : token[SegFaceLsb+:FACE_BITS];
    assign piece.entry = token[FaceIndexLsb+:EntryBits];
    assign piece.z = DepthBits'(token[SegZLsb+:SegZBits]);
    assign piece.dx = token[SegDxLsb+:DX_BITS];
    assign piece.completes = verdict.completes;

    assign call.start = take_header && verdict.good;
    assign call.flush = bad && !verdict.header;
    assign call.claim = emit_tree;
    assign call.face = sound && verdict.face;
    assign tree_seg_valid_o = held_valid && verdict.seg_goes;

    assign frame_free = tree_frame_ready_i;
    // FACE and SEG pass a command that waits: the units fill while the pixels work.
    assign body_free = verdict.seg ? !verdict.seg_goes || tree_seg_ready_i : verdict.face || cmd_free;
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = ^{tree_frame_ready_i, tree_seg_ready_i, verdict.seg, verdict.seg_goes, verdict.completes,
                           verdict.face};
    assign {tree_seg_valid_o, call, piece} = '0;
    assign frame_free = 1'b1;
    assign body_free = cmd_free;
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. The header is the first token of a frame and no other.
      assert (!accept || verdict.header == (state_q == StHeader));
      assert (!held_valid || verdict.header || state_q == StBody);
      // 2. A command has pixels.
      assert (!cmd_valid_o || cmd.xl < cmd.xr);
      // 3. No line ends when all have ended.
      assert (!emit_eol || !lines_done_q);
      assert (state_q == StHeader || lines_done_q == (left_q == '0));
      assert (blank_due_q == (state_q == StBlank && !lines_done_q));
      // 4. A token acts in the clock in which it is taken, but for the work that a TP waits for.
      assert (accept || !(take_header || bad || body_eol || emit_span || emit_tree || emit_entry || call.face));
      assert (!accept || take_header || bad || sound);
    end
  end
`endif

endmodule

`default_nettype wire
