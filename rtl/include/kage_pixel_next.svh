// SPDX-License-Identifier: Apache-2.0
// Included inside a module that has the pixel parameters, kage_widths.svh and kage_layout.svh.
//
// What a token does to one pixel: the only place in the RTL that says so. Both arrangements loop over these functions.
//
// A pixel's state is one word, ZB lowest, then colour, then lit, DSF and FSF as far as the configuration has them.
/* verilator lint_off UNUSEDPARAM */
localparam int PixelLitBits = DSF_BITS > 0 ? 1 : 0;
localparam int PixelBits = Z_BITS + RgbBits + PixelLitBits + DSF_BITS + FSF;
// Places of the optional fields; 0, and never read, when they are absent.
localparam int PixelLitAt = DSF_BITS > 0 ? Z_BITS + RgbBits : 0;
localparam int PixelDsfAt = DSF_BITS > 0 ? PixelLitAt + 1 : 0;
localparam int PixelFsfAt = FSF > 0 ? PixelDsfAt + DSF_BITS : 0;
localparam logic [PixelBits-1:0] PixelClear = {{(PixelBits - Z_BITS) {1'b0}}, {Z_BITS{1'b1}}};
/* verilator lint_on UNUSEDPARAM */

// Next state of a pixel in the range of a token. `z` and `color` are the span's at this pixel, or the tree's; `count` is the lit bit
// for OP and TREE, w for SP and NC, the line's bias for EV. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [3:0] kind,
                                                    input logic [Z_BITS-1:0] z, input logic [RgbBits-1:0] color,
                                                    input logic [CountBits-1:0] count);
  logic in_front;
  logic [CountBits-1:0] sum;
  begin
    in_front = z < pixel[Z_BITS-1:0];
    sum = pixel[PixelDsfAt+:CountBits] + count;
    pixel_next = pixel;
    // TREE does what OP does.
    unique case (UNITS > 0 && kind == KindTree ? KindOp : kind)
      KindOp:
      if (in_front) begin
        pixel_next[Z_BITS-1:0] = z;
        pixel_next[Z_BITS+:RgbBits] = color;
        if (DSF_BITS > 0) pixel_next[PixelLitAt] = count[0];
      end
      KindSp:  if (DSF_BITS > 0 && in_front) pixel_next[PixelDsfAt+:CountBits] = sum;
      KindNc:  if (DSF_BITS > 0) pixel_next[PixelDsfAt+:CountBits] = sum;
      KindEv:
      if (FSF > 0) begin
        if (sum != '0) pixel_next[PixelFsfAt] = 1'b1;
        pixel_next[PixelDsfAt+:CountBits] = '0;
      end
      KindEol: pixel_next = PixelClear;
      default: pixel_next = pixel;
    endcase
  end
endfunction

// What leaves a pixel at the end of its line: {dark, covered, colour}, without dark in a core without shadows. `bias` is the
// line's. A line that has shadow flags has been resolved (frame_control sees to it), and a line that has not been resolved has
// no flags set, so this reads them without asking.
function automatic logic [ExitBits-1:0] pixel_exit(input logic [PixelBits-1:0] pixel, input logic [CountBits-1:0] bias);
  logic shadow;
  begin
    pixel_exit = '0;
    pixel_exit[RgbBits-1:0] = pixel[Z_BITS+:RgbBits];
    pixel_exit[RgbBits] = pixel[Z_BITS-1:0] != {Z_BITS{1'b1}};
    shadow = FSF > 0 ? pixel[PixelFsfAt] : (pixel[PixelDsfAt+:CountBits] + bias) != '0;
    if (DSF_BITS > 0) pixel_exit[ExitBits-1] = shadow && pixel[PixelLitAt];
  end
endfunction
