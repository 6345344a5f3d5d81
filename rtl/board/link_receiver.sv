// SPDX-License-Identifier: Apache-2.0
// The board's end of what the host sends (docs/link.md): takes the frame that is next in sequence, keeps it until it
// has been executed, and says what an ACK says.
//
// Handshake: a byte comes with rx_valid_i, and is always taken (rx_ready_o is high out of reset).
// Frames: head_valid_o offers the oldest frame that was kept, head_words_o is its number of words. Its bytes are read
//   as from a RAM: rd_at_i is the address, the byte comes a clock later. While a frame is offered, head_done_i gives
//   its slot back.
// Answers: answer_o is high for a clock after the end of each frame, when a slot gets free, and after reset: an ACK is
//   due. The ACK's fields are right in any clock. Input ack_taken_i marks the clock in which an ACK takes them, and
//   clears `dropped`: a frame was damaged, or out of turn, and none has been kept since.
// Slots: SLOTS frames of 256 bytes. A frame is written to the free slot as it comes; it is kept (committed) when its
//   CRC and its form are right and its sequence is the expected one. When no slot was free at its first byte it is not
//   written; if it would have been kept, overrun_o is set.
// Counters: frames whose CRC and form are right, other frames, and overruns; modulo 65536.
// Latency: 2 clocks from a frame's last flag to head_valid_o and answer_o. Throughput: a byte a clock.
// Cost: a RAM of SLOTS x 256 bytes, and without link_deframer 233 LUT and 119 flip-flops of an iCE40, of which 48 are
//   counters and 24 word counts.
`default_nettype none
`include "kage_illegal.svh"

module link_receiver #(
    parameter  int SLOTS    = 4,
    localparam int SlotBits = $clog2(SLOTS)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic       rx_valid_i,
    output logic            rx_ready_o,
    input  wire logic [7:0] rx_data_i,

    // the oldest frame
    output logic            head_valid_o,
    output logic      [5:0] head_words_o,
    input  wire logic       head_done_i,
    input  wire logic [7:0] rd_at_i,
    output logic      [7:0] rd_data_o,
    input  wire logic       axi_error_i,   // a response of AXI was an error

    // what an ACK says
    output logic            answer_o,
    input  wire logic       ack_taken_i,
    output logic      [7:0] expected_o,
    output logic      [7:0] limit_o,
    output logic      [7:0] done_o,
    output logic      [7:0] session_o,
    output logic            fresh_o,
    output logic            dropped_o,
    output logic            axi_error_o,
    output logic            overrun_o,

    output logic [15:0] good_frames_o,
    output logic [15:0] bad_frames_o,
    output logic [15:0] overruns_o
);
  if (SLOTS < 2 || SLOTS > 64 || SLOTS != 2 ** SlotBits) begin : gen_bad_slots
    `KAGE_ILLEGAL("SLOTS must be a power of two, of 2 to 64")
  end
  `include "kage_link.svh"

  logic byte_valid, frame_end, frame_good;
  logic [7:0] byte_data, byte_at;
  logic [8:0] size;
  assign rx_ready_o = rst_ni;
  link_deframer u_deframer (
      .clk_i,
      .rst_ni,
      .in_valid_i(rx_valid_i && rx_ready_o),
      .in_data_i(rx_data_i),
      .byte_valid_o(byte_valid),
      .byte_o(byte_data),
      .byte_at_o(byte_at),
      .end_o(frame_end),
      .good_o(frame_good),
      .size_o(size)
  );

  // ---- slots -------------------------------------------------------------------------------------------------------
  // Frames that were kept, and those that have been executed, modulo 2 SLOTS.
  logic [SlotBits:0] kept_q, done_q, used;
  logic full, keep, writing, writing_q;
  logic [5:0] words_mem[SLOTS];
  assign used = kept_q - done_q;
  assign full = used[SlotBits];
  assign head_valid_o = used != '0;
  assign head_words_o = words_mem[done_q[SlotBits-1:0]];
  // Decided with the first byte: a frame whose beginning was not written is not kept.
  assign writing = byte_at == 8'd0 ? !full : writing_q;

  ram_1r1w #(
      .BITS (8),
      .WORDS(SLOTS * 256)
  ) u_slots (
      .clk_i,
      .wr_en_i  (byte_valid && writing),
      .wr_addr_i({kept_q[SlotBits-1:0], byte_at}),
      .wr_data_i(byte_data),
      .rd_en_i  (1'b1),
      .rd_addr_i({done_q[SlotBits-1:0], rd_at_i}),
      .rd_data_o
  );

  // ---- what the frame is -------------------------------------------------------------------------------------------
  logic [7:0] kind_q, sequence_q;
  logic [7:0] ahead;
  logic [5:0] words;  // behind the address, if there is one
  logic count_right_q, form_right, good, in_turn, hello, kept_kind, missed;
  always_comb begin
    words = 6'(size[8:2] - 7'd1);
    unique case (kind_q)
      KindHello, KindPoll: form_right = size == 9'd4;
      KindStream: form_right = size[1:0] == 2'd0;
      KindWrite, KindWriteSame: begin
        form_right = size[1:0] == 2'd0 && size >= 9'd8;
        words = 6'(size[8:2] - 7'd2);
      end
      KindRead: form_right = size == 9'd9 && count_right_q;
      default: form_right = 1'b0;
    endcase
  end
  assign good = frame_end && frame_good && form_right;
  assign hello = good && kind_q == KindHello;
  assign kept_kind = kind_q != KindHello && kind_q != KindPoll;
  assign in_turn = good && kept_kind && !fresh_o && ahead == '0;
  assign keep = in_turn && writing_q;
  // missed: the frame is dropped, and the host must send it again. A frame that was kept before and comes once more is
  // not missed, because a host that goes back would be told to go back for what it sends again, for ever.
  assign ahead = sequence_q - expected_o;
  assign missed = frame_end && (!good || (kept_kind && (fresh_o || !ahead[7]) && !keep));

  always_ff @(posedge clk_i) begin
    if (byte_valid) begin
      writing_q <= writing;
      if (byte_at == 8'd0) kind_q <= byte_data;
      if (byte_at == 8'd1) sequence_q <= byte_data;
      if (byte_at == 8'd6) count_right_q <= byte_data != 8'd0 && byte_data <= ReadMost;
    end
    if (keep) words_mem[kept_q[SlotBits-1:0]] <= words;
    if (!rst_ni) begin
      kept_q <= '0;
      done_q <= '0;
    end else begin
      if (keep) kept_q <= kept_q + 1'b1;
      if (head_done_i && head_valid_o) done_q <= done_q + 1'b1;
    end
  end

  // ---- what an ACK says --------------------------------------------------------------------------------------------
  // HELLO moves the sequence, not the frames: those that were kept before it are executed, and `done` stays as far
  // behind `expected` as they are many.
  assign done_o  = expected_o - 8'(used);
  assign limit_o = done_o + 8'(SLOTS);
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      expected_o <= '0;
      session_o <= '0;
      fresh_o <= 1'b1;
      dropped_o <= 1'b0;
      axi_error_o <= 1'b0;
      overrun_o <= 1'b0;
      answer_o <= 1'b1;
    end else begin
      answer_o <= frame_end || (head_done_i && head_valid_o);
      if (ack_taken_i) dropped_o <= 1'b0;
      if (missed) dropped_o <= 1'b1;
      if (keep) begin
        expected_o <= expected_o + 8'd1;
        dropped_o  <= 1'b0;
      end
      if (hello) begin
        expected_o <= sequence_q + 8'd1;
        session_o <= sequence_q;
        {fresh_o, dropped_o, axi_error_o, overrun_o} <= '0;
      end
      if (axi_error_i) axi_error_o <= 1'b1;
      if (in_turn && !writing_q) overrun_o <= 1'b1;
    end
  end

  // ---- counters ----------------------------------------------------------------------------------------------------
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      good_frames_o <= '0;
      bad_frames_o <= '0;
      overruns_o <= '0;
    end else begin
      if (good) good_frames_o <= good_frames_o + 16'd1;
      if (frame_end && !good) bad_frames_o <= bad_frames_o + 16'd1;
      if (in_turn && !writing_q) overruns_o <= overruns_o + 16'd1;
    end
  end

endmodule

`default_nettype wire
