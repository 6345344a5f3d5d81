// SPDX-License-Identifier: Apache-2.0
// table_check from its ports alone: entries come in order, class by class and light by light, until a token comes that
// is none; a class is there once its last light has come.
`default_nettype none

module table_check_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int First = 1  // class of the first entry
) (
    input wire logic                      clk_i,
    input wire logic                      frame_start_i,
    input wire logic                      take_table_i,
    input wire logic                      take_other_i,
    input wire logic [    CLASS_BITS-1:0] class_i,
    input wire logic [     LightBits-1:0] light_i,
    input wire logic [EntryShareBits-1:0] share_i,
    input wire logic [    CLASS_BITS-1:0] span_class_i,
    input wire logic                      order_error_o,
    input wire logic                      range_error_o,
    input wire logic                      lacking_o
);
  `include "kage_trace.svh"

  bit known_q;  // a frame has begun
  int entries_q;  // that have come; the next is of class 1 + entries / LIGHTS
  logic closed_q, range;
  always_comb begin
    range = 32'(class_i) != First + entries_q / LIGHTS || 32'(light_i) != entries_q % LIGHTS;
    for (int c = 0; c < CHANNELS; c++) begin
      if (share_i[c*FactorBits+:FactorBits] > WholeShare) range = 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (known_q) begin
      trace_module(PartTableCheck, {509'd0, closed_q, range, 32'(span_class_i) > entries_q / LIGHTS}, {
                   509'd0, order_error_o, range_error_o, lacking_o});
    end
    if (frame_start_i) begin
      known_q   <= 1'b1;
      entries_q <= 0;
      closed_q  <= 1'b0;
    end else begin
      if (take_table_i) entries_q <= entries_q + 1;
      if (take_other_i) closed_q <= 1'b1;
    end
  end

endmodule

bind table_check table_check_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

`default_nettype wire
