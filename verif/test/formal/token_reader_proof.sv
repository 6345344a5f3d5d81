// SPDX-License-Identifier: Apache-2.0
// Proof of token_reader at its ports, for any words, any stalls of both sides, drops wherever they are allowed, and a
// reset at any time (verif/test/formal/run.sh).
// By induction (MODEL 0):
//   ready_stays  a ready input stays ready until a beat comes;  in_reset  and is not ready in reset: no beat is taken
//                and lost;
//   out.*        a token that waits stays as it is, flags and all; reset silences it (stream_rules).
// To a bound of clocks (MODEL 1), where resets at any time have a lesser one:
//   whole        a token is offered only when all its words have come, or TLAST has cut it;
//   flags_right  header, lacking, cut and ends are right: by the kind of its first word, by where the frame's TLAST
//                lies;
//   words        the words of a token are the next ones of the frame: none lost, doubled or out of order. After a final
//                token, or one that is dropped, the next is the header of the next frame;
//   kind_first   so is the kind of its first word;
//   first_in_last  the flag at_last says whether the token's first word is in TLAST's beat;
//   prompt       a token is offered in the third clock after the beat that completes it, or right behind the token
//                before it;
//   on_its_way   until then moving_o is high: a complete token never waits in here;
//   takes        the input is ready from the second clock on in which no token is complete: no standstill;
//   busy_in_frame  busy_o is high while something of a frame has come in and its end has not been passed on;
//   still        while neither a port nor moving_o moves, nothing changes: the watchdog misses nothing.
// The RTL's own assertions hold as well.
//
// How: the proof keeps all words that came since reset and how far the tokens have gone: of a word its kind and bit
// BIT.
//
// Why that says it for all: but for the kind no bit of a word is looked at, all are copied alike. The parameters of
// proofs.bash make tokens of one, two and three words and a header of five, in beats of one, two and four: tokens that
// share a beat, and tokens of several.
`default_nettype none

module token_reader_proof #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int BEAT_WORDS = 2,
    parameter int BIT = 31,  // of each word, that is followed
    parameter int MODEL = 1,
    parameter int RESETS = 0,  // 1: a reset comes whenever it pleases, 0: at the start
    parameter int MAX_WORDS = 32,  // that can come within the bound
    parameter int InsideAtBits = 5,  // AtBits of the module in beats of two words
    localparam int TokenWordsMost = 5,
    localparam int AtBits = $clog2(MAX_WORDS + 8)
) (
    input wire logic                     clk_i,
    input wire logic                     rst_ni,
    input wire logic                     s_valid_i,
    input wire logic [BEAT_WORDS*32-1:0] s_data_i,
    input wire logic                     s_last_i,
    input wire logic                     token_ready_i,
    input wire logic                     drop_i
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  logic s_ready, token_valid, dropping, busy, moving;
  flags_t flags;
  logic [TokenWordsMost*32-1:0] token;
  token_reader #(
      .BEAT_WORDS (BEAT_WORDS),
      .TOKEN_WORDS(TokenWordsMost),
      `include "generated/kage_pixel_param_map.svh"
  ) dut (
      .clk_i,
      .rst_ni,
      .s_axis_tvalid_i(s_valid_i),
      .s_axis_tready_o(s_ready),
      .s_axis_tdata_i (s_data_i),
      .s_axis_tlast_i (s_last_i),
      .token_valid_o  (token_valid),
      .token_ready_i,
      .token_o        (token),
      .token_flags_o  (flags),
      .drop_i,
      .dropping_o     (dropping),
      .busy_o         (busy),
      .moving_o       (moving)
  );
  stream_rules #(
      .BITS(TokenWordsMost + 4 + FlagsBits)
  ) out (
      .clk_i,
      .rst_ni,
      .valid_i(token_valid),
      .ready_i(token_ready_i),
      .data_i ({token_bits, token[3:0], flags})
  );

  // ---- surroundings: reset; drops as the contract allows them ------------------------------------------------------
  logic started_q = 1'b0;
  logic push, pop;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  assign push = s_valid_i && s_ready;
  assign pop  = token_valid && token_ready_i;
  always_comb begin
    if (!started_q) assume (!rst_ni);
    if (started_q && RESETS == 0) assume (rst_ni);
    if (drop_i) assume (pop && !flags.ends);
  end

  // ---- all words since reset, and how far the tokens have gone -----------------------------------------------------
  logic [MAX_WORDS*4-1:0] kinds_q;
  logic [  MAX_WORDS-1:0] bits_q;
  logic [AtBits-1:0] in_q, out_q;  // words that came; words that are gone
  logic [AtBits-1:0] end_q, next_end_q;  // where the frame ends, and the next one
  logic has_end_q, has_next_end_q, skip_q, header_q;
  logic [AtBits-1:0] in_before_q, in_before2_q;  // the same a clock and two clocks ago
  logic has_end_before_q, has_next_end_before_q, has_end_before2_q;

  logic [3:0] kind;
  logic [4:0] kind_words;
  logic [AtBits-1:0] need, available, available_before;
  logic is_cut, is_whole, is_end, was_complete, frame_done;
  assign kind = 4'(kinds_q >> {out_q, 2'b00});
  assign kind_words = token_words(kind);
  assign need = header_q ? AtBits'(HeaderWords) : kind_words == '0 ? AtBits'(1) : AtBits'(kind_words);
  assign available = skip_q ? '0 : (has_end_q ? end_q : in_q) - out_q;
  assign available_before = skip_q || !has_end_before2_q && in_before2_q < out_q ? '0 :
      (has_end_before2_q ? end_q : in_before2_q) - out_q;
  assign is_whole = available >= need && !skip_q;
  assign is_cut = has_end_q && !is_whole && !skip_q;
  assign is_end = !header_q && is_whole && kind == KindEnd;
  assign was_complete = !skip_q && (available_before >= need || has_end_before2_q);
  assign frame_done = pop && (flags.ends || drop_i);

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {in_q, out_q, in_before_q, in_before2_q, skip_q} <= '0;
      {has_end_q, has_next_end_q, has_end_before_q, has_next_end_before_q, has_end_before2_q} <= '0;
      header_q <= 1'b1;
    end else begin
      in_before_q <= in_q;
      in_before2_q <= in_before_q;
      has_end_before_q <= frame_done ? has_next_end_q : has_end_q;
      has_next_end_before_q <= !frame_done && has_next_end_q;
      has_end_before2_q <= frame_done ? has_next_end_before_q : has_end_before_q;
      if (push) begin
        for (int w = 0; w < BEAT_WORDS; w++) begin
          for (int k = 0; k < MAX_WORDS; k++) begin
            if (in_q + AtBits'(w) == AtBits'(k)) begin
              kinds_q[4*k+:4] <= s_data_i[32*w+:4];
              bits_q[k] <= s_data_i[32*w+BIT];
            end
          end
        end
        in_q <= in_q + AtBits'(BEAT_WORDS);
      end
      if (pop && !frame_done) begin
        out_q <= out_q + need;
        header_q <= 1'b0;
      end
      if (frame_done) begin
        // The rest of the frame goes, as far as it is there.
        header_q <= 1'b1;
        out_q <= has_end_q ? end_q : in_q + (push ? AtBits'(BEAT_WORDS) : '0);
        has_end_q <= has_next_end_q;
        has_next_end_q <= 1'b0;
        end_q <= next_end_q;
        skip_q <= !has_end_q && !(push && s_last_i);
        if (push && s_last_i && has_end_q) begin
          if (has_next_end_q) begin
            has_next_end_q <= 1'b1;
            next_end_q <= in_q + AtBits'(BEAT_WORDS);
          end else begin
            has_end_q <= 1'b1;
            end_q <= in_q + AtBits'(BEAT_WORDS);
          end
        end
      end else if (skip_q) begin
        if (push) out_q <= in_q + AtBits'(BEAT_WORDS);
        if (push && s_last_i) skip_q <= 1'b0;
      end else if (push && s_last_i) begin
        if (has_end_q) begin
          has_next_end_q <= 1'b1;
          next_end_q <= in_q + AtBits'(BEAT_WORDS);
        end else begin
          has_end_q <= 1'b1;
          end_q <= in_q + AtBits'(BEAT_WORDS);
        end
      end
    end
  end

  // ---- the tokens --------------------------------------------------------------------------------------------------
  logic [TokenWordsMost-1:0] expected_bits, token_bits, words_there;
  always_comb begin
    expected_bits = TokenWordsMost'(bits_q >> out_q);
    for (int w = 0; w < TokenWordsMost; w++) begin
      token_bits[w]  = token[32*w+BIT];
      words_there[w] = AtBits'(w) < need && AtBits'(w) < available;
    end
  end

  (* keep *) logic inside_full, inside_front_valid;
  (* keep *) logic [InsideAtBits-1:0] inside_next_at, inside_front_at, inside_front_end_at, inside_ahead;
  (* keep *) logic [InsideAtBits-$clog2(BEAT_WORDS)-1:0] inside_held;
  logic [1:0] held_q;  // clocks in a row without a complete token in which the input was not ready
  logic quiet_q, was_valid_q, was_ready_q, was_busy_q, was_dropping_q, ready_waits_q;
  always_ff @(posedge clk_i) begin
    held_q <= rst_ni && !is_whole && !is_cut && !s_ready ? held_q + 2'(held_q != 2'd3) : '0;
    quiet_q <= rst_ni && !moving && !push && !pop;
    ready_waits_q <= rst_ni && s_ready && !s_valid_i;
    {was_valid_q, was_ready_q, was_busy_q, was_dropping_q} <= {token_valid, s_ready, busy, dropping};
  end
  always_comb begin
    if (started_q && !rst_ni) in_reset : assert (!s_ready);
    if (started_q && rst_ni && ready_waits_q) ready_stays : assert (s_ready);
  end

  // For induction, lemmas of the registers within (proofs.bash connects inside_*). The places count beats and words
  // modulo four times the capacity, so that a place past the newest beat differs from one before it.
  if (MODEL == 0) begin : gen_lemmas
    localparam int OffBits = $clog2(BEAT_WORDS);
    localparam int Depth = 1 << InsideAtBits - 2 - OffBits;  // beats
    always_comb begin
      if (started_q) begin
        lemma_full : assert (inside_full == (32'(inside_held) == Depth));
        lemma_fits : assert (dropping || 32'(inside_held) <= Depth);
        lemma_apart : assert (InsideAtBits'(inside_next_at - inside_front_at) <= InsideAtBits'(8));
        lemma_next : assert (!inside_front_valid || inside_next_at == inside_front_end_at);
        lemma_reached : assert (inside_front_valid || dropping || !inside_ahead[InsideAtBits-1]);
      end
    end
  end
  if (MODEL > 0) begin : gen_model
    always_comb begin
      if (started_q && rst_ni) begin
        if (token_valid) begin
          whole : assert (is_whole || is_cut);
          flags_right :
          assert (flags.header == header_q && flags.cut == is_cut && flags.ends == (is_cut || is_end) &&
                          flags.lacking == (!header_q && is_whole && kind_words == '0));
          words : assert ((token_bits & words_there) == (expected_bits & words_there));
          if (available != '0) kind_first : assert (token[3:0] == kind);
          if (available != '0) begin
            first_in_last : assert (flags.at_last == (has_end_q && end_q - out_q <= AtBits'(BEAT_WORDS)));
          end
        end
        if (was_complete) prompt : assert (token_valid);
        if (!token_valid && (is_whole || is_cut)) on_its_way : assert (moving);
        takes : assert (held_q < 2'd2);
        if (header_q == 1'b0 || skip_q || available != '0) busy_in_frame : assert (busy);
        if (quiet_q) begin
          still :
          assert ({token_valid, s_ready, busy, dropping} == {was_valid_q, was_ready_q, was_busy_q, was_dropping_q});
        end
        lemma_ends : assert (in_q <= AtBits'(MAX_WORDS) && !(push && s_last_i && has_next_end_q));
      end
    end
  end

  // ---- what the rules are about happens within the bound -----------------------------------------------------------
  logic dropped_q, cut_q, cut_off_q;  // a frame before this one was dropped, cut, or cut off by a reset
  always_ff @(posedge clk_i) begin
    dropped_q <= rst_ni && (dropped_q || drop_i);
    cut_q <= rst_ni && (cut_q || (pop && is_cut));
    cut_off_q <= started_q && (cut_off_q || (!rst_ni && busy));
  end
  if (MODEL == 0) begin : gen_ports
    always_comb if (started_q && rst_ni) held : cover (token_valid && !token_ready_i && s_valid_i && s_ready);
  end else if (RESETS > 0) begin : gen_resets
    always_comb if (started_q && rst_ni) behind_reset : cover (cut_off_q && token_valid && header_q);
  end else begin : gen_no_resets
    always_comb begin
      if (started_q && rst_ni) begin
        token_lacking : cover (pop && flags.lacking);
        cut_within : cover (pop && is_cut && !header_q && (available != '0 || BEAT_WORDS == 1));
        behind_drop : cover (dropped_q && push && s_last_i);
        behind_cut : cover (cut_q && pop && header_q);
      end
    end
    if (BEAT_WORDS > 1) begin : gen_wide
      always_comb begin
        if (started_q && rst_ni) begin
          across_beats : cover (pop && !header_q && is_whole && need > AtBits'(1) && !flags.at_last && has_end_q);
          cut_at_once : cover (pop && is_cut && !header_q && available == '0);
          input_held : cover (s_valid_i && !s_ready && !has_end_q && held_q == '0);
          two_tokens : cover (pop && !header_q && is_whole && out_q > AtBits'(HeaderWords));
        end
      end
    end
    if (BEAT_WORDS > 2) begin : gen_widest
      always_comb if (started_q && rst_ni) at_end : cover (pop && is_end);
    end
  end

endmodule

`default_nettype wire
