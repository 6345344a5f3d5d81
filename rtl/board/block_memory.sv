// SPDX-License-Identifier: Apache-2.0
// A frame memory in block RAM, with the ports of sdram_memory, for boards without an SDRAM, and for tests; in one
// clock.
//
// Handshake: valid/ready at the ports for words to write, for runs to read ({address, words}, words at least 1, from
// any address on), and for the words of a run, which come in order. Addresses have ADDR_BITS bits, of which the lowest
// log2 WORDS count: the memory repeats. A run is accepted when the last word of the former has left, or leaves.
// wr_ready_o is high always.
// Order: a run brings every word that was accepted before the run was, or in the same clock; a word that is accepted
// while a run goes on is in it or not. Where the word that is written is the one to be read, reading waits for a
// clock, as the RAM would give bits of both; whoever writes there in every clock stops the run.
// Latency: 2 clocks from run to first word. Throughput: a word a clock, while others are written too; one clock is lost
// between runs.
// Cost: block RAM for WORDS of 32 bits; 80 LUT4, 14 carry cells, 30 flip-flops by yosys synth_ecp5.
`default_nettype none
`include "kage_illegal.svh"

module block_memory #(
    parameter  int WORDS     = 4096,          // a power of two
    parameter  int ADDR_BITS = 23,
    localparam int Bits      = $clog2(WORDS)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                 wr_valid_i,
    output logic                      wr_ready_o,
    input  wire logic [ADDR_BITS-1:0] wr_addr_i,
    input  wire logic [         31:0] wr_data_i,

    input  wire logic                 run_valid_i,
    output logic                      run_ready_o,
    input  wire logic [ADDR_BITS-1:0] run_addr_i,
    input  wire logic [         15:0] run_words_i,

    output logic             rd_valid_o,
    input  wire logic        rd_ready_i,
    output logic      [31:0] rd_data_o
);
  if (WORDS < 2 || WORDS != 2 ** Bits || Bits > ADDR_BITS) begin : gen_bad_words
    `KAGE_ILLEGAL("WORDS must be a power of two, at least 2, and within ADDR_BITS")
  end

  logic [Bits-1:0] at_q;
  logic [15:0] left_q;  // words that were not read
  logic valid_q, free, read, clash;

  assign clash = wr_valid_i && wr_addr_i[Bits-1:0] == at_q;
  assign free = !valid_q || rd_ready_i;
  assign read = left_q != '0 && free && !clash;
  assign wr_ready_o = 1'b1;
  assign run_ready_o = left_q == '0 && free;
  assign rd_valid_o = valid_q;

  always_ff @(posedge clk_i) begin
    if (run_valid_i && run_ready_o) at_q <= run_addr_i[Bits-1:0];
    else if (read) at_q <= at_q + 1'b1;
    if (!rst_ni) begin
      left_q  <= '0;
      valid_q <= 1'b0;
    end else begin
      if (run_valid_i && run_ready_o) left_q <= run_words_i;
      else if (read) left_q <= left_q - 1'b1;
      if (free) valid_q <= read;
    end
  end

  ram_1r1w #(
      .BITS (32),
      .WORDS(WORDS)
  ) u_ram (
      .clk_i,
      .wr_en_i  (wr_valid_i),
      .wr_addr_i(wr_addr_i[Bits-1:0]),
      .wr_data_i,
      .rd_en_i  (read),
      .rd_addr_i(at_q),
      .rd_data_o
  );

  // The memory repeats: the highest bits of addresses say nothing.
  if (Bits < ADDR_BITS) begin : gen_unused
    logic unused;
    assign unused = &{1'b0, wr_addr_i[ADDR_BITS-1:Bits], run_addr_i[ADDR_BITS-1:Bits]};
  end

endmodule

`default_nettype wire
