// SPDX-License-Identifier: Apache-2.0
// From linear light to what a display takes: sRGB, each channel of its own (docs/stream.md, "Light after light").
//
// Result: pixel_i is {covered, colour} with LINEAR_BITS a channel. LightStages clocks of go_i later pixel_o is the
//   same with 8 bits a channel. A displayed value is the number of thresholds that the level reaches. A pixel with
//   shown_i is displayed already: the lowest 8 bits of each channel pass as they are.
// How: a bit of the value a clock, the highest first. Each clock compares the level with the threshold in the middle of
//   the values that are left. Both thresholds that may come next are looked up meanwhile.
// Latency: LightStages, 8 clocks. Throughput: a pixel a clock.
// Cost: for each channel 8 comparisons of LINEAR_BITS bits, a table of 255 thresholds as logic, and 8 registers of 2
//   LINEAR_BITS + 8 bits at most.
// Needs LINEAR_BITS > 0: a core without linear light leaves it out.
`default_nettype none

module display_curve #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int InBits  = PixelRgbBits + 1,
    localparam int OutBits = RgbBits + 1
) (
    input wire logic clk_i,

    input  wire logic               go_i,
    input  wire logic [ InBits-1:0] pixel_i,
    input  wire logic               shown_i,
    output logic      [OutBits-1:0] pixel_o
);
  `include "generated/kage_curve.svh"

  localparam int Level = PixelLevelBits;
  localparam int Shown = 8;  // bits of a displayed value, and so clocks

  // The thresholds that clock `stage` compares with, by the bits of the value that it has, rounded up to a level. Each
  // has a place of 2^PlaceLog bits, for then its address takes no product.
  localparam int PlaceLog = 4;
  localparam int Place = 2 ** PlaceLog;
  function automatic logic [2**(Shown-1)*Place-1:0] thresholds_of(input int stage);
    logic [32:0] light;
    begin
      thresholds_of = '0;
      light = '0;
      for (int p = 0; p < 2 ** stage; p++) begin
        light = {1'b0, DisplayThresholds[(((2*p+1)<<(Shown-1-stage))-1)*32+:32]} + ((33'd1 << (32 - Level)) - 33'd1);
        thresholds_of[p*Place+:Level] = Level'(light >> (32 - Level));
      end
    end
  endfunction

  logic [Shown-1:0] covered_q, shown_q;
  always_ff @(posedge clk_i) begin
    if (go_i) begin
      covered_q <= {covered_q[Shown-2:0], pixel_i[InBits-1]};
      shown_q   <= {shown_q[Shown-2:0], shown_i};
    end
  end
  assign pixel_o[OutBits-1] = covered_q[Shown-1];

  for (genvar c = 0; c < CHANNELS; c++) begin : gen_channel
    logic [Shown*Level-1:0] level_q;  // behind each clock
    // Behind clock s the s + 1 bits of the value that are known: they lie behind each other, from s (s + 1) / 2 on.
    logic [Shown*(Shown+1)/2-1:0] value_q;
    logic [Shown-1:0] reached;  // of each clock: the level reaches its threshold
    always_ff @(posedge clk_i) begin
      if (go_i) level_q <= (Shown * Level)'({level_q, pixel_i[c*Level+:Level]});
    end
    for (genvar s = 0; s < Shown; s++) begin : gen_clock
      localparam int Entries = 2 ** s;
      localparam int At = s * (s + 1) / 2;
      localparam logic [Entries*Place-1:0] Thresholds = (Entries * Place)'(thresholds_of(s));
      if (s == 0) begin : gen_first
        assign reached[s] = pixel_i[c*Level+:Level] >= Thresholds[Level-1:0];
        always_ff @(posedge clk_i) if (go_i) value_q[0] <= reached[0];
      end else begin : gen_next
        // The threshold is found in the clock before, whose comparison decides between two.
        logic [Level-1:0] threshold_q;
        logic [s-1:0] below, above;
        if (s == 1) begin : gen_second
          assign {below, above} = 2'b01;
        end else begin : gen_later
          assign below = {value_q[At-2*s+1+:s-1], 1'b0};
          assign above = {value_q[At-2*s+1+:s-1], 1'b1};
        end
        assign reached[s] = level_q[(s-1)*Level+:Level] >= threshold_q;
        always_ff @(posedge clk_i) begin
          if (go_i) begin
            threshold_q <= reached[s-1] ? Thresholds[{above, PlaceLog'(0)}+:Level] :
                Thresholds[{below, PlaceLog'(0)}+:Level];
            value_q[At+:s+1] <= {value_q[At-s+:s], reached[s]};
          end
        end
      end
    end
    assign pixel_o[c*8+:8] = shown_q[Shown-1] ? level_q[(Shown-1)*Level+:8] : value_q[Shown*(Shown-1)/2+:Shown];
  end

endmodule

`default_nettype wire
