// SPDX-License-Identifier: Apache-2.0
// Effect of each command on each pixel of its range, as events (rtl/defs/stages.yaml), where every pixel has a
// processor.
`default_nettype none

module pixel_systolic_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int PIXELS = 64
) (
    input wire logic                           clk_i,
    input wire logic                           rst_ni,
    input wire logic [             PIXELS-1:0] hit_q,
    input wire logic [(PIXELS+1)*KindBits-1:0] kind_q,
    input wire logic [   PIXELS*PixelBits-1:0] pixel_d
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "kage_trace_pixel.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      for (int i = 0; i < PIXELS; i++) begin
        if (hit_q[i] && kind_q[(i+1)*KindBits+:KindBits] != KindEol && kind_q[(i+1)*KindBits+:KindBits] != CmdOut) begin
          trace_pixel_state(i, kind_q[(i+1)*KindBits+:KindBits], '1, '1, pixel_d[i*PixelBits+:PixelBits]);
        end
      end
    end
  end

endmodule

bind pixel_systolic pixel_systolic_monitor #(
    .PIXELS(N),
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

`default_nettype wire
