// SPDX-License-Identifier: Apache-2.0
// Where colours come back to the pixels: the commands of frame_control, and between them a line's colours from the way
// out, a command CmdLoad of one pixel each.
//
// Handshake: in_*, load_* and out_* are valid/ready. Loads go first; frame_control gives no command from its CmdOut
//   until done_o, one clock, says that the line's last load has been taken, so neither side ever waits for the other.
// Latency: 0. Throughput: a command a clock.
// Cost: the choice of a command's kind, range, colour and slope. Without counters or without translucency wires only.
`default_nettype none

module pixel_loads #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam logic [SlopeBits-1:0] Flat = '0
) (
    input  wire logic                   in_valid_i,
    output logic                        in_ready_o,
    input  wire logic [CommandBits-1:0] in_i,

    input  wire logic                load_valid_i,
    output logic                     load_ready_o,
    input  wire logic [LoadBits-1:0] load_i,
    output logic                     done_o,

    output logic                        out_valid_o,
    input  wire logic                   out_ready_i,
    output logic      [CommandBits-1:0] out_o
);
  `include "generated/kage_buses.svh"

  // A load, and what goes on to the pixels.
  load_t load;
  command_t out;
  assign load  = load_i;
  assign out_o = out;

  if (HasLoads) begin : gen_loads
    // The colour, and as a span has it. Icarus Verilog takes no parts of a struct's field by a variable.
    logic [  RgbBits-1:0] rgb;
    logic [ColorBits-1:0] color;
    assign rgb = load.color;
    assign in_ready_o = out_ready_i && !load_valid_i;
    assign load_ready_o = out_ready_i;
    assign done_o = load_valid_i && load_ready_o && load.last;
    assign out_valid_o = in_valid_i || load_valid_i;
    always_comb begin
      for (int c = 0; c < CHANNELS; c++) color[c*RampBits+:RampBits] = RampBits'(rgb[c*8+:8]) << COLOR_FRAC;
      out = in_i;
      if (load_valid_i) begin
        out.kind = CmdLoad;
        out.xl = load.x;
        out.xr = load.x + 1'b1;
        out.color = color;
        out.dcolor = Flat;
      end
    end
  end else begin : gen_none
    logic unused_load;
    assign unused_load = ^{load_valid_i, load};
    assign {load_ready_o, done_o} = '0;
    assign in_ready_o = out_ready_i;
    assign out_valid_o = in_valid_i;
    assign out = in_i;
  end

endmodule

`default_nettype wire
