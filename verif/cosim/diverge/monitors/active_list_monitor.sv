// SPDX-License-Identifier: Apache-2.0
// active_list from its ports alone. Each line reads all that was kept for it, in the order in which it was written: so
// all lines together are one queue, of which a line has so many.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module active_list_monitor #(
    parameter int BITS = 8,
    parameter int PLACE_AT = 0,
    parameter int PLACE_BITS = 2,
    parameter int END_AT = 2,
    parameter int END_BITS = 2,
    parameter int ACTIVE = 512
) (
    input wire logic                  clk_i,
    input wire logic                  rst_ni,
    input wire logic                  clear_i,
    input wire logic [PLACE_BITS-1:0] place_i,
    input wire logic                  renew_i,
    input wire logic [  END_BITS-1:0] line_i,
    input wire logic                  polygon_valid_o,
    input wire logic [      BITS-1:0] polygon_o,
    input wire logic                  before_o,
    input wire logic                  same_o,
    input wire logic                  goes_on_o,
    input wire logic                  pop_i,
    input wire logic                  left_o,
    input wire logic                  keep_i,
    input wire logic                  room_o,
    input wire logic                  swap_i,
    input wire logic                  swap_ready_o,
    input wire logic                  write_i,
    input wire logic [      BITS-1:0] polygon_i,
    input wire logic                  swap_write_i
);
  `include "kage_trace.svh"
  `include "kage_trace_word.svh"

  localparam int Wait = 4;  // clocks until one that could be the first is

  localparam int Depth = 2 * ACTIVE;
  logic [BITS-1:0] queue_q[Depth];  // written, and not yet taken, from head_q to tail_q
  int head_q = 0, tail_q = 0;
  int left_q, kept_q;  // of this line, for the next one
  int swaps_q;  // that the writer has not seen
  int waited_q;  // clocks in which the first was missing
  logic [BITS-1:0] first;
  logic [PLACE_BITS-1:0] place;
  always @(posedge clk_i) begin
    if (!rst_ni || clear_i) begin
      head_q = tail_q;
      {left_q, kept_q, swaps_q, waited_q} <= '0;
    end else begin
      trace_module(PartActiveList, {509'd0, left_q != 0, left_q + kept_q < ACTIVE, swaps_q == 0}, {
                   509'd0, left_o, room_o, swap_ready_o});
      first = '0;
      if (left_q > 0 && tail_q != head_q) first = queue_q[head_q%Depth];
      if (polygon_valid_o) begin
        place = first[PLACE_AT+:PLACE_BITS];
        trace_module(PartActiveList, {511'd0, left_q > 0 && tail_q != head_q}, {511'd0, 1'b1});
        trace_module(PartActiveList, folded(first), folded(polygon_o));
        if (!renew_i) begin
          trace_module(PartActiveList, {
                       509'd0, place < place_i, place == place_i, $signed(first[END_AT+:END_BITS]) > $signed(line_i)}, {
                       509'd0, before_o, same_o, goes_on_o});
        end
      end
      if (polygon_valid_o || renew_i || left_q == 0 || tail_q == head_q) waited_q <= 0;
      else waited_q <= waited_q + 1;
      trace_module(PartActiveList, '0, {511'd0, waited_q > Wait});
      if (pop_i && tail_q != head_q) head_q = head_q + 1;
      if (write_i) begin
        queue_q[tail_q%Depth] = polygon_i;
        tail_q = tail_q + 1;
      end
      left_q  <= swap_i ? kept_q : left_q - 32'(pop_i);
      kept_q  <= swap_i ? 0 : kept_q + 32'(keep_i);
      swaps_q <= swaps_q + 32'(swap_i) - 32'(swap_write_i);
    end
  end

endmodule

bind active_list active_list_monitor #(
    .BITS(BITS),
    .PLACE_AT(PLACE_AT),
    .PLACE_BITS(PLACE_BITS),
    .END_AT(END_AT),
    .END_BITS(END_BITS),
    .ACTIVE(ACTIVE)
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
