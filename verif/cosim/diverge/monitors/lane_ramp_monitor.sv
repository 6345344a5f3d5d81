// SPDX-License-Identifier: Apache-2.0
// lane_ramp from its ports alone: each lane's value by a product, as the contract has it.
`default_nettype none

module lane_ramp_monitor #(
    parameter int LANES = 4,
    parameter int BITS = 37,
    parameter int FRAC = 11,
    parameter int LO = 1,
    parameter int HI = 255,
    parameter int OUT_BITS = 24,
    parameter int OFF_BITS = 1,
    parameter int SETS = 1
) (
    input wire logic                      clk_i,
    input wire logic                      rst_ni,
    input wire logic [          SETS-1:0] set_en_i,
    input wire logic                      put_i,
    input wire logic [          BITS-1:0] start_i,
    input wire logic [          BITS-1:0] slope_i,
    input wire logic [      OFF_BITS-1:0] offset_i,
    input wire logic                      load_i,
    input wire logic                      step_i,
    input wire logic [LANES*OUT_BITS-1:0] value_o
);
  `include "kage_trace.svh"

  localparam int Delay = $clog2(LANES) + 2;
  localparam int SetBits = 2 * BITS + OFF_BITS;
  // The last set-up stage is a queue of two: of it the oldest and the one behind.
  // Stage 0 lowest; place k of the ways is what stage k takes.
  logic [SETS*SetBits-1:0] set_q;
  logic [(SETS+1)*SetBits-1:0] set_way;
  bit [SETS-1:0] set_known_q;  // something has come in
  bit [SETS:0] known_way;
  logic [SetBits-1:0] oldest_q, behind_q;
  bit oldest_known_q, behind_known_q;
  logic [1:0] held_q;
  logic puts;
  logic [BITS-1:0] start_q, slope_q;
  int place_q;  // of lane 0, from xl
  bit known_q;
  logic [OFF_BITS-1:0] offset;
  logic [LANES*OUT_BITS-1:0] values;
  logic [LANES-1:0] used;
  logic [Delay*LANES*OUT_BITS-1:0] values_q;
  bit [Delay*LANES-1:0] used_q;
  assign offset = oldest_q[OFF_BITS-1:0];
  assign puts   = put_i && held_q < 2'd2;

  logic signed [BITS-1:0] sum;
  int place;
  always_comb begin
    sum = '0;
    place = 0;
    values = '0;
    for (int l = 0; l < LANES; l++) begin
      place = place_q + l;
      used[l] = known_q && place >= 0;
      sum = $signed(start_q + slope_q * BITS'(place)) >>> FRAC;
      values[l*OUT_BITS+:OUT_BITS] = OUT_BITS'(sum);
      if (sum < BITS'(LO)) values[l*OUT_BITS+:OUT_BITS] = OUT_BITS'(LO);
      if (sum > BITS'(HI)) values[l*OUT_BITS+:OUT_BITS] = OUT_BITS'(HI);
    end
  end

  assign set_way   = {set_q, start_i, slope_i, offset_i};
  assign known_way = {set_known_q, 1'b1};

  always_ff @(posedge clk_i) begin
    for (int k = 0; k < SETS; k++) begin
      if (set_en_i[k]) begin
        set_q[k*SetBits+:SetBits] <= set_way[k*SetBits+:SetBits];
        set_known_q[k] <= known_way[k];
      end
    end
    held_q <= rst_ni ? held_q + 2'(puts) - 2'(load_i && held_q != '0) : '0;
    if (load_i || held_q == '0) begin
      if (held_q == 2'd2) {oldest_q, oldest_known_q} <= {behind_q, behind_known_q};
      else {oldest_q, oldest_known_q} <= {set_way[SETS*SetBits+:SetBits], known_way[SETS]};
    end
    if (puts) {behind_q, behind_known_q} <= {set_way[SETS*SetBits+:SetBits], known_way[SETS]};
    if (load_i) begin
      {start_q, slope_q} <= oldest_q[SetBits-1:OFF_BITS];
      place_q <= LANES > 1 ? -32'(offset) : 0;
      known_q <= oldest_known_q;
    end else if (step_i) begin
      place_q <= place_q + LANES;
    end
    values_q <= (Delay * LANES * OUT_BITS)'({values_q, values});
    used_q   <= (Delay * LANES)'({used_q, used});
    for (int l = 0; l < LANES; l++) begin
      if (used_q[(Delay-1)*LANES+l]) begin
        trace_module(PartLaneRamp, 512'(values_q[((Delay-1)*LANES+l)*OUT_BITS+:OUT_BITS]),
                     512'(value_o[l*OUT_BITS+:OUT_BITS]));
      end
    end
  end

endmodule

bind lane_ramp lane_ramp_monitor #(
    .LANES(LANES),
    .BITS(BITS),
    .FRAC(FRAC),
    .LO(LO),
    .HI(HI),
    .OUT_BITS(OUT_BITS),
    .OFF_BITS(OffBits),
    .SETS(SetStages)
) u_monitor (.*);

`default_nettype wire
