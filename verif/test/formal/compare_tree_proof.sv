// SPDX-License-Identifier: Apache-2.0
// Proof of compare_tree, for any stalls of any input and of the output (verif/test/formal/run.sh):
//   1. an output is, data and last, the least of the units' oldest pixels that have not been output, the lowest unit's
//      on equal keys;
//   2. every unit's pixels come to an output once, in order: an output uses up one pixel of each unit, and never more
//      are inside than the tree has registers on their way: one a level, two more where a skid_buffer is behind it;
//   3. an output that waits stays as it is;
//   4. nothing gets stuck: with all inputs valid and the output ready, as many clocks as the latency fill the tree.
//
// How: a queue per unit, beside the tree, holds the pixels that went in and have not come out. Its oldest pixels must
// be what the output says. For induction the same is demanded of each node inside: a node that holds a pixel holds the
// least of its units' pixels at the place that the nodes above it leave. Script run.sh connects the inside_* wires to
// the tree's own. Assertions without a label are lemmas of the induction.
//
// Why small widths say it for all: the tree looks at data in one place only, the `<` of a cell, and that at keys only;
// all else is copied. Its work depends on how the keys of the UNITS pixels that meet are ordered, ties included, and
// UNITS <= 5 different keys make all such orders; here are 2^KEY_BITS = 8. A payload that is free in each pixel shows
// that data are copied whole.
`default_nettype none

module compare_tree_proof #(
    parameter int UNITS = 4,
    parameter int KEY_BITS = 3,
    parameter int DATA_BITS = 5,
    localparam int Levels = $clog2(UNITS),
    localparam int Nodes = 2 * UNITS + Levels  // at least as many as the tree has
) (
    input wire logic                       clk_i,
    input wire logic                       rst_ni,
    input wire logic [          UNITS-1:0] in_valid_i,
    input wire logic [UNITS*DATA_BITS-1:0] in_data_i,
    input wire logic [          UNITS-1:0] in_last_i,
    input wire logic                       out_ready_i
);
  localparam int Word = DATA_BITS + 1;  // {data, last}
  localparam int Buffers = (Levels - 1) / 2;  // on a pixel's way
  localparam int Latency = Levels + Buffers;
  localparam int Most = Levels + 2 * Buffers;  // pixels of a unit that are inside
  localparam int Places = Most + 1;

  logic [UNITS-1:0] in_ready;
  logic out_valid, out_last;
  logic [DATA_BITS-1:0] out_data;
  compare_tree #(
      .UNITS    (UNITS),
      .KEY_BITS (KEY_BITS),
      .DATA_BITS(DATA_BITS)
  ) dut (
      .clk_i,
      .rst_ni,
      .in_valid_i,
      .in_ready_o (in_ready),
      .in_data_i,
      .in_last_i,
      .out_valid_o(out_valid),
      .out_ready_i,
      .out_data_o (out_data),
      .out_last_o (out_last)
  );

  // The tree's nodes, level by level; level 0 is the inputs.
  (* keep *) logic [Nodes-1:0] inside_valid;
  (* keep *) logic [Nodes-1:0] inside_last;
  (* keep *) logic [Nodes*DATA_BITS-1:0] inside_data;
  // Where a skid_buffer is behind a node, the nodes above are what it offers; in front of that come its spare word,
  // {last, data}, and what the node itself holds.
  (* keep *) logic [Nodes-1:0] inside_spare_valid;
  (* keep *) logic [Nodes*Word-1:0] inside_spare;
  (* keep *) logic [Nodes-1:0] inside_own_valid;
  (* keep *) logic [Nodes-1:0] inside_own_last;
  (* keep *) logic [Nodes*DATA_BITS-1:0] inside_own_data;
  function automatic integer buffered(input integer level);
    buffered = level % 2 == 0 && level < Levels ? 1 : 0;
  endfunction
  function automatic integer nodes(input integer level);
    nodes = (UNITS + (1 << level) - 1) >> level;
  endfunction
  function automatic integer first(input integer level);
    first = 0;
    for (int k = 0; k < level; k++) first = first + nodes(k);
  endfunction

  // ---- the queues --------------------------------------------------------------------------------------------------
  logic [UNITS*Places*Word-1:0] queue_q, queue_d;  // unit u, place p: oldest first
  logic [UNITS*4-1:0] count_q, count_d;
  logic output_taken;
  assign output_taken = out_valid && out_ready_i;
  always_comb begin
    queue_d = queue_q;
    count_d = count_q;
    for (int u = 0; u < UNITS; u++) begin
      if (output_taken) begin
        for (int p = 0; p < Places - 1; p++) begin
          queue_d[(u*Places+p)*Word+:Word] = queue_d[(u*Places+p+1)*Word+:Word];
        end
        count_d[u*4+:4] = count_d[u*4+:4] - 4'd1;
      end
      if (in_valid_i[u] && in_ready[u]) begin
        for (int p = 0; p < Places; p++) begin
          if (count_d[u*4+:4] == 4'(p)) begin
            queue_d[(u*Places+p)*Word+:Word] = {in_data_i[u*DATA_BITS+:DATA_BITS], in_last_i[u]};
          end
        end
        count_d[u*4+:4] = count_d[u*4+:4] + 4'd1;
      end
    end
  end
  always_ff @(posedge clk_i) begin
    queue_q <= queue_d;
    count_q <= rst_ni ? count_d : '0;
  end

  // ---- surroundings: reset at the start; lines of the same width in all units --------------------------------------
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb assume (rst_ni == started_q);
  for (genvar u = 0; u < UNITS; u++) begin : gen_unit
    for (genvar v = 0; v < UNITS; v++) begin : gen_other
      if (u != v) begin : gen_same_width
        always_comb begin
          if (in_valid_i[u] && in_valid_i[v] && count_q[u*4+:4] == count_q[v*4+:4]) begin
            assume (in_last_i[u] == in_last_i[v]);
          end
          for (int p = 0; p < Places; p++) begin
            if (in_valid_i[u] && count_q[u*4+:4] == 4'(p) && count_q[v*4+:4] > 4'(p)) begin
              assume (in_last_i[u] == queue_q[(v*Places+p)*Word]);
            end
            // The queues agree on where lines end.
            if (rst_ni && count_q[u*4+:4] > 4'(p) && count_q[v*4+:4] > 4'(p)) begin
              assert (queue_q[(u*Places+p)*Word] == queue_q[(v*Places+p)*Word]);
            end
          end
        end
      end
    end
  end

  // ---- every register: the least of its units' pixels at its place -------------------------------------------------
  // By rst_ni, because a plain alias of the inside_* would lose what run.sh connects to them.
  // Register 0 of a node is what it offers, 1 the spare word of its buffer, 2 its own behind that.
  logic [Nodes*3-1:0] full;
  logic [Nodes*3*Word-1:0] words;
  for (genvar k = 1; k <= Levels; k++) begin : gen_words
    for (genvar i = 0; i < nodes(k); i++) begin : gen_node
      localparam int N = first(k) + i;
      assign full[3*N] = rst_ni && inside_valid[N];
      assign words[3*N*Word+:Word] = rst_ni ? {inside_data[N*DATA_BITS+:DATA_BITS], inside_last[N]} : '0;
      if (buffered(k) != 0) begin : gen_buffer
        assign full[3*N+1] = rst_ni && inside_spare_valid[N];
        assign full[3*N+2] = rst_ni && inside_own_valid[N];
        assign words[(3*N+1)*Word+:Word] =
            rst_ni ? {inside_spare[N*Word+:DATA_BITS], inside_spare[N*Word+DATA_BITS]} : '0;
        assign words[(3*N+2)*Word+:Word] = rst_ni ? {inside_own_data[N*DATA_BITS+:DATA_BITS], inside_own_last[N]} : '0;
        always_comb if (rst_ni) assert (inside_valid[N] || !inside_spare_valid[N]);
      end else begin : gen_none
        assign full[3*N+1+:2] = '0;
        assign words[(3*N+1)*Word+:2*Word] = '0;
      end
    end
  end

  for (genvar k = 1; k <= Levels; k++) begin : gen_level
    for (genvar i = 0; i < nodes(k); i++) begin : gen_node
      for (genvar r = 0; r < 3; r++) begin : gen_register
        localparam int N = first(k) + i;
        logic [3:0] place;  // pixels of the same units that are further on
        logic [Word-1:0] least, pixel;
        always_comb begin
          place = '0;
          for (int l = k + 1; l <= Levels; l++) begin
            for (int q = 0; q < 3; q++) place = place + 4'(full[3*(first(l)+(i>>(l-k)))+q]);
          end
          for (int q = 0; q < r; q++) place = place + 4'(full[3*N+q]);
          least = '1;
          pixel = '0;
          for (int u = UNITS - 1; u >= 0; u--) begin
            if (u >> k == i) begin
              pixel = '0;
              for (int p = 0; p < Places; p++) begin
                if (place == 4'(p)) pixel = queue_q[(u*Places+p)*Word+:Word];
              end
              if (u == UNITS - 1 || u == ((i + 1) << k) - 1 || pixel[Word-1-:KEY_BITS] <= least[Word-1-:KEY_BITS]) begin
                least = pixel;
              end
              if (rst_ni && full[3*N+r]) assert (count_q[u*4+:4] > place);
            end
          end
          if (rst_ni && full[3*N+r]) assert (words[(3*N+r)*Word+:Word] == least);
        end
      end
    end
  end
  for (genvar u = 0; u < UNITS; u++) begin : gen_count
    logic [3:0] held;
    always_comb begin
      held = '0;
      for (int l = 1; l <= Levels; l++) begin
        for (int q = 0; q < 3; q++) held = held + 4'(full[3*(first(l)+(u>>l))+q]);
      end
      if (rst_ni) assert (count_q[u*4+:4] == held);
    end
  end

  // ---- the output, by the queues alone -----------------------------------------------------------------------------
  logic [Word-1:0] oldest, winner;
  logic all_have, none_long;  // every unit has a pixel for the output; none has more inside than there is room for
  always_comb begin
    winner = queue_q[0+:Word];
    oldest = '0;
    all_have = 1'b1;
    none_long = 1'b1;
    for (int u = 1; u < UNITS; u++) begin
      oldest = queue_q[u*Places*Word+:Word];
      if (oldest[Word-1-:KEY_BITS] < winner[Word-1-:KEY_BITS]) winner = oldest;
    end
    for (int u = 0; u < UNITS; u++) begin
      if (count_q[u*4+:4] == '0) all_have = 1'b0;
      if (count_q[u*4+:4] > 4'(Most)) none_long = 1'b0;
    end
    if (rst_ni) begin
      if (out_valid) pixel_of_each : assert (all_have);
      capacity : assert (none_long);
      if (out_valid) least : assert ({out_data, out_last} == winner);
    end
  end

  logic waits_q = 1'b0;
  logic [Word-1:0] before_q;
  always_ff @(posedge clk_i) begin
    waits_q  <= rst_ni && out_valid && !out_ready_i;
    before_q <= {out_data, out_last};
  end
  always_comb if (rst_ni && waits_q) stays : assert (out_valid && {out_data, out_last} == before_q);

  // ---- no standstill: after as many clocks of full supply and demand as a level is behind the inputs it is full -----
  logic [3:0] flowing_q = '0;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || !(&in_valid_i) || !out_ready_i) flowing_q <= '0;
    else if (flowing_q != 4'(Latency)) flowing_q <= flowing_q + 4'd1;
  end
  for (genvar k = 1; k <= Levels; k++) begin : gen_flow
    for (genvar i = 0; i < nodes(k); i++) begin : gen_full
      // Buffers in front of the level's own registers: one for each even level below it.
      always_comb begin
        if (rst_ni && flowing_q >= 4'(k + k / 2 - (k == Levels && k % 2 == 0 ? 1 : 0)))
          assert (inside_valid[first(k)+i]);
        if (rst_ni && buffered(k) != 0 && flowing_q >= 4'(k + k / 2 - 1)) assert (inside_own_valid[first(k)+i]);
      end
    end
  end
  always_comb if (rst_ni && flowing_q == 4'(Latency)) no_standstill : assert (out_valid);

  // ---- what the rules are about happens ----------------------------------------------------------------------------
  logic [UNITS-1:0] key_of_first;
  always_comb begin
    for (int u = 0; u < UNITS; u++) begin
      key_of_first[u] = queue_q[(u*Places+1)*Word-1-:KEY_BITS] == winner[Word-1-:KEY_BITS];
    end
    if (rst_ni) begin
      all_tie : cover (out_valid && (&key_of_first) && out_last);
      last_wins : cover (out_valid && key_of_first == (UNITS'(1) << (UNITS - 1)));
      flows : cover (output_taken && flowing_q == 4'(Latency));
      waits : cover (waits_q && (&in_valid_i) && in_ready == '0);
    end
  end

endmodule

`default_nettype wire
