// SPDX-License-Identifier: Apache-2.0
// The pixels that leave the core of pixels and those that come back to it, as events (rtl/defs/stages.yaml).
// Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_pixels_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int EXIT_LANES = 4
) (
    input wire logic                           clk_i,
    input wire logic                           rst_ni,
    input wire logic                           exit_free,
    input wire logic                           exit_take,
    input wire logic                           exit_valid,
    input wire logic                           exit_last,
    input wire logic [EXIT_LANES*ExitBits-1:0] exit_data,
    input wire logic                           load_valid,
    input wire logic                           load_ready,
    input wire logic [           LoadBits-1:0] load
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  // The load that comes back; its event needs no end of line.
  load_t back;
  logic  unused_last;
  assign back = load;
  assign unused_last = back.last;

  localparam int CountersBits = ExitTallyBits > 0 ? ExitTallyBits : 1;
  function automatic void trace_leaving(input logic last, input logic [ExitBits-1:0] pixel);
    trace_exit(32'(last), 64'(pixel[ExitColorAt+:PixelRgbBits]), 64'(pixel[ExitCoveredAt]),
               DarkBits > 0 ? 64'(pixel[ExitDarkAt]) : 64'd0, HasTable ? 64'(pixel[ExitClassAt+:CLASS_BITS]) : 64'd0,
               ExitTallyBits > 0 ? 64'(pixel[ExitCountsAt+:CountersBits]) : 64'd0);
  endfunction

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      trace_module(PartPixels, 512'(exit_take && exit_free), 512'(exit_take));
      if (exit_valid) begin
        for (int l = 0; l < EXIT_LANES; l++) begin
          trace_leaving(exit_last && l == EXIT_LANES - 1, exit_data[l*ExitBits+:ExitBits]);
        end
      end
      if (load_valid && load_ready) begin
        trace_load(0, 64'(back.x), 64'(back.color));
      end
    end
  end

endmodule

bind kage_top kage_top_pixels_monitor #(
    .EXIT_LANES(ExitLanes),
    `include "generated/kage_pixel_param_map.svh"
) u_pixels_monitor (.*);

`default_nettype wire
