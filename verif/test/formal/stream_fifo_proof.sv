// SPDX-License-Identifier: Apache-2.0
// Proof of stream_fifo, for any stalls of both sides and a reset at any time (verif/test/formal/run.sh):
//   1. words come out once, in order, one clock after they have become the oldest, within as many ready clocks as words
//   fit;
//      DEPTH words fit, and the input is ready whenever one more does (queue_rules);
//   2. an output that waits stays as it is, and reset silences it (stream_rules).
//
// How: by induction. The queue of queue_rules says what is inside. Script run.sh connects inside_* to the memory, the
// count, the place of the oldest word and that of the next. The lemmas say that the words of the queue lie between
// them.
//
// Why small widths say it for all: no bit of a word is looked at, all are copied alike. BITS bits are free in each
// word. DEPTH is 2, the least there is and the one that kage_top has, 4, and 8: pointers of one bit and of more,
// words in flip-flops and in LUT RAM.
`default_nettype none
module stream_fifo_proof #(
    parameter int BITS = 2,
    parameter int DEPTH = 4,
    localparam int PtrBits = $clog2(DEPTH)
) (
    input wire logic            clk_i,
    input wire logic            rst_ni,
    input wire logic            in_valid_i,
    input wire logic [BITS-1:0] in_data_i,
    input wire logic            out_ready_i,
    input wire logic            mark_i
);
  logic in_ready, out_valid;
  logic [BITS-1:0] out_data;
  stream_fifo #(
      .BITS (BITS),
      .DEPTH(DEPTH)
  ) dut (
      .clk_i,
      .rst_ni,
      .in_valid_i,
      .in_ready_o (in_ready),
      .in_data_i,
      .out_valid_o(out_valid),
      .out_ready_i,
      .out_data_o (out_data)
  );

  logic [$clog2(DEPTH+1):0] count;
  logic [DEPTH*BITS-1:0] words;
  queue_rules #(
      .BITS(BITS),
      .CAPACITY(DEPTH)
  ) queue (
      .clk_i,
      .rst_ni,
      .in_valid_i,
      .in_ready_i (in_ready),
      .in_data_i,
      .out_valid_i(out_valid),
      .out_ready_i,
      .out_data_i (out_data),
      .mark_i,
      .count_o    (count),
      .words_o    (words)
  );
  stream_rules #(
      .BITS(BITS)
  ) axi (
      .clk_i,
      .rst_ni,
      .valid_i(out_valid),
      .ready_i(out_ready_i),
      .data_i (out_data)
  );

  // ---- for induction: the memory from the oldest word on is the queue ----------------------------------------------
  (* keep *) logic [DEPTH*BITS-1:0] inside_memory;
  (* keep *) logic [PtrBits-1:0] inside_oldest, inside_next;
  (* keep *) logic [PtrBits:0] inside_count;
  logic words_there;
  logic [PtrBits-1:0] place;
  always_comb begin
    words_there = 1'b1;
    place = inside_oldest;
    for (int p = 0; p < DEPTH; p++) begin
      if (count > p && inside_memory[place*BITS+:BITS] != words[p*BITS+:BITS]) words_there = 1'b0;
      place = place + 1'b1;
    end
    if (rst_ni) lemma_words : assert (words_there);
  end
  always_comb if (rst_ni) lemma_count : assert (inside_count == count);
  always_comb if (rst_ni) lemma_next : assert (inside_next == PtrBits'(inside_oldest + count));

  // ---- surroundings: reset at the start, and whenever it pleases ---------------------------------------------------
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);
endmodule

`default_nettype wire
