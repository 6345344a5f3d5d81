// SPDX-License-Identifier: Apache-2.0
// Whether a token of a frame's body is good: kind, order, range, line (docs/stream.md, "Errors"). frame_control asks
// about the token it has and acts on the answer; nothing here waits. Headers are frame_control's own.
//
// Question: token_* as from token_reader, bad_range_i as token_facts has it; width_i, lines_left_i (the height less the
//   EOLs accepted, with units only), lines_done_i (that is 0) and index_i, its number in the frame.
// Answer, combinational: good_o; code_o, ErrNone if it is good, and of a fault that a TREE raises the unit and the
//   token that are to blame, else unit 0 and this token. seg_goes_o: it is good, and a SEG that its unit takes; a good
//   SEG without it is swallowed.
// Acts, each one clock: header_i, a header is taken, and start_i with it if it is good; take_i, the token is good and
//   taken; eol_i, a line has ended; clear_bias_i.
// State: bias_o, as the token finds it; resolved_o: a RESOLVE was the line's last token. behind_*_o: as segment_check
//   has it, of units; without units 0.
// Latency: answers 0, state 1 clock. Throughput: a token a clock.
// Cost: line_phase, with CLASS_BITS > 1 table_check, with UNITS > 0 segment_check and a flip-flop; comparators of
//   X_BITS and 16 bits.
`default_nettype none

module token_check #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int TOKEN_WORDS = 5,
    localparam int CodeBits = 4
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic [TOKEN_WORDS*32-1:0] token_i,
    input wire logic                      bad_range_i,
    input wire logic                      token_lacking_i,
    input wire logic                      token_cut_i,
    input wire logic                      token_at_last_i,
    input wire logic [        X_BITS-1:0] width_i,
    input wire logic [              14:0] line_i,
    input wire logic [              14:0] lines_left_i,
    input wire logic                      lines_done_i,
    input wire logic [              31:0] index_i,

    input wire logic header_i,
    input wire logic start_i,
    input wire logic take_i,
    input wire logic eol_i,
    input wire logic clear_bias_i,

    output logic                good_o,
    output logic [CodeBits-1:0] code_o,
    output logic [         5:0] fault_unit_o,
    output logic [        31:0] fault_token_o,
    output logic                seg_goes_o,

    output logic [DsfBits-1:0] bias_o,
    output logic               resolved_o,
    output logic               behind_o,
    output logic [        5:0] behind_unit_o,
    output logic [        1:0] behind_ahead_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_order.svh"

  logic unused_token;
  assign unused_token = ^token_i;  // longer than what is looked at

  // ---- order, range, line ------------------------------------------------------------------------------------------
  logic [3:0] kind;
  logic is_eol, is_end, is_span;
  logic [X_BITS-1:0] xr;
  logic in_phase, in_order, in_range, in_line, last_late, good;
  logic tree_order_error, tree_range_error, tree_error;  // those of FACE, SEG and TREE; see gen_tree below
  logic table_order_error, table_range_error;  // those of TABLE and classes, see gen_table
  logic shade_seen_q;
  logic [CodeBits-1:0] tree_code;
  assign kind = token_i[3:0];
  assign is_eol = kind == KindEol;
  assign is_end = kind == KindEnd;
  assign is_span = kind_has_range(kind);
  assign xr = token_i[OpXrLsb+:X_BITS];  // the place is the same in all that have a range
  assign last_late = is_end && !token_at_last_i;
  always_comb begin
    unique case (kind)
      KindShade: in_order = UNITS > 0 ? !shade_seen_q : index_i == 32'd1;
      KindTable: in_order = !table_order_error;
      default:   in_order = in_phase;
    endcase
    if ((lines_done_i && !is_end) || tree_order_error) in_order = 1'b0;
    in_range = !bad_range_i && !(is_span && xr > width_i) && !tree_range_error && !table_range_error;
    in_line  = !(is_eol && token_i[EolYLsb+:16] != 16'(line_i)) && !(is_end && !lines_done_i);
    if (token_cut_i) code_o = ErrLastEarly;
    else if (token_lacking_i) code_o = ErrKind;
    else if (!in_order) code_o = ErrOrder;
    else if (!in_range) code_o = ErrRange;
    else if (!in_line) code_o = ErrLine;
    else if (tree_error) code_o = tree_code;
    else if (last_late) code_o = ErrLastLate;
    else code_o = ErrNone;
  end
  // code_o == ErrNone, without the priority chain, which is slower.
  assign good   = !token_cut_i && !token_lacking_i && in_order && in_range && in_line && !tree_error && !last_late;
  assign good_o = good;

  line_phase #(
      `include "generated/kage_pixel_param_map.svh"
  ) u_phase (
      .clk_i,
      .start_i   (header_i || eol_i),
      .take_i,
      .clear_bias_i,
      .kind_i    (kind),
      .w_i       (token_i[IfWLsb+:DsfBits]),
      .in_order_o(in_phase),
      .resolved_o,
      .bias_o
  );

  // ---- light table -------------------------------------------------------------------------------------------------
  if (HasTable) begin : gen_table
    logic is_op, is_table, lacking, class_used, entry_error;
    logic [CLASS_BITS-1:0] span_class;
    assign is_op = kind == KindOp;
    assign is_table = kind == KindTable;
    if (UNITS > 0) begin : gen_faces
      assign class_used = is_op || kind == KindFace;
      assign span_class = is_op ? token_i[OpClassLsb+:CLASS_BITS] : token_i[FaceClassLsb+:CLASS_BITS];
    end else begin : gen_no_faces
      assign class_used = is_op;
      assign span_class = token_i[OpClassLsb+:CLASS_BITS];
    end
    table_check #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_table (
        .clk_i,
        .frame_start_i(start_i),
        .take_table_i (take_i && is_table),
        .take_other_i (take_i && !kind_is_state(kind)),
        .class_i      (token_i[TableClassLsb+:CLASS_BITS]),
        .light_i      (token_i[TableLightLsb+:LightBits]),
        .share_i      (token_i[TableShareLsb+:EntryShareBits]),
        .span_class_i (span_class),
        .order_error_o(table_order_error),
        .range_error_o(entry_error),
        .lacking_o    (lacking)
    );
    assign table_range_error = is_table ? entry_error : class_used && lacking;
  end else begin : gen_no_table
    assign {table_order_error, table_range_error} = '0;
  end

  // ---- units and tree ----------------------------------------------------------------------------------------------
  if (UNITS > 0) begin : gen_tree
    logic is_face, is_seg, is_tree, seg_pass, is_fault;
    logic [UnitBits-1:0] tree_unit, unit_of_behind;
    logic [31:0] tree_token;
    assign is_face = kind == KindFace;
    assign is_seg = kind == KindSeg;
    assign is_tree = kind == KindTree;
    assign seg_goes_o = seg_pass && good;

    // What a TREE raises has its own place.
    assign is_fault = tree_error && code_o == tree_code;
    assign fault_token_o = is_fault ? tree_token : index_i;
    assign fault_unit_o = is_fault ? 6'(tree_unit) : '0;
    assign behind_unit_o = 6'(unit_of_behind);

    always_ff @(posedge clk_i) begin
      if (header_i) shade_seen_q <= 1'b0;
      else if (take_i && kind == KindShade) shade_seen_q <= 1'b1;
    end

    segment_check #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_check (
        .clk_i,
        .rst_ni,
        .frame_start_i(start_i),
        .take_i,
        .is_shade_i   (kind_is_state(kind) && !is_face),
        .is_face_i    (is_face),
        .is_seg_i     (is_seg),
        .is_tree_i    (is_tree),
        .is_eol_i     (is_eol),
        .is_other_i   (!(kind_is_state(kind) || is_seg || is_tree || is_eol || is_end)),
        .width_i,
        .lines_left_i,
        .token_i      (index_i),
        .unit_i       (is_face ? token_i[FaceUnitLsb+:UnitBits] : token_i[SegUnitLsb+:UnitBits]),
        .face_i       (is_face ? token_i[FaceFaceLsb+:FACE_BITS] : token_i[SegFaceLsb+:FACE_BITS]),
        .sync_i       (token_i[SegSyncLsb]),
        .dx_i         (token_i[SegDxLsb+:DX_BITS]),
        .order_error_o(tree_order_error),
        .range_error_o(tree_range_error),
        .seg_pass_o   (seg_pass),
        .tree_error_o (tree_error),
        .tree_code_o  (tree_code),
        .tree_unit_o  (tree_unit),
        .tree_token_o (tree_token),
        // verilator lint_off PINCONNECTEMPTY
        .tree_o       (),
        .due_o        (),
        // verilator lint_on PINCONNECTEMPTY
        .behind_o,
        .behind_unit_o(unit_of_behind),
        .behind_ahead_o
    );
  end else begin : gen_no_tree
    logic unused_tree;
    assign unused_tree = (^lines_left_i) ^ rst_ni ^ good ^ start_i;
    assign {tree_order_error, tree_range_error, tree_error, tree_code, shade_seen_q} = '0;
    assign {seg_goes_o, fault_unit_o, behind_o, behind_unit_o, behind_ahead_o} = '0;
    assign fault_token_o = index_i;
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. What is taken as good has no code.
      assert (!take_i || code_o == ErrNone);
      assert (!seg_goes_o || code_o == ErrNone);
    end
  end
`endif

endmodule

`default_nettype wire
