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
/* verilator lint_off UNUSEDSIGNAL */  // a command's count has other bits for each kind

// Whether the blender darkens: a RESOLVE where the pixels do it themselves.
function automatic logic pixel_darkens(input logic [KindBits-1:0] kind);
  pixel_darkens = COUNT_BITS == 0 && LINEAR_BITS == 0 && kind == KindResolve;
endfunction

// The share of a command as the blender takes it: TP's alpha, or the part of a colour that RESOLVE leaves, 1 - shade.
function automatic logic [ShareBits-1:0] pixel_weight(input logic [KindBits-1:0] kind,
                                                      input logic [ShareBits-1:0] share);
  pixel_weight = pixel_darkens(kind) ? ShareBits'(WholeShare) - share : share;
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
                                                     input logic [LaneRgbBits-1:0] over);
  logic [AddedOne-1:0] sum;
  begin
    pixel_added = '0;
    sum = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      sum = AddedOne'(over[c*LaneLevelBits+LaneLevelBits-8+:8]) * AddedOne'({alpha, alpha}) + AddedOne'(257 * 128);
      if (pixel_darkens(kind)) sum = AddedOne'(32768);
      if (TRANSLUCENCY > 0) pixel_added[c*AddedOne+:AddedOne] = sum;
    end
  end
endfunction
function automatic logic [PixelRgbBits-1:0] pixel_blend(input logic [PixelRgbBits-1:0] under,
                                                        input logic [KeepBits-1:0] keep,
                                                        input logic [AddedBits-1:0] added);
  logic [AddedOne-1:0] sum;
  begin
    pixel_blend = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      sum = AddedOne'(under[c*PixelLevelBits+:8]) * AddedOne'(keep) + added[c*AddedOne+:AddedOne];
      pixel_blend[c*PixelLevelBits+:8] = 8'(sum >> 16);
    end
  end
endfunction

// Light after light (LINEAR_BITS > 0): the light of a CmdLight is added to what a pixel has, as much of it as samples
// are left. Each channel is level x (samples - count) / 2^COUNT_BITS, rounded to the nearest, halves up; the sum is at
// most all ones. Without counters all of the light comes, or nothing. `count` is the command's: {samples, or without
// counters bias, pass}.
localparam int PassAt = LINEAR_BITS > 0 ? 1 : 0;  // of samples or bias
localparam int PassRest = LINEAR_BITS > 0 ? PassBits - 1 : 1;  // bits of these
localparam int LightSumBits = LaneLevelBits + TallyOne + 1;
function automatic logic [PixelRgbBits-1:0] pixel_add(input logic [PixelBits-1:0] pixel,
                                                      input logic [LaneRgbBits-1:0] color,
                                                      input logic [CountBits-1:0] count);
  logic [LightSumBits-1:0] sum;
  logic [TallyOne-1:0] all, gone, left;
  begin
    all = COUNT_BITS > 0 ? TallyOne'(count[PassAt+:PassRest]) : TallyOne'(1);
    gone = COUNT_BITS > 0 ? pixel[PixelCountsAt+:TallyOne] : TallyOne'(pixel_shadow(pixel, DsfBits'(count[PassAt+:PassRest])));
    left = gone < all ? all - gone : '0;
    pixel_add = '0;
    sum = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      sum = LightSumBits'(color[c*LaneLevelBits+:LaneLevelBits]) * LightSumBits'(left);
      if (COUNT_BITS > 0) sum = (sum + (LightSumBits'(1) << (TallyOne - 1))) >> COUNT_BITS;
      sum = sum + LightSumBits'(pixel[PixelColorAt+c*PixelLevelBits+:PixelLevelBits]);
      pixel_add[c*PixelLevelBits+:PixelLevelBits] = sum >> PixelLevelBits != '0 ? '1 : PixelLevelBits'(sum);
    end
  end
endfunction

// A span's colour at a pixel as the pixel holds it: the light from everywhere, without the bits that parts of a light
// have. `displayed`: one that comes back from the way out has 8 bits a channel, the highest.
function automatic logic [PixelRgbBits-1:0] pixel_color(input logic [LaneRgbBits-1:0] color, input logic displayed);
  begin
    pixel_color = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      pixel_color[c*PixelLevelBits+:PixelLevelBits] = displayed ?
          PixelLevelBits'(color[c*LaneLevelBits+LaneLevelBits-8+:8]) :
          color[c*LaneLevelBits+LaneLevelBits-PixelLevelBits+:PixelLevelBits];
    end
  end
endfunction

// The other way round: a colour of the tree, as a span has it at a pixel.
function automatic logic [LaneRgbBits-1:0] lane_color_of(input logic [PixelRgbBits-1:0] color);
  begin
    lane_color_of = '0;
    for (int c = 0; c < CHANNELS; c++) begin
      lane_color_of[c*LaneLevelBits+LaneLevelBits-PixelLevelBits+:PixelLevelBits] =
          color[c*PixelLevelBits+:PixelLevelBits];
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

// Whether a command brings a light to what is drawn.
function automatic logic pixel_lights(input logic [KindBits-1:0] kind);
  pixel_lights = LINEAR_BITS > 0 && kind == CmdLight;
endfunction

// Whether a span, or the tree, with depth `z` is in front of what a pixel has; on a tie the first one drawn stays. A
// light, `lights`, comes to what has its depth, too.
function automatic logic pixel_in_front(input logic [Z_BITS-1:0] z, input logic [Z_BITS-1:0] drawn, input logic lights);
  if (LINEAR_BITS > 0) pixel_in_front = {z, 1'b0} < {drawn, lights};
  else pixel_in_front = z < drawn;
endfunction

// Whether a light comes to the pixel in front of which it is: no span of its pass has been there.
function automatic logic pixel_unserved(input logic [PixelBits-1:0] pixel, input logic pass);
  pixel_unserved = LINEAR_BITS > 0 && pixel[PixelServedAt] != pass;
endfunction

// Next state of a pixel in the range of a token. Inputs with a long way are found ahead: `opaque` by pixel_opaque,
// `in_front` by pixel_in_front. Blended colours come last, by pixel_blends and pixel_blend. `z` and `color` are the
// span's at this pixel, or the tree's; RESOLVE has the background. `count` is the class for OP and TREE, w for SP and
// NC, the line's bias for EV and RESOLVE, {light, bias} for ES; for CmdLight see pixel_add. RESOLVE comes only where TPs follow; otherwise line_out
// darkens. With counters RESOLVE darkens nothing: CmdOut sends a line with something to darken to line_out, and CmdLoad
// brings its colours back. EOL clears.
function automatic logic [PixelBits-1:0] pixel_next(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                                    input logic opaque, input logic in_front,
                                                    input logic [Z_BITS-1:0] z, input logic [LaneRgbBits-1:0] color,
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
      if (HasLoads && COUNT_BITS > 0) begin
        for (int l = 0; l < LIGHTS; l++) pixel_next[PixelCountsAt+l*TallyOne+:TallyOne] = '0;
      end
      CmdLoad: if (HasLoads) pixel_next[PixelColorAt+:PixelRgbBits] = pixel_color(color, 1'b1);
      CmdLight:
      if (LINEAR_BITS > 0 && in_front && pixel_unserved(pixel, count[0])) begin
        pixel_next[PixelServedAt] = count[0];
        pixel_next[PixelDsfAt+:DsfBits] = '0;
        if (FSF > 0) pixel_next[PixelFsfAt] = 1'b0;
        if (COUNT_BITS > 0) pixel_next[PixelCountsAt+:TallyOne] = '0;
      end
      KindResolve:
      if (TRANSLUCENCY > 0) begin
        if (clear) pixel_next[PixelColorAt+:PixelRgbBits] = pixel_color(color, 1'b1);
        if (DSF_BITS > 0) pixel_next[PixelDsfAt+:DsfBits] = '0;
        if (FSF > 0) pixel_next[PixelFsfAt] = 1'b0;
      end
      KindEol: pixel_next = PixelClear;
      default: pixel_next = pixel;
    endcase
    if (opaque && in_front) begin
      pixel_next[PixelZAt+:Z_BITS] = z;
      pixel_next[PixelColorAt+:PixelRgbBits] = pixel_color(color, 1'b0);
      if (ClassBits > 0) pixel_next[PixelClassAt+:CLASS_BITS] = count[CLASS_BITS-1:0];
      if (LINEAR_BITS > 0) pixel_next[PixelServedAt] = 1'b0;
    end
  end
endfunction

// Whether a token in whose range a pixel is gives it pixel_mixed's colour: TP in front of it, RESOLVE where it darkens,
// a light that comes to it. `count` is as pixel_next has it.
function automatic logic pixel_mixes(input logic [PixelBits-1:0] pixel, input logic [KindBits-1:0] kind,
                                     input logic in_front, input logic [CountBits-1:0] count);
  logic clear, dark;
  begin
    clear = pixel[PixelZAt+:Z_BITS] == ClearDepth;
    dark = ClassBits > 0 && pixel_darkens(kind) && pixel_shadow(pixel, count[DsfBits-1:0]) && pixel[PixelClassAt];
    pixel_mixes = TRANSLUCENCY > 0 && (kind == KindTp ? in_front : !clear && dark);
    if (pixel_lights(kind)) pixel_mixes = in_front && pixel_unserved(pixel, count[0]);
  end
endfunction

// The colour that it gives.
/* verilator lint_off UNUSEDPARAM */
localparam bit Mixes = TRANSLUCENCY > 0 || LINEAR_BITS > 0;  // some token does
/* verilator lint_on UNUSEDPARAM */
function automatic logic [PixelRgbBits-1:0] pixel_mixed(input logic [PixelBits-1:0] pixel,
                                                        input logic [KindBits-1:0] kind,
                                                        input logic [LaneRgbBits-1:0] color,
                                                        input logic [CountBits-1:0] count,
                                                        input logic [KeepBits-1:0] keep,
                                                        input logic [AddedBits-1:0] added);
  begin
    pixel_mixed = pixel_blend(pixel[PixelColorAt+:PixelRgbBits], keep, added);
    if (LINEAR_BITS > 0 && (TRANSLUCENCY == 0 || pixel_lights(kind))) pixel_mixed = pixel_add(pixel, color, count);
  end
endfunction

// A pixel's result at the end of its line, a word of ExitBits; its counts are 0 where the class is. `bias` is the
// line's.
function automatic logic [ExitBits-1:0] pixel_exit(input logic [PixelBits-1:0] pixel, input logic [DsfBits-1:0] bias);
  begin
    pixel_exit = '0;
    pixel_exit[ExitColorAt+:PixelRgbBits] = pixel[PixelColorAt+:PixelRgbBits];
    pixel_exit[ExitCoveredAt] = pixel[PixelZAt+:Z_BITS] != ClearDepth;
    if (ExitTallyBits > 0) begin
      if (HasTable) pixel_exit[ExitClassAt+:CLASS_BITS] = pixel[PixelClassAt+:CLASS_BITS];
      for (int l = 0; l < LIGHTS; l++) begin
        if (pixel[PixelClassAt+:CLASS_BITS] != '0) begin
          pixel_exit[ExitCountsAt+l*TallyOne+:TallyOne] = pixel[PixelCountsAt+l*TallyOne+:TallyOne];
        end
      end
    end else if (DarkBits > 0) begin
      pixel_exit[ExitDarkAt] = pixel[PixelClassAt] && pixel_shadow(pixel, bias);
    end
  end
endfunction
/* verilator lint_on UNUSEDSIGNAL */
