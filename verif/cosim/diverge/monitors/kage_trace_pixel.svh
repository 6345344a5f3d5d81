// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor that has the pixel parameters and kage_widths.svh: tells what a command did to pixel x. `z`
// and `color` are what came to it; all ones where the monitor cannot see them.
localparam int TraceTallyBits = COUNT_BITS > 0 ? TallyBits : 1;

function automatic void trace_pixel_state(input int x, input logic [KindBits-1:0] kind, input logic [63:0] z,
                                          input logic [63:0] color, input logic [PixelBits-1:0] pixel);
  trace_pixel(x, 64'(kind), z, color, 64'(pixel[PixelZAt+:Z_BITS]), 64'(pixel[PixelColorAt+:PixelRgbBits]),
              ClassBits > 0 ? 64'(pixel[PixelClassAt+:CLASS_BITS]) : 64'd0,
              DSF_BITS > 0 ? 64'(pixel[PixelDsfAt+:DsfBits]) : 64'd0, FSF > 0 ? 64'(pixel[PixelFsfAt]) : 64'd0,
              COUNT_BITS > 0 ? 64'(pixel[PixelCountsAt+:TraceTallyBits]) : 64'd0,
              LINEAR_BITS > 0 ? 64'(pixel[PixelServedAt]) : 64'd0);
endfunction
