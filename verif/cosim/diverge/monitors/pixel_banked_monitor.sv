// SPDX-License-Identifier: Apache-2.0
// Effect of each command on each pixel of its range, as events (rtl/defs/stages.yaml), where pixels are in block RAM.
`default_nettype none

module pixel_banked_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int LANES = 4,
    parameter int ADDR_BITS = 8
) (
    input wire logic                       clk_i,
    input wire logic                       rst_ni,
    input wire logic                       group_valid,
    input wire logic [       KindBits-1:0] now_kind,
    input wire logic [          LANES-1:0] now_lanes,
    input wire logic [      ADDR_BITS-1:0] now_addr,
    input wire logic [   LANES*Z_BITS-1:0] now_z,
    input wire logic [  LANES*RgbBits-1:0] now_color,
    input wire logic [LANES*PixelBits-1:0] next,
    input wire logic [          LANES-1:0] blends,
    input wire logic [  LANES*RgbBits-1:0] blended
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "kage_trace_pixel.svh"

  // The next state with its colour, which the core chooses a clock later where it is blended.
  logic [LANES*PixelBits-1:0] full;
  always_comb begin
    full = next;
    for (int l = 0; l < LANES; l++) begin
      if (blends[l]) full[l*PixelBits+PixelColorAt+:RgbBits] = blended[l*RgbBits+:RgbBits];
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && group_valid && now_kind != KindEol && now_kind != CmdOut) begin
      for (int l = 0; l < LANES; l++) begin
        if (now_lanes[l]) begin
          trace_pixel_state(32'(now_addr) * LANES + l, now_kind, 64'(now_z[l*Z_BITS+:Z_BITS]),
                            64'(now_color[l*RgbBits+:RgbBits]), full[l*PixelBits+:PixelBits]);
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
