// SPDX-License-Identifier: Apache-2.0
// Included inside a module that has the pixel parameters, kage_widths.svh and kage_layout.svh.
//
// What a token does to one pixel: the only place in the RTL that says so. Both arrangements loop over these functions.
//
// A pixel's state is one word, PixelBits of kage_widths.svh. No struct of it: a field that the configuration lacks has
// no bits, and yosys 0.23 takes no struct in a function.
/* verilator lint_off UNUSEDPARAM */
localparam int TallyOne = COUNT_BITS > 0 ? COUNT_BITS : 1;  // one counter
localparam logic [PixelBits-1:0] PixelClear = PixelBits'(ClearDepth);
/* verilator lint_on UNUSEDPARAM */

// All sums are taken modulo 2^BlendBits and come out right.
localparam int BlendBits = SHADE_FRAC > 8 ? SHADE_FRAC + 8 : 16;
// A colour with a share of another: of TP `over` with alpha / 255, of RESOLVE (resolve = 1) black with shade /
// 2^SHADE_FRAC; rounded once. There is one product a channel: share x (over - under), or share x under.
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
        product = (BlendBits'(under[c*8+:8]) << SHADE_FRAC) + BlendBits'(HalfShare) - product;
        pixel_blend[c*8+:8] = 8'(product >> SHADE_FRAC);
      end else begin
        pixel_blend[c*8+:8] = mixed[15:8];
      end
    end
  end
endfunction

// Whether a pixel is in shadow, with the line's bias. A line that has shadow flags is resolved before they are asked
// for (frame_control sees to it), and one that has none has no flags set.
function automatic logic pixel_shadow(input logic [PixelBits-1:0] pixel, input logic [DsfBits-1:0] bias);
  pixel_shadow = FSF > 0 ? pixel[PixelFsfAt] : (pixel[PixelDsfAt+:DsfBits] + bias) != '0;
endfunction

// Next state of a pixel in the range of a token. `z` and `color` are the span's at this pixel, or the tree's, of
// RESOLVE the background; `count` is the class for OP and TREE, w for SP and NC, the line's bias for EV and RESOLVE,
// {light, bias} for ES; `share` is TP's alpha and RESOLVE's shade. RESOLVE reaches the pixels only where TPs follow;
// otherwise line_out darkens. With counters RESOLVE darkens nothing: where there is something to darken CmdOut sends
// the line to line_out and CmdLoad brings its colours back. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                                    input logic [Z_BITS-1:0] z, input logic [RgbBits-1:0] color,
                                                    input logic [CountBits-1:0] count,
                                                    input logic [ShareBits-1:0] share);
  logic in_front, clear, dark, shadow;
  logic [DsfBits-1:0] sum;
  logic [  RgbBits-1:0] blended;
  begin
    in_front = z < pixel[PixelZAt+:Z_BITS];
    clear = pixel[PixelZAt+:Z_BITS] == ClearDepth;
    sum = pixel[PixelDsfAt+:DsfBits] + count[DsfBits-1:0];
    shadow = DSF_BITS > 0 && pixel_shadow(pixel, count[DsfBits-1:0]);
    dark = COUNT_BITS == 0 && shadow && pixel[PixelClassAt];
    blended = '0;
    if (TRANSLUCENCY > 0) begin
      blended = pixel_blend(pixel[PixelColorAt+:RgbBits], color, share, COUNT_BITS == 0 && kind == KindResolve);
    end
    pixel_next = pixel;
    // TREE does what OP does.
    unique case (UNITS > 0 && kind == KindTree ? KindOp : kind)
      KindOp:
      if (in_front) begin
        pixel_next[PixelZAt+:Z_BITS] = z;
        pixel_next[PixelColorAt+:RgbBits] = color;
        if (DSF_BITS > 0) pixel_next[PixelClassAt+:CLASS_BITS] = count[CLASS_BITS-1:0];
      end
      KindSp:  if (DSF_BITS > 0 && in_front) pixel_next[PixelDsfAt+:DsfBits] = sum;
      KindNc:  if (DSF_BITS > 0) pixel_next[PixelDsfAt+:DsfBits] = sum;
      KindEv:
      if (FSF > 0) begin
        if (sum != '0) pixel_next[PixelFsfAt] = 1'b1;
        pixel_next[PixelDsfAt+:DsfBits] = '0;
      end
      KindEs:
      if (COUNT_BITS > 0) begin
        for (int l = 0; l < LIGHTS; l++) begin
          if (shadow && (LIGHTS == 1 || count[(LIGHTS>1?LightAt : 0)+:(LIGHTS>1?LightBits : 1)] == LightBits'(l)) &&
              !(&pixel[PixelCountsAt+l*TallyOne+:TallyOne])) begin
            pixel_next[PixelCountsAt+l*TallyOne+:TallyOne] = pixel[PixelCountsAt+l*TallyOne+:TallyOne] + 1'b1;
          end
        end
        if (FSF > 0) pixel_next[PixelFsfAt] = 1'b0;
        else pixel_next[PixelDsfAt+:DsfBits] = '0;
      end
      CmdOut:  // with counters nothing asks for DSF and FSF until EOL clears them
      if (HasLoads) begin
        for (int l = 0; l < LIGHTS; l++) pixel_next[PixelCountsAt+l*TallyOne+:TallyOne] = '0;
      end
      CmdLoad: if (HasLoads) pixel_next[PixelColorAt+:RgbBits] = color;
      KindTp:  if (TRANSLUCENCY > 0 && in_front) pixel_next[PixelColorAt+:RgbBits] = blended;
      KindResolve:
      if (TRANSLUCENCY > 0) begin
        if (clear) pixel_next[PixelColorAt+:RgbBits] = color;
        else if (dark) pixel_next[PixelColorAt+:RgbBits] = blended;
        if (DSF_BITS > 0) pixel_next[PixelDsfAt+:DsfBits] = '0;
        if (FSF > 0) pixel_next[PixelFsfAt] = 1'b0;
      end
      KindEol: pixel_next = PixelClear;
      default: pixel_next = pixel;
    endcase
  end
endfunction

// What leaves a pixel at the end of its line, a word of ExitBits; its counts are 0 where the class is. `bias` is the
// line's.
function automatic logic [ExitBits-1:0] pixel_exit(input logic [PixelBits-1:0] pixel, input logic [DsfBits-1:0] bias);
  begin
    pixel_exit = '0;
    pixel_exit[ExitColorAt+:RgbBits] = pixel[PixelColorAt+:RgbBits];
    pixel_exit[ExitCoveredAt] = pixel[PixelZAt+:Z_BITS] != ClearDepth;
    if (COUNT_BITS > 0) begin
      if (HasTable) pixel_exit[ExitClassAt+:CLASS_BITS] = pixel[PixelClassAt+:CLASS_BITS];
      for (int l = 0; l < LIGHTS; l++) begin
        if (pixel[PixelClassAt+:CLASS_BITS] != '0) begin
          pixel_exit[ExitCountsAt+l*TallyOne+:TallyOne] = pixel[PixelCountsAt+l*TallyOne+:TallyOne];
        end
      end
    end else if (DSF_BITS > 0) begin
      pixel_exit[ExitDarkAt] = pixel[PixelClassAt] && pixel_shadow(pixel, bias);
    end
  end
endfunction
