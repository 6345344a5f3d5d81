// SPDX-License-Identifier: Apache-2.0
// pixel_loads from its ports alone, by the nets of kage_top (it has no clock): a load is a command of one pixel, and
// goes before the command that comes in.
`default_nettype none

module pixel_loads_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int KindBits = 4
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 cmd_valid,
    input wire logic                 cmd_ready,
    input wire logic [ KindBits-1:0] cmd_kind,
    input wire logic [   X_BITS-1:0] cmd_xl,
    input wire logic [   X_BITS-1:0] cmd_xr,
    input wire logic [ColorBits-1:0] cmd_color,
    input wire logic [SlopeBits-1:0] cmd_dcolor,
    input wire logic                 load_valid,
    input wire logic                 load_ready,
    input wire logic [   X_BITS-1:0] load_x,
    input wire logic [  RgbBits-1:0] load_color,
    input wire logic                 load_last,
    input wire logic                 loads_done,
    input wire logic                 pixel_valid,
    input wire logic                 pixel_ready,
    input wire logic [ KindBits-1:0] pixel_kind,
    input wire logic [   X_BITS-1:0] pixel_xl,
    input wire logic [   X_BITS-1:0] pixel_xr,
    input wire logic [ColorBits-1:0] pixel_color,
    input wire logic [SlopeBits-1:0] pixel_dcolor
);
  `include "kage_trace.svh"

  localparam bit HasLoads = TRANSLUCENCY > 0 && COUNT_BITS > 0;
  localparam int CommandBits = KindBits + 2 * X_BITS + ColorBits + SlopeBits;
  logic load;
  logic [ColorBits-1:0] color;
  logic [CommandBits-1:0] command;
  assign load = HasLoads && load_valid;
  always_comb begin
    color = '0;
    for (int c = 0; c < CHANNELS; c++) color[c*RampBits+:RampBits] = RampBits'(load_color[c*8+:8]) << COLOR_FRAC;
    command = {cmd_kind, cmd_xl, cmd_xr, cmd_color, cmd_dcolor};
    if (load) command = {CmdLoad, load_x, X_BITS'(load_x + 1'b1), color, SlopeBits'(0)};
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      trace_module(
          PartPixelLoads, {
          508'd0, cmd_valid || load, pixel_ready && !load, HasLoads && pixel_ready, load && load_last && pixel_ready}, {
          508'd0, pixel_valid, cmd_ready, load_ready, loads_done});
      if (cmd_valid || load) begin
        trace_module(PartPixelLoads, 512'(command), 512'({pixel_kind, pixel_xl, pixel_xr, pixel_color, pixel_dcolor}));
      end
    end
  end

endmodule

bind kage_top pixel_loads_monitor #(
    .X_BITS(X_BITS),
    .CHANNELS(CHANNELS),
    .SMOOTH(SMOOTH),
    .COLOR_FRAC(COLOR_FRAC),
    .COUNT_BITS(COUNT_BITS),
    .TRANSLUCENCY(TRANSLUCENCY)
) u_loads_monitor (.*);

`default_nettype wire
