// SPDX-License-Identifier: Apache-2.0
// The commands to the pixels, and lines to the way out, as events (rtl/defs/stages.yaml).
// Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_commands_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 cmd_valid,
    input wire logic                 cmd_ready,
    input wire logic [          3:0] cmd_kind,
    input wire logic [   X_BITS-1:0] cmd_xl,
    input wire logic [   X_BITS-1:0] cmd_xr,
    input wire logic                 pixel_valid,
    input wire logic                 pixel_ready,
    input wire logic [          3:0] pixel_kind,
    input wire logic [   X_BITS-1:0] pixel_xl,
    input wire logic [   X_BITS-1:0] pixel_xr,
    input wire logic [ColorBits-1:0] pixel_color,
    input wire logic [SlopeBits-1:0] pixel_dcolor,
    input wire logic [CountBits-1:0] cmd_count,
    input wire logic [DepthBits-1:0] cmd_z,
    input wire logic [DepthBits-1:0] cmd_dz,
    input wire logic [ShareBits-1:0] cmd_share,
    input wire logic                 line_valid,
    input wire logic                 line_ready,
    input wire logic                 line_first,
    input wire logic                 line_blank,
    input wire logic                 line_load,
    input wire logic                 line_painted,
    input wire logic [   X_BITS-1:0] line_width,
    input wire logic [  RgbBits-1:0] line_background,
    input wire logic [ SHADE_FRAC:0] line_shade
);
  `include "kage_trace.svh"

  // A channel of a span's colour, and of its slope, as far as there are so many.
  function automatic logic [63:0] ramp(input logic [ColorBits-1:0] color, input int channel);
    ramp = channel < CHANNELS ? 64'(color[(channel<CHANNELS?channel : 0)*RampBits+:RampBits]) : '0;
  endfunction
  logic [ColorBits-1:0] dcolor;
  assign dcolor = SMOOTH > 0 ? ColorBits'(pixel_dcolor) : '0;

  // What of a command must not change while it waits.
  localparam int FixedBits = 4 + 2 * X_BITS + 2 * DepthBits + CountBits;
  logic waits_q;
  logic [FixedBits-1:0] fixed, fixed_q;
  assign fixed = {cmd_kind, cmd_xl, cmd_xr, cmd_z, cmd_dz, cmd_count};

  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni && cmd_valid && !cmd_ready;
    fixed_q <= fixed;
    if (rst_ni) begin
      if (waits_q) trace_module(PartTokenCommand, 512'({1'b1, fixed_q}), 512'({cmd_valid, fixed}));
      if (line_valid && line_ready) begin
        trace_line(0, 64'(line_first), 64'(line_blank), 64'(line_load), 64'(line_painted), 64'(line_width),
                   64'(line_background), 64'(line_shade));
      end
      if (pixel_valid && pixel_ready) begin
        trace_command(0, 64'(pixel_kind), 64'(pixel_xl), 64'(pixel_xr), 64'(cmd_count), 64'(cmd_z), 64'(cmd_dz),
                      64'(cmd_share), {ramp(pixel_color, 2), ramp(pixel_color, 1), ramp(pixel_color, 0)}, {
                      ramp(dcolor, 2), ramp(dcolor, 1), ramp(dcolor, 0)});
      end
    end
  end

endmodule

bind kage_top kage_top_commands_monitor #(
    `include "generated/kage_pixel_param_map.svh"
    `include "generated/kage_impl_param_map.svh"
) u_commands_monitor (.*);

`default_nettype wire
