// SPDX-License-Identifier: Apache-2.0
// display_curve, by the nets of line_out, which alone knows which of its pixels are some. A displayed value is the
// number of thresholds that its level reaches, counted.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // only some stages of a pipeline's bits are looked at

module display_curve_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int Depth = 5 + LightStages
) (
    input wire logic                   clk_i,
    input wire logic                   rst_ni,
    input wire logic                   go,
    input wire logic [      Depth-1:0] valid_q,
    input wire logic [   ExitBits-1:0] pixel_q,
    input wire logic [LightStages+2:0] painted_at_q,
    input wire logic [      RgbBits:0] colored
);
  `include "kage_trace.svh"

  if (LINEAR_BITS > 0) begin : gen_curve
    `include "generated/kage_curve.svh"
    logic [RgbBits:0] results_q[LightStages];
    logic [RgbBits:0] result;
    logic [32:0] light;

    always_comb begin
      result = '0;
      light = '0;
      result[RgbBits] = pixel_q[ExitCoveredAt];
      for (int c = 0; c < CHANNELS; c++) begin
        light = 33'(pixel_q[ExitColorAt+c*PixelLevelBits+:PixelLevelBits]) << (32 - PixelLevelBits);
        for (int k = 0; k < 255; k++) begin
          if (light >= {1'b0, DisplayThresholds[k*32+:32]}) result[c*8+:8] = 8'(k + 1);
        end
        if (painted_at_q[2]) result[c*8+:8] = pixel_q[ExitColorAt+c*PixelLevelBits+:8];
      end
    end

    always_ff @(posedge clk_i) begin
      if (go) begin
        results_q[0] <= result;
        for (int i = 1; i < LightStages; i++) results_q[i] <= results_q[i-1];
      end
      if (rst_ni && valid_q[2+LightStages]) begin
        trace_module(PartDisplayCurve, 512'(results_q[LightStages-1]), 512'(colored));
      end
    end
  end else begin : gen_none
    logic unused;
    assign unused = ^{clk_i, rst_ni, go, valid_q, pixel_q, painted_at_q, colored};
  end

endmodule
/* verilator lint_on UNUSEDSIGNAL */

bind line_out display_curve_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_curve_monitor (.*);

`default_nettype wire
