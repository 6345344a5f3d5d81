// SPDX-License-Identifier: Apache-2.0
// Gives the core frames from a list: from the memory, or straight from the link. The player adds TLAST.
//
// List: a word N, the number of words of a frame in its lower 24 bits, then these words, then the next frame; N = 0
//   ends the list. From the memory the list begins at address_i. With loop_i it begins anew behind its end, and from
//   the link the end is passed over; a list without a frame ends at once.
// Commands: start_i, for one clock while playing_o is low. After stop_i, for one clock, no frame begins behind the one
//   at hand. From the link a frame at hand may never be whole: its rest has to come, or the core is held in reset.
//   Inputs direct_i, loop_i and paced_i stay as they are while playing_o is high.
// Pace: with paced_i a frame begins when the screen has asked for one, without, at once. A request is kept until a
//   frame begins, and two are as good as one.
// Handshake: valid/ready on all ports; m_axis is AXI4-Stream with BEAT_WORDS words a beat, the first one lowest, and
//   zeros behind the frame's last word. A frame is read in runs of at most 2^RUN_BITS words.
// Memory: run_valid_o with address and number of words, then the words (block_memory, sdram_memory).
// Latency: 1 clock from start_i to the run of N, and without a pace 2 from N to the first run of its frame; 1 from a
//   word to the beat that it fills.
// Throughput: a word a clock with BEAT_WORDS 1; with more, BEAT_WORDS words in BEAT_WORDS + 1 clocks. Between two
//   frames the memory's latency passes twice.
// Cost: about 150 flip-flops, and 32 BEAT_WORDS for the beat.
`default_nettype none
`include "kage_illegal.svh"

module stream_player #(
    parameter int ADDR_BITS  = 23,
    parameter int BEAT_WORDS = 1,
    parameter int RUN_BITS   = 15
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                 start_i,
    input  wire logic                 stop_i,
    input  wire logic                 direct_i,
    input  wire logic                 loop_i,
    input  wire logic                 paced_i,
    input  wire logic [ADDR_BITS-1:0] address_i,
    output logic                      playing_o,
    output logic      [         15:0] played_o,   // frames since start_i, modulo 65536
    output logic                      word_o,     // a word of a frame moves on in this clock: data_o
    output logic      [         31:0] data_o,

    input  wire logic frame_req_valid_i,
    output logic      frame_req_ready_o,

    output logic                      run_valid_o,
    input  wire logic                 run_ready_i,
    output logic      [ADDR_BITS-1:0] run_addr_o,
    output logic      [         15:0] run_words_o,
    input  wire logic                 rd_valid_i,
    output logic                      rd_ready_o,
    input  wire logic [         31:0] rd_data_i,

    input  wire logic        link_valid_i,
    output logic             link_ready_o,
    input  wire logic [31:0] link_data_i,

    output logic                          m_axis_tvalid_o,
    input  wire logic                     m_axis_tready_i,
    output logic      [BEAT_WORDS*32-1:0] m_axis_tdata_o,
    output logic                          m_axis_tlast_o
);
  if (BEAT_WORDS != 1 && BEAT_WORDS != 2 && BEAT_WORDS != 4 && BEAT_WORDS != 8) begin : gen_bad_beat
    `KAGE_ILLEGAL("BEAT_WORDS must be one of 1 2 4 8")
  end
  if (RUN_BITS < 1 || RUN_BITS > 15) begin : gen_bad_run
    `KAGE_ILLEGAL("RUN_BITS must be 1 .. 15")
  end

  localparam int RunMost = 2 ** RUN_BITS;

  typedef enum logic [2:0] {
    Idle,
    AskCount,  // a run of the word N
    Count,     // N
    Wait,      // for the screen
    AskFrame,  // a run of the frame
    Frame      // its words
  } state_t;
  state_t state_q;

  logic [ADDR_BITS-1:0] at_q, run_step;  // the next word to ask for; words to the next run
  logic [23:0] left_q;  // words of the frame that have not come
  logic [RUN_BITS:0] run_left_q, run_words;  // and of the run
  logic stopping_q, any_q, asked_q;
  logic in_valid, in_ready, take, last_word, begins;
  logic [31:0] in_data;
  assign in_valid    = direct_i ? link_valid_i : rd_valid_i;
  assign in_data     = direct_i ? link_data_i : rd_data_i;
  assign take        = in_valid && in_ready;
  assign last_word   = left_q == 24'd1;
  assign begins      = state_q == Wait && !stopping_q && (asked_q || !paced_i);

  assign playing_o   = state_q != Idle;
  assign word_o      = take && state_q == Frame;
  assign data_o      = in_data;

  assign run_words   = left_q > 24'(RunMost) ? (RUN_BITS + 1)'(RunMost) : left_q[RUN_BITS:0];
  assign run_step    = ADDR_BITS'(run_words);
  assign run_valid_o = state_q == AskCount || state_q == AskFrame;
  assign run_addr_o  = at_q;
  assign run_words_o = state_q == AskCount ? 16'd1 : 16'(run_words);

  // ---- what the words are ------------------------------------------------------------------------------------------
  logic beat_free;
  assign in_ready          = (state_q == Count && !(direct_i && stopping_q)) || (state_q == Frame && beat_free);
  // A reset may come in the middle of a run: the memory takes no other before the words of that one have left.
  assign rd_ready_o        = (in_ready && !direct_i) || state_q == Idle || state_q == AskCount;
  assign link_ready_o      = in_ready && direct_i;

  assign frame_req_ready_o = 1'b1;

  always_ff @(posedge clk_i) begin
    if (frame_req_valid_i) asked_q <= 1'b1;
    else if (begins) asked_q <= 1'b0;
    if (stop_i) stopping_q <= 1'b1;
    case (state_q)
      Idle: begin
        stopping_q <= 1'b0;
        any_q      <= 1'b0;
        at_q       <= address_i;
        if (start_i) begin
          state_q  <= direct_i ? Count : AskCount;
          played_o <= '0;
        end
      end
      AskCount:
      if (run_ready_i) begin
        at_q    <= at_q + 1'b1;
        state_q <= Count;
      end
      Count:
      if (direct_i && stopping_q) begin
        state_q <= Idle;
      end else if (take) begin
        left_q <= in_data[23:0];
        if (in_data[23:0] != '0) begin
          state_q <= stopping_q ? Idle : Wait;
        end else begin
          at_q    <= address_i;
          state_q <= stopping_q || !loop_i || !(direct_i || any_q) ? Idle : direct_i ? Count : AskCount;
        end
      end
      Wait:
      if (stopping_q) begin
        state_q <= Idle;
      end else if (begins) begin
        state_q <= direct_i ? Frame : AskFrame;
      end
      AskFrame: begin
        run_left_q <= run_words;
        if (run_ready_i) begin
          at_q    <= at_q + run_step;
          state_q <= Frame;
        end
      end
      Frame:
      if (take) begin
        left_q     <= left_q - 24'd1;
        run_left_q <= run_left_q - 1'b1;
        if (last_word) begin
          any_q    <= 1'b1;
          played_o <= played_o + 16'd1;
          state_q  <= direct_i ? Count : stopping_q ? Idle : AskCount;
        end else if (!direct_i && run_left_q == (RUN_BITS + 1)'(1)) begin
          state_q <= AskFrame;
        end
      end
      default: state_q <= Idle;
    endcase
    if (!rst_ni) begin
      state_q    <= Idle;
      stopping_q <= 1'b0;
      asked_q    <= 1'b0;
      played_o   <= '0;
    end
  end

  // ---- words to beats ----------------------------------------------------------------------------------------------
  localparam int PlaceBits = BEAT_WORDS > 1 ? $clog2(BEAT_WORDS) : 1;
  logic [BEAT_WORDS*32-1:0] beat_q;
  logic [PlaceBits-1:0] place_q;  // of the next word
  logic full_q, last_q;
  assign m_axis_tvalid_o = full_q;
  assign m_axis_tdata_o  = beat_q;
  assign m_axis_tlast_o  = last_q;
  // A beat of one word may be replaced while it leaves; one of several is begun behind the one that left.
  assign beat_free       = !full_q || (BEAT_WORDS == 1 && m_axis_tready_i);

  always_ff @(posedge clk_i) begin
    if (word_o) begin
      for (int w = 0; w < BEAT_WORDS; w++) begin
        if (place_q == PlaceBits'(w)) beat_q[w*32+:32] <= in_data;
        else if (place_q == '0) beat_q[w*32+:32] <= '0;
      end
      last_q <= last_word;
    end
    if (!rst_ni) begin
      full_q  <= 1'b0;
      place_q <= '0;
    end else if (word_o) begin
      full_q  <= last_word || place_q == PlaceBits'(BEAT_WORDS - 1);
      place_q <= last_word || place_q == PlaceBits'(BEAT_WORDS - 1) ? '0 : place_q + 1'b1;
    end else if (m_axis_tready_i) begin
      full_q <= 1'b0;
    end
  end

endmodule

`default_nettype wire
