// SPDX-License-Identifier: Apache-2.0
// Whether a token of a frame's body is good: kind, order, range, line (docs/stream.md, "Errors"). token_stage asks
// about the token that comes in; nothing here waits. Headers are token_stage's own.
//
// Question: token_* as from token_reader, bad_range_i as token_facts has it, width_i, and index_i, the token's number
//   in the frame. Lines: line_i EOLs have come, lines_left_i is the height less that, lines_done_i says that it is 0.
//   Input first_i: only the header has come.
// Answer, combinational, not for a header: good_o; code_o, ErrNone if it is good. Output raised_o: a TREE raises the
//   fault of a unit, and fault_*_o are the unit and the token to blame. Output seg_goes_o: it is a good SEG that its
//   unit takes; a good SEG without it is swallowed. Output completes_o: it ends its unit's line.
// Acts: take_i, one clock, the token comes in. After one that is not good nothing but a header counts.
// State: bias_o, as the token finds it; resolved_o and pass_o as line_phase has them. behind_*_o: as segment_check
//   has it, of units; without units 0.
// Latency: answers 0, state 1 clock. Throughput: a token a clock.
// Cost: line_phase, with CLASS_BITS > 1 table_check, with UNITS > 0 segment_check and a flip-flop; comparators of
//   X_BITS and 16 bits.
`default_nettype none

module token_check #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int TOKEN_WORDS = 5
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic [TOKEN_WORDS*32-1:0] token_i,
    input wire logic                      bad_range_i,
    input wire logic                      token_header_i,
    input wire logic                      token_lacking_i,
    input wire logic                      token_cut_i,
    input wire logic                      token_at_last_i,
    input wire logic [      CodeBits-1:0] token_fault_i,
    input wire logic [        X_BITS-1:0] width_i,
    input wire logic [LineNumberBits-1:0] line_i,
    input wire logic [LineNumberBits-1:0] lines_left_i,
    input wire logic                      lines_done_i,
    input wire logic                      first_i,
    input wire logic [              31:0] index_i,

    input wire logic take_i,

    output logic                      good_o,
    output logic [      CodeBits-1:0] code_o,
    output logic                      raised_o,
    output logic [UnitNumberBits-1:0] fault_unit_o,
    output logic [              31:0] fault_token_o,
    output logic                      seg_goes_o,
    output logic                      completes_o,

    output logic [       DsfBits-1:0] bias_o,
    output logic                      resolved_o,
    output logic [      PassBits-1:0] pass_o,
    output logic                      behind_o,
    output logic [UnitNumberBits-1:0] behind_unit_o,
    output logic [               1:0] behind_ahead_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_order.svh"

  logic unused_token;
  assign unused_token = ^token_i;  // longer than what is looked at

  logic start, take;  // a header comes in, a token of the body does
  assign start = take_i && token_header_i;
  assign take  = take_i && !token_header_i;

  // ---- order, range, line ------------------------------------------------------------------------------------------
  logic [KindBits-1:0] kind;
  logic is_eol, is_end, is_span;
  logic [X_BITS-1:0] xr;
  logic in_phase, in_order, in_range, in_line, last_late, good;
  logic tree_order_error, tree_range_error, tree_error;  // those of FACE, SEG and TREE; see gen_tree below
  logic table_order_error, table_range_error;  // those of TABLE and classes, see gen_table
  logic shade_seen_q;
  logic [CodeBits-1:0] tree_code;
  assign kind = token_i[KindBits-1:0];
  assign is_eol = kind == KindEol;
  assign is_end = kind == KindEnd;
  assign is_span = kind_has_range(kind);
  assign xr = token_i[RangeXrLsb+:X_BITS];
  assign last_late = is_end && !token_at_last_i;
  always_comb begin
    unique case (kind)
      KindShade: in_order = UNITS > 0 ? !shade_seen_q : first_i;
      KindTable: in_order = !table_order_error;
      default:   in_order = in_phase;
    endcase
    if ((lines_done_i && !is_end) || tree_order_error) in_order = 1'b0;
    in_range = !bad_range_i && !(is_span && xr > width_i) && !tree_range_error && !table_range_error;
    in_line  = !(is_eol && token_i[EolYLsb+:EolYBits] != EolYBits'(line_i)) && !(is_end && !lines_done_i);
    if (token_cut_i) code_o = ErrLastEarly;
    else if (token_lacking_i) code_o = ErrKind;
    else if (token_fault_i != ErrNone) code_o = token_fault_i;
    else if (!in_order) code_o = ErrOrder;
    else if (!in_range) code_o = ErrRange;
    else if (!in_line) code_o = ErrLine;
    else if (tree_error) code_o = tree_code;
    else if (last_late) code_o = ErrLastLate;
    else code_o = ErrNone;
  end
  // code_o == ErrNone, without the priority chain, which is slower.
  assign good = !token_cut_i && !token_lacking_i && token_fault_i == ErrNone && in_order && in_range && in_line &&
      !tree_error && !last_late;
  assign good_o = good;

  line_phase #(
      `include "generated/kage_pixel_param_map.svh"
  ) u_phase (
      .clk_i,
      .start_i   (start || (take && is_eol)),
      .take_i    (take),
      .kind_i    (kind),
      .w_i       (token_i[IfWLsb+:DsfBits]),
      .samples_i (token_i[ResolveSamplesLsb+:(COUNT_BITS>0?COUNT_BITS : 1)]),
      .in_order_o(in_phase),
      .resolved_o,
      .pass_o,
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
        .frame_start_i(start),
        .take_table_i (take && is_table),
        .take_other_i (take && !kind_is_state(kind)),
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
    logic is_face, is_seg, is_tree, seg_pass, completes;
    logic [UnitBits-1:0] tree_unit, unit_of_behind;
    assign is_face = kind == KindFace;
    assign is_seg = kind == KindSeg;
    assign is_tree = kind == KindTree;
    assign seg_goes_o = seg_pass && good;
    assign completes_o = completes;
    assign raised_o = tree_error && code_o == tree_code;
    assign fault_unit_o = UnitNumberBits'(tree_unit);
    assign behind_unit_o = UnitNumberBits'(unit_of_behind);

    always_ff @(posedge clk_i) begin
      if (start) shade_seen_q <= 1'b0;
      else if (take && kind == KindShade) shade_seen_q <= 1'b1;
    end

    segment_check #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_check (
        .clk_i,
        .rst_ni,
        .frame_start_i(start),
        .take_i       (take),
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
        .completes_o  (completes),
        .tree_error_o (tree_error),
        .tree_code_o  (tree_code),
        .tree_unit_o  (tree_unit),
        .tree_token_o (fault_token_o),
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
    assign unused_tree = (^lines_left_i) ^ (^index_i) ^ rst_ni;
    assign {tree_order_error, tree_range_error, tree_error, tree_code, shade_seen_q} = '0;
    assign {seg_goes_o, completes_o, raised_o, fault_unit_o, fault_token_o} = '0;
    assign {behind_o, behind_unit_o, behind_ahead_o} = '0;
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. A good token has no code, and any other has one.
      assert (!take || good == (code_o == ErrNone));
      assert (!seg_goes_o || code_o == ErrNone);
    end
  end
`endif

endmodule

`default_nettype wire
