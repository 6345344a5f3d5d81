// SPDX-License-Identifier: Apache-2.0
// The facts of a token by itself, whatever came before it; token_stage and token_check judge what depends on the frame.
//
// Question: token_i as it comes into token_stage. Answer: facts_o as facts_t. head_error is for headers only, bad_range
//   and empty for tokens of a body only.
// Latency: 0. Throughput: a token a clock.
// Cost: comparators of 32, 32, 16 and 16 bits with constants, two of X_BITS, one of SHADE_FRAC + 1 bits, one of a
//   light's number.
`default_nettype none

module token_facts #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int MAX_WIDTH   = 640,
    parameter int TOKEN_WORDS = 5,
    parameter int POLYGONS    = 0   // frames at the polygon level are good too
) (
    input  wire logic [TOKEN_WORDS*32-1:0] token_i,
    output logic      [     FactsBits-1:0] facts_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

facts_t facts;
  assign facts_o = facts;

  logic unused_token;
  assign unused_token = ^token_i;  // longer than what is looked at

  logic [HeaderVersionBits-1:0] head_version;
  logic [HeaderMagicBits-1:0] head_magic;
  logic [HeaderWidthBits-1:0] head_width;
  logic [HeaderHeightBits-1:0] head_height;
  logic [KindBits-1:0] kind;
  logic [X_BITS-1:0] xl, xr;
  assign head_version = token_i[HeaderVersionLsb+:HeaderVersionBits];
  assign head_magic = token_i[HeaderMagicLsb+:HeaderMagicBits];
  assign head_width = token_i[HeaderWidthLsb+:HeaderWidthBits];
  assign head_height = token_i[HeaderHeightLsb+:HeaderHeightBits];
  assign kind = token_i[KindBits-1:0];
  assign xl = token_i[RangeXlLsb+:X_BITS];
  assign xr = token_i[RangeXrLsb+:X_BITS];
  always_comb begin
    // a header
    if (head_version != HeaderVersionBits'(StreamVersion) &&
        !(POLYGONS > 0 && head_version == HeaderVersionBits'(PolygonVersion)))
      facts.head_error = ErrHeader;
    else if (head_magic != HeaderMagicBits'(StreamMagic)) facts.head_error = ErrHeader;
    else if (head_width == '0 || head_width > HeaderWidthBits'(MAX_WIDTH)) facts.head_error = ErrSize;
    else if (head_height == '0 || head_height > HeaderHeightBits'(MaxHeight)) facts.head_error = ErrSize;
    else if (token_i[HeaderParamHashLsb+:32] != ParamHash) facts.head_error = ErrParams;
    else facts.head_error = ErrNone;
    // a token of the body
    facts.empty = xl == xr;
    facts.bad_range = kind_has_range(kind) && xl > xr;
    if (COUNT_BITS > 0 && kind == KindEs && 32'(token_i[EsLightLsb+:LightBits]) >= 32'(LIGHTS)) facts.bad_range = 1'b1;
    if (kind == KindShade && token_i[ShadeShadeLsb+:FactorBits] > WholeShare) facts.bad_range = 1'b1;
  end

endmodule

`default_nettype wire
