// SPDX-License-Identifier: Apache-2.0
// Proof of skid_buffer, for any stalls of both sides and a reset at any time (verif/test/formal/run.sh):
//   1. words come out once, in order, one clock after they have become the oldest, within as many ready clocks as words
//   fit;
//      two words fit, and the input is ready whenever one more does (queue_rules);
//   2. an output that waits stays as it is, and reset silences it: m_axis of kage_top is such an output (stream_rules).
//
// How: by induction. The queue of queue_rules says what is inside; the ports show both valid bits and the output's
// register, and lemma_spare says the same of the spare register, which run.sh connects to inside_spare.
//
// Why small widths say it for all: no bit of a word is looked at, all are copied alike. BITS bits are free in each
// word.
`default_nettype none
module skid_buffer_proof #(
    parameter int BITS = 2
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
  skid_buffer #(
      .BITS(BITS)
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

  logic [2:0] count;
  logic [2*BITS-1:0] words;
  queue_rules #(
      .BITS(BITS),
      .CAPACITY(2)
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

  // ---- for induction: the spare register holds the younger of two words --------------------------------------------
  (* keep *) logic [BITS-1:0] inside_spare;
  always_comb if (rst_ni && count == 3'd2) lemma_spare : assert (inside_spare == words[BITS+:BITS]);

  // ---- surroundings: reset at the start, and whenever it pleases ---------------------------------------------------
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);
endmodule

`default_nettype wire
