// SPDX-License-Identifier: Apache-2.0
// Part of a module's parameter list, right after kage_pixel_params.svh: the widths of the buses between modules. A bus whose
// feature is absent keeps one bit, tied to 0, because SystemVerilog has no vectors without bits.
/* verilator lint_off UNUSEDPARAM */
localparam int DepthBits = Z_BITS + Z_FRAC + 2,  // depth accumulator
localparam int RampBits = SMOOTH > 0 ? 10 + COLOR_FRAC : 8,  // one channel of a span's colour
localparam int ColorBits = CHANNELS * RampBits,
localparam int SlopeBits = SMOOTH > 0 ? ColorBits : 1,
localparam int CountBits = DSF_BITS > 0 ? DSF_BITS : 1,  // shadow counter, bias, or the lit bit of OP
localparam int ShareBits = TRANSLUCENCY == 0 ? 1 : SHADE_FRAC > 7 ? SHADE_FRAC + 1 : 8,  // TP's alpha, or RESOLVE's shade
localparam int RgbBits = 8 * CHANNELS,  // one pixel's colour
localparam int ExitBits = RgbBits + (DSF_BITS > 0 ? 2 : 1),  // a pixel that leaves: {dark, covered, colour}
localparam int LitBits = DSF_BITS > 0 ? 1 : 0,  // the lit bit of a face and of the tree's pixel
localparam int UnitBits = UNITS > 2 ? $clog2(UNITS) : 1,  // an expansion unit's number
localparam int EntryBits = ORDER_BITS + LitBits + DepthBits + RgbBits,  // {colour, dz, lit, index}, as FACE has them
localparam int KeyBits = Z_BITS + ORDER_BITS,  // what the compare tree compares: {Z, index}
localparam int PointBits = KeyBits + RgbBits + LitBits,  // a pixel in the compare tree: {Z, index, colour, lit}
/* verilator lint_on UNUSEDPARAM */
