// SPDX-License-Identifier: Apache-2.0
// expansion_unit from its ports alone: a line whose segments were taken leaves with as many pixels as they have, the
// last of them as its last. The pixels' values are held against the golden core elsewhere.
`default_nettype none

module expansion_unit_monitor #(
    parameter int DX_BITS = 9
) (
    input wire logic               clk_i,
    input wire logic               rst_ni,
    input wire logic               flush_i,
    input wire logic               seg_valid_i,
    input wire logic               seg_ready_o,
    input wire logic [DX_BITS-1:0] seg_dx,
    input wire logic               seg_completes,
    input wire logic               px_valid_o,
    input wire logic               px_ready_i,
    input wire logic               px_last_o
);
  `include "kage_trace.svh"

  // Lines under way: two in the halves, and one that has been read out and leaves.
  localparam int Most = 4;
  int widths[Most];
  int at_q, lines_q, sum_q, x_q, sum;
  logic lost_q;  // segments that make no line have come: what follows is anybody's
  logic take, whole, last;
  assign take  = seg_valid_i && seg_ready_o;
  assign sum   = sum_q + 32'(seg_dx);
  assign whole = take && seg_completes;
  assign last  = x_q + 1 == widths[at_q];

  always_ff @(posedge clk_i) begin
    if (!rst_ni || flush_i) begin
      {at_q, lines_q, sum_q, x_q, lost_q} <= '0;
    end else begin
      if (take) begin
        sum_q <= whole ? 0 : sum;
        if (seg_dx == '0) lost_q <= 1'b1;
      end
      if (px_valid_o && !lost_q)
        trace_module(PartExpansionUnit, {510'd0, 1'b1, last}, {510'd0, lines_q > 0, px_last_o});
      if (whole) widths[(at_q+lines_q)%Most] <= sum;
      if (px_valid_o && px_ready_i && lines_q > 0) begin
        x_q <= last ? 0 : x_q + 1;
        if (last) at_q <= (at_q + 1) % Most;
      end
      lines_q <= lines_q + 32'(whole) - 32'(px_valid_o && px_ready_i && lines_q > 0 && last);
    end
  end

endmodule

bind expansion_unit expansion_unit_monitor #(
    .DX_BITS(DX_BITS)
) u_monitor (
    .seg_dx       (piece.dx),
    .seg_completes(piece.completes),
    .*
);

`default_nettype wire
