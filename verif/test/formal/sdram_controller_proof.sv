// SPDX-License-Identifier: Apache-2.0
// Proof of sdram_controller, for any words and blocks at any time and a reset at any time (verif/test/formal/run.sh):
//   1. the chip's rules (sdram_rules), all of them, for ever: start, distances, banks and rows, bus, refreshes on time;
//   2. every block brings as many words as it has, and no word comes unasked; what was accepted, or a refresh that is
//      due, is nearer to its end in every clock, and of two ports that wait none goes twice in a row;
//   3. a word read is the one that was last written there before the block was accepted.
//
// How: by induction. run.sh connects inside_* to the registers of the controller and of the rules. The rules see a
// command a clock after it was decided, so the lemmas compare what the rules count now with what the controller counted
// a clock ago: that is never less. A refresh is on time because a sum is bounded: the clocks it is late by now, and
// those until it comes in the worst case (to_go), which each clock lessens. Property 3 is carried from register to
// register: accepted, decided, on the pins, in the chip, on its way back.
// The chip is one word, at an address that is any (marked); what the other words read as is free.
//
// Why small values say it for all: the controller counts down to 0 from the numbers and compares with nothing else, and
// the lemmas are about what is left. Here each number is 2 or more, large enough to hold a command back. A block (2
// words), a row (4 words), the banks (2) and INIT_REFRESHES (2) are the least that have a next one. Bits of rows and of
// words are all treated alike; rows have 11 bits as A10 has a meaning.
`default_nettype none

module sdram_controller_proof #(
    parameter int CAS_LATENCY = 2,
    parameter int QUIET = 0,  // for defects: 1: words of two rows and banks are written all the time; 2: of one
    localparam int RowBits = 11,
    localparam int ColumnBits = 3,
    localparam int BankBits = 1,
    localparam int Burst = 2,
    localparam int AddrBits = RowBits + BankBits + ColumnBits - 1,
    localparam int Init = 3,
    localparam int InitRefreshes = 2,
    localparam int Rcd = 3,
    localparam int Rp = 2,
    localparam int Ras = 10,
    localparam int Rc = 13,
    localparam int Rrd = 4,
    localparam int Rfc = 4,
    localparam int Wr = 3,
    localparam int Mrd = 4,
    localparam int CloseRas = Rc - Rp,  // the controller's own: RC by RAS and RP
    localparam int Longest = 2 * Burst < CAS_LATENCY + 3 ? CAS_LATENCY + 3 : 2 * Burst,
    localparam int Late = Rfc + CloseRas + Rp + Rcd + Longest + CloseRas + Wr + Rp + 1,
    localparam int Refi = Late + 2,
    localparam int RasMax = Refi + Late,
    localparam int Stages = CAS_LATENCY + 3
) (
    input wire logic                clk_i,
    input wire logic                rst_ni,
    input wire logic                wr_valid_i,
    input wire logic [AddrBits-1:0] wr_addr_i,
    input wire logic [        31:0] wr_data_i,
    input wire logic                req_valid_i,
    input wire logic [AddrBits-2:0] req_block_i,
    input wire logic [        15:0] dq_i,
    input wire logic                mark_i
);
  logic ready, wr_ready, req_ready, rd_valid;
  logic [31:0] rd_data;
  logic cke, cs_n, ras_n, cas_n, we_n, oe;
  logic [BankBits-1:0] ba;
  logic [RowBits-1:0] a;
  logic [1:0] dqm;
  logic [15:0] dq;
  // A clock of 1 us makes nanoseconds to clocks.
  sdram_controller #(
      .CLOCK_HZ(1_000_000),
      .ROW_BITS(RowBits),
      .COLUMN_BITS(ColumnBits),
      .BANK_BITS(BankBits),
      .BURST(Burst),
      .CAS_LATENCY(CAS_LATENCY),
      .T_INIT(Init * 1000),
      .T_RCD(Rcd * 1000),
      .T_RP(Rp * 1000 - 999),
      .T_RAS(Ras * 1000),
      .T_RAS_MAX(RasMax * 1000),
      .T_RC(Rc * 1000),
      .T_RFC(Rfc * 1000),
      .T_WR(Wr * 1000),
      .T_REF((2 ** RowBits * Refi + Late) * 1000),
      .CLOCKS_MRD(Mrd),
      .INIT_REFRESHES(InitRefreshes)
  ) dut (
      .clk_i,
      .rst_ni,
      .ready_o(ready),
      .wr_valid_i,
      .wr_ready_o(wr_ready),
      .wr_addr_i,
      .wr_data_i,
      .req_valid_i,
      .req_ready_o(req_ready),
      .req_block_i,
      .rd_valid_o(rd_valid),
      .rd_data_o(rd_data),
      .sdram_cke_o(cke),
      .sdram_cs_no(cs_n),
      .sdram_ras_no(ras_n),
      .sdram_cas_no(cas_n),
      .sdram_we_no(we_n),
      .sdram_ba_o(ba),
      .sdram_a_o(a),
      .sdram_dqm_o(dqm),
      .sdram_dq_o(dq),
      .sdram_dq_oe_o(oe),
      .sdram_dq_i(dq_i)
  );

  logic [1:0] active;
  logic [2*RowBits-1:0] rows;
  logic [3:0] burst;
  logic [1:0] latency;
  logic started;
  sdram_rules #(
      .ROW_BITS(RowBits),
      .BANK_BITS(BankBits),
      .INIT(Init),
      .INIT_REFRESHES(InitRefreshes),
      .RCD(Rcd),
      .RP(Rp),
      .RAS(Ras),
      .RAS_MAX(RasMax),
      .RC(Rc),
      .RRD(Rrd),
      .RFC(Rfc),
      .WR(Wr),
      .MRD(Mrd),
      .REFI(Refi),
      .SLACK(Late)
  ) rules (
      .clk_i,
      .rst_ni,
      .cke_i(cke),
      .cs_ni(cs_n),
      .ras_ni(ras_n),
      .cas_ni(cas_n),
      .we_ni(we_n),
      .ba_i(ba),
      .a_i(a),
      .dqm_i(dqm),
      .dq_oe_i(oe),
      .active_o(active),
      .row_o(rows),
      .burst_o(burst),
      .latency_o(latency),
      .started_o(started)
  );

  // ---- surroundings: reset at the start, and whenever it pleases ---------------------------------------------------
  logic begun_q = 1'b0;
  always_ff @(posedge clk_i) begin
    begun_q <= 1'b1;
  end
  always_comb begin
    if (!begun_q) assume (!rst_ni);
    if (QUIET != 0) assume (wr_valid_i && !req_valid_i && wr_data_i == '0 && wr_addr_i[ColumnBits-2:0] == '0);
    if (QUIET != 0) assume (wr_addr_i[AddrBits-2:ColumnBits] == '0);
    if (QUIET == 2) assume (wr_addr_i == '0);
    if (QUIET != 0 && begun_q) assume (rst_ni);
  end
  // An offer stays.
  logic wr_waits_q = 1'b0, req_waits_q = 1'b0;
  logic [AddrBits-1:0] wr_addr_q;
  logic [AddrBits-2:0] req_block_q;
  logic [31:0] wr_data_q;
  always_ff @(posedge clk_i) begin
    wr_waits_q  <= rst_ni && wr_valid_i && !wr_ready;
    req_waits_q <= rst_ni && req_valid_i && !req_ready;
    wr_addr_q   <= wr_addr_i;
    wr_data_q   <= wr_data_i;
    req_block_q <= req_block_i;
  end
  always_comb begin
    if (wr_waits_q) assume (wr_valid_i && wr_addr_i == wr_addr_q && wr_data_i == wr_data_q);
    if (req_waits_q) assume (req_valid_i && req_block_i == req_block_q);
  end

  // ---- words asked for ----------------------------------------------------------------------------------------------
  logic wr_take, req_take;
  logic [4:0] asked_q = '0;
  assign wr_take  = wr_valid_i && wr_ready;
  assign req_take = req_valid_i && req_ready;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) asked_q <= '0;
    else asked_q <= asked_q + (req_take ? 5'(Burst) : 5'd0) - 5'(rd_valid);
  end
  always_comb begin
    if (rst_ni) begin
      before_start : assert (ready || !(wr_ready || req_ready));
      ready_started : assert (!ready || started || {ras_n, cas_n, we_n} == 3'b000);
      one_at_a_time : assert (!(wr_take && req_take));
      unasked : assert (!rd_valid || asked_q != '0);
    end
  end

  // ---- inside, for induction ----------------------------------------------------------------------------------------
  (* keep *)logic [2:0] inside_phase;
  (* keep *)logic [5:0] inside_timer;
  (* keep *)logic [1:0] inside_count;
  (* keep *) logic inside_due, inside_held, inside_write, inside_open, inside_half;
  (* keep *) logic [RowBits-1:0] inside_row, inside_open_row;
  (* keep *) logic [BankBits-1:0] inside_bank, inside_open_bank;
  (* keep *) logic [1:0] inside_word;
  (* keep *) logic [2:0] inside_wait, inside_turn;
  (* keep *) logic [3:0] inside_close;
  (* keep *) logic [Stages-1:0] inside_coming;
  (* keep *) logic [31:0] inside_data;
  (* keep *) logic [15:0] inside_second, inside_in, inside_low;

  (* keep *) logic [15:0] rule_rcd, rule_rp, rule_ras, rule_rc, rule_wr;
  (* keep *) logic [2*7-1:0] rule_open;
  (* keep *) logic [7:0] rule_rrd, rule_rfc, rule_mrd;
  (* keep *) logic [2:0] rule_init;
  (* keep *) logic rule_closed, rule_drove;
  (* keep *) logic [3:0] rule_refreshes, rule_columns, rule_beats, rule_masked;
  (* keep *)logic [ 6:0] rule_due;
  (* keep *)logic [11:0] rule_drives;

  localparam logic [2:0] Pause = 3'd0;
  localparam logic [2:0] Close = 3'd1;
  localparam logic [2:0] Refreshes = 3'd2;
  localparam logic [2:0] Mode = 3'd3;
  localparam logic [2:0] Run = 3'd4;

  // The controller a clock ago; at reset nothing is said.
  logic was_q = 1'b0;
  logic [2:0] phase_q, wait_q, turn_q;
  logic [3:0] close_q;
  logic [5:0] timer_q;
  logic [1:0] count_q;
  logic due_q, open_q, half_q;
  logic [ RowBits-1:0] open_row_q;
  logic [BankBits-1:0] open_bank_q;
  always_ff @(posedge clk_i) begin
    was_q <= rst_ni;
    phase_q <= inside_phase;
    wait_q <= inside_wait;
    close_q <= inside_close;
    turn_q <= inside_turn;
    timer_q <= inside_timer;
    count_q <= inside_count;
    due_q <= inside_due;
    open_q <= inside_open;
    half_q <= inside_half;
    open_row_q <= inside_open_row;
    open_bank_q <= inside_open_bank;
  end

  logic lemma_ok;
  logic [1:0] open_bank;
  always_comb begin
    open_bank = open_q ? 2'b01 << open_bank_q : 2'b00;
    lemma_ok  = 1'b1;
    for (int b = 0; b < 2; b++) begin
      if (rule_rcd[b*8+:8] > 8'(wait_q)) lemma_ok = 1'b0;
      if (rule_rp[b*8+:8] > 8'(wait_q)) lemma_ok = 1'b0;
      if (rule_ras[b*8+:8] > (open_bank[b] ? 8'(close_q) : 8'd0)) lemma_ok = 1'b0;
      if (rule_wr[b*8+:8] > (open_bank[b] ? 8'(close_q) : 8'd0)) lemma_ok = 1'b0;
      if (rule_rc[b*8+:8] > (open_bank[b] ? 8'(close_q) + 8'(Rp) : 8'(wait_q))) lemma_ok = 1'b0;
      if (active[b] && rows[b*RowBits+:RowBits] != open_row_q) lemma_ok = 1'b0;
      if (active[b] && (rule_open[b*7+:7] > rule_due)) lemma_ok = 1'b0;
    end
    if (rst_ni && was_q) begin
      lemma_banks : assert (lemma_ok);
      lemma_active : assert (active == open_bank);
      lemma_rrd : assert (rule_rrd <= (open_q ? 8'(close_q) : 8'd0));
      lemma_rfc : assert (rule_rfc <= 8'(wait_q) && rule_mrd <= 8'(wait_q) && rule_columns <= 4'(wait_q));
      lemma_beats : assert (rule_beats == 4'(half_q));
      lemma_burst : assert (!half_q || (turn_q == '0 && wait_q != '0));
      lemma_phase :
      assert (phase_q <= Run && (phase_q == Run || !(open_q || due_q || half_q || turn_q != '0 || close_q != '0)));
      lemma_pause : assert (phase_q == Pause ? rule_init <= timer_q[2:0] && timer_q <= 6'(Init) : rule_init == '0);
      lemma_started : assert (started == (phase_q == Run) && rule_closed == (phase_q > Close));
      lemma_count :
      assert (rule_refreshes == (phase_q < Refreshes ? 4'd0 : phase_q == Refreshes ? 4'(count_q) : 4'(InitRefreshes)));
      lemma_counted :
      assert (phase_q > Refreshes || count_q < 2'(InitRefreshes) && (phase_q == Refreshes || count_q == '0));
      lemma_mode : assert (!started || (burst == 4'd2 && latency == 2'(CAS_LATENCY)));
      lemma_masks : assert (phase_q == Run ? dqm == '0 : dqm == '1);
      lemma_masked : assert (rule_drives == '0 || rule_masked[1:0] == '0);
      lemma_masked_2 : assert (rule_drives[CAS_LATENCY-2:0] == '0 || rule_masked == '0);
      lemma_due : assert (phase_q != Run || 7'(timer_q) < 7'(Refi));
      lemma_due_1 : assert (phase_q != Run || due_q || 8'(rule_due) + 8'(timer_q) <= 8'(Refi - 1));
      lemma_due_2 : assert (phase_q != Run || !due_q || 8'(rule_due) + 8'(timer_q) <= 8'(2 * Refi - 1));
    end
  end
  logic turns;
  always_comb begin
    turns = !rule_drove || turn_q != '0;
    for (int i = 0; i < 12; i++) if (rule_drives[i] && 4'(i + 2) > 4'(turn_q)) turns = 1'b0;
    if (rst_ni && was_q) lemma_turn : assert (turns);
  end

  // Clocks until the refresh is decided, at most.
  logic [7:0] to_go, columns, closed_go;
  logic inside_hit;
  assign inside_hit = inside_open && inside_open_row == inside_row && inside_open_bank == inside_bank;
  always_comb begin
    columns   = inside_write ? 8'd1 + 8'(inside_turn) : inside_word[0] ? 8'd2 : 8'd4;
    closed_go = 8'(Rcd) + columns + 8'(CloseRas) + 8'(Wr + 2 + Rp);
    if (!inside_held) to_go = 8'(inside_wait) + (inside_open ? 8'(inside_close) + 8'(Rp) : 8'd0);
    else if (!inside_open) to_go = 8'(inside_wait) + closed_go;
    else if (inside_hit) to_go = 8'(inside_wait) + columns + 8'(inside_close) + 8'(Wr + 2 + Rp);
    else to_go = 8'(inside_wait) + 8'(inside_close) + 8'(Rp) + closed_go;
    if (rst_ni && was_q) begin
      lemma_late : assert (!inside_due || to_go + 8'(Refi - 1) - 8'(inside_timer) <= 8'(Late - 1));
      lemma_to_go : assert (to_go <= 8'(Late - 1));
      lemma_run : assert (inside_phase == Run || !inside_held);
      lemma_counters :
      assert (inside_close < 4'(CloseRas) && inside_turn <= 3'(CAS_LATENCY + 2) && inside_wait < 3'(Rfc) &&
                               (!inside_held || inside_wait < 3'(Rfc)));
    end
  end

  // Words asked for are those that the block that is held has left, and those on their way.
  logic [4:0] outstanding;
  always_comb begin
    outstanding = !inside_held || inside_write ? 5'd0 : 5'(Burst) - 5'(inside_word[0]);
    for (int i = 0; i < Stages; i++) outstanding = outstanding + 5'(inside_coming[i]);
    if (rst_ni && was_q) none_lost : assert (asked_q == outstanding);
  end

  // Nothing waits for long: what is held, or a refresh that is due, is nearer in each clock; and what waits meanwhile
  // comes before another of the kind that was last.
  logic [7:0] to_go_q;
  logic held_q = 1'b0, due_now_q = 1'b0, wrote_last_q;
  always_ff @(posedge clk_i) begin
    to_go_q   <= to_go;
    held_q    <= rst_ni && inside_held;
    due_now_q <= rst_ni && inside_due && !inside_held;
    if (!rst_ni) wrote_last_q <= 1'b0;
    else if (wr_take || req_take) wrote_last_q <= wr_take;
  end
  always_comb begin
    if (rst_ni && was_q) begin
      progress : assert (!((held_q && inside_held) || (due_now_q && inside_due)) || to_go < to_go_q);
      answered : assert (!ready || inside_held || inside_due || !(wr_valid_i || req_valid_i) || wr_take || req_take);
      fair : assert (!(wr_take && req_waits_q && wrote_last_q) && !(req_take && wr_waits_q && !wrote_last_q));
      lemma_kind : assert (inside_write == wrote_last_q);
    end
  end

  // ---- a marked word -----------------------------------------------------------------------------------------------
  (* anyconst *) logic [AddrBits-1:0] marked;
  logic known_q = 1'b0, followed_q = 1'b0;
  logic [31:0] value_q, store_q, expected_q;  // as last written by the user; as the chip has it; as it must come
  logic [4:0] ahead_q;  // words before it
  logic second_q = 1'b0;  // the second half is written
  logic [CAS_LATENCY:0] reads_q = '0;  // the chip brings the first half in so many clocks
  logic there, mark;
  assign there = active[ba] && rows[ba*RowBits+:RowBits] == marked[AddrBits-1:ColumnBits-1+BankBits] &&
      ba == marked[ColumnBits-1+:BankBits] && a[ColumnBits-1:0] == {marked[ColumnBits-2:0], 1'b0};
  assign mark = req_take && req_block_i == marked[AddrBits-1:1] && known_q && !followed_q && mark_i;
  always_ff @(posedge clk_i) begin
    second_q <= rst_ni && there && {ras_n, cas_n, we_n} == 3'b100;
    if (there && {ras_n, cas_n, we_n} == 3'b100) store_q[15:0] <= dq;
    if (second_q) store_q[31:16] <= dq;
    reads_q <= rst_ni ? {reads_q[CAS_LATENCY-1:0], there && {ras_n, cas_n, we_n} == 3'b101} : '0;
    if (wr_take && wr_addr_i == marked) value_q <= wr_data_i;
    if (!rst_ni) begin
      known_q    <= 1'b0;
      followed_q <= 1'b0;
    end else begin
      if (wr_take && wr_addr_i == marked) known_q <= 1'b1;
      if (mark) begin
        followed_q <= 1'b1;
        ahead_q    <= asked_q - 5'(rd_valid) + 5'(marked[0]);
        expected_q <= value_q;
      end else if (followed_q && rd_valid) begin
        ahead_q <= ahead_q - 1'b1;
        if (ahead_q == '0) followed_q <= 1'b0;
      end
    end
  end
  always_comb begin
    if (reads_q[CAS_LATENCY-1]) assume (dq_i == store_q[15:0]);
    if (reads_q[CAS_LATENCY]) assume (dq_i == store_q[31:16]);
    if (rst_ni) data : assert (!(followed_q && rd_valid && ahead_q == '0) || rd_data == expected_q);
  end
  // For induction: where the word is that was written last, and where the one that is followed.
  logic holds, way_ok;
  logic [Stages-1:0]
      with_ahead, right;  // as many words before it as the followed one has; what it should be like there
  logic [Stages-1:0] reading;
  assign reading = {1'b0, reads_q, there && {ras_n, cas_n, we_n} == 3'b101};
  logic [4:0] coming;
  assign holds = inside_held && {inside_row, inside_bank} == marked[AddrBits-1:ColumnBits-1];
  for (genvar i = 0; i < Stages; i++) begin : gen_stage
    logic [4:0] later;
    always_comb begin
      later = '0;
      for (int j = i + 1; j < Stages; j++) later = later + 5'(inside_coming[j]);
    end
    assign with_ahead[i] = later == ahead_q;
    assign right[i] = (i > CAS_LATENCY + 1 || reading[i]) &&
        (i > CAS_LATENCY || store_q[15:0] == expected_q[15:0]) &&
        (i > CAS_LATENCY + 1 || store_q[31:16] == expected_q[31:16]) &&
        (i != CAS_LATENCY + 1 || inside_in == expected_q[15:0]) &&
        (i != CAS_LATENCY + 2 || {inside_in, inside_low} == expected_q);
  end
  // Nothing is written while a word is on its way from the chip.
  logic turns_right;
  always_comb begin
    turns_right = !inside_half || (inside_turn == '0 && inside_wait != '0 && {ras_n, cas_n, we_n} == 3'b100);
    for (int i = 0; i < Stages; i++)
    if (inside_coming[i] && 4'(inside_turn) < 4'(CAS_LATENCY + 2 - i)) turns_right = 1'b0;
  end
  always_comb begin
    coming = '0;
    for (int i = 0; i < Stages; i++) coming = coming + 5'(inside_coming[i]);
    if (rst_ni && was_q) begin
      if (known_q) begin
        if (holds && inside_write && inside_word == marked[1:0])
          lemma_held :
          assert (inside_data == value_q);
          else if (there && {ras_n, cas_n, we_n} == 3'b100)
            lemma_pins :
            assert ({inside_second, dq} == value_q);
            else if (second_q)
              lemma_half :
              assert ({dq, store_q[15:0]} == value_q);
              else lemma_store : assert (store_q == value_q);
      end
      lemma_second : assert (!second_q || half_q);
      lemma_no_write : assert (turns_right);
    end
    // A word that is followed: still to be read, or at one place on its way (stage), with as many before it.
    way_ok = ahead_q >= coming || (inside_coming & with_ahead & right) != '0;
    if (rst_ni && was_q && followed_q) begin
      lemma_way : assert (way_ok);
      lemma_ahead : assert (ahead_q < asked_q && known_q);
      if (ahead_q >= coming) begin
        lemma_asked_for :
        assert (holds && !inside_write && inside_word[1] == marked[1] && expected_q == value_q &&
                5'(marked[0]) == 5'(inside_word[0]) + ahead_q - coming);
      end
    end
  end

  // ---- what the rules are about happens -----------------------------------------------------------------------------
  logic [2:0] cmd, cmd_q;
  assign cmd = {ras_n, cas_n, we_n};
  logic read_q = 1'b0, wrote_q = 1'b0, refreshed_q = 1'b0, done_q = 1'b0;
  always_ff @(posedge clk_i) begin
    if (cmd != 3'b111) cmd_q <= cmd;
    if (!rst_ni) begin
      {read_q, wrote_q, refreshed_q, done_q} <= '0;
    end else begin
      if (cmd == 3'b101) read_q <= 1'b1;
      if (cmd == 3'b100) wrote_q <= 1'b1;
      if (cmd == 3'b001 && started && (read_q || wrote_q)) refreshed_q <= 1'b1;
      if (rd_valid) done_q <= 1'b1;
    end
  end
  always_comb begin
    if (rst_ni) begin
      activates : cover (cmd == 3'b011);
      row_stays_open : cover (cmd == 3'b100 && cmd_q == 3'b100);
    end
  end
  if (QUIET == 2) begin : gen_quiet
    always_comb begin
      if (rst_ni) begin
        refresh_between : cover (refreshed_q && cmd == 3'b100);
        refresh_waits : cover (inside_due && inside_held);
      end
    end
  end else if (QUIET == 0) begin : gen_traffic
    always_comb begin
      if (rst_ni) begin
        both_wait : cover (wr_valid_i && req_valid_i && !wr_ready && !req_ready && ready);
        read_then_write : cover (cmd == 3'b100 && cmd_q == 3'b101);
        write_then_read : cover (cmd == 3'b101 && cmd_q == 3'b100);
        read_comes : cover (done_q && asked_q == '0);
        other_row : cover (cmd == 3'b011 && wrote_q);
      end
    end
  end
endmodule

`default_nettype wire
