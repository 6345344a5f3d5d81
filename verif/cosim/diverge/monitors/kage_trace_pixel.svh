// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor that has the pixel parameters and the places of a pixel's fields: tells what a command did
// to pixel x. `z` and `color` are what came to it; all ones where the monitor cannot see them.
localparam int TraceTallyBits = COUNT_BITS > 0 ? TallyBits : 1;

function automatic void trace_pixel_state(input int x, input logic [3:0] kind, input logic [63:0] z,
                                          input logic [63:0] color, input logic [PIXEL_BITS-1:0] pixel);
  trace_pixel(x, 64'(kind), z, color, 64'(pixel[Z_BITS-1:0]), 64'(pixel[Z_BITS+:RgbBits]),
              DSF_BITS > 0 ? 64'(pixel[CLASS_AT+:CLASS_BITS]) : 64'd0,
              DSF_BITS > 0 ? 64'(pixel[DSF_AT+:DsfBits]) : 64'd0, FSF > 0 ? 64'(pixel[FSF_AT]) : 64'd0,
              COUNT_BITS > 0 ? 64'(pixel[COUNT_AT+:TraceTallyBits]) : 64'd0);
endfunction
