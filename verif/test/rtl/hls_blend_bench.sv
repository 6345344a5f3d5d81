// SPDX-License-Identifier: Apache-2.0
// The blender of kage_pixel_next.svh and the kernel pixel_blend, as hls/tool makes it for KERNEL's configuration, of
// the same pixel, span and share: one channel.
`default_nettype none

module hls_blend_bench #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int ChannelBits = 8
) (
`ifdef MUTANTS
    input wire logic [15:0] mutant_i,
`endif
    input wire logic darkens_i,  // RESOLVE, else TP
    input wire logic [ChannelBits-1:0] under_i,
    input wire logic [ChannelBits-1:0] over_i,
    input wire logic [ShareBits-1:0] share_i,
    output logic [ChannelBits-1:0] rtl_o,
    output logic [ChannelBits-1:0] kernel_o
);
  `include "generated/kage_layout.svh"
  `include "kage_pixel_next.svh"

  logic [ KindBits-1:0] kind;
  logic [ShareBits-1:0] weight;
  assign kind   = darkens_i ? KindResolve : KindTp;
  assign weight = pixel_weight(kind, share_i);
  assign rtl_o  = pixel_blend(under_i, pixel_keep(kind, weight), pixel_added(kind, 8'(weight), over_i));

  `KERNEL dut (
`ifdef MUTANTS
      .mutant_i,
`endif
      .under_i,
      .over_i,
      .share_i,
      .darkens_i,
      .color_o(kernel_o)
  );
endmodule

`default_nettype wire
