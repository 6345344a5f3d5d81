// SPDX-License-Identifier: Apache-2.0
// The kernel pixel_next, as hls/tool makes it without stages, is what the RTL has in kage_pixel_next.svh: whatever the
// pixel, the command and the span are. The blender's product is cut out: `blended` is any colour on both sides. The
// generated module is KERNEL; its arrays are ports with their first element lowest.
`default_nettype none

module pixel_next_proof #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int CountOne = COUNT_BITS > 0 ? COUNT_BITS : 1
) (
    input wire logic [PixelBits-1:0] pixel,
    input wire logic [KindBits-1:0] kind,
    input wire logic [Z_BITS-1:0] z,
    input wire logic [RgbBits-1:0] color,
    input wire logic [RgbBits-1:0] blended,
    input wire logic [CountBits-1:0] count
);
  `include "generated/kage_layout.svh"
  `include "kage_pixel_next.svh"

  // ---- the RTL's ----------------------------------------------------------------------------------------------------
  logic opaque, in_front, mixes;
  logic [PixelBits-1:0] plain, next;
  always_comb begin
    opaque = pixel_opaque(kind);
    in_front = pixel_in_front(z, pixel[PixelZAt+:Z_BITS], pixel_lights(kind));
    mixes = pixel_mixes(pixel, kind, in_front, count);
    plain = pixel_next(pixel, kind, opaque, in_front, z, color, count);
    next = plain;
    if (mixes) next[PixelColorAt+:RgbBits] = blended;
  end

  // ---- the kernel's -------------------------------------------------------------------------------------------------
  logic [CLASS_BITS-1:0] own_class;
  logic [DsfBits-1:0] own_dsf;
  logic own_fsf;
  logic [LIGHTS*CountOne-1:0] own_count;
  logic [2:0] light;
  assign own_class = DSF_BITS > 0 ? pixel[PixelClassAt+:CLASS_BITS] : '0;
  assign own_dsf = DSF_BITS > 0 ? pixel[PixelDsfAt+:DsfBits] : '0;
  assign own_fsf = FSF > 0 ? pixel[PixelFsfAt] : '0;
  assign own_count = COUNT_BITS > 0 ? pixel[PixelCountsAt+:LIGHTS*CountOne] : '0;
  assign light = LIGHTS > 1 ? 3'(count[(LIGHTS>1?LightAt : 0)+:(LIGHTS>1?LightBits : 1)]) : '0;

  logic [Z_BITS-1:0] z_o;
  logic [RgbBits-1:0] color_o;
  logic [CLASS_BITS-1:0] class_o;
  logic [DsfBits-1:0] dsf_o;
  logic fsf_o;
  logic [LIGHTS*CountOne-1:0] count_o;
  `KERNEL dut (
      .pixel_z_i(pixel[PixelZAt+:Z_BITS]),
      .pixel_color_i(pixel[PixelColorAt+:RgbBits]),
      .pixel_lit_class_i(own_class),
      .pixel_dsf_i(own_dsf),
      .pixel_fsf_i(own_fsf),
      .pixel_count_i(own_count),
      .kind_i(kind),
      .z_i(z),
      .color_i(color),
      .blended_i(blended),
      .lit_class_i(count[CLASS_BITS-1:0]),
      .change_i(count[DsfBits-1:0]),
      .light_i(light),
      .z_o(z_o),
      .color_o(color_o),
      .lit_class_o(class_o),
      .dsf_o(dsf_o),
      .fsf_o(fsf_o),
      .count_o(count_o)
  );

  // A field that the configuration lacks has a bit that stays 0.
  always_comb begin
    same_z : assert (z_o == next[PixelZAt+:Z_BITS]);
    same_color : assert (color_o == next[PixelColorAt+:RgbBits]);
    same_class : assert (class_o == (DSF_BITS > 0 ? next[PixelClassAt+:CLASS_BITS] : '0));
    same_dsf : assert (dsf_o == (DSF_BITS > 0 ? next[PixelDsfAt+:DsfBits] : '0));
    same_fsf : assert (fsf_o == (FSF > 0 ? next[PixelFsfAt] : '0));
    same_count : assert (count_o == (COUNT_BITS > 0 ? next[PixelCountsAt+:LIGHTS*CountOne] : '0));
  end
endmodule

`default_nettype wire
