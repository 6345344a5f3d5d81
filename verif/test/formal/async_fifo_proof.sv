// SPDX-License-Identifier: Apache-2.0
// Proof of async_fifo, for any two clocks, any stalls of both sides and a reset of both sides at any time
// (verif/test/formal/run.sh):
//   order     words come out once and in order: word number N that leaves is word number N that came. mark_i, free,
//             chooses the word that is watched.
//   stays     valid stays until ready, and same: what goes with it, too.
//   silent    after an edge of the output's clock in reset nothing is valid.
//   arrival   from the moment that a word has come, the output idles for at most Idle edges of its clock until the word
//             has left: the word leaves as soon as those before it, and three to four clocks after it came.
//   capacity  with fewer than DEPTH words in it the FIFO refuses at most Refused edges of the input's clock in a row.
//
// How: by induction. A step of the solver is a moment in which each clock rises, falls or rests as it likes, so no
// ratio of clocks and no phase is left out (clk2fflogic). Module undecided_synchronizer lets each bit that crosses
// while it changes be taken as the old or the new one. Script run.sh connects inside_* to the pointers and the memory.
// The lemmas say that each side's copy of the other's pointer lies between the true one and its own.
//
// Why small widths say it for all: no bit of a word is looked at, all are copied alike. DEPTH is 4, 8 and 16: the least
// there is, and pointers whose Gray code turns more bits.
`default_nettype none
module async_fifo_proof #(
    parameter int BITS = 1,
    parameter int DEPTH = 4,
    localparam int PtrBits = $clog2(DEPTH) + 1,
    localparam int Idle = 4,
    localparam int Refused = 3
) (
    input wire logic            in_clk_i,
    input wire logic            in_rst_ni,
    input wire logic            in_valid_i,
    input wire logic [BITS-1:0] in_data_i,
    input wire logic            out_clk_i,
    input wire logic            out_rst_ni,
    input wire logic            out_ready_i,
    input wire logic            mark_i
);
  logic in_ready, out_valid;
  logic [BITS-1:0] out_data;
  async_fifo #(
      .BITS (BITS),
      .DEPTH(DEPTH)
  ) dut (
      .in_clk_i,
      .in_rst_ni,
      .in_valid_i,
      .in_ready_o (in_ready),
      .in_data_i,
      .out_clk_i,
      .out_rst_ni,
      .out_valid_o(out_valid),
      .out_ready_i,
      .out_data_o (out_data)
  );

  // ---- time: what an edge sees is what there was in the step before ------------------------------------------------
  (* gclk *)logic step;
  logic started_q = 1'b0;
  logic in_clk_q, in_rst_nq, in_valid_q, in_ready_q, out_clk_q, out_rst_nq, out_valid_q, out_ready_q, mark_q;
  logic [BITS-1:0] in_data_q, out_data_q;
  always_ff @(posedge step) begin
    started_q   <= 1'b1;
    in_clk_q    <= in_clk_i;
    in_rst_nq   <= in_rst_ni;
    in_valid_q  <= in_valid_i;
    in_ready_q  <= in_ready;
    in_data_q   <= in_data_i;
    out_clk_q   <= out_clk_i;
    out_rst_nq  <= out_rst_ni;
    out_valid_q <= out_valid;
    out_ready_q <= out_ready_i;
    out_data_q  <= out_data;
    mark_q      <= mark_i;
  end
  logic in_edge, out_edge, push, pop;
  assign in_edge  = started_q && in_clk_i && !in_clk_q;
  assign out_edge = started_q && out_clk_i && !out_clk_q;
  assign push     = in_edge && in_rst_nq && in_valid_q && in_ready_q;
  assign pop      = out_edge && out_rst_nq && out_valid_q && out_ready_q;

  // ---- surroundings: both sides are reset at once, until each has had an edge; then each leaves when it likes -------
  logic in_reset_q = 1'b0, out_reset_q = 1'b0;  // that edge has been
  logic in_reset, out_reset, both, falls;
  assign falls     = (in_rst_nq && !in_rst_ni) || (out_rst_nq && !out_rst_ni);
  assign both      = !in_rst_nq && !out_rst_nq;
  assign in_reset  = in_reset_q || (in_edge && both);
  assign out_reset = out_reset_q || (out_edge && both);
  always_ff @(posedge step) begin
    in_reset_q  <= in_reset && !falls && (!in_rst_ni || !out_rst_ni);
    out_reset_q <= out_reset && !falls && (!in_rst_ni || !out_rst_ni);
  end
  always_comb begin
    if (!started_q) assume (!in_rst_ni && !out_rst_ni);
    if (started_q) begin
      if (falls) assume (!in_rst_ni && !out_rst_ni);
      if ((!in_rst_nq && in_rst_ni) || (!out_rst_nq && out_rst_ni)) assume (in_reset_q && out_reset_q);
    end
  end
  logic runs;  // no reset that is not over for both sides, and none that an edge has not seen yet
  assign runs = !falls && (in_rst_ni || out_rst_ni || (in_reset_q && out_reset_q));

  // ---- words by their numbers, modulo 4 DEPTH: more than there can be inside ----------------------------------------
  logic [PtrBits:0] came_q, came, left_q, left;
  assign came = push ? came_q + 1'b1 : came_q;
  assign left = pop ? left_q + 1'b1 : left_q;
  always_ff @(posedge step) begin
    came_q <= runs ? came : '0;
    left_q <= runs ? left : '0;
  end

  logic marked_q = 1'b0, marked;
  logic [PtrBits:0] number_q, number;
  logic [BITS-1:0] word_q, word;
  logic [2:0] idle_q, idle, refused, refused_q = '0;
  logic [2:0] edges_q, edges;  // of the output's clock since the marked word came: 4 is as many or more
  logic marks, leaves;
  assign marks  = push && mark_q && !marked_q;
  assign leaves = pop && marked_q && left_q == number_q;
  assign marked = runs && ((marked_q && !leaves) || marks);
  assign number = marks ? came_q : number_q;
  assign word   = marks ? in_data_q : word_q;
  assign idle   = !marked_q ? '0 : out_edge && out_rst_nq && !out_valid_q ? idle_q + 1'b1 : idle_q;
  assign edges  = !marked_q ? '0 : out_edge && out_rst_nq && edges_q != 3'd4 ? edges_q + 1'b1 : edges_q;
  logic [PtrBits:0] inside_q;
  assign inside_q = came_q - left_q;
  assign refused  = !in_edge ? refused_q : in_ready_q || inside_q >= (PtrBits + 1)'(DEPTH) ? '0 : refused_q + 1'b1;
  always_ff @(posedge step) begin
    marked_q  <= marked;
    number_q  <= number;
    word_q    <= word;
    idle_q    <= idle;
    edges_q   <= edges;
    refused_q <= runs && in_rst_ni && out_rst_ni ? refused : '0;
  end

  always_comb begin
    if (runs && leaves) order : assert (out_data_q == word_q);
    if (runs && pop) nothing_more : assert (came_q != left_q);
    if (runs && marked_q) arrival : assert (idle <= Idle);
    capacity : assert (refused_q <= Refused);
    if (started_q && runs && out_rst_nq && out_rst_ni && out_valid_q && !pop) begin
      stays : assert (out_valid);
      same : assert (out_data == out_data_q);
    end
    if (out_edge && !out_rst_nq) silent : assert (!out_valid);
  end

  // ---- for induction ------------------------------------------------------------------------------------------------
  (* keep *) logic [DEPTH*BITS-1:0] inside_memory;
  (* keep *) logic [PtrBits-1:0] inside_wr, inside_rd, inside_wr_gray, inside_rd_gray;
  (* keep *) logic [PtrBits-1:0] inside_wr_meta, inside_wr_seen, inside_rd_meta, inside_rd_seen;
  function automatic logic [PtrBits-1:0] number_of(logic [PtrBits-1:0] gray);
    number_of = gray;
    for (int b = PtrBits - 2; b >= 0; b--) number_of[b] = number_of[b+1] ^ gray[b];
  endfunction
  logic [PtrBits+2:0] unseen_wr, late_wr, held, unseen_rd, late_rd, sum;
  always_comb begin
    unseen_wr = PtrBits'(inside_wr - number_of(inside_wr_meta));
    late_wr = PtrBits'(number_of(inside_wr_meta) - number_of(inside_wr_seen));
    held = PtrBits'(number_of(inside_wr_seen) - inside_rd);
    unseen_rd = PtrBits'(inside_rd - number_of(inside_rd_meta));
    late_rd = PtrBits'(number_of(inside_rd_meta) - number_of(inside_rd_seen));
    sum = unseen_wr + late_wr + held + unseen_rd + late_rd;
    if (!falls && in_rst_ni != out_rst_ni) lemma_both_reset : assert (in_reset_q && out_reset_q);
    if (in_reset_q && !falls && !in_rst_ni)
      lemma_in_reset : assert (inside_wr == '0 && inside_wr_gray == '0 && inside_rd_meta == '0 && inside_rd_seen == '0);
    if (out_reset_q && !falls && !out_rst_ni)
      lemma_out_reset :
      assert (inside_rd == '0 && inside_rd_gray == '0 && inside_wr_meta == '0 && inside_wr_seen == '0 && !out_valid);
    if (runs) begin
      lemma_gray : assert (number_of(inside_wr_gray) == inside_wr && number_of(inside_rd_gray) == inside_rd);
      lemma_order : assert (sum <= DEPTH);
      lemma_came : assert (inside_wr == PtrBits'(came));
      lemma_left : assert (PtrBits'(inside_rd - {{(PtrBits - 1) {1'b0}}, out_valid}) == PtrBits'(left));
      lemma_count : assert ((PtrBits + 1)'(came - left) == (PtrBits + 1)'(PtrBits'(inside_wr - inside_rd)) + out_valid);
      // A flip-flop that crosses may miss what has just changed at one edge, never at two.
      if (refused >= 3'd1) lemma_free : assert (unseen_wr + late_wr + held < DEPTH);
      if (refused >= 3'd2) lemma_free_seen : assert (unseen_wr + late_wr + held + unseen_rd < DEPTH);
      if (refused >= 3'd3) lemma_ready : assert (sum < DEPTH);
      if (marked) begin
        lemma_idle : assert (idle <= edges && edges <= 3'd4);
        if (edges >= 3'd2) lemma_on_its_way : assert ((PtrBits + 1)'(came - number) > unseen_wr);
        if (edges >= 3'd3) lemma_seen : assert ((PtrBits + 1)'(came - number) > unseen_wr + late_wr);
        if (edges >= 3'd4) lemma_there : assert (out_valid);
        lemma_number : assert ((PtrBits + 1)'(number - left) < (PtrBits + 1)'(came - left));
        if (number == left && out_valid) begin
          lemma_out : assert (out_data == word);
        end else begin
          lemma_memory : assert (inside_memory[number[PtrBits-2:0]*BITS+:BITS] == word);
        end
      end
    end
  end

  // ---- what the rules are about happens -----------------------------------------------------------------------------
  logic was_full_q = 1'b0, reset_again_q = 1'b0;
  always_ff @(posedge step) begin
    if (runs && (PtrBits + 1)'(came - left) == (PtrBits + 1)'(DEPTH + 1)) was_full_q <= 1'b1;
    if (was_full_q && both && runs) reset_again_q <= 1'b1;
  end
  always_comb begin
    full : cover (was_full_q);
    empty_again : cover (was_full_q && runs && came == left && left > DEPTH);
    through_again : cover (reset_again_q && pop);
  end

endmodule

`default_nettype wire
