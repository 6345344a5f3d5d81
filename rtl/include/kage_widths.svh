// SPDX-License-Identifier: Apache-2.0
// Part of a module's parameter list, right after kage_pixel_params.svh: the widths of the buses between modules. A bus whose
// feature is absent keeps one bit, tied to 0, because SystemVerilog has no vectors without bits.
/* verilator lint_off UNUSEDPARAM */
localparam int DepthBits = Z_BITS + Z_FRAC + 2,  // depth accumulator
localparam int RampBits = SMOOTH > 0 ? 10 + COLOR_FRAC : 8,  // one channel of a span's colour
localparam int ColorBits = CHANNELS * RampBits,
localparam int SlopeBits = SMOOTH > 0 ? ColorBits : 1,
localparam int DsfBits = DSF_BITS > 0 ? DSF_BITS : 1,  // shadow counter, bias
localparam int ClassBits = DSF_BITS > 0 ? CLASS_BITS : 0,  // the class of a pixel, a face, and the tree's pixel
localparam int LightBits = LIGHTS > 2 ? $clog2(LIGHTS) : 1,  // a light's number
localparam int LightAt = FSF > 0 ? 0 : DsfBits,  // ES's light in its command's count; below it, without FSF, the bias
localparam int SampleEndBits = LIGHTS > 1 ? LightAt + LightBits : 1,
localparam int PlainCountBits = DsfBits > CLASS_BITS ? DsfBits : CLASS_BITS,
localparam int CountBits = PlainCountBits > SampleEndBits ? PlainCountBits : SampleEndBits,  // a command's count: w, bias, class, or of ES {light, bias}
localparam int ShareBits = TRANSLUCENCY == 0 ? 1 : COUNT_BITS == 0 && SHADE_FRAC > 7 ? SHADE_FRAC + 1 : 8,  // TP's alpha, or RESOLVE's shade
localparam int RgbBits = 8 * CHANNELS,  // one pixel's colour
localparam int TallyBits = LIGHTS * COUNT_BITS,  // a pixel's counters
// A pixel that leaves: {dark, covered, colour}, or with counters {counts, class, covered, colour}, where the class is a table's only.
localparam int ExitClassAt = CLASS_BITS > 1 ? RgbBits + 1 : 0,
localparam int ExitCountAt = COUNT_BITS == 0 ? 0 : RgbBits + 1 + (CLASS_BITS > 1 ? CLASS_BITS : 0),
localparam int ExitBits = DSF_BITS == 0 ? RgbBits + 1 : COUNT_BITS == 0 ? RgbBits + 2 : ExitCountAt + TallyBits,
localparam int EntryShareBits = CHANNELS * (SHADE_FRAC + 1),  // an entry of the light table
localparam int LightStages = COUNT_BITS == 0 ? 0 : CLASS_BITS > 1 ? 5 : 2,  // clocks of light_resolve
// Commands without token, by kinds that never become commands: a line's pixels leave but stay, and a pixel that comes back.
localparam logic [3:0] CmdLoad = 4'd1,
localparam logic [3:0] CmdOut = 4'd2,
localparam int UnitBits = UNITS > 2 ? $clog2(UNITS) : 1,  // an expansion unit's number
localparam int EntryBits = ORDER_BITS + ClassBits + DepthBits + RgbBits,  // {colour, dz, class, index}, as FACE has them
localparam int KeyBits = Z_BITS + ORDER_BITS,  // what the compare tree compares: {Z, index}
localparam int PointBits = KeyBits + RgbBits + ClassBits,  // a pixel in the compare tree: {Z, index, colour, class}
/* verilator lint_on UNUSEDPARAM */
