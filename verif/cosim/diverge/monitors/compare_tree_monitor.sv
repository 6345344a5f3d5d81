// SPDX-License-Identifier: Apache-2.0
// compare_tree from its ports alone. For each place, the pixel with the least key leaves, on equal keys the lowest
// unit's. Once the last unit's pixel is taken, the result comes within the tree's latency. And no more pixels are taken
// of a unit than there are registers for.
`default_nettype none

module compare_tree_monitor #(
    parameter int UNITS = 8,
    parameter int KEY_BITS = 32,
    parameter int DATA_BITS = 57
) (
    input wire logic                       clk_i,
    input wire logic                       rst_ni,
    input wire logic [          UNITS-1:0] in_valid_i,
    input wire logic [          UNITS-1:0] in_ready_o,
    input wire logic [UNITS*DATA_BITS-1:0] in_data_i,
    input wire logic [          UNITS-1:0] in_last_i,
    input wire logic                       out_valid_o,
    input wire logic                       out_ready_i,
    input wire logic [      DATA_BITS-1:0] out_data_o,
    input wire logic                       out_last_o
);
  `include "kage_trace.svh"

  if (UNITS > 1) begin : gen_tree
    localparam int Levels = $clog2(UNITS);  // a register each
    localparam int Buffers = (Levels - 1) / 2;  // on a pixel's way: a clock and two registers each
    localparam int Latency = Levels + Buffers;
    localparam int MostHeld = Levels + 2 * Buffers;
    localparam int Most = MostHeld + 1;  // of a ring, where one comes in the clock in which one leaves
    localparam int WordBits = DATA_BITS + 1;  // {last, data}
    int at_q, wait_q;
    logic [UNITS-1:0] there;  // units of which a pixel is in the tree
    logic [UNITS*WordBits-1:0] fronts;  // the oldest of each
    logic [WordBits-1:0] word, best;
    logic pop;
    always_comb begin
      best = fronts[WordBits-1:0];
      word = '0;
      for (int u = 1; u < UNITS; u++) begin
        word = fronts[u*WordBits+:WordBits];
        if (word[DATA_BITS-1-:KEY_BITS] < best[DATA_BITS-1-:KEY_BITS]) best = word;
      end
      best[DATA_BITS] = fronts[DATA_BITS];
    end
    assign pop = out_valid_o && out_ready_i && (&there);

    // A ring a unit: Verilator takes no array that a loop over many units writes.
    for (genvar u = 0; u < UNITS; u++) begin : gen_unit
      logic [WordBits-1:0] words[Most];
      int held_q;
      assign there[u] = held_q != 0;
      assign fronts[u*WordBits+:WordBits] = words[at_q];
      always_ff @(posedge clk_i) begin
        if (!rst_ni) held_q <= 0;
        else begin
          if (in_valid_i[u] && in_ready_o[u]) begin
            words[(at_q+held_q)%Most] <= {in_last_i[u], in_data_i[u*DATA_BITS+:DATA_BITS]};
          end
          trace_module(PartCompareTree, 512'(1), 512'(held_q <= MostHeld));
          held_q <= held_q + 32'(in_valid_i[u] && in_ready_o[u]) - 32'(pop);
        end
      end
    end

    always_ff @(posedge clk_i) begin
      if (!rst_ni) begin
        at_q   <= 0;
        wait_q <= 0;
      end else begin
        if (out_valid_o) trace_module(PartCompareTree, 512'(1), 512'(&there));
        if (out_valid_o && (&there)) trace_module(PartCompareTree, 512'(best), 512'({out_last_o, out_data_o}));
        if (pop) at_q <= (at_q + 1) % Most;
        trace_module(PartCompareTree, 512'(1), 512'(wait_q <= Latency));
        wait_q <= (&there) && !out_valid_o ? wait_q + 1 : 0;
      end
    end
  end else begin : gen_wires
    logic unused;
    assign unused = ^{clk_i, rst_ni, in_valid_i, in_ready_o, in_data_i, in_last_i, out_valid_o, out_ready_i,
                      out_data_o, out_last_o};
  end

endmodule

bind compare_tree compare_tree_monitor #(
    .UNITS(UNITS),
    .KEY_BITS(KEY_BITS),
    .DATA_BITS(DATA_BITS)
) u_monitor (.*);

`default_nettype wire
