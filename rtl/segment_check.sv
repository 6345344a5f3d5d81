// SPDX-License-Identifier: Apache-2.0
// The rules for FACE, SEG and TREE (docs/stream.md, "Units and the tree"): what each unit has been given, which tokens
// may come, and which fault a TREE raises. Module token_check asks about the token that comes in; nothing here waits.
//
// Question: is_*_i, at most one, says what the token is, *_i brings its fields; all hold still while the token waits.
//   lines_left_i is the height less the number of EOLs taken. Every answer is combinational, and valid for the kinds
//   it names.
// Acts: frame_start_i, one clock, at a header. take_i, one clock, when the token has been taken; after one that was
//   refused by any check nothing but the next frame_start_i counts.
// Answers, in the order of the checks:
//   order_error_o   FACE, SEG, TREE, SHADE, TABLE, EOL, or any other token but END (is_other_i), where its phase does
//                   not allow it: as far as the tree is concerned. token_check judges lines and the number of SHADEs,
//                   line_phase volumes
//   range_error_o   FACE or SEG of a unit that the core lacks, FACE out of turn
//   seg_pass_o      SEG: it goes to its unit; otherwise it is swallowed: its unit is or becomes at fault
//   completes_o     SEG: it ends its unit's line, if it goes there
//   tree_error_o    TREE: a unit is at fault for this line; tree_code_o, tree_unit_o and tree_token_o say how.
// State: tree_o, the frame has a tree; due_o, the line's TREE has not been taken yet, so only SEG and TREE may come.
//   Output behind_o, 1 clock late as the two others: some unit has been given more than another. Output behind_unit_o
//   is the lowest of the units that have fewest lines complete, behind_ahead_o how many more than have ended it has.
// Two faults are kept, the first SEG at fault for this line and for the next. No SEG can be at fault for a later one,
//   and none is left from an earlier one, because that line's TREE has raised it.
// Latency: answers 0, state 1 clock. Throughput: a token a clock.
// Cost: per unit FACE_BITS + X_BITS + SEG_BITS + 5 flip-flops and the multiplexers to them; comparators once.
// Needs UNITS > 0: a core without units leaves it out.
`default_nettype none

module segment_check #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int RestBits = X_BITS > DX_BITS ? X_BITS : DX_BITS
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic frame_start_i,
    input wire logic take_i,

    input wire logic                      is_shade_i,    // SHADE or TABLE: other frame state
    input wire logic                      is_face_i,
    input wire logic                      is_seg_i,
    input wire logic                      is_tree_i,
    input wire logic                      is_eol_i,
    input wire logic                      is_other_i,
    input wire logic [        X_BITS-1:0] width_i,
    input wire logic [LineNumberBits-1:0] lines_left_i,
    input wire logic [              31:0] token_i,       // index of the token in its frame

    input wire logic [ UnitBits-1:0] unit_i,  // of FACE or SEG
    input wire logic [FACE_BITS-1:0] face_i,  // of FACE or SEG
    input wire logic                 sync_i,
    input wire logic [  DX_BITS-1:0] dx_i,

    output logic order_error_o,
    output logic range_error_o,
    output logic seg_pass_o,
    output logic completes_o,

    output logic                tree_error_o,
    output logic [CodeBits-1:0] tree_code_o,
    output logic [UnitBits-1:0] tree_unit_o,
    output logic [        31:0] tree_token_o,

    output logic tree_o,
    output logic due_o,

    output logic                behind_o,
    output logic [UnitBits-1:0] behind_unit_o,
    output logic [         1:0] behind_ahead_o
);
  `include "generated/kage_layout.svh"

  // ---- the frame: has it a tree? -----------------------------------------------------------------------------------
  logic state_q;  // only SHADE, TABLE and FACE since the header: a SEG begins the tree, any other token rules it out
  logic tree_q, due_q;
  assign tree_o = tree_q;
  assign due_o  = due_q;

  // ---- the units ---------------------------------------------------------------------------------------------------
  // Flat: unit u has bits u * width and up.
  logic [UNITS*FACE_BITS-1:0] faces_q;  // defined
  logic [UNITS-1:0] begun_q;  // a line has been given in part
  logic [UNITS*X_BITS-1:0] rest_q;  // pixels that it lacks, of a line that has begun
  logic [UNITS*SEG_BITS-1:0] count_q;  // its segments, modulo 2^SEG_BITS: 0 with pixels is all of them
  logic [UNITS*2-1:0] ahead_q;  // lines complete, less the number of this line
  logic [UNITS-1:0] fault_q;

  logic lacking;
  logic [UnitBits-1:0] unit;
  logic [FACE_BITS-1:0] faces;
  logic begun;
  logic [X_BITS-1:0] rest;
  logic [SEG_BITS-1:0] count;
  logic [1:0] ahead;
  logic fault;
  assign lacking = 32'(unit_i) >= 32'(UNITS);
  assign unit = lacking ? '0 : unit_i;
  assign faces = faces_q[unit*FACE_BITS+:FACE_BITS];
  assign begun = begun_q[unit];
  assign rest = begun ? rest_q[unit*X_BITS+:X_BITS] : width_i;
  assign count = count_q[unit*SEG_BITS+:SEG_BITS];
  assign ahead = ahead_q[unit*2+:2];
  assign fault = fault_q[unit];

  // ---- order and range ---------------------------------------------------------------------------------------------
  logic all_lines;  // the unit has all lines of the frame
  logic [3:0] left_is;  // lines left: 0, 1, 2, 3; compared while the unit is chosen
  always_comb for (int n = 0; n < 4; n++) left_is[n] = lines_left_i == LineNumberBits'(n);
  assign all_lines = left_is[ahead];
  always_comb begin
    order_error_o = 1'b0;
    if (is_shade_i || is_face_i) order_error_o = !state_q;
    if (is_seg_i) order_error_o = !(state_q || due_q) || (!lacking && all_lines);
    if (is_tree_i) order_error_o = !due_q;
    if (is_eol_i || is_other_i) order_error_o = due_q;
    range_error_o = (is_face_i || is_seg_i) && lacking;
    if (is_face_i && (face_i != faces || face_i == BlankFace)) range_error_o = 1'b1;
  end

  // ---- a segment ---------------------------------------------------------------------------------------------------
  logic [X_BITS-1:0] rest_next, dx_of_line;  // a length of more bits than a position has does not complete the line
  logic completes, too_long, too_early, seg_fault;
  logic [CodeBits-1:0] seg_code;
  assign dx_of_line = X_BITS'(dx_i);
  assign rest_next = rest - dx_of_line;
  assign completes = RestBits'(rest) == RestBits'(dx_i);
  assign completes_o = completes;
  assign too_long = RestBits'(rest) < RestBits'(dx_i);
  assign too_early = ahead == 2'd2;
  assign seg_pass_o = is_seg_i && !fault && seg_code == ErrNone;
  assign seg_fault = is_seg_i && !fault && seg_code != ErrNone;
  always_comb begin
    if (too_early) seg_code = ErrUnitLong;
    else if (sync_i == begun || dx_i == '0 || (face_i != BlankFace && face_i >= faces)) seg_code = ErrSegment;
    else if (too_long || (begun && count == '0)) seg_code = ErrUnitLong;
    else seg_code = ErrNone;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= 1'b0;
      tree_q  <= 1'b0;
      due_q   <= 1'b0;
    end else if (frame_start_i) begin
      state_q <= 1'b1;
      tree_q  <= 1'b0;
      due_q   <= 1'b0;
    end else if (take_i) begin
      if (!is_shade_i && !is_face_i) state_q <= 1'b0;
      if (is_seg_i) tree_q <= 1'b1;
      if (is_seg_i || (is_eol_i && tree_q)) due_q <= 1'b1;
      if (is_tree_i) due_q <= 1'b0;
    end
    if (frame_start_i) begin
      faces_q <= '0;
      begun_q <= '0;
      count_q <= '0;
      ahead_q <= '0;
      fault_q <= '0;
    end else if (take_i) begin
      if (is_face_i) faces_q[unit*FACE_BITS+:FACE_BITS] <= faces + 1'b1;
      if (seg_fault) fault_q[unit] <= 1'b1;
      // Nobody asks for these two of a unit at fault any more.
      if (is_seg_i) begin
        rest_q[unit*X_BITS+:X_BITS] <= rest_next;
        count_q[unit*SEG_BITS+:SEG_BITS] <= completes ? '0 : count + 1'b1;
      end
      if (seg_pass_o) begin
        begun_q[unit] <= !completes;
        if (completes) ahead_q[unit*2+:2] <= ahead + 2'd1;
      end
      if (is_eol_i && tree_q) begin
        for (int u = 0; u < UNITS; u++) ahead_q[u*2+:2] <= ahead_q[u*2+:2] - 2'd1;
      end
    end
  end

  // ---- who is behind -----------------------------------------------------------------------------------------------
  // The unit with least, the lowest of those: pairs of units, pairs of pairs, and so on. Node n has the nodes 2n and
  // 2n + 1 below it; unit u is node Leaves + u, and a node without a unit never has less than one that has.
  localparam int Leaves = 2 ** $clog2(UNITS);
  logic [1:0] least;
  logic [UnitBits-1:0] least_unit;
  logic uneven;
  logic [4*Leaves-1:0] ahead_at;
  logic [2*Leaves*UnitBits-1:0] unit_at;
  always_comb begin
    ahead_at = '1;
    unit_at  = '0;
    for (int u = 0; u < UNITS; u++) begin
      ahead_at[(Leaves+u)*2+:2] = ahead_q[u*2+:2];
      unit_at[(Leaves+u)*UnitBits+:UnitBits] = UnitBits'(u);
    end
    for (int n = Leaves - 1; n > 0; n--) begin
      if (ahead_at[4*n+:2] <= ahead_at[4*n+2+:2]) begin
        ahead_at[2*n+:2] = ahead_at[4*n+:2];
        unit_at[n*UnitBits+:UnitBits] = unit_at[2*n*UnitBits+:UnitBits];
      end else begin
        ahead_at[2*n+:2] = ahead_at[4*n+2+:2];
        unit_at[n*UnitBits+:UnitBits] = unit_at[(2*n+1)*UnitBits+:UnitBits];
      end
    end
    least = ahead_at[2+:2];
    least_unit = unit_at[UnitBits+:UnitBits];
    uneven = begun_q != '0;
    for (int u = 0; u < UNITS; u++) if (ahead_q[u*2+:2] != ahead_q[1:0]) uneven = 1'b1;
  end
  always_ff @(posedge clk_i) begin
    behind_o <= rst_ni && tree_q && uneven;
    behind_unit_o <= least_unit;
    behind_ahead_o <= least;
  end

  // ---- faults kept for this line and the next ----------------------------------------------------------------------
  logic [1:0] kept_q;
  logic [2*CodeBits-1:0] kept_code_q;
  logic [2*UnitBits-1:0] kept_unit_q;
  logic [63:0] kept_token_q;
  logic later;  // the segment is of the next line, not of this one
  assign later = ahead != 2'd0;

  // A segment at fault is kept a clock after it was taken, as finding its fault takes a clock. A TREE may be there by
  // then, a line's end may not.
  logic new_q, new_later_q;
  logic [CodeBits-1:0] new_code_q;
  logic [UnitBits-1:0] new_unit_q;
  logic [31:0] new_token_q;
  always_ff @(posedge clk_i) begin
    new_q <= rst_ni && take_i && !frame_start_i && seg_fault;
    new_later_q <= later;
    new_code_q <= seg_code;
    new_unit_q <= unit;
    new_token_q <= token_i;
  end

  always_ff @(posedge clk_i) begin
    if (frame_start_i) begin
      kept_q <= '0;
    end else if (take_i && is_eol_i) begin
      kept_q <= {1'b0, kept_q[1]};
      kept_code_q[0+:CodeBits] <= kept_code_q[CodeBits+:CodeBits];
      kept_unit_q[0+:UnitBits] <= kept_unit_q[UnitBits+:UnitBits];
      kept_token_q[31:0] <= kept_token_q[63:32];
    end else if (new_q) begin
      for (int i = 0; i < 2; i++) begin
        if (new_later_q == 1'(i) && !kept_q[i]) begin
          kept_q[i] <= 1'b1;
          kept_code_q[i*CodeBits+:CodeBits] <= new_code_q;
          kept_unit_q[i*UnitBits+:UnitBits] <= new_unit_q;
          kept_token_q[i*32+:32] <= new_token_q;
        end
      end
    end
  end

  // ---- at TREE -----------------------------------------------------------------------------------------------------
  logic short_any;  // the unit with least has not this line
  logic new_fault;  // the token before is a segment of this line, at fault
  assign new_fault = new_q && !new_later_q;
  always_comb begin
    short_any = 1'b0;
    for (int u = 0; u < UNITS; u++) if (ahead_q[u*2+:2] == 2'd0) short_any = 1'b1;
    tree_error_o = is_tree_i && (kept_q[0] || new_fault || short_any);
    tree_code_o  = kept_q[0] ? kept_code_q[0+:CodeBits] : new_fault ? new_code_q : ErrUnitShort;
    tree_unit_o  = kept_q[0] ? kept_unit_q[0+:UnitBits] : new_fault ? new_unit_q : least_unit;
    tree_token_o = kept_q[0] ? kept_token_q[31:0] : new_fault ? new_token_q : token_i;
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic [5:0] kinds;
  assign kinds = {is_shade_i, is_face_i, is_seg_i, is_tree_i, is_eol_i, is_other_i};
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. One token at a time. ($onehot0 of Icarus Verilog 11 is never true.)
      assert (!take_i || (kinds & (kinds - 6'd1)) == '0);
      // 2. A line that ends under a tree has had its TREE, so every unit had it complete and no fault of it is left.
      assert (!take_i || !is_eol_i || order_error_o || !tree_q || !(short_any || kept_q[0] || new_q));
      // 3. A faulty segment is of this line or the next.
      assert (!take_i || !seg_fault || order_error_o || range_error_o || lines_left_i > LineNumberBits'(later));
    end
  end
`endif

endmodule

`default_nettype wire
