// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor that has the pixel parameters and the places of a pixel's fields: the values of StagePixel. `z` and
// `color` are what came to the pixel; all ones where the monitor cannot see them.
localparam int TraceTallyBits = COUNT_BITS > 0 ? TallyBits : 1;

function automatic logic [TraceBits-1:0] trace_pixel(input logic [3:0] kind, input logic [63:0] z,
                                                     input logic [63:0] color, input logic [PIXEL_BITS-1:0] pixel);
  trace_pixel = TraceBits'({
      COUNT_BITS > 0 ? 64'(pixel[COUNT_AT+:TraceTallyBits]) : 64'd0,
      FSF > 0 ? 64'(pixel[FSF_AT]) : 64'd0,
      DSF_BITS > 0 ? 64'(pixel[DSF_AT+:DsfBits]) : 64'd0,
      DSF_BITS > 0 ? 64'(pixel[CLASS_AT+:CLASS_BITS]) : 64'd0,
      64'(pixel[Z_BITS+:RgbBits]), 64'(pixel[Z_BITS-1:0]), color, z, 64'(kind)
  });
endfunction
