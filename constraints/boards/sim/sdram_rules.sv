// SPDX-License-Identifier: Apache-2.0
// The rules by which an SDR SDRAM takes its commands (JEDEC's, with the numbers of the data sheet as parameters, in
// clocks): the one definition of them. A proof puts it on the pins of a controller (sdram_controller_proof); the
// behavioural chip (sdram_chip.sv beside it) has it inside, where a broken rule stops the simulation with its name, the
// time and the bank.
//
//   enabled     the chip's clock is never suspended: cke is high.
//   known       no burst stop, and no auto precharge (A10 low in reads and writes): neither is told of here.
//   pause       no command within INIT clocks after power-up.
//   start_up    then all banks are precharged, INIT_REFRESHES refreshes and the mode register follow, in this order,
//               before anything is activated. The mode register is set once.
//   mode        its value is one that the data sheet has: burst of 1, 2, 4 or 8 in sequence, CAS latency 2 or 3.
//   idle        activate, refresh and mode register only where the bank (all banks) is precharged.
//   active      read and write only of an active bank.
//   rcd         activate to read or write: RCD.                     rp    precharge to activate, refresh, mode: RP.
//   ras         activate to precharge: RAS.                         rc    activate to activate of the bank: RC.
//   rrd         activate to activate of any other bank: RRD.        rfc   refresh to the next command: RFC.
//   wr          last word written to precharge: WR.                 mrd   mode register to the next command: MRD.
//   ras_max     no row stays open longer than RAS_MAX.
//   whole       no read, write or precharge cuts a burst short. (A chip takes that; a controller has no reason for it.)
//   driven      words that are written are on the bus in their clocks, unmasked.
//   unmasked    dqm is low two clocks before each word that is read.
//   bus         nobody drives the bus while the chip does, nor in the clock after it.
//   refreshes   the n-th refresh after start-up comes at most n x REFI + SLACK clocks after it. A refresh that comes
//               early counts for its own interval only. So SLACK clocks are all that refreshes may be late by: with R
//               rows, R x REFI + SLACK within the chip's 64 ms loses nothing.
//
// Low rst_ni is power off: everything starts anew. active_o and row_o say which rows are open, for those who keep data.
`default_nettype none

`ifdef FORMAL
`define SDRAM_RULE(name, holds) name : assert (holds);
`else
// The simulator's message has the rule's name before this text.
`define SDRAM_RULE(name, holds) name : assert (holds) else $fatal(1, "SDRAM: broken at %0t, bank %0d", $time, ba_i);
`endif

module sdram_rules #(
    parameter int ROW_BITS = 13,
    parameter int BANK_BITS = 2,
    parameter int INIT = 20000,
    parameter int INIT_REFRESHES = 8,
    parameter int RCD = 3,
    parameter int RP = 3,
    parameter int RAS = 5,
    parameter int RAS_MAX = 10000,
    parameter int RC = 7,
    parameter int RRD = 2,
    parameter int RFC = 7,
    parameter int WR = 2,
    parameter int MRD = 2,
    parameter int REFI = 781,
    parameter int SLACK = 96,
    localparam int Banks = 2 ** BANK_BITS
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic                 cke_i,
    input wire logic                 cs_ni,
    input wire logic                 ras_ni,
    input wire logic                 cas_ni,
    input wire logic                 we_ni,
    input wire logic [BANK_BITS-1:0] ba_i,
    input wire logic [ ROW_BITS-1:0] a_i,
    input wire logic [          1:0] dqm_i,
    input wire logic                 dq_oe_i, // the controller drives the bus

    output logic [         Banks-1:0] active_o,
    output logic [Banks*ROW_BITS-1:0] row_o,
    output logic [               3:0] burst_o,    // as the mode register says: 1, 2, 4, 8
    output logic [               1:0] latency_o,
    output logic                      started_o   // the mode register was set
);
  // Clocks until a command is allowed that a former one forbids; they stand still at 0.
  localparam int LeftBits = 8;
  localparam int InitBits = $clog2(INIT + 2);
  localparam int MaxBits = $clog2(RAS_MAX + 2);
  localparam int DueBits = $clog2(REFI + SLACK + 2);

  logic command, activate, read, write, precharge, refresh, set_mode, stop;
  assign command   = !cs_ni && {ras_ni, cas_ni, we_ni} != 3'b111;
  assign activate  = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b011;
  assign read      = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b101;
  assign write     = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b100;
  assign precharge = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b010;
  assign refresh   = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b001;
  assign set_mode  = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b000;
  assign stop      = !cs_ni && {ras_ni, cas_ni, we_ni} == 3'b110;

  // ---- what the chip remembers -------------------------------------------------------------------------------------
  logic [Banks-1:0] active_q = '0;
  logic [Banks*ROW_BITS-1:0] row_q;
  logic [Banks*LeftBits-1:0] rcd_q = '0, rp_q = '0, ras_q = '0, rc_q = '0, wr_q = '0;
  logic [Banks*MaxBits-1:0] open_q = '0;  // clocks for which the row is open
  logic [LeftBits-1:0] rrd_q = '0, rfc_q = '0, mrd_q = '0;
  logic [InitBits-1:0] init_q = InitBits'(INIT);
  logic closed_q = 1'b0, started_q = 1'b0;  // all banks precharged for the first time; mode register set
  logic [3:0] refreshes_q = '0;
  logic [DueBits-1:0] due_q = '0;  // clocks since start-up less REFI for each refresh, at least 0
  logic [3:0]
      burst_q = 4'd1, columns_q = '0, beats_q = '0;  // columns of a burst that are to come; those that are written
  logic [1:0] latency_q = 2'd2;
  logic [11:0] drives_q = '0;  // bit i: the chip drives in i clocks
  logic drove_q = 1'b0;
  logic [3:0] masked_q = '0;  // dqm of the last clocks, newest lowest

  logic [11:0] drives;
  logic [3:0] mode_burst;
  always_comb begin
    case (burst_q)
      4'd1: drives = 12'h001;
      4'd2: drives = 12'h003;
      4'd4: drives = 12'h00F;
      default: drives = 12'h0FF;
    endcase
    drives = read ? drives_q | drives << latency_q : drives_q;
    case (a_i[2:0])
      3'd0: mode_burst = 4'd1;
      3'd1: mode_burst = 4'd2;
      3'd2: mode_burst = 4'd4;
      default: mode_burst = 4'd8;
    endcase
  end
  assign active_o  = active_q;
  assign row_o     = row_q;
  assign burst_o   = burst_q;
  assign latency_o = latency_q;
  assign started_o = started_q;

  logic [Banks-1:0] asked;  // the banks that the command is about
  always_comb begin
    for (int b = 0; b < Banks; b++) asked[b] = set_mode || refresh || (precharge && a_i[10]) || BANK_BITS'(b) == ba_i;
  end

  always_ff @(posedge clk_i) begin
    for (int b = 0; b < Banks; b++) begin
      if (rcd_q[b*LeftBits+:LeftBits] != '0) rcd_q[b*LeftBits+:LeftBits] <= rcd_q[b*LeftBits+:LeftBits] - 1'b1;
      if (rp_q[b*LeftBits+:LeftBits] != '0) rp_q[b*LeftBits+:LeftBits] <= rp_q[b*LeftBits+:LeftBits] - 1'b1;
      if (ras_q[b*LeftBits+:LeftBits] != '0) ras_q[b*LeftBits+:LeftBits] <= ras_q[b*LeftBits+:LeftBits] - 1'b1;
      if (rc_q[b*LeftBits+:LeftBits] != '0) rc_q[b*LeftBits+:LeftBits] <= rc_q[b*LeftBits+:LeftBits] - 1'b1;
      if (wr_q[b*LeftBits+:LeftBits] != '0) wr_q[b*LeftBits+:LeftBits] <= wr_q[b*LeftBits+:LeftBits] - 1'b1;
      if (!active_q[b]) open_q[b*MaxBits+:MaxBits] <= '0;
      else if (open_q[b*MaxBits+:MaxBits] <= MaxBits'(RAS_MAX))
        open_q[b*MaxBits+:MaxBits] <= open_q[b*MaxBits+:MaxBits] + 1'b1;
      if (asked[b] && activate) begin
        active_q[b] <= 1'b1;
        row_q[b*ROW_BITS+:ROW_BITS] <= a_i;
        rcd_q[b*LeftBits+:LeftBits] <= LeftBits'(RCD - 1);
        ras_q[b*LeftBits+:LeftBits] <= LeftBits'(RAS - 1);
        rc_q[b*LeftBits+:LeftBits] <= LeftBits'(RC - 1);
      end
      if (asked[b] && precharge) begin
        active_q[b] <= 1'b0;
        rp_q[b*LeftBits+:LeftBits] <= LeftBits'(RP - 1);
      end
      if (asked[b] && write) wr_q[b*LeftBits+:LeftBits] <= LeftBits'(burst_q) + LeftBits'(WR - 2);
    end
    if (activate) rrd_q <= LeftBits'(RRD - 1);
    else if (rrd_q != '0) rrd_q <= rrd_q - 1'b1;
    if (refresh) rfc_q <= LeftBits'(RFC - 1);
    else if (rfc_q != '0) rfc_q <= rfc_q - 1'b1;
    if (set_mode) mrd_q <= LeftBits'(MRD - 1);
    else if (mrd_q != '0) mrd_q <= mrd_q - 1'b1;
    if (init_q != '0) init_q <= init_q - 1'b1;
    if (precharge && a_i[10]) closed_q <= 1'b1;
    if (refresh && refreshes_q != 4'(INIT_REFRESHES)) refreshes_q <= refreshes_q + 1'b1;
    if (set_mode) begin
      started_q <= 1'b1;
      burst_q   <= mode_burst;
      latency_q <= a_i[5:4];
    end
    if (!started_q) due_q <= '0;
    else if (refresh) due_q <= due_q >= DueBits'(REFI) ? due_q - DueBits'(REFI - 1) : DueBits'(1);
    else if (due_q <= DueBits'(REFI + SLACK)) due_q <= due_q + 1'b1;
    if (read || write) columns_q <= burst_q - 1'b1;
    else if (columns_q != '0) columns_q <= columns_q - 1'b1;
    if (write) beats_q <= burst_q - 1'b1;
    else if (beats_q != '0) beats_q <= beats_q - 1'b1;
    drives_q <= drives >> 1;
    drove_q  <= drives[0];
    masked_q <= {masked_q[1:0], dqm_i};
    if (!rst_ni) begin
      active_q <= '0;
      {rcd_q, rp_q, ras_q, rc_q, wr_q} <= '0;
      {rrd_q, rfc_q, mrd_q} <= '0;
      open_q <= '0;
      init_q <= InitBits'(INIT);
      closed_q <= 1'b0;
      started_q <= 1'b0;
      refreshes_q <= '0;
      due_q <= '0;
      burst_q <= 4'd1;
      latency_q <= 2'd2;
      columns_q <= '0;
      beats_q <= '0;
      drives_q <= '0;
      drove_q <= 1'b0;
      masked_q <= '0;
    end
  end

  // ---- the rules ---------------------------------------------------------------------------------------------------
  logic [Banks-1:0] rcd_over, rp_over, ras_over, rc_over, wr_over, open_long;
  always_comb begin
    for (int b = 0; b < Banks; b++) begin
      rcd_over[b]  = rcd_q[b*LeftBits+:LeftBits] == '0;
      rp_over[b]   = rp_q[b*LeftBits+:LeftBits] == '0;
      ras_over[b]  = ras_q[b*LeftBits+:LeftBits] == '0;
      rc_over[b]   = rc_q[b*LeftBits+:LeftBits] == '0;
      wr_over[b]   = wr_q[b*LeftBits+:LeftBits] == '0;
      open_long[b] = active_q[b] && open_q[b*MaxBits+:MaxBits] > MaxBits'(RAS_MAX);
    end
  end
  // A controller that is reset while the chip keeps its supply sets the mode once more.
  logic starts_well;
  always_comb begin
    starts_well = !refresh || closed_q;
    if (set_mode && refreshes_q != 4'(INIT_REFRESHES)) starts_well = 1'b0;
    if ((activate || read || write) && !started_q) starts_well = 1'b0;
  end
  // A rule is looked at where the chip takes its pins, at the clock's edge: between edges they may be anything.
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      `SDRAM_RULE(enabled, cke_i)
      `SDRAM_RULE(known, !stop && !((read || write) && a_i[10]))
      `SDRAM_RULE(pause, !command || init_q == '0)
      `SDRAM_RULE(start_up, starts_well)
      `SDRAM_RULE(mode, !set_mode || (ba_i == '0 && a_i[ROW_BITS-1:7] == '0 && a_i[6:5] == 2'b01 && a_i[3:2] == '0))
      `SDRAM_RULE(idle, !(activate || refresh || set_mode) || (asked & active_q) == '0)
      `SDRAM_RULE(active, !(read || write) || (asked & ~active_q) == '0)
      `SDRAM_RULE(rcd, !(read || write) || (asked & ~rcd_over) == '0)
      `SDRAM_RULE(rp, !(activate || refresh || set_mode) || (asked & ~rp_over) == '0)
      `SDRAM_RULE(ras, !precharge || (asked & ~ras_over) == '0)
      `SDRAM_RULE(rc, !(activate || refresh) || (asked & ~rc_over) == '0)
      `SDRAM_RULE(rrd, !activate || rrd_q == '0)
      `SDRAM_RULE(rfc, !command || rfc_q == '0)
      `SDRAM_RULE(wr, !precharge || (asked & ~wr_over) == '0)
      `SDRAM_RULE(mrd, !command || mrd_q == '0)
      `SDRAM_RULE(ras_max, open_long == '0)
      `SDRAM_RULE(whole, !(read || write || precharge) || columns_q == '0)
      `SDRAM_RULE(driven, !(write || beats_q != '0) || (dq_oe_i && dqm_i == '0))
      `SDRAM_RULE(unmasked, !drives_q[0] || masked_q[3:2] == '0)
      `SDRAM_RULE(bus, !dq_oe_i || !(drives_q[0] || drove_q))
      `SDRAM_RULE(refreshes, due_q <= DueBits'(REFI + SLACK))
    end
  end

endmodule

`default_nettype wire
