// SPDX-License-Identifier: Apache-2.0
// Beats to tokens: cuts the words of the input port into the frame's header and its tokens, one whole token at a time.
//
// Handshake: s_* is AXI4-Stream; s_ready_o depends on registers and on rst_ni, which keeps it low: no beat is taken and
//   lost in reset. token_* is valid/ready, the token and its flags stable while it waits. drop_i may be high only with
//   token_ready_i, and only for a token without token_final_o: the rest of the frame is then dropped up to and with
//   TLAST. The reader drops the rest by itself after a final token (END, or one that TLAST cut).
// Order: the first token of a frame is its header (HeaderWords words). A token of a kind that the configuration lacks
//   is passed on as soon as its first word is there. A cut token is passed on with token_cut_o and whatever words there
//   are.
// Capacity: the beats a token can touch and one more, at least. Latency: 2 clocks from the beat that completes a token.
// Throughput: a token a clock, or as many clocks as the port needs for its words. A frame's end costs 2 clocks.
// Cost: the beats' registers, a multiplexer per word of the longest token over beats and words of a beat.
`default_nettype none
`include "kage_illegal.svh"

module token_reader #(
    `include "generated/kage_pixel_params.svh"
    parameter int BEAT_WORDS  = 4,
    parameter int TOKEN_WORDS = 5   // the longest of all tokens and the header
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // input port
    input  wire logic                     s_valid_i,
    output logic                          s_ready_o,
    input  wire logic [BEAT_WORDS*32-1:0] s_data_i,
    input  wire logic                     s_last_i,

    // to frame_control
    output logic                           token_valid_o,
    input  wire logic                      token_ready_i,
    output logic      [TOKEN_WORDS*32-1:0] token_o,
    output logic                           token_header_o,   // the frame's first
    output logic                           token_lacking_o,  // its kind is not in this configuration
    output logic                           token_cut_o,      // TLAST came before its last word
    output logic                           token_final_o,    // nothing of the frame follows: END, or cut
    output logic                           token_at_last_o,  // its first word is in TLAST's beat
    input  wire logic                      drop_i,

    output logic dropping_o,  // words are being dropped up to TLAST
    output logic busy_o,      // some of a frame has come in and its end has not been passed on
    output logic moving_o     // something changes in here, though no beat comes and no token is taken
);
  `include "generated/kage_layout.svh"

  if (TOKEN_WORDS < TokenWords || TOKEN_WORDS < HeaderWords) begin : gen_bad_token_words
    `KAGE_ILLEGAL("TOKEN_WORDS must hold every token and the header")
  end

  localparam int WindowBeats = (TOKEN_WORDS + 2 * BEAT_WORDS - 2) / BEAT_WORDS;  // beats that a token can touch
  localparam int Depth = 2 ** $clog2(WindowBeats + 1);
  localparam int PtrBits = $clog2(Depth);
  localparam int OffBits = BEAT_WORDS > 1 ? $clog2(BEAT_WORDS) : 1;
  localparam int WordsBits = $clog2(Depth * BEAT_WORDS + 1);
  localparam int BeatBits = 32 * BEAT_WORDS;

  // ---- beats, oldest first -----------------------------------------------------------------------------------------
  logic [BeatBits-1:0] mem[Depth];
  logic [PtrBits-1:0] rd_q;
  logic [PtrBits:0] beats_q;
  logic [OffBits-1:0] off_q;  // words of the oldest beat that are gone
  logic last_q;  // the newest beat had TLAST
  logic header_q, dropping_q;

  logic push;
  assign s_ready_o = rst_ni && !beats_q[PtrBits] && !last_q;
  assign push = s_valid_i && s_ready_o;

  // ---- the token at the front ------------------------------------------------------------------------------------
  logic [WindowBeats*BeatBits-1:0] window;
  logic [TOKEN_WORDS*32-1:0] front;
  logic [WordsBits-1:0] available, need;
  logic [4:0] kind_words;
  logic lacking, whole, cut, is_end, take, out_free;

  always_comb begin
    for (int i = 0; i < WindowBeats; i++) window[i*BeatBits+:BeatBits] = mem[PtrBits'(rd_q+PtrBits'(i))];
  end

  if (BEAT_WORDS > 1) begin : gen_align
    always_comb begin
      front = window[0+:TOKEN_WORDS*32];
      for (int o = 1; o < BEAT_WORDS; o++) begin
        if (off_q == OffBits'(o)) front = window[o*32+:TOKEN_WORDS*32];
      end
    end
    assign available = {beats_q, {OffBits{1'b0}}} - WordsBits'(off_q);
  end else begin : gen_word_beats
    assign front = window[0+:TOKEN_WORDS*32];
    assign available = beats_q;
  end

  assign kind_words = token_words(front[3:0]);
  assign lacking = !header_q && kind_words == 5'd0;
  always_comb begin
    if (header_q) need = WordsBits'(HeaderWords);
    else if (lacking) need = WordsBits'(1);
    else need = WordsBits'(kind_words);
  end
  assign whole = available >= need;
  assign cut = last_q && !whole && (!header_q || available != '0);
  assign is_end = whole && !header_q && front[3:0] == KindEnd;
  assign take = out_free && !dropping_q && (whole || cut);

  // Where the front moves to when a token is taken; a cut token takes nothing, since the rest is dropped anyway.
  logic [WordsBits-1:0] next_words;
  logic [PtrBits:0] gone;  // beats that are used up
  assign next_words = WordsBits'(off_q) + need;
  if (BEAT_WORDS > 1) begin : gen_gone
    assign gone = next_words[OffBits+:PtrBits+1];
  end else begin : gen_gone_words
    assign gone = next_words;
  end

  // ---- output register -------------------------------------------------------------------------------------------
  logic token_valid_q, token_header_q, token_lacking_q, token_cut_q, token_final_q, token_at_last_q;
  logic [TOKEN_WORDS*32-1:0] token_q;

  assign token_valid_o = token_valid_q;
  assign token_o = token_q;
  assign token_header_o = token_header_q;
  assign token_lacking_o = token_lacking_q;
  assign token_cut_o = token_cut_q;
  assign token_final_o = token_final_q;
  assign token_at_last_o = token_at_last_q;
  assign out_free = !token_valid_q || token_ready_i;
  assign dropping_o = dropping_q;
  assign busy_o = !header_q || token_valid_q || beats_q != '0;
  assign moving_o = take || (dropping_q && (last_q || beats_q != '0));

  always_ff @(posedge clk_i) begin
    if (take) begin
      token_q <= front;
      token_header_q <= header_q;
      token_lacking_q <= lacking && !cut;
      token_cut_q <= cut;
      token_final_q <= cut || is_end;
      token_at_last_q <= last_q && beats_q == (PtrBits + 1)'(1);
    end
    if (!rst_ni) token_valid_q <= 1'b0;
    else if (out_free) token_valid_q <= take && !drop_i;
  end

  // ---- state -------------------------------------------------------------------------------------------------------
  always_ff @(posedge clk_i) begin
    if (push) mem[PtrBits'(rd_q+beats_q[PtrBits-1:0])] <= s_data_i;
    if (!rst_ni) begin
      rd_q <= '0;
      beats_q <= '0;
      off_q <= '0;
      last_q <= 1'b0;
      header_q <= 1'b1;
      dropping_q <= 1'b0;
    end else begin
      if (dropping_q) begin
        beats_q <= '0;
        off_q   <= '0;
        if (last_q || (push && s_last_i)) begin
          last_q <= 1'b0;
          header_q <= 1'b1;
          dropping_q <= 1'b0;
        end
      end else begin
        if (push) last_q <= s_last_i;
        beats_q <= beats_q + (PtrBits + 1)'(push) - (take && !cut ? gone : '0);
        if (take) begin
          header_q <= 1'b0;
          if (!cut) begin
            rd_q  <= rd_q + gone[PtrBits-1:0];
            off_q <= BEAT_WORDS > 1 ? next_words[OffBits-1:0] : '0;
          end
        end
        dropping_q <= drop_i || (take && (cut || is_end));
      end
    end
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. Only a token that is accepted and not final can ask for the rest to be dropped.
      assert (!drop_i || (token_valid_q && token_ready_i && !token_final_q));
      // 2. What is used up was there.
      assert (!(take && !cut) || gone <= beats_q);
      // 3. What is dropped is of a frame whose header has been taken: busy_o need not ask for dropping_q.
      assert (!dropping_q || !header_q);
    end
  end
`endif

endmodule

`default_nettype wire
