// SPDX-License-Identifier: Apache-2.0
// A value that changes linearly along a span, for LANES neighbouring pixels at a time: depth, or one channel of colour.
//
// Result: clamp((start + (x - xl) * slope) >> FRAC, LO, HI) for x = first pixel of the group + lane; the sum in two's
//   complement of BITS bits, the shift arithmetic. Lanes left of xl get values too, which nobody uses.
// How: no products. The set-up, two clocks or three where a group has more than four lanes, makes the value at the
//   first group's first lane. It subtracts the shifted slopes that the bits of xl's place in its group select. Then a
//   tree doubles the number of lanes per clock: left half the same, right half plus slope x half the lanes. A
//   multiplier per lane would be the core's slowest path.
// Control: the parent moves the set-up stages but the last: set_en_i bit k lets stage k + 1 take the data before it. It
//   says when the last of these has something (put_i), and moves the walker (load_i: take the set-up's oldest result;
//   step_i: one group further). The last stage is a queue of two, like the parent's own, so the walker moves only a
//   pointer of it: put_i is acted on where there is room. The rest is a pipeline that always moves.
// Latency: value_o belongs to the group the walker held $clog2(LANES) + 2 clocks ago. Throughput: a group a clock.
// Cost: about 2 x LANES adders and 3 x LANES registers of BITS bits. The queue's pointers alone are reset.
`default_nettype none
`include "kage_illegal.svh"

module lane_ramp #(
    parameter int LANES = 4,
    parameter int BITS = 37,
    parameter int FRAC = 11,
    parameter int LO = 1,
    parameter int HI = (1 << 24) - 2,
    parameter int OUT_BITS = 24,
    localparam int Levels = $clog2(LANES),
    localparam int OffBits = LANES > 1 ? Levels : 1,
    localparam int SetStages = LANES > 4 ? 2 : 1  // ahead of the queue
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic [SetStages-1:0] set_en_i,
    input wire logic                 put_i,
    input wire logic [     BITS-1:0] start_i,
    input wire logic [     BITS-1:0] slope_i,
    input wire logic [  OffBits-1:0] offset_i,  // of xl in its group
    input wire logic                 load_i,
    input wire logic                 step_i,

    output logic [LANES*OUT_BITS-1:0] value_o
);

  // ---- set-up: start - offset * slope ------------------------------------------------------------------------------
  logic [BITS-1:0] start_q, slope_q, low_q, part, set_start, set_slope, first, first_slope;
  logic [4:0] off;
  assign off = LANES > 1 ? 5'(offset_i) : 5'd0;

  always_ff @(posedge clk_i) begin
    if (set_en_i[0]) begin
      start_q <= start_i;
      slope_q <= slope_i;
      low_q   <= (off[0] ? slope_i : '0) + (off[1] ? slope_i << 1 : '0);
    end
  end
  assign part = start_q - low_q;

  if (SetStages > 1) begin : gen_wide
    logic [BITS-1:0] mid_q, high_q, part_q, rest_q, slope2_q;
    always_ff @(posedge clk_i) begin
      if (set_en_i[0]) begin
        mid_q  <= (off[2] ? slope_i << 2 : '0) + (off[3] ? slope_i << 3 : '0);
        high_q <= off[4] ? slope_i << 4 : '0;
      end
      if (set_en_i[1]) begin
        part_q   <= part;
        rest_q   <= mid_q + high_q;
        slope2_q <= slope_q;
      end
    end
    assign set_start = part_q - rest_q;
    assign set_slope = slope2_q;
  end else begin : gen_narrow
    logic unused_off;
    assign unused_off = ^off[4:2];
    assign set_start  = part;
    assign set_slope  = slope_q;
  end

  logic unused_ready, set_valid;  // the parent's queue says the same
  stream_fifo #(
      .BITS (2 * BITS),
      .DEPTH(2)
  ) u_set (
      .clk_i,
      .rst_ni,
      .in_valid_i (put_i),
      .in_ready_o (unused_ready),
      .in_data_i  ({set_start, set_slope}),
      .out_valid_o(set_valid),
      .out_ready_i(load_i),
      .out_data_o ({first, first_slope})
  );

  // ---- walker and lane tree ----------------------------------------------------------------------------------------
  // Level k holds 2^k values, that of pixel i * LANES / 2^k of the group at place i; levels lie behind each other, the
  // root first.
  logic [(2*LANES-1)*BITS-1:0] tree_d, tree_q;
  logic [(Levels+1)*BITS-1:0] slopes_d, slopes_q;  // the slope that goes with each level

  logic [BITS-1:0] node;
  always_comb begin
    node = '0;
    tree_d = tree_q;
    slopes_d = slopes_q;
    if (load_i) begin
      tree_d[0+:BITS]   = first;
      slopes_d[0+:BITS] = first_slope;
    end else if (step_i) begin
      tree_d[0+:BITS] = tree_q[0+:BITS] + (slopes_q[0+:BITS] << Levels);
    end
    for (int k = 0; k < Levels; k++) begin
      slopes_d[(k+1)*BITS+:BITS] = slopes_q[k*BITS+:BITS];
      // Level k has 2^k places; Icarus Verilog wants a loop's bound to be the same for all k.
      for (int i = 0; i < LANES / 2; i++) begin
        if (i < (1 << k)) begin
          node = tree_q[((1<<k)-1+i)*BITS+:BITS];
          tree_d[((2<<k)-1+2*i)*BITS+:BITS] = node;
          tree_d[((2<<k)+2*i)*BITS+:BITS] = node + (slopes_q[k*BITS+:BITS] << (Levels - 1 - k));
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    tree_q   <= tree_d;
    slopes_q <= slopes_d;
  end

  // ---- clamp, in two clocks ----------------------------------------------------------------------------------------
  localparam int IntBits = BITS - FRAC;
  logic [LANES*OUT_BITS-1:0] int_d, int_q, value_d, value_q;
  logic [LANES-1:0] under_d, under_q, over_d, over_q;
  logic signed [IntBits-1:0] whole;

  always_comb begin
    whole = '0;
    for (int l = 0; l < LANES; l++) begin
      whole = $signed(tree_q[(LANES-1+l)*BITS+FRAC+:IntBits]);
      int_d[l*OUT_BITS+:OUT_BITS] = whole[OUT_BITS-1:0];
      under_d[l] = whole < IntBits'(LO);
      over_d[l] = whole > IntBits'(HI);
      if (under_q[l]) value_d[l*OUT_BITS+:OUT_BITS] = OUT_BITS'(LO);
      else if (over_q[l]) value_d[l*OUT_BITS+:OUT_BITS] = OUT_BITS'(HI);
      else value_d[l*OUT_BITS+:OUT_BITS] = int_q[l*OUT_BITS+:OUT_BITS];
    end
  end

  always_ff @(posedge clk_i) begin
    int_q   <= int_d;
    under_q <= under_d;
    over_q  <= over_d;
    value_q <= value_d;
  end

  assign value_o = value_q;

  logic unused_set;
  assign unused_set = set_valid;

  // ---- checks ------------------------------------------------------------------------------------------------------
  if (FRAC < 0 || IntBits < OUT_BITS + 1) begin : gen_bad_bits
    `KAGE_ILLEGAL("BITS must hold FRAC fraction bits, OUT_BITS and a sign")
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic begun_q = 1'b0;  // there has been a clock
  always @(posedge clk_i) begin
    begun_q <= 1'b1;
    if (rst_ni) begin
      // 1. The walker takes what has been set up, and does not go on in the same clock.
      assert (!load_i || (set_valid && !step_i));
      // 2. No value is less than the least and more than the greatest. Before the first span values are not known.
      if (begun_q && |(under_q & over_q)) assert (1'b0);
    end
  end
`endif

endmodule

`default_nettype wire
