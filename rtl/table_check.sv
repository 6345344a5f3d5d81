// SPDX-License-Identifier: Apache-2.0
// The rules for the light table (docs/stream.md, "What a pixel does"): its entries come in order, and no class is used
// before the frame's table has it whole. Module token_check asks about the token that comes in; nothing here waits.
//
// Question: class_i and light_i are TABLE's, share_i its shares, span_class_i the class of OP or FACE. Answers are
//   combinational:
//   order_error_o   TABLE may not come any more: something other than TABLE and FACE has come
//   range_error_o   TABLE: not the next entry, or a share of more than 1
//   lacking_o       the table has not span_class_i whole.
// Acts: frame_start_i, one clock, at a header. In the clock in which a token is taken, take_table_i says that it is a
//   TABLE, take_other_i that it is anything else but FACE. After one that was refused nothing but frame_start_i
//   counts.
// Latency: answers 0, state 1 clock. Throughput: a token a clock.
// Cost: CLASS_BITS + LightBits + 2 flip-flops, a comparison of CLASS_BITS + 1 bits.
// Needs CLASS_BITS > 1: a core without table leaves it out.
`default_nettype none

module table_check #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int NextBits = CLASS_BITS + 1  // past the last class nothing is next
) (
    input wire logic clk_i,

    input wire logic frame_start_i,
    input wire logic take_table_i,
    input wire logic take_other_i,

    input wire logic [    CLASS_BITS-1:0] class_i,
    input wire logic [     LightBits-1:0] light_i,
    input wire logic [EntryShareBits-1:0] share_i,
    input wire logic [    CLASS_BITS-1:0] span_class_i,

    output logic order_error_o,
    output logic range_error_o,
    output logic lacking_o
);

  // The next entry.
  logic [NextBits-1:0] class_q;
  logic [LightBits-1:0] light_q;
  logic state_q;  // the frame's state may still grow

  assign order_error_o = !state_q;
  assign lacking_o = {1'b0, span_class_i} >= class_q;
  always_comb begin
    range_error_o = {1'b0, class_i} != class_q || light_i != light_q;
    for (int c = 0; c < CHANNELS; c++) begin
      if (share_i[c*FactorBits+:FactorBits] > WholeShare) range_error_o = 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (frame_start_i) begin
      state_q <= 1'b1;
      class_q <= NextBits'(1);
      light_q <= '0;
    end else begin
      if (take_other_i) state_q <= 1'b0;
      if (take_table_i) begin
        if (light_q == LightBits'(LIGHTS - 1)) begin
          light_q <= '0;
          class_q <= class_q + 1'b1;
        end else begin
          light_q <= light_q + 1'b1;
        end
      end
    end
  end

endmodule

`default_nettype wire
