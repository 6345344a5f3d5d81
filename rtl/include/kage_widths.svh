// SPDX-License-Identifier: Apache-2.0
// Part of a module's parameter list, right after kage_pixel_params.svh: the widths of the buses between modules. A bus whose
// feature is absent keeps one bit, tied to 0, because SystemVerilog has no vectors without bits.
/* verilator lint_off UNUSEDPARAM */
localparam int DepthBits = Z_BITS + Z_FRAC + 2,  // depth accumulator
localparam int RampBits = SMOOTH > 0 ? 10 + COLOR_FRAC : 8,  // one channel of a span's colour
localparam int ColorBits = CHANNELS * RampBits,
localparam int SlopeBits = SMOOTH > 0 ? ColorBits : 1,
localparam int CountBits = DSF_BITS > 0 ? DSF_BITS : 1,  // shadow counter, bias, or the lit bit of OP
localparam int RgbBits = 8 * CHANNELS,  // one pixel's colour
localparam int ExitBits = RgbBits + (DSF_BITS > 0 ? 2 : 1),  // a pixel that leaves: {dark, covered, colour}
/* verilator lint_on UNUSEDPARAM */
