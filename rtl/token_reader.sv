// SPDX-License-Identifier: Apache-2.0
// Beats to tokens: cuts the words of the input port into the frame's header and its tokens, one whole token at a time.
//
// Handshake: s_axis_* is AXI4-Stream; s_axis_tready_o depends on registers and on rst_ni, which keeps it low: no beat
//   is taken and lost in reset. Port token_* is valid/ready, the token and its flags stable while it waits. Without
//   token_valid_o they are the next token, in part, or the token before; `header` is then high only while no token of
//   another frame is to come first. Input drop_i may be high only with token_ready_i, and only for a token without the
//   flag `ends`. The rest of the frame is then dropped up to and with TLAST. The reader drops the rest by itself after
//   a token that ends it (END, or one that TLAST cut).
// Levels: with POLYGONS a frame's header says by its version which tokens it has (docs/stream.md, "The polygon level").
// Order: the first token of a frame is its header (HeaderWords words). A token of a kind that the configuration lacks
//   is passed on as soon as its first word is there. A cut token is passed on with the flag `cut` and whatever words
//   there are.
// Capacity: the beats a token can touch and one more, at least. Latency: 2 clocks from the beat that completes a token,
//   3 if that beat also brings its first word.
// Throughput: a token a clock, or as many clocks as the port needs for its words. A frame's end costs 2 clocks.
// Cost: the beats' registers, a multiplexer per word of the longest token over beats and words of a beat.
`default_nettype none
`include "kage_illegal.svh"

module token_reader #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int BEAT_WORDS  = 4,
    parameter int TOKEN_WORDS = 5,  // the longest of all tokens and the header
    parameter int POLYGONS    = 0   // frames at the polygon level come too
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // input port
    input  wire logic                     s_axis_tvalid_i,
    output logic                          s_axis_tready_o,
    input  wire logic [BEAT_WORDS*32-1:0] s_axis_tdata_i,
    input  wire logic                     s_axis_tlast_i,

    // to frame_control
    output logic                           token_valid_o,
    input  wire logic                      token_ready_i,
    output logic      [TOKEN_WORDS*32-1:0] token_o,
    output logic      [     FlagsBits-1:0] token_flags_o,  // what its frame says of it
    input  wire logic                      drop_i,

    output logic dropping_o,  // words are being dropped up to TLAST
    output logic busy_o,      // some of a frame has come in and its end has not been passed on
    output logic moving_o     // something changes in here, though no beat comes and no token is taken
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  if (TOKEN_WORDS < TokenWords || TOKEN_WORDS < HeaderWords) begin : gen_bad_token_words
    `KAGE_ILLEGAL("TOKEN_WORDS must hold every token and the header")
  end

  localparam int WindowBeats = (TOKEN_WORDS + 2 * BEAT_WORDS - 2) / BEAT_WORDS;  // beats that a token can touch
  localparam int Depth = 2 ** $clog2(WindowBeats + 1);
  localparam int AddrBits = $clog2(Depth);
  localparam int OffBits = $clog2(BEAT_WORDS);
  localparam int BeatBits = 32 * BEAT_WORDS;
  // Places in the stream, counted in beats or words, modulo 4 times what there is room for: so a difference
  // of two has a sign.
  localparam int BeatAtBits = AddrBits + 2;
  localparam int WordAtBits = BeatAtBits + OffBits;

  // ---- beats that came ---------------------------------------------------------------------------------------------
  logic [BeatBits-1:0] mem[Depth];
  // Facts of each word if a token begins with it, for a second address: {last of its frame, lacking, words behind it}.
  // Words behind it, not words, because a word that was never written must not look like a token of none.
  localparam int WordsBits = $clog2(TOKEN_WORDS);
  localparam int SaidBits = 2 + WordsBits;
  logic [SaidBits*BEAT_WORDS-1:0] said[Depth];
  logic [SaidBits*BEAT_WORDS-1:0] said_in;
  logic [BeatAtBits-1:0] end_beat_q;  // behind the newest
  logic last_q;  // the newest had TLAST
  logic full_q;  // beats_held is Depth
  logic dropping_q, flushed_q;

  logic [WordAtBits-1:0] front_at_q, next_at_q;  // first words: the front's, before which none is needed; the next's
  logic [BeatAtBits-1:0] front_beat, next_beat, beats_held, next_end_beat;
  logic full_here, full_behind;  // in the next clock, if the front stays, and if what is behind it becomes the front
  logic push;
  // On their own, since yosys takes a cast that shortens at its full width within a longer expression.
  assign front_beat = BeatAtBits'(front_at_q >> OffBits);
  assign next_beat = BeatAtBits'(next_at_q >> OffBits);
  assign beats_held = end_beat_q - front_beat;
  assign s_axis_tready_o = rst_ni && !full_q && !last_q;
  assign push = s_axis_tvalid_i && s_axis_tready_o;

  // The level of the frame that a beat is of, which its header has in the first word of the first beat.
  logic polygons;
  if (POLYGONS > 0) begin : gen_levels
    logic begins_q, polygons_q;
    assign polygons = begins_q ? s_axis_tdata_i[HeaderVersionLsb+:HeaderVersionBits] ==
        HeaderVersionBits'(PolygonVersion) : polygons_q;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) begins_q <= 1'b1;
      else if (push) begins_q <= s_axis_tlast_i;
      if (push) polygons_q <= polygons;
    end
  end else begin : gen_spans
    assign polygons = 1'b0;
  end
  assign next_end_beat = end_beat_q + BeatAtBits'(push);
  assign full_here = next_end_beat - front_beat == BeatAtBits'(Depth);
  assign full_behind = next_end_beat - next_beat == BeatAtBits'(Depth);
  for (genvar w = 0; w < BEAT_WORDS; w++) begin : gen_said
    logic [KindBits-1:0] kind;
    logic [4:0] words;
    logic [WordsBits-1:0] behind;  // yosys 0.23 takes no ?: with a cast in a concatenation
    assign kind = s_axis_tdata_i[32*w+:KindBits];
    assign words = polygons ? polygon_token_words(kind) : token_words(kind);
    assign behind = words == 5'd0 ? WordsBits'(0) : WordsBits'(words - 5'd1);
    assign said_in[SaidBits*w+:SaidBits] = {kind == KindEnd, words == 5'd0, behind};
  end

  // ---- looking ahead: begin, kind and end of the token behind the front --------------------------------------------
  // So the token's length, found by an address, is not in one path with the signals that take a token.
  logic [WordAtBits-1:0] next_rest, next_end_at, words_ahead;
  logic header_q;  // the next one is the frame's header
  logic next_there, look;
  logic [SaidBits*BEAT_WORDS-1:0] next_said;
  logic next_is_end, next_lacking;
  logic [WordsBits-1:0] body_behind, next_behind;
  assign words_ahead = (WordAtBits'(end_beat_q) << OffBits) - next_at_q;
  assign next_there  = !words_ahead[WordAtBits-1] && words_ahead != '0;
  assign next_said   = said[AddrBits'(next_at_q>>OffBits)];
  if (BEAT_WORDS > 1) begin : gen_next_said
    assign {next_is_end, next_lacking, body_behind} = next_said[SaidBits*next_at_q[OffBits-1:0]+:SaidBits];
  end else begin : gen_next_said
    assign {next_is_end, next_lacking, body_behind} = next_said;
  end
  assign next_behind = header_q ? WordsBits'(HeaderWords - 1) : body_behind;
  assign next_rest   = WordAtBits'(next_behind);
  assign next_end_at = next_at_q - ~next_rest;  // next_at_q + next_rest + 1, in one carry chain

  // ---- the token at the front --------------------------------------------------------------------------------------
  logic front_valid_q, front_header_q, front_lacking_q, front_is_end_q;
  logic [WordAtBits-1:0] front_end_at_q, words_over;
  logic whole, cut, take, out_free;
  assign words_over = (WordAtBits'(end_beat_q) << OffBits) - front_end_at_q;
  assign whole = !words_over[WordAtBits-1];
  assign cut = last_q && !whole;
  assign take = front_valid_q && (whole || cut) && out_free && !dropping_q;
  // Behind the last word of a frame that was not ended a token of no words is looked at, which is cut.
  assign look = (!front_valid_q || take) && (next_there || last_q) && !dropping_q;

  logic [WindowBeats*BeatBits-1:0] window;
  logic [TOKEN_WORDS*32-1:0] front;
  always_comb begin
    for (int i = 0; i < WindowBeats; i++) window[i*BeatBits+:BeatBits] = mem[AddrBits'(front_beat+BeatAtBits'(i))];
  end
  if (BEAT_WORDS > 1) begin : gen_align
    always_comb begin
      front = window[0+:TOKEN_WORDS*32];
      for (int o = 1; o < BEAT_WORDS; o++) begin
        if (front_at_q[OffBits-1:0] == OffBits'(o)) front = window[o*32+:TOKEN_WORDS*32];
      end
    end
  end else begin : gen_word_beats
    assign front = window[0+:TOKEN_WORDS*32];
  end

  // ---- output register -------------------------------------------------------------------------------------------
  logic token_valid_q;
  flags_t flags_q;
  logic [TOKEN_WORDS*32-1:0] token_q;

  assign token_valid_o = token_valid_q;
  assign token_o = token_q;
  assign token_flags_o = flags_q;
  assign out_free = !token_valid_q || token_ready_i;
  assign dropping_o = dropping_q;
  assign busy_o = !header_q || token_valid_q || words_ahead != '0;
  assign moving_o = take || look || (dropping_q && (last_q || !flushed_q));

  always_ff @(posedge clk_i) begin
    // Taken or not: token_valid_q says whether it counts, so that a token's many bits wait for less.
    if (out_free) begin
      token_q <= front;
      flags_q.header <= front_header_q;
      flags_q.lacking <= front_lacking_q && !cut;
      flags_q.cut <= cut;
      flags_q.ends <= cut || front_is_end_q;
      flags_q.fault <= ErrNone;
      flags_q.at_last <= last_q && beats_held == BeatAtBits'(1);
    end
    if (!rst_ni) token_valid_q <= 1'b0;
    else if (out_free) token_valid_q <= take && !drop_i;
  end

  // ---- state -------------------------------------------------------------------------------------------------------
  always_ff @(posedge clk_i) begin
    // A free place is written whether or not a beat comes: so many bits need not wait for it.
    if (!full_q) begin
      mem[AddrBits'(end_beat_q)]  <= s_axis_tdata_i;
      said[AddrBits'(end_beat_q)] <= said_in;
    end
    if (look) begin
      front_header_q  <= header_q;
      front_lacking_q <= !header_q && next_lacking;
      front_is_end_q  <= !header_q && next_is_end;
      front_end_at_q  <= next_end_at;
    end
    if (!rst_ni) begin
      end_beat_q <= '0;
      next_at_q <= '0;
      front_at_q <= '0;
      front_valid_q <= 1'b0;
      last_q <= 1'b0;
      header_q <= 1'b1;
      dropping_q <= 1'b0;
      flushed_q <= 1'b0;
      full_q <= 1'b0;
    end else begin
      full_q <= !dropping_q && (look ? full_behind : full_here);
      end_beat_q <= next_end_beat;
      flushed_q <= dropping_q;
      if (dropping_q) begin
        // The beats held go; the next frame begins with a beat.
        next_at_q <= WordAtBits'(next_end_beat) << OffBits;
        front_at_q <= WordAtBits'(next_end_beat) << OffBits;
        front_valid_q <= 1'b0;
        if (last_q || (push && s_axis_tlast_i)) begin
          last_q <= 1'b0;
          header_q <= 1'b1;
          dropping_q <= 1'b0;
        end
      end else begin
        if (push) last_q <= s_axis_tlast_i;
        if (look) begin
          next_at_q  <= next_end_at;
          front_at_q <= next_at_q;
          header_q   <= 1'b0;
        end
        front_valid_q <= look || (front_valid_q && !take);
        dropping_q <= drop_i || (take && (cut || front_is_end_q));
      end
    end
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  // Behind the last word of a frame that was not ended `said` is read where nothing may be written. Any value will
  // do, because such a token is cut in any case; a simulator's unknown would spread. The proof takes any value.
`ifndef FORMAL
  initial for (int i = 0; i < Depth; i++) if ((^said[i]) === 1'bx) said[i] = '0;
`endif

  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. Only a token that is accepted and not final can ask for the rest to be dropped.
      assert (!drop_i || (token_valid_q && token_ready_i && !flags_q.ends));
      // 2. The beats held fit. (Behind a cut token the front may lie past what came.)
      assert (dropping_q || beats_held <= BeatAtBits'(Depth));
      assert (full_q == (beats_held == BeatAtBits'(Depth)));
      // 3. A frame is dropped only when its header has been taken: busy_o need not ask for dropping_q.
      assert (!dropping_q || !header_q);
    end
  end
`endif

endmodule

`default_nettype wire
