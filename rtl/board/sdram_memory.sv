// SPDX-License-Identifier: Apache-2.0
// A frame memory in an SDRAM: words are written one by one and read as runs, in the core's clock, while the chip has
// its own. Between the clocks lie two async_fifos, nothing else.
//
// Handshake: valid/ready at the ports for words to write, for runs to read, and for the words of a run, which come in
// order. A run is {address, words}: words is at least 1, from any address on, round the end of the memory. It is
// accepted when the last word of the run before has left. All ready outputs depend on registers, and wr_ready_o also on
// whether a block is asked for.
// Order: words to write and blocks to read go through one FIFO. So a run brings every word that was accepted before
// the run was, or in the same clock; a word that is accepted while a run goes on is in it or not.
// Room: a block of BURST words is asked for only when the FIFO of words read has room for it beside those under way.
// The room is counted in the core's clock alone, where the words leave.
// Reset: both clocks' resets at once, as async_fifo says. Words accepted before the chip has started wait in the FIFO.
// Latency: from run to first word about 8 clocks of the core and 16 of the memory, 9 more where another row is open.
// Throughput: a word a clock of the core, or a word in 2.1 clocks of the memory, whichever is less.
// Cost: yosys synth_ecp5, controller and FIFOs together: 620 LUT4 and 61 carry cells, 410 flip-flops, 14 LUT RAMs of
// 16 x 4, a block RAM.
`default_nettype none
`include "kage_illegal.svh"

module sdram_memory #(
    parameter  int CLOCK_HZ    = 100_000_000,                             // of the memory
    parameter  int ROW_BITS    = 13,
    parameter  int COLUMN_BITS = 9,
    parameter  int BANK_BITS   = 2,
    parameter  int BURST       = 16,
    parameter  int CAS_LATENCY = 3,
    parameter  int READ_DELAY  = CAS_LATENCY,
    parameter  int T_INIT      = 200_000,
    parameter  int T_REF       = 64_000_000,
    parameter  int WORDS       = 64,                                      // places for words read, a power of two
    parameter  int COMMANDS    = 8,                                       // words to write and blocks to read that wait
    localparam int AddrBits    = ROW_BITS + BANK_BITS + COLUMN_BITS - 1,
    localparam int BurstBits   = $clog2(BURST),
    localparam int RoomBits    = $clog2(WORDS) + 1,
    localparam int BlockBits   = 17 - BurstBits
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                wr_valid_i,
    output logic                     wr_ready_o,
    input  wire logic [AddrBits-1:0] wr_addr_i,
    input  wire logic [        31:0] wr_data_i,

    input  wire logic                run_valid_i,
    output logic                     run_ready_o,
    input  wire logic [AddrBits-1:0] run_addr_i,
    input  wire logic [        15:0] run_words_i,

    output logic             rd_valid_o,
    input  wire logic        rd_ready_i,
    output logic      [31:0] rd_data_o,

    input  wire logic                 mem_clk_i,
    input  wire logic                 mem_rst_ni,
    output logic                      mem_ready_o,
    output logic                      sdram_cke_o,
    output logic                      sdram_cs_no,
    output logic                      sdram_ras_no,
    output logic                      sdram_cas_no,
    output logic                      sdram_we_no,
    output logic      [BANK_BITS-1:0] sdram_ba_o,
    output logic      [ ROW_BITS-1:0] sdram_a_o,
    output logic      [          1:0] sdram_dqm_o,
    output logic      [         15:0] sdram_dq_o,
    output logic                      sdram_dq_oe_o,
    input  wire logic [         15:0] sdram_dq_i
);
  if (WORDS < 2 * BURST || WORDS != 2 ** (RoomBits - 1) || BURST > 64) begin : gen_bad_words
    `KAGE_ILLEGAL("WORDS must be a power of two and at least two bursts, which have at most 64 words")
  end

  // ---- the core's clock: runs to blocks -----------------------------------------------------------------------------
  logic busy_q;  // a run is not over, or words of its last block are still to be thrown away
  logic [AddrBits-BurstBits-1:0] block_q;
  logic [BlockBits-1:0] blocks_q;  // to be asked for
  logic [BurstBits-1:0] skip_q;  // words of the first block before the run
  logic [15:0] left_q;  // words of the run that have not left
  logic [RoomBits-1:0] room_q;  // places for words that were not asked for
  logic [BurstBits-1:0] word_q;  // of its block, that comes next
  logic [16:0] reach;  // words from the first block's start to the end of the last one's
  logic unused;
  assign unused = &{1'b0, reach[BurstBits-1:0]};

  logic ask, asks, pop, words_valid, words_ready, command_valid, command_ready;
  logic [31:0] words_data;
  assign asks = blocks_q != '0 && room_q >= RoomBits'(BURST);
  assign ask = asks && command_ready;
  assign command_valid = asks || wr_valid_i;
  assign wr_ready_o = command_ready && !asks;
  assign run_ready_o = !busy_q;
  assign reach = 17'(run_addr_i[BurstBits-1:0]) + 17'(run_words_i) + 17'(BURST - 1);

  // Words before the run, and behind it, are taken from the FIFO and shown to nobody.
  logic wanted;
  assign wanted = skip_q == '0 && left_q != '0;
  assign rd_valid_o = words_valid && wanted;
  assign rd_data_o = words_data;
  assign words_ready = !wanted || rd_ready_i;
  assign pop = words_valid && words_ready;

  always_ff @(posedge clk_i) begin
    if (run_valid_i && run_ready_o) begin
      block_q  <= run_addr_i[AddrBits-1:BurstBits];
      blocks_q <= reach[16:BurstBits];
      skip_q   <= run_addr_i[BurstBits-1:0];
      left_q   <= run_words_i;
    end else begin
      if (ask) begin
        block_q  <= block_q + 1'b1;
        blocks_q <= blocks_q - 1'b1;
      end
      if (pop && skip_q != '0) skip_q <= skip_q - 1'b1;
      if (pop && wanted) left_q <= left_q - 1'b1;
    end
    if (pop) word_q <= word_q + 1'b1;
    room_q <= room_q + RoomBits'(pop) - (ask ? RoomBits'(BURST) : '0);
    if (run_valid_i && run_ready_o) busy_q <= 1'b1;
    else if (pop && (&word_q) && (left_q == '0 || (left_q == 16'd1 && wanted))) busy_q <= 1'b0;
    if (!rst_ni) begin
      busy_q   <= 1'b0;
      blocks_q <= '0;
      skip_q   <= '0;
      left_q   <= '0;
      room_q   <= RoomBits'(WORDS);
      word_q   <= '0;
    end
  end

  // ---- to the memory's clock, and back ------------------------------------------------------------------------------
  logic [AddrBits+32:0] command, mem_command;
  logic mem_command_valid, mem_command_ready, mem_write, mem_wr_ready, mem_req_ready;
  logic mem_rd_valid, mem_rd_ready;
  logic [31:0] mem_rd_data;
  assign command = {!asks, asks ? {block_q, BurstBits'(0)} : wr_addr_i, wr_data_i};
  assign mem_write = mem_command[AddrBits+32];
  assign mem_command_ready = mem_write ? mem_wr_ready : mem_req_ready;

  async_fifo #(
      .BITS (AddrBits + 33),
      .DEPTH(COMMANDS)
  ) u_commands (
      .in_clk_i(clk_i),
      .in_rst_ni(rst_ni),
      .in_valid_i(command_valid),
      .in_ready_o(command_ready),
      .in_data_i(command),
      .out_clk_i(mem_clk_i),
      .out_rst_ni(mem_rst_ni),
      .out_valid_o(mem_command_valid),
      .out_ready_i(mem_command_ready),
      .out_data_o(mem_command)
  );

  async_fifo #(
      .BITS (32),
      .DEPTH(WORDS)
  ) u_words (
      .in_clk_i(mem_clk_i),
      .in_rst_ni(mem_rst_ni),
      .in_valid_i(mem_rd_valid),
      .in_ready_o(mem_rd_ready),
      .in_data_i(mem_rd_data),
      .out_clk_i(clk_i),
      .out_rst_ni(rst_ni),
      .out_valid_o(words_valid),
      .out_ready_i(words_ready),
      .out_data_o(words_data)
  );

  sdram_controller #(
      .CLOCK_HZ(CLOCK_HZ),
      .ROW_BITS(ROW_BITS),
      .COLUMN_BITS(COLUMN_BITS),
      .BANK_BITS(BANK_BITS),
      .BURST(BURST),
      .CAS_LATENCY(CAS_LATENCY),
      .READ_DELAY(READ_DELAY),
      .T_INIT(T_INIT),
      .T_REF(T_REF)
  ) u_controller (
      .clk_i(mem_clk_i),
      .rst_ni(mem_rst_ni),
      .ready_o(mem_ready_o),
      .wr_valid_i(mem_command_valid && mem_write),
      .wr_ready_o(mem_wr_ready),
      .wr_addr_i(mem_command[AddrBits+31:32]),
      .wr_data_i(mem_command[31:0]),
      .req_valid_i(mem_command_valid && !mem_write),
      .req_ready_o(mem_req_ready),
      .req_block_i(mem_command[AddrBits+31:32+BurstBits]),
      .rd_valid_o(mem_rd_valid),
      .rd_data_o(mem_rd_data),
      .*
  );

  always @(posedge mem_clk_i) if (mem_rst_ni && mem_rd_valid) assert (mem_rd_ready);

endmodule

`default_nettype wire
