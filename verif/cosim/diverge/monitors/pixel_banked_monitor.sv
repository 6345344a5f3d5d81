// SPDX-License-Identifier: Apache-2.0
// Effect of each command on each pixel of its range, as events (rtl/defs/stages.yaml), where pixels are in block RAM.
`default_nettype none

module pixel_banked_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 4,
    parameter int ADDR_BITS = 8
) (
    input wire logic                          clk_i,
    input wire logic                          rst_ni,
    input wire logic                          group_valid,
    input wire logic [          KindBits-1:0] now_kind,
    input wire logic [             LANES-1:0] now_lanes,
    input wire logic [         ADDR_BITS-1:0] now_addr,
    input wire logic [      LANES*Z_BITS-1:0] now_z,
    input wire logic [ LANES*LaneRgbBits-1:0] now_color,
    input wire logic [   LANES*PixelBits-1:0] next,
    input wire logic [             LANES-1:0] mixes,
    input wire logic [LANES*PixelRgbBits-1:0] mixed
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "kage_trace_pixel.svh"

  // A colour that came, as a pixel holds it; one that is displayed has 8 bits a channel, the highest.
  function automatic logic [PixelRgbBits-1:0] held(input logic [LaneRgbBits-1:0] color, input logic displayed);
    held = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      held[c*PixelLevelBits+:PixelLevelBits] = displayed ?
          PixelLevelBits'(color[c*LaneLevelBits+LaneLevelBits-8+:8]) :
          color[c*LaneLevelBits+LaneLevelBits-PixelLevelBits+:PixelLevelBits];
    end
  endfunction

  // The next state with its colour, which the core chooses a clock later where it is mixed.
  logic [LANES*PixelBits-1:0] full;
  always_comb begin
    full = next;
    for (int l = 0; l < LANES; l++) begin
      if (mixes[l]) full[l*PixelBits+PixelColorAt+:PixelRgbBits] = mixed[l*PixelRgbBits+:PixelRgbBits];
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && group_valid && now_kind != KindEol && now_kind != CmdOut) begin
      for (int l = 0; l < LANES; l++) begin
        if (now_lanes[l]) begin
          trace_pixel_state(32'(now_addr) * LANES + l, now_kind, 64'(now_z[l*Z_BITS+:Z_BITS]), 64'(held(
                            now_color[l*LaneRgbBits+:LaneRgbBits], now_kind == KindTp || now_kind == CmdLoad)),
                            full[l*PixelBits+:PixelBits]);
        end
      end
    end
  end

endmodule

bind pixel_banked pixel_banked_monitor #(
    .LANES(LANES),
    .ADDR_BITS(AddrBits),
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (
    .group_valid(valid[Last]),
    .*
);

`default_nettype wire
