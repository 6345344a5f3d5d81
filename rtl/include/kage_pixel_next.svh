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

// The share of a command as pixel_blend takes it: TP's alpha; of RESOLVE what is left of a colour, 1 - shade. It is
// worked out long before its use, because pixel_blend is the slowest part of the pixels' loop.
function automatic logic [ShareBits-1:0] pixel_weight(input logic [KindBits-1:0] kind,
                                                      input logic [ShareBits-1:0] share);
  pixel_weight = COUNT_BITS == 0 && kind == KindResolve ? ShareBits'(WholeShare) - share : share;
endfunction

localparam int BlendBits = SHADE_FRAC > 8 ? SHADE_FRAC + 8 : 16;
// A colour with a share of another: of TP `over` with alpha / 255, of RESOLVE (resolve = 1) black with shade /
// 2^SHADE_FRAC; rounded once. Only the product with `under` waits for the command before; the one with `over` is a
// multiplier of its own so that it need not.
function automatic logic [RgbBits-1:0] pixel_blend(input logic [RgbBits-1:0] under, input logic [RgbBits-1:0] over,
                                                   input logic [ShareBits-1:0] weight, input logic resolve);
  logic [7:0] alpha;
  logic [ShareBits-1:0] keep;
  logic [BlendBits-1:0] added, sum;
  begin
    {added, sum} = '0;
    alpha = 8'(weight);
    keep = resolve ? weight : ShareBits'({1'b0, 8'd255 - alpha});
    for (int c = 0; c < CHANNELS; c++) begin
      added = BlendBits'(over[c*8+:8]) * BlendBits'(alpha) + BlendBits'(128);
      if (resolve) added = BlendBits'(HalfShare);
      // At most 255 x 255 + 128 or (255 x 2^SHADE_FRAC) + 2^(SHADE_FRAC - 1): it fits.
      sum = BlendBits'(under[c*8+:8]) * BlendBits'(keep) + added;
      // Its own 1/256 added, a division by 256 is one by 255, rounded.
      if (resolve) pixel_blend[c*8+:8] = 8'(sum >> SHADE_FRAC);
      else pixel_blend[c*8+:8] = 8'((sum + (sum >> 8)) >> 8);
    end
  end
endfunction

// Whether a pixel is in shadow, with the line's bias. A line that has shadow flags is resolved before they are asked
// for (frame_control sees to it), and one that has none has no flags set.
function automatic logic pixel_shadow(input logic [PixelBits-1:0] pixel, input logic [DsfBits-1:0] bias);
  pixel_shadow = FSF > 0 ? pixel[PixelFsfAt] : (pixel[PixelDsfAt+:DsfBits] + bias) != '0;
endfunction

// Whether a token does what OP does; TREE does.
function automatic logic pixel_opaque(input logic [KindBits-1:0] kind);
  pixel_opaque = kind == KindOp || (UNITS > 0 && kind == KindTree);
endfunction

// Next state of a pixel in the range of a token. `opaque` is pixel_opaque's of its kind, found a clock ahead, since
// what the depth comparison says has the longest way. `z` and `color` are the span's at this pixel, or the tree's, of
// RESOLVE the background; `count` is the class for OP and TREE, w for SP and NC, the line's bias for EV and RESOLVE,
// {light, bias} for ES; `weight` is pixel_weight's, of TP and RESOLVE. RESOLVE reaches the pixels only where TPs follow;
// otherwise line_out darkens. With counters RESOLVE darkens nothing: where there is something to darken CmdOut sends
// the line to line_out and CmdLoad brings its colours back. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                                    input logic opaque, input logic [Z_BITS-1:0] z,
                                                    input logic [RgbBits-1:0] color,
                                                    input logic [CountBits-1:0] count,
                                                    input logic [ShareBits-1:0] weight);
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
      blended = pixel_blend(pixel[PixelColorAt+:RgbBits], color, weight, COUNT_BITS == 0 && kind == KindResolve);
    end
    pixel_next = pixel;
    unique case (kind)
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
    if (opaque && in_front) begin
      pixel_next[PixelZAt+:Z_BITS] = z;
      pixel_next[PixelColorAt+:RgbBits] = color;
      if (DSF_BITS > 0) pixel_next[PixelClassAt+:CLASS_BITS] = count[CLASS_BITS-1:0];
    end
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
