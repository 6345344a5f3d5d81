// SPDX-License-Identifier: Apache-2.0
// Included inside a module that has the pixel parameters, kage_widths.svh and kage_layout.svh.
//
// The effect of a token on one pixel: the RTL defines it only here. Both arrangements loop over these functions.
//
// A pixel's state is one word, PixelBits of kage_widths.svh. No struct of it: a field that the configuration lacks has
// no bits, and yosys 0.23 takes no struct in a function.
/* verilator lint_off UNUSEDPARAM */
localparam int TallyOne = COUNT_BITS > 0 ? COUNT_BITS : 1;  // one counter
localparam logic [PixelBits-1:0] PixelClear = PixelBits'(ClearDepth);
/* verilator lint_on UNUSEDPARAM */

// The share of a command as the blender takes it: TP's alpha, or the part of a colour that RESOLVE leaves, 1 - shade.
function automatic logic [ShareBits-1:0] pixel_weight(input logic [KindBits-1:0] kind,
                                                      input logic [ShareBits-1:0] share);
  pixel_weight = COUNT_BITS == 0 && kind == KindResolve ? ShareBits'(WholeShare) - share : share;
endfunction

// The blender: a colour with a share of another. TP blends `over` with alpha / 255, RESOLVE black with shade /
// 2^SHADE_FRAC; rounded once. Only the product with the old colour and one sum wait for the command before. All else is
// worked out ahead of them: `keep`, the part of the old colour that stays, in 1/65536, and `added`.
//   TP: with t = old x (255 - alpha) + over x alpha + 128 the colour is 257 t / 65536, rounded down, for any t here. So
//   both weights are multiplied by 257 beforehand: `keep` is 255 - alpha twice, one behind the other.
//   RESOLVE: (old x (1 - shade) + half of a share) / 2^SHADE_FRAC, all of it times 2^(16 - SHADE_FRAC).
// Less than 2^24: 255 x 65536 + 32768 at most, or 257 x (255 x 255 + 128).
localparam int KeepBits = 17;
localparam int AddedOne = 24;  // of one channel
localparam int AddedBits = CHANNELS * AddedOne;
function automatic logic pixel_darkens(input logic [KindBits-1:0] kind);
  pixel_darkens = COUNT_BITS == 0 && kind == KindResolve;
endfunction
function automatic logic [KeepBits-1:0] pixel_keep(input logic [KindBits-1:0] kind,
                                                   input logic [ShareBits-1:0] weight);
  logic [7:0] alpha;
  begin
    alpha = 8'(weight);
    if (TRANSLUCENCY == 0) pixel_keep = '0;
    else if (pixel_darkens(kind)) pixel_keep = KeepBits'(weight) << (16 - SHADE_FRAC);
    else pixel_keep = {1'b0, ~alpha, ~alpha};
  end
endfunction
function automatic logic [AddedBits-1:0] pixel_added(input logic [KindBits-1:0] kind,
                                                     input logic [7:0] alpha,
                                                     input logic [RgbBits-1:0] over);
  logic [AddedOne-1:0] sum;
  begin
    pixel_added = '0;
    sum = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      sum = AddedOne'(over[c*8+:8]) * AddedOne'({alpha, alpha}) + AddedOne'(257 * 128);
      if (pixel_darkens(kind)) sum = AddedOne'(32768);
      if (TRANSLUCENCY > 0) pixel_added[c*AddedOne+:AddedOne] = sum;
    end
  end
endfunction
function automatic logic [RgbBits-1:0] pixel_blend(input logic [RgbBits-1:0] under, input logic [KeepBits-1:0] keep,
                                                   input logic [AddedBits-1:0] added);
  logic [AddedOne-1:0] sum;
  begin
    for (int c = 0; c < CHANNELS; c++) begin
      sum = AddedOne'(under[c*8+:8]) * AddedOne'(keep) + added[c*AddedOne+:AddedOne];
      pixel_blend[c*8+:8] = 8'(sum >> 16);
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

// Whether a span, or the tree, with depth `z` is in front of what a pixel has; on a tie the first one drawn stays.
function automatic logic pixel_in_front(input logic [Z_BITS-1:0] z, input logic [Z_BITS-1:0] drawn);
  pixel_in_front = z < drawn;
endfunction

// Next state of a pixel in the range of a token. Inputs with a long way are found ahead: `opaque` by pixel_opaque,
// `in_front` by pixel_in_front. Blended colours come last, by pixel_blends and pixel_blend. `z` and `color` are the
// span's at this pixel, or the tree's; RESOLVE has the background. `count` is the class for OP and TREE, w for SP and
// NC, the line's bias for EV and RESOLVE, {light, bias} for ES. RESOLVE comes only where TPs follow; otherwise line_out
// darkens. With counters RESOLVE darkens nothing: CmdOut sends a line with something to darken to line_out, and CmdLoad
// brings its colours back. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                                    input logic opaque, input logic in_front,
                                                    input logic [Z_BITS-1:0] z, input logic [RgbBits-1:0] color,
                                                    input logic [CountBits-1:0] count);
  logic clear, shadow;
  logic [DsfBits-1:0] sum;
  begin
    clear = pixel[PixelZAt+:Z_BITS] == ClearDepth;
    sum = pixel[PixelDsfAt+:DsfBits] + count[DsfBits-1:0];
    shadow = DSF_BITS > 0 && pixel_shadow(pixel, count[DsfBits-1:0]);
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
      KindResolve:
      if (TRANSLUCENCY > 0) begin
        if (clear) pixel_next[PixelColorAt+:RgbBits] = color;
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

// Whether a token in whose range a pixel is gives it pixel_blend's colour: TP in front of it, RESOLVE where it darkens.
// `bias` is the line's.
function automatic logic pixel_blends(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                      input logic in_front, input logic [DsfBits-1:0] bias);
  logic clear, dark;
  begin
    clear = pixel[PixelZAt+:Z_BITS] == ClearDepth;
    dark = DSF_BITS > 0 && COUNT_BITS == 0 && pixel_shadow(pixel, bias) && pixel[PixelClassAt];
    pixel_blends = TRANSLUCENCY > 0 && (kind == KindTp ? in_front : kind == KindResolve && !clear && dark);
  end
endfunction

// A pixel's result at the end of its line, a word of ExitBits; its counts are 0 where the class is. `bias` is the
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
