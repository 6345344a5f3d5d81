// SPDX-License-Identifier: Apache-2.0
// compare_tree from its ports alone: of the units' pixels that were taken for a place, the one with the least key, on
// equal keys the lowest unit's, as many clocks after the last of them as there are levels; and no more are taken of a
// unit than there are registers for.
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
    localparam int Most = 8;
    logic [DATA_BITS:0] words[UNITS*Most];  // {last, data}
    int at_q, wait_q, held_q[UNITS];
    logic [DATA_BITS:0] word, best;
    logic whole, pop;
    always_comb begin
      whole = 1'b1;
      best  = words[at_q];
      word  = '0;
      for (int u = 0; u < UNITS; u++) begin
        word = words[u*Most+at_q];
        if (held_q[u] == 0) whole = 1'b0;
        if (word[DATA_BITS-1-:KEY_BITS] < best[DATA_BITS-1-:KEY_BITS]) best = word;
      end
      best[DATA_BITS] = words[at_q][DATA_BITS];
    end
    assign pop = out_valid_o && out_ready_i && whole;

    always_ff @(posedge clk_i) begin
      if (!rst_ni) begin
        at_q   <= 0;
        wait_q <= 0;
        for (int u = 0; u < UNITS; u++) held_q[u] <= 0;
      end else begin
        if (out_valid_o) trace_module(PartCompareTree, 512'(1), 512'(whole));
        if (out_valid_o && whole) trace_module(PartCompareTree, 512'(best), 512'({out_last_o, out_data_o}));
        if (pop) at_q <= (at_q + 1) % Most;
        trace_module(PartCompareTree, 512'(1), 512'(wait_q <= Levels));
        wait_q <= whole && !out_valid_o ? wait_q + 1 : 0;
        for (int u = 0; u < UNITS; u++) begin
          if (in_valid_i[u] && in_ready_o[u]) begin
            words[u*Most+(at_q+held_q[u])%Most] <= {in_last_i[u], in_data_i[u*DATA_BITS+:DATA_BITS]};
          end
          trace_module(PartCompareTree, 512'(1), 512'(held_q[u] <= Levels));
          held_q[u] <= held_q[u] + 32'(in_valid_i[u] && in_ready_o[u]) - 32'(pop);
        end
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
