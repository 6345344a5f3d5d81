// SPDX-License-Identifier: Apache-2.0
// The stage in front of frame_control. In it token_facts and token_check judge a token in the clock in which it comes
// in; it stands in a queue with its verdict until frame_control is done with it. So frame_control knows from flip-flops
// what a token may do.
//
// Handshake: token_* is valid/ready, token_ready_o depends on registers only. held_* is valid/ready, token and verdict
//   stable while it waits; held_ready_i may depend on them.
// State: a header sets width and lines as soon as it shows, token_valid_i or not. These, index, phases, the table's and
//   the units' state advance with each token that comes in, good or not. After a token at fault they are wrong, and
//   nobody asks: only a header comes in behind it, which sets all of them anew.
// Errors: a token at fault lets none in behind it until frame_control has taken it. If it does not end its frame,
//   another token of the frame follows, which is taken and forgotten. In this clock drop_o has the reader drop the rest
//   of the frame, unless that token ends it. Output dropping_o: that token has yet to come.
// Fault: fault_unit_o and fault_token_o count while the token held is at fault: whom a TREE blames; otherwise unit 0
//   and the token's own index.
// Units: unit_behind_o, 1 clock late: a unit has been given more than another by the tokens that came in; behind_o
//   names the unit that has least, and its line.
// Capacity: two tokens. Latency: 1 clock. Throughput: a token a clock.
// Cost: a stream_fifo of two tokens, a skid_buffer of their verdicts; counters of 15, 15 and 32 bits, with units 39;
//   token_facts and token_check.
`default_nettype none

module token_stage #(
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

    // to frame_control
    output logic                           held_valid_o,
    input  wire logic                      held_ready_i,
    output logic      [TOKEN_WORDS*32-1:0] held_o,
    output logic      [   VerdictBits-1:0] verdict_o,
    output logic      [UnitNumberBits-1:0] fault_unit_o,
    output logic      [              31:0] fault_token_o,
    output logic                           dropping_o,
    output logic                           unit_behind_o,
    output logic      [    BehindBits-1:0] behind_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

flags_t flags;
  assign flags = token_flags_i;

  // ---- the queue ---------------------------------------------------------------------------------------------------
  // At most two tokens. One at fault is the newest, since none comes in behind it.
  logic queue_ready, take, held_bad, bad_q, ends_q, drop_q;
  logic token_room, token_there;
  verdict_t verdict, held_verdict;
  assign verdict_o = held_verdict;
  assign held_bad = held_valid_o && !held_verdict.good;
  assign token_ready_o = queue_ready && !bad_q;
  assign take = token_valid_i && token_ready_o && !drop_q;
  assign drop_o = drop_q && token_valid_i && !flags.ends;
  assign dropping_o = drop_q;
  // The verdict comes from flip-flops. A token's many bits come through a multiplexer, so that held_ready_i moves a
  // pointer and not all of them. Both buffers hold as many at any time.
  skid_buffer #(
      .BITS(VerdictBits)
  ) u_verdict (
      .clk_i,
      .rst_ni,
      .in_valid_i (take),
      .in_ready_o (queue_ready),
      .in_data_i  (verdict),
      .out_valid_o(held_valid_o),
      .out_ready_i(held_ready_i),
      .out_data_o (held_verdict)
  );
  stream_fifo #(
      .BITS (TOKEN_WORDS * 32),
      .DEPTH(2)
  ) u_token (
      .clk_i,
      .rst_ni,
      .in_valid_i (take),
      .in_ready_o (token_room),
      .in_data_i  (token_i),
      .out_valid_o(token_there),
      .out_ready_i(held_ready_i),
      .out_data_o (held_o)
  );

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      bad_q  <= 1'b0;
      drop_q <= 1'b0;
    end else begin
      if (take) bad_q <= !verdict.good;
      else if (held_bad && held_ready_i) bad_q <= 1'b0;
      if (held_bad && held_ready_i) drop_q <= !ends_q;
      else if (token_valid_i) drop_q <= 1'b0;
    end
    if (take) ends_q <= flags.ends;
  end

  // ---- the frame, as the token finds it that comes in --------------------------------------------------------------
  logic [X_BITS-1:0] width_q;
  logic [LineNumberBits-1:0] line_q, left_q;  // lines that have ended, and those that have not
  logic lines_done_q;  // left_q is 0
  logic first_q;  // the header was the last token
  logic [31:0] index_q, index;  // of the newest token, and of the one that comes in
  if (POLYGONS > 0) begin : gen_index
    assign index = token_index_i;
  end else begin : gen_count
    logic unused_index;
    assign unused_index = ^token_index_i;
    assign index = index_q + 32'd1;
  end

  // A header's words are taken whenever token_reader has one, even if it has not come whole, as nothing of the frame
  // before is judged any more. So these flip-flops wait for no handshake; with units until a token at fault has
  // been taken, since behind_o tells its frame's line until then.
  always_ff @(posedge clk_i) begin
    if (take) first_q <= flags.header;
    if (flags.header && (UNITS == 0 || !bad_q)) begin
      width_q <= token_i[HeaderWidthLsb+:X_BITS];
      line_q <= '0;
      left_q <= token_i[HeaderHeightLsb+:LineNumberBits];
      lines_done_q <= 1'b0;
    end else if (take && verdict.eol) begin
      line_q <= line_q + 1'b1;
      left_q <= left_q - 1'b1;
      lines_done_q <= left_q == LineNumberBits'(1);
    end
    if (take) index_q <= flags.header ? '0 : index;
  end

  // ---- the verdict -------------------------------------------------------------------------------------------------
  facts_t facts;
  token_facts #(
      .MAX_WIDTH  (MAX_WIDTH),
      .TOKEN_WORDS(TOKEN_WORDS),
      .POLYGONS   (POLYGONS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_facts (
      .token_i,
      .facts_o(facts)
  );

  logic body_good, seg_goes, completes, resolved, raised;
  logic [PassBits-1:0] pass;
  logic [CodeBits-1:0] body_code, head_code;
  logic [DsfBits-1:0] bias;
  logic [UnitNumberBits-1:0] unit_to_blame, unit_of_behind;
  logic [31:0] token_to_blame;
  logic [ 1:0] ahead_of_behind;

  token_check #(
      .TOKEN_WORDS(TOKEN_WORDS),
      `include "generated/kage_pixel_param_map.svh"
  ) u_check (
      .clk_i,
      .rst_ni,
      .token_i,
      .bad_range_i    (facts.bad_range),
      .token_header_i (flags.header),
      .token_lacking_i(flags.lacking),
      .token_cut_i    (flags.cut),
      .token_at_last_i(flags.at_last),
      .token_fault_i  (flags.fault),
      .width_i        (width_q),
      .line_i         (line_q),
      .lines_left_i   (left_q),
      .lines_done_i   (lines_done_q),
      .first_i        (first_q),
      .index_i        (index),
      .take_i         (take),
      .good_o         (body_good),
      .code_o         (body_code),
      .raised_o       (raised),
      .fault_unit_o   (unit_to_blame),
      .fault_token_o  (token_to_blame),
      .seg_goes_o     (seg_goes),
      .completes_o    (completes),
      .bias_o         (bias),
      .resolved_o     (resolved),
      .pass_o         (pass),
      .behind_o       (unit_behind_o),
      .behind_unit_o  (unit_of_behind),
      .behind_ahead_o (ahead_of_behind)
  );

  // The token's kind, decoded, so that frame_control finds no kind in the clock in which it acts on it.
  logic [KindBits-1:0] kind;
  logic body;
  assign kind = token_i[KindBits-1:0];
  assign body = !flags.header;
  assign head_code = flags.cut ? ErrLastEarly : facts.head_error;
  always_comb begin
    verdict.header = flags.header;
    verdict.cut = flags.cut;
    verdict.eol = body && kind == KindEol;
    verdict.end_token = body && kind == KindEnd;
    verdict.span = body && kind_has_range(kind) && !facts.empty;
    verdict.tp = body && TRANSLUCENCY > 0 && kind == KindTp;
    verdict.entry = body && HasTable && kind == KindTable;
    verdict.tree = body && UNITS > 0 && kind == KindTree;
    verdict.face = body && UNITS > 0 && kind == KindFace;
    verdict.seg = body && UNITS > 0 && kind == KindSeg;
    verdict.good = flags.header ? !flags.cut && facts.head_error == ErrNone : body_good;
    verdict.code = flags.header ? head_code : body_code;
    verdict.seg_goes = !flags.header && seg_goes;
    verdict.completes = completes;
    verdict.resolved = resolved;
    verdict.pass = pass;
    verdict.bias = bias;
  end

  // ---- whom to blame -----------------------------------------------------------------------------------------------
  logic raised_q;
  logic [UnitNumberBits-1:0] fault_unit_q;
  logic [31:0] fault_token_q;
  assign fault_unit_o  = raised_q ? fault_unit_q : '0;
  assign fault_token_o = raised_q ? fault_token_q : index_q;
  always_ff @(posedge clk_i) begin
    if (take) begin
      raised_q <= !flags.header && raised;
      fault_unit_q <= unit_to_blame;
      fault_token_q <= token_to_blame;
    end
  end

  behind_t behind;
  assign behind_o = behind;
  assign behind.unit = unit_of_behind;
  assign behind.line = line_q + LineNumberBits'(ahead_of_behind);

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic wrong_q;  // the newest token that came in is at fault
  always @(posedge clk_i) begin
    if (!rst_ni) wrong_q <= 1'b0;
    else if (take) wrong_q <= !verdict.good;
    if (rst_ni) begin
      // 1. Behind a token at fault no token is judged but a header.
      assert (!take || !wrong_q || flags.header);
      // 2. A token to be dropped is of the frame of the one at fault.
      assert (!drop_q || !token_valid_i || !flags.header);
      assert (!drop_q || !held_valid_o);
      // 3. Token and verdict belong together.
      assert (queue_ready == token_room && held_valid_o == token_there);
      // 4. The flag for no lines left is right.
      assert (!take || flags.header || wrong_q || lines_done_q == (left_q == '0));
    end
  end
`endif

endmodule

`default_nettype wire
