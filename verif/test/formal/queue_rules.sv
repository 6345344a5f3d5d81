// SPDX-License-Identifier: Apache-2.0
// The rules of a first-in first-out buffer between two valid/ready ports, held against a reference queue. A proof puts
// it beside the buffer, on the same wires; skid_buffer_proof and stream_fifo_proof do.
//
//   order     a word that waits at the output is the oldest of those that went in and have not come out: none lost,
//             doubled or out of order. Reset empties the queue, so no word comes out after a reset that went in before
//             it.
//   arrival   a word is at the output one clock after it has become the oldest: the output is valid whenever something
//             is inside.
//   capacity  the input is ready whenever less than CAPACITY words are inside, and not otherwise.
//   deadline  a word leaves within CAPACITY clocks in which the output is ready, whatever else goes on. mark_i, free,
//             chooses the word.
//
// count_o and words_o are the queue: a proof by induction says with them what the registers of the buffer hold.
`default_nettype none

module queue_rules #(
    parameter int BITS = 2,
    parameter int CAPACITY = 2,
    localparam int CountBits = $clog2(CAPACITY + 1) + 1
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic            in_valid_i,
    input wire logic            in_ready_i,
    input wire logic [BITS-1:0] in_data_i,

    input wire logic            out_valid_i,
    input wire logic            out_ready_i,
    input wire logic [BITS-1:0] out_data_i,

    input wire logic mark_i,

    output logic [    CountBits-1:0] count_o,
    output logic [CAPACITY*BITS-1:0] words_o   // oldest first
);
  logic [CAPACITY*BITS-1:0] words_q, words_d;
  logic [CountBits-1:0] count_q, count_d;
  logic push, pop;
  assign push = in_valid_i && in_ready_i;
  assign pop = out_valid_i && out_ready_i;
  assign words_o = words_q;
  assign count_o = count_q;
  always_comb begin
    words_d = words_q;
    count_d = count_q;
    if (pop) begin
      words_d = words_d >> BITS;
      count_d = count_d - 1'b1;
    end
    if (push) begin
      for (int p = 0; p < CAPACITY; p++) if (count_d == CountBits'(p)) words_d[p*BITS+:BITS] = in_data_i;
      count_d = count_d + 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    words_q <= words_d;
    count_q <= rst_ni ? count_d : '0;
  end

  always_comb begin
    if (rst_ni) begin
      if (out_valid_i) order : assert (count_q != '0 && out_data_i == words_q[0+:BITS]);
      arrival : assert (out_valid_i || count_q == '0);
      capacity : assert (in_ready_i == (count_q < CountBits'(CAPACITY)) && count_q <= CountBits'(CAPACITY));
    end
  end

  // ---- one word on its way -----------------------------------------------------------------------------------------
  logic marked_q = 1'b0;
  logic [CountBits-1:0] ahead_q, clocks_q;  // words before it; clocks with a ready output that it has waited
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      marked_q <= 1'b0;
    end else if (!marked_q) begin
      marked_q <= push && mark_i;
      ahead_q  <= count_d - 1'b1;
      clocks_q <= '0;
    end else begin
      if (pop) ahead_q <= ahead_q - 1'b1;
      if (pop && ahead_q == '0) marked_q <= 1'b0;
      if (out_ready_i) clocks_q <= clocks_q + 1'b1;
    end
  end
  always_comb begin
    if (rst_ni && marked_q) begin
      lemma_inside : assert (ahead_q < count_q);
      deadline : assert (ahead_q + clocks_q < CountBits'(CAPACITY));
    end
  end

  // ---- what the rules are about happens ----------------------------------------------------------------------------
  logic was_full_q = 1'b0, was_reset_q = 1'b0;
  logic [1:0] through_q = '0;  // clocks in a row in which a word came and a word left
  always_ff @(posedge clk_i) begin
    was_full_q  <= rst_ni && (was_full_q || count_q == CountBits'(CAPACITY));
    was_reset_q <= was_reset_q || (!rst_ni && was_full_q && count_q == CountBits'(CAPACITY));
    if (!rst_ni || !push || !pop) through_q <= '0;
    else if (through_q != 2'd3) through_q <= through_q + 1'b1;
  end
  always_comb begin
    if (rst_ni) begin
      full : cover (count_q == CountBits'(CAPACITY) && in_valid_i);
      empty_again : cover (was_full_q && count_q == '0);
      word_a_clock : cover (through_q == 2'd3);
      full_at_reset : cover (was_reset_q && count_q == CountBits'(1));
      last_moment : cover (marked_q && pop && ahead_q == '0 && clocks_q == CountBits'(CAPACITY - 1));
    end
  end

endmodule

`default_nettype wire
