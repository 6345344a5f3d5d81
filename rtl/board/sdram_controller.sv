// SPDX-License-Identifier: Apache-2.0
// A controller for one SDR SDRAM of 16 bits (IS42S16160, W9825G6KH, AS4C16M16 and their like), in the memory's clock.
//
// Words have 32 bits: two columns, the lower half in the even one. The address of a word is {row, bank, column
// without its lowest bit}. The chip runs with bursts of two columns, so a word is a command; one row is open at a
// time, and stays open until another is wanted or a refresh is due.
//
// Handshake: valid/ready at the ports for words to write and for blocks to read. Each port's ready, wr_ready_o and
// req_ready_o, depends on registers and on the other port's valid: words to write and blocks to read alternate while
// both wait. Requests are done in the order of acceptance, so a block brings every word that was written before it. A
// block of BURST words, aligned, comes in order at rd_valid_o, which has no ready: who asks has room. Neither port is
// ready before ready_o, which is when the chip has started (T_INIT after reset, and some 100 clocks).
// Refresh: one is due every RefreshClocks, by a counter that never waits, and goes before any word or block that was
// not accepted yet. It comes at most Late clocks after it is due: 61 clocks at 100 MHz, added up as if none overlapped.
// First are the command before it (T_RFC the longest), T_RAS or T_WR until the open row may be closed, T_RP and T_RCD.
// Then a block of 2 x BURST clocks (or CAS_LATENCY + 3 until the bus is free for a word), T_RAS and T_WR again, and
// T_RP. RefreshClocks is such that a row sees its next refresh within T_REF even so: 2^ROW_BITS x RefreshClocks + Late
// clocks.
// Pins: all outputs are flip-flops (those of cke and cs are constant); dq_oe_o says when dq_o is driven. READ_DELAY:
// clocks from the one in which a read stands on the pins to the one in which its first half stands at dq_i. It is
// CAS_LATENCY where the chip takes commands at the end of their clock, and one less where the chip's clock is inverted.
// Each register between outputs and pads, or between pads and dq_i, adds one.
// Latency: a block whose row is open brings its first word READ_DELAY + 4 clocks after it was accepted; another row
// costs T_RP + T_RCD more, and the rest of T_RAS or T_WR.
// Throughput: a word in two clocks, written or read, while they are in one row; a block after another in another row
// takes 2 x BURST + T_RP + T_RCD clocks. At 100 MHz, refresh counted in, 194 MB/s within rows and 166 MB/s
// with another row for each block (rtl_modules [sdram]).
// Cost: yosys synth_ecp5: 270 LUT4 and 12 carry cells, 200 flip-flops.
`default_nettype none
`include "kage_illegal.svh"

module sdram_controller #(
    parameter int CLOCK_HZ = 100_000_000,
    parameter int ROW_BITS = 13,
    parameter int COLUMN_BITS = 9,
    parameter int BANK_BITS = 2,
    parameter int BURST = 16,  // words of a block, a power of two, at least 2
    parameter int CAS_LATENCY = 3,
    parameter int READ_DELAY = CAS_LATENCY,
    // Nanoseconds, the longest of the speed grades -6 and -7 of these chips.
    parameter int T_INIT = 200_000,
    parameter int T_RCD = 21,
    parameter int T_RP = 21,
    parameter int T_RAS = 45,
    parameter int T_RAS_MAX = 100_000,
    parameter int T_RC = 66,
    parameter int T_RFC = 70,
    parameter int T_WR = 15,
    parameter int T_REF = 64_000_000,  // for all rows
    parameter int CLOCKS_MRD = 2,
    parameter int CLOCKS_WR = 2,  // at least, whatever T_WR says
    parameter int INIT_REFRESHES = 8,
    localparam int AddrBits = ROW_BITS + BANK_BITS + COLUMN_BITS - 1,
    localparam int BurstBits = $clog2(BURST)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    output logic ready_o,

    input  wire logic                wr_valid_i,
    output logic                     wr_ready_o,
    input  wire logic [AddrBits-1:0] wr_addr_i,
    input  wire logic [        31:0] wr_data_i,

    input  wire logic                          req_valid_i,
    output logic                               req_ready_o,
    input  wire logic [AddrBits-BurstBits-1:0] req_block_i,

    output logic        rd_valid_o,
    output logic [31:0] rd_data_o,

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
  // ---- nanoseconds to clocks, rounded up ----------------------------------------------------------------------------
  localparam logic [63:0] KiloHz = (64'(CLOCK_HZ) + 64'd999) / 64'd1000;
  localparam logic [63:0] Million = 64'd1_000_000;
  localparam logic [63:0] UpTo = Million - 64'd1;
  localparam int Init = 32'((64'(T_INIT) * KiloHz + UpTo) / Million);
  localparam int Rcd = 32'((64'(T_RCD) * KiloHz + UpTo) / Million);
  localparam int Rp = 32'((64'(T_RP) * KiloHz + UpTo) / Million);
  localparam int Rc = 32'((64'(T_RC) * KiloHz + UpTo) / Million);
  localparam int Rfc = 32'((64'(T_RFC) * KiloHz + UpTo) / Million);
  localparam int WrTime = 32'((64'(T_WR) * KiloHz + UpTo) / Million);
  localparam int Wr = WrTime < CLOCKS_WR ? CLOCKS_WR : WrTime;
  localparam int RasTime = 32'((64'(T_RAS) * KiloHz + UpTo) / Million);
  // Between two activates lies a precharge: RAS and RP together make RC.
  localparam int Ras = RasTime + Rp < Rc ? Rc - Rp : RasTime;
  localparam int RasMax = 32'(64'(T_RAS_MAX) * (64'(CLOCK_HZ) / 64'd1000) / Million);

  localparam int Longest = 2 * BURST < CAS_LATENCY + 3 ? CAS_LATENCY + 3 : 2 * BURST;
  localparam int Late = Rfc + Ras + Rp + Rcd + Longest + Ras + Wr + Rp + 1;
  localparam int AllRows = 32'(64'(T_REF) * (64'(CLOCK_HZ) / 64'd1000) / Million);
  localparam int RefreshClocks = (AllRows - Late) / 2 ** ROW_BITS;

  localparam int TimerMost = Init > RefreshClocks ? Init : RefreshClocks;
  localparam int TimerBits = $clog2(TimerMost + 1);
  localparam int WaitMost0 = Rfc > Rcd ? Rfc : Rcd;
  localparam int WaitMost1 = Rp > CLOCKS_MRD ? Rp : CLOCKS_MRD;
  localparam int WaitMost = WaitMost0 > WaitMost1 ? WaitMost0 : WaitMost1;
  localparam int WaitBits = $clog2(WaitMost + 2);
  localparam int CloseBits = $clog2((Ras > Wr ? Ras : Wr) + 2);
  localparam int TurnBits = $clog2(CAS_LATENCY + 3);
  localparam int CountBits = $clog2(INIT_REFRESHES + 1);
  localparam int WordBits = COLUMN_BITS - 1;  // of a word's place in its row
  localparam int Stages = READ_DELAY + 3;

  if (CLOCK_HZ < 1_000_000) begin : gen_bad_clock
    `KAGE_ILLEGAL("CLOCK_HZ must be at least 1 MHz")
  end
  if (BURST < 2 || BURST != 2 ** BurstBits || BurstBits > WordBits) begin : gen_bad_burst
    `KAGE_ILLEGAL("BURST must be a power of two, at least 2, and within a row")
  end
  if (CAS_LATENCY != 2 && CAS_LATENCY != 3) begin : gen_bad_latency
    `KAGE_ILLEGAL("CAS_LATENCY must be 2 or 3")
  end
  if (READ_DELAY < 1) begin : gen_bad_delay
    `KAGE_ILLEGAL("READ_DELAY must be at least 1")
  end
  if (ROW_BITS < 11 || COLUMN_BITS < 2 || COLUMN_BITS > 10 || BANK_BITS < 1) begin : gen_bad_size
    `KAGE_ILLEGAL("ROW_BITS must be at least 11, COLUMN_BITS 2 to 10, BANK_BITS at least 1")
  end
  if (T_INIT < 1 || T_RCD < 1 || T_RP < 1 || T_RAS < 1 || T_RC < 1 || T_RFC < 1 || Wr < 1 || CLOCKS_MRD < 1 ||
      INIT_REFRESHES < 1) begin : gen_bad_time
    `KAGE_ILLEGAL("times must be at least 1")
  end
  if (AllRows <= Late || RefreshClocks <= Late) begin : gen_bad_refresh
    `KAGE_ILLEGAL("T_REF leaves no time between refreshes")
  end
  if (RasMax < RefreshClocks + Late) begin : gen_bad_open
    `KAGE_ILLEGAL("T_RAS_MAX must be longer than the time between refreshes, which close the row")
  end

  // ---- what goes on -------------------------------------------------------------------------------------------------
  localparam logic [2:0] Pause = 3'd0;
  localparam logic [2:0] Close = 3'd1;
  localparam logic [2:0] Refreshes = 3'd2;
  localparam logic [2:0] Mode = 3'd3;
  localparam logic [2:0] Run = 3'd4;
  logic [2:0] phase_q;
  logic [TimerBits-1:0] timer_q;  // until the pause is over, or a refresh is due
  logic [CountBits-1:0] count_q;  // refreshes at the start
  logic due_q;

  // The word or block that is being done.
  logic held_q, write_q;
  logic [ROW_BITS-1:0] row_q;
  logic [BANK_BITS-1:0] bank_q;
  logic [WordBits-1:0] word_q;
  logic [31:0] data_q;
  logic accept, accept_write;

  logic open_q;
  logic [ROW_BITS-1:0] open_row_q;
  logic [BANK_BITS-1:0] open_bank_q;

  // Clocks until a command may follow; until the row may be closed; until the bus is free for a word to write.
  logic [WaitBits-1:0] wait_q;
  logic [CloseBits-1:0] close_q;
  logic [TurnBits-1:0] turn_q;

  logic running, may, hit, column, last, activate, close, refresh, set_mode;
  assign running = phase_q == Run;
  assign may = wait_q == '0;
  assign hit = open_q && open_row_q == row_q && open_bank_q == bank_q;
  assign column = running && held_q && hit && may && (!write_q || turn_q == '0);
  assign last = write_q || &word_q[BurstBits-1:0];
  assign activate = running && held_q && !open_q && may;
  assign close = may && close_q == '0 && (phase_q == Close || (running && open_q && (held_q ? !hit : due_q)));
  assign refresh = may && (phase_q == Refreshes || (running && !held_q && !open_q && due_q));
  assign set_mode = may && phase_q == Mode;

  // A column takes two clocks, so that the next word or block, accepted in the second, loses none.
  assign accept = running && !held_q && !due_q;
  assign accept_write = wr_valid_i && wr_ready_o;
  assign ready_o = running;
  assign wr_ready_o = accept && (!req_valid_i || !write_q);
  assign req_ready_o = accept && (!wr_valid_i || write_q);

  always_ff @(posedge clk_i) begin
    if (accept && (wr_valid_i || req_valid_i)) begin
      write_q <= accept_write;
      {row_q, bank_q, word_q} <= accept_write ? wr_addr_i : {req_block_i, BurstBits'(0)};
      data_q <= wr_data_i;
    end else if (column) begin
      word_q <= word_q + 1'b1;
    end
    if (activate) begin
      open_row_q  <= row_q;
      open_bank_q <= bank_q;
    end

    if (timer_q != '0) timer_q <= timer_q - 1'b1;
    else if (running) timer_q <= TimerBits'(RefreshClocks - 1);
    if (refresh) due_q <= 1'b0;
    if (running && timer_q == '0) due_q <= 1'b1;

    if (activate) wait_q <= WaitBits'(Rcd - 1);
    else if (column) wait_q <= WaitBits'(1);
    else if (close) wait_q <= WaitBits'(Rp - 1);
    else if (refresh) wait_q <= WaitBits'(Rfc - 1);
    else if (set_mode) wait_q <= WaitBits'(CLOCKS_MRD - 1);
    else if (!may) wait_q <= wait_q - 1'b1;

    if (activate) close_q <= CloseBits'(Ras - 1);
    else if (column && write_q && close_q <= CloseBits'(Wr)) close_q <= CloseBits'(Wr);
    else if (close_q != '0) close_q <= close_q - 1'b1;

    if (column && !write_q) turn_q <= TurnBits'(CAS_LATENCY + 2);
    else if (turn_q != '0) turn_q <= turn_q - 1'b1;

    if (accept) held_q <= accept_write || req_valid_i;
    else if (column && last) held_q <= 1'b0;
    if (activate) open_q <= 1'b1;
    else if (close) open_q <= 1'b0;

    case (phase_q)
      Pause:   if (timer_q == '0) phase_q <= Close;
      Close:   if (close) phase_q <= Refreshes;
      Refreshes:
      if (refresh) begin
        count_q <= count_q + 1'b1;
        if (count_q == CountBits'(INIT_REFRESHES - 1)) phase_q <= Mode;
      end
      Mode:
      if (set_mode) begin
        phase_q <= Run;
        timer_q <= TimerBits'(RefreshClocks - 1);
      end
      default: ;
    endcase

    if (!rst_ni) begin
      phase_q <= Pause;
      timer_q <= TimerBits'(Init);
      count_q <= '0;
      due_q   <= 1'b0;
      held_q  <= 1'b0;
      write_q <= 1'b0;
      open_q  <= 1'b0;
      wait_q  <= '0;
      close_q <= '0;
      turn_q  <= '0;
    end
  end

  // ---- commands, a clock later on the pins --------------------------------------------------------------------------
  logic [2:0] command_q;
  logic [BANK_BITS-1:0] ba_q;
  logic [ROW_BITS-1:0] a_q;
  logic [15:0] dq_q, second_q;
  logic oe_q, half_q, masked_q;
  always_ff @(posedge clk_i) begin
    // Row or column stand there while no command says otherwise: fewer choices.
    ba_q <= set_mode ? '0 : bank_q;
    a_q  <= row_q;
    if (held_q && open_q) a_q <= ROW_BITS'({word_q, 1'b0});
    if (close) a_q[10] <= 1'b1;
    // Bursts of two in sequence.
    if (set_mode) a_q <= ROW_BITS'({3'(CAS_LATENCY), 4'b0001});

    unique case (1'b1)
      activate: command_q <= 3'b011;
      column:   command_q <= write_q ? 3'b100 : 3'b101;
      close:    command_q <= 3'b010;
      refresh:  command_q <= 3'b001;
      set_mode: command_q <= 3'b000;
      default:  command_q <= 3'b111;
    endcase
    half_q   <= column && write_q;
    oe_q     <= (column && write_q) || half_q;
    dq_q     <= half_q ? second_q : data_q[15:0];
    second_q <= data_q[31:16];
    masked_q <= !running;
    if (!rst_ni) begin
      command_q <= 3'b111;
      half_q    <= 1'b0;
      oe_q      <= 1'b0;
      masked_q  <= 1'b1;
    end
  end
  assign sdram_cke_o = 1'b1;
  assign sdram_cs_no = 1'b0;
  assign {sdram_ras_no, sdram_cas_no, sdram_we_no} = command_q;
  assign sdram_ba_o = ba_q;
  assign sdram_a_o = a_q;
  assign sdram_dqm_o = {2{masked_q}};
  assign sdram_dq_o = dq_q;
  assign sdram_dq_oe_o = oe_q;

  // ---- words that come back -----------------------------------------------------------------------------------------
  logic [Stages-1:0] coming_q;
  logic [15:0] in_q, low_q;
  always_ff @(posedge clk_i) begin
    in_q     <= sdram_dq_i;
    low_q    <= in_q;
    coming_q <= rst_ni ? {coming_q[Stages-2:0], column && !write_q} : '0;
  end
  assign rd_valid_o = coming_q[Stages-1];
  assign rd_data_o  = {in_q, low_q};

endmodule

`default_nettype wire
