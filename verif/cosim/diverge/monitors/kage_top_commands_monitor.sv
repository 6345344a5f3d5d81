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
    input wire logic                   clk_i,
    input wire logic                   rst_ni,
    input wire logic                   cmd_valid,
    input wire logic                   cmd_ready,
    input wire logic [CommandBits-1:0] cmd,
    input wire logic                   pixel_valid,
    input wire logic                   pixel_ready,
    input wire logic [CommandBits-1:0] pixel_cmd,
    input wire logic                   line_valid,
    input wire logic                   line_ready,
    input wire logic [   LineBits-1:0] line
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  // A channel of a span's colour, and of its slope, as far as there are so many.
  function automatic logic [63:0] ramp(input logic [ColorBits-1:0] color, input int channel);
    ramp = channel < CHANNELS ? 64'(color[(channel<CHANNELS?channel : 0)*RampBits+:RampBits]) : '0;
  endfunction
  logic [ColorBits-1:0] dcolor;
  command_t taken;
  line_t told;
  assign taken  = pixel_cmd;
  assign told   = line;
  assign dcolor = SMOOTH > 0 ? ColorBits'(taken.dcolor) : '0;

  // A command that waits stays.
  logic waits_q;
  logic [CommandBits-1:0] cmd_q;

  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni && cmd_valid && !cmd_ready;
    cmd_q   <= cmd;
    if (rst_ni) begin
      if (waits_q) trace_module(PartTokenCommand, 512'({1'b1, cmd_q}), 512'({cmd_valid, cmd}));
      if (line_valid && line_ready) begin
        trace_line(0, 64'(told.first), 64'(told.blank), 64'(told.load), 64'(told.painted), 64'(told.width),
                   64'(told.background), 64'(told.shade));
      end
      if (pixel_valid && pixel_ready) begin
        trace_command(0, 64'(taken.kind), 64'(taken.xl), 64'(taken.xr), 64'(taken.count), 64'(taken.z), 64'(taken.dz),
                      64'(taken.share), {ramp(taken.color, 2), ramp(taken.color, 1), ramp(taken.color, 0)}, {
                      ramp(dcolor, 2), ramp(dcolor, 1), ramp(dcolor, 0)});
      end
    end
  end

endmodule

bind kage_top kage_top_commands_monitor #(
    `include "generated/kage_impl_param_map.svh"
    `include "generated/kage_pixel_param_map.svh"
) u_commands_monitor (.*);

`default_nettype wire
