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
    localparam int KindBits = 4
) (
    input  wire logic                 in_valid_i,
    output logic                      in_ready_o,
    input  wire logic [ KindBits-1:0] in_kind_i,
    input  wire logic [   X_BITS-1:0] in_xl_i,
    input  wire logic [   X_BITS-1:0] in_xr_i,
    input  wire logic [ColorBits-1:0] in_color_i,
    input  wire logic [SlopeBits-1:0] in_dcolor_i,

    input  wire logic               load_valid_i,
    output logic                    load_ready_o,
    input  wire logic [ X_BITS-1:0] load_x_i,
    input  wire logic [RgbBits-1:0] load_color_i,
    input  wire logic               load_last_i,
    output logic                    done_o,

    output logic                      out_valid_o,
    input  wire logic                 out_ready_i,
    output logic      [ KindBits-1:0] out_kind_o,
    output logic      [   X_BITS-1:0] out_xl_o,
    output logic      [   X_BITS-1:0] out_xr_o,
    output logic      [ColorBits-1:0] out_color_o,
    output logic      [SlopeBits-1:0] out_dcolor_o
);

  if (TRANSLUCENCY > 0 && COUNT_BITS > 0) begin : gen_loads
    assign in_ready_o   = out_ready_i && !load_valid_i;
    assign load_ready_o = out_ready_i;
    assign done_o       = load_valid_i && load_ready_o && load_last_i;
    assign out_valid_o  = in_valid_i || load_valid_i;
    always_comb begin
      out_kind_o = in_kind_i;
      out_xl_o = in_xl_i;
      out_xr_o = in_xr_i;
      out_color_o = in_color_i;
      out_dcolor_o = in_dcolor_i;
      if (load_valid_i) begin
        out_kind_o = CmdLoad;
        out_xl_o   = load_x_i;
        out_xr_o   = load_x_i + 1'b1;
        for (int c = 0; c < CHANNELS; c++)
        out_color_o[c*RampBits+:RampBits] = RampBits'(load_color_i[c*8+:8]) << COLOR_FRAC;
        out_dcolor_o = '0;
      end
    end
  end else begin : gen_none
    logic unused_load;
    assign unused_load = ^{load_valid_i, load_x_i, load_color_i, load_last_i};
    assign {load_ready_o, done_o} = '0;
    assign in_ready_o = out_ready_i;
    assign out_valid_o = in_valid_i;
    assign out_kind_o = in_kind_i;
    assign out_xl_o = in_xl_i;
    assign out_xr_o = in_xr_i;
    assign out_color_o = in_color_i;
    assign out_dcolor_o = in_dcolor_i;
  end

endmodule

`default_nettype wire
