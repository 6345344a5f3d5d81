// SPDX-License-Identifier: Apache-2.0
// An SDR SDRAM of 16 bits as its data sheet tells of it, for simulation by Verilator. It knows nothing of any
// controller.
//
// Function: bursts and CAS latency as the mode register says (1, 2, 4, 8 columns in sequence, which wrap within their
// aligned group), and dqm (two clocks late for reads). The module sdram_rules checks every command: a broken rule stops
// the simulation with its name, the time and the bank.
// Charge leaks: a row that is neither refreshed nor activated for RETENTION clocks reads as its complement from then
// on. An auto refresh takes the next row, of every bank. Words never written read as a number made of the address.
// Data bus: split in dq_i, dq_o and dq_oe_o, because Verilator 5.006 only approximates a tristate bus between
// modules. Bits that are not driven or are masked read as those of 16'hdead.
// Memory: an associative array, so that 32 MB cost only the words that were written.
// Power: power_i is no pin. While it is low, the chip has no supply, and forgets its mode. A test that resets its
// controller turns the power off too.
// Latency: that of the mode register. Throughput: a column a clock. Cost: none, it is not for synthesis.
`default_nettype none

module sdram_chip #(
    parameter int ROW_BITS = 13,
    parameter int COLUMN_BITS = 9,  // at most 10: those below A10
    parameter int BANK_BITS = 2,
    parameter int RETENTION = 6_400_000,  // 64 ms
    // For sdram_rules, in clocks: of 10 ns here, grade -7.
    parameter int INIT = 20000,
    parameter int INIT_REFRESHES = 8,
    parameter int RCD = 2,
    parameter int RP = 2,
    parameter int RAS = 5,
    parameter int RAS_MAX = 10000,
    parameter int RC = 7,
    parameter int RRD = 2,
    parameter int RFC = 7,
    parameter int WR = 2,
    parameter int MRD = 2,
    parameter int REFI = 781,
    parameter int SLACK = 1000,
    localparam int Banks = 2 ** BANK_BITS
) (
    input wire logic power_i,

    input  wire logic                 clk_i,
    input  wire logic                 cke_i,
    input  wire logic                 cs_ni,
    input  wire logic                 ras_ni,
    input  wire logic                 cas_ni,
    input  wire logic                 we_ni,
    input  wire logic [BANK_BITS-1:0] ba_i,
    input  wire logic [ ROW_BITS-1:0] a_i,
    input  wire logic [          1:0] dqm_i,
    input  wire logic                 dq_driven_i,  // the other side drives dq_i
    input  wire logic [         15:0] dq_i,
    output logic      [         15:0] dq_o,
    output logic                      dq_oe_o,

    output logic [31:0] lost_o  // rows that lost their charge and were opened
);
  logic [Banks-1:0] active;
  logic [Banks*ROW_BITS-1:0] rows;
  logic [3:0] burst;
  logic [1:0] latency;
  logic started;
  sdram_rules #(
      .ROW_BITS(ROW_BITS),
      .BANK_BITS(BANK_BITS),
      .INIT(INIT),
      .INIT_REFRESHES(INIT_REFRESHES),
      .RCD(RCD),
      .RP(RP),
      .RAS(RAS),
      .RAS_MAX(RAS_MAX),
      .RC(RC),
      .RRD(RRD),
      .RFC(RFC),
      .WR(WR),
      .MRD(MRD),
      .REFI(REFI),
      .SLACK(SLACK)
  ) u_rules (
      .rst_ni(power_i),
      .dq_oe_i(dq_driven_i),
      .active_o(active),
      .row_o(rows),
      .burst_o(burst),
      .latency_o(latency),
      .started_o(started),
      .*
  );

  logic [15:0] mem[bit [31:0]];
  logic [63:0] now_q, charged_q[2**(ROW_BITS+BANK_BITS)];
  logic [ROW_BITS-1:0] refresh_q;
  // The burst that goes on: read or written, where it stands, columns left.
  logic reading_q, writing_q;
  logic [3:0] left_q;
  logic [BANK_BITS-1:0] bank_q;
  logic [COLUMN_BITS-1:0] column_q;
  // Words on their way: the chip drives from the edge before the one that latency counts to.
  logic [3:0] oe_q;
  logic [63:0] way_q;
  logic [1:0] dqm_q, mask_q;

  function automatic logic [31:0] place(input logic [BANK_BITS-1:0] bank, input logic [ROW_BITS-1:0] row,
                                        input logic [COLUMN_BITS-1:0] column);
    place = 32'({row, bank, column});
  endfunction
  function automatic logic [15:0] never(input logic [31:0] at);
    never = 16'((at * 32'h9e37_79b1) >> 13);
  endfunction
  function automatic logic [COLUMN_BITS-1:0] following(input logic [COLUMN_BITS-1:0] column, input logic [3:0] length);
    following = (column & ~(COLUMN_BITS'(length) - 1'b1)) | ((column + 1'b1) & (COLUMN_BITS'(length) - 1'b1));
  endfunction

  logic [2:0] command;
  assign command = cs_ni ? 3'b111 : {ras_ni, cas_ni, we_ni};
  assign dq_oe_o = oe_q[0];
  assign dq_o[7:0] = oe_q[0] && !mask_q[0] ? way_q[7:0] : 8'had;
  assign dq_o[15:8] = oe_q[0] && !mask_q[1] ? way_q[15:8] : 8'hde;

  // Work of the edge, step by step: so assignments block, in variables that nothing else reads in this edge.
  /* verilator lint_off BLKSEQ */
  logic now_reads, now_writes;
  logic [3:0] now_left;
  logic [BANK_BITS-1:0] now_bank;
  logic [COLUMN_BITS-1:0] now_column;
  logic [31:0] at;
  logic [15:0] word;
  logic [3:0] oe;
  logic [63:0] way;
  always @(posedge clk_i) begin
    now_q  <= now_q + 1'b1;
    dqm_q  <= dqm_i;
    mask_q <= dqm_q;

    now_reads  = reading_q;
    now_writes = writing_q;
    now_left   = left_q;
    now_bank   = bank_q;
    now_column = column_q;
    if (command == 3'b101 || command == 3'b100) begin
      now_reads  = command == 3'b101;
      now_writes = command == 3'b100;
      now_left   = burst;
      now_bank   = ba_i;
      now_column = COLUMN_BITS'(a_i[9:0]);
    end
    at  = place(now_bank, rows[32'(now_bank)*ROW_BITS+:ROW_BITS], now_column);
    oe  = oe_q >> 1;
    way = way_q >> 16;
    if (now_left != '0 && now_reads) begin
      word = mem.exists(at) != 0 ? mem[at] : never(at);
      oe[latency-1'b1] = 1'b1;
      way[{latency-1'b1, 4'd0}+:16] = word;
    end
    if (now_left != '0 && now_writes) begin
      word = mem.exists(at) != 0 ? mem[at] : never(at);
      if (!dqm_i[0]) word[7:0] = dq_i[7:0];
      if (!dqm_i[1]) word[15:8] = dq_i[15:8];
      mem[at] = word;
    end
    reading_q <= now_reads;
    writing_q <= now_writes;
    left_q <= now_left == '0 ? '0 : now_left - 1'b1;
    bank_q <= now_bank;
    column_q <= following(now_column, burst);
    oe_q <= oe;
    way_q <= way;

    // ---- charge ----
    if (command == 3'b011) begin
      if (now_q - charged_q[{ba_i, a_i}] > 64'(RETENTION)) begin
        lost_o <= lost_o + 1'b1;
        for (int c = 0; c < 2 ** COLUMN_BITS; c++) begin
          at = place(ba_i, a_i, COLUMN_BITS'(c));
          if (mem.exists(at) != 0) mem[at] = ~mem[at];
        end
      end
      charged_q[{ba_i, a_i}] <= now_q;
    end
    if (command == 3'b001) begin
      for (int b = 0; b < Banks; b++)
      if (now_q - charged_q[{BANK_BITS'(b), refresh_q}] <= 64'(RETENTION))
        charged_q[{BANK_BITS'(b), refresh_q}] <= now_q;
      refresh_q <= refresh_q + 1'b1;
    end
    if (!power_i) begin
      {reading_q, writing_q} <= '0;
      left_q <= '0;
      oe_q <= '0;
    end
  end
  /* verilator lint_on BLKSEQ */
  initial begin
    now_q = '0;
    refresh_q = '0;
    lost_o = '0;
    oe_q = '0;
    for (int r = 0; r < 2 ** (ROW_BITS + BANK_BITS); r++) charged_q[r] = '0;
  end

  logic unused;
  assign unused = &{1'b0, started, active};
endmodule

`default_nettype wire
