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

localparam int BlendBits = SHADE_FRAC > 8 ? SHADE_FRAC + 8 : 16;  // all sums are taken modulo 2^BlendBits and come out right
// A colour with a share of another: of TP `over` with alpha / 255, of RESOLVE (resolve = 1) black with shade / 2^SHADE_FRAC; rounded
// once. There is one product a channel: share x (over - under), or share x under.
function automatic logic [RgbBits-1:0] pixel_blend(input logic [RgbBits-1:0] under, input logic [RgbBits-1:0] over,
                                                   input logic [ShareBits-1:0] share, input logic resolve);
  logic signed [8:0] factor;
  logic [BlendBits-1:0] product;
  logic [15:0] mixed;
  begin
    {factor, product, mixed} = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      factor = resolve ? 9'({1'b0, under[c*8+:8]}) : 9'({1'b0, over[c*8+:8]}) - 9'({1'b0, under[c*8+:8]});
      product = BlendBits'(factor) * BlendBits'({1'b0, share});
      // 255 under + product + 128 lies in 128 .. 65153. Its own 1/256 added, a division by 256 is one by 255, rounded.
      mixed = {under[c*8+:8], 8'd128} - 16'(under[c*8+:8]) + 16'(product);
      mixed = mixed + (mixed >> 8);
      if (resolve) begin
        pixel_blend[c*8+:8] = 8'(((BlendBits'(under[c*8+:8]) << SHADE_FRAC) + BlendBits'(1 << (SHADE_FRAC - 1)) - product) >> SHADE_FRAC);
      end else begin
        pixel_blend[c*8+:8] = mixed[15:8];
      end
    end
  end
endfunction

// Whether a pixel is in shadow, with the line's bias. A line that has shadow flags is resolved before they are asked for (frame_control
// sees to it), and one that has none has no flags set.
function automatic logic pixel_shadow(input logic [PixelBits-1:0] pixel, input logic [CountBits-1:0] bias);
  pixel_shadow = FSF > 0 ? pixel[PixelFsfAt] : (pixel[PixelDsfAt+:CountBits] + bias) != '0;
endfunction

// Next state of a pixel in the range of a token. `z` and `color` are the span's at this pixel, or the tree's, of RESOLVE the
// background; `count` is the lit bit for OP and TREE, w for SP and NC, the line's bias for EV and RESOLVE; `share` is TP's alpha
// and RESOLVE's shade. RESOLVE comes only where TPs follow: else the way out darkens. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [3:0] kind,
                                                    input logic [Z_BITS-1:0] z, input logic [RgbBits-1:0] color,
                                                    input logic [CountBits-1:0] count,
                                                    input logic [ShareBits-1:0] share);
  logic in_front, clear, dark;
  logic [CountBits-1:0] sum;
  logic [  RgbBits-1:0] blended;
  begin
    in_front = z < pixel[Z_BITS-1:0];
    clear = pixel[Z_BITS-1:0] == {Z_BITS{1'b1}};
    sum = pixel[PixelDsfAt+:CountBits] + count;
    dark = DSF_BITS > 0 && pixel[PixelLitAt] && pixel_shadow(pixel, count);
    blended = '0;
    if (TRANSLUCENCY > 0) blended = pixel_blend(pixel[Z_BITS+:RgbBits], color, share, kind == KindResolve);
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
      KindTp:  if (TRANSLUCENCY > 0 && in_front) pixel_next[Z_BITS+:RgbBits] = blended;
      KindResolve:
      if (TRANSLUCENCY > 0) begin
        if (clear) pixel_next[Z_BITS+:RgbBits] = color;
        else if (dark) pixel_next[Z_BITS+:RgbBits] = blended;
        if (DSF_BITS > 0) pixel_next[PixelDsfAt+:CountBits] = '0;
        if (FSF > 0) pixel_next[PixelFsfAt] = 1'b0;
      end
      KindEol: pixel_next = PixelClear;
      default: pixel_next = pixel;
    endcase
  end
endfunction

// What leaves a pixel at the end of its line: {dark, covered, colour}, without dark in a core without shadows. `bias` is the
// line's.
function automatic logic [ExitBits-1:0] pixel_exit(input logic [PixelBits-1:0] pixel, input logic [CountBits-1:0] bias);
  begin
    pixel_exit = '0;
    pixel_exit[RgbBits-1:0] = pixel[Z_BITS+:RgbBits];
    pixel_exit[RgbBits] = pixel[Z_BITS-1:0] != {Z_BITS{1'b1}};
    if (DSF_BITS > 0) pixel_exit[ExitBits-1] = pixel[PixelLitAt] && pixel_shadow(pixel, bias);
  end
endfunction
