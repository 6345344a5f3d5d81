// SPDX-License-Identifier: Apache-2.0
// pixel_loads from its ports alone, by the nets of kage_top (it has no clock): a load is a command of one pixel, and
// goes before the command that comes in.
`default_nettype none

module pixel_loads_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam logic [SlopeBits-1:0] Flat = '0
) (
    input wire logic                   clk_i,
    input wire logic                   rst_ni,
    input wire logic                   cmd_valid,
    input wire logic                   cmd_ready,
    input wire logic [CommandBits-1:0] cmd,
    input wire logic                   load_valid,
    input wire logic                   load_ready,
    input wire logic [   LoadBits-1:0] load,
    input wire logic                   loads_done,
    input wire logic                   pixel_valid,
    input wire logic                   pixel_ready,
    input wire logic [CommandBits-1:0] pixel_cmd
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  logic goes;  // a load does
  load_t back;
  command_t command;
  assign back = load;
  assign goes = HasLoads && load_valid;
  always_comb begin
    command = cmd;
    if (goes) begin
      command.kind = CmdLoad;
      command.xl   = back.x;
      command.xr   = X_BITS'(back.x + 1'b1);
      for (int c = 0; c < CHANNELS; c++) begin
        command.color[c*RampBits+:RampBits] = RampBits'(back.color[c*8+:8]) << COLOR_FRAC;
      end
      command.dcolor = Flat;
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      trace_module(
          PartPixelLoads, {
          508'd0, cmd_valid || goes, pixel_ready && !goes, HasLoads && pixel_ready, goes && back.last && pixel_ready}, {
          508'd0, pixel_valid, cmd_ready, load_ready, loads_done});
      if (cmd_valid || goes) trace_module(PartPixelLoads, 512'(command), 512'(pixel_cmd));
    end
  end

endmodule

bind kage_top pixel_loads_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_loads_monitor (.*);

`default_nettype wire
