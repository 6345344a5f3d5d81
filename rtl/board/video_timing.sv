// SPDX-License-Identifier: Apache-2.0
// The counters of a video mode, in its pixel clock: where on the screen the beam is, and the two syncs.
//
// Handshake: none; a pixel a clock, for ever. After reset comes the first pixel of a frame.
// A line is H_ACTIVE pixels, front porch, sync, back porch; a frame is made of lines in the same way. Output vsync_o
// changes where the hsync pulse of a line begins, as the standards of progressive modes have it. The syncs are high in
// their pulse if H_POSITIVE or V_POSITIVE is 1, else low. Places x_o and y_o count on in blanking. Output frame_start_o
// is high for the frame's first pixel, blank_start_o for the first pixel of the first line that is not seen.
// Latency: all outputs are registers and belong to the same pixel. Throughput: a pixel a clock.
// Cost: 640x480: 26 flip-flops, 61 LUTs of four inputs.
`default_nettype none
`include "kage_illegal.svh"

module video_timing #(
    parameter  int H_ACTIVE   = 640,
    parameter  int H_FRONT    = 16,
    parameter  int H_SYNC     = 96,
    parameter  int H_BACK     = 48,
    parameter  int V_ACTIVE   = 480,
    parameter  int V_FRONT    = 10,
    parameter  int V_SYNC     = 2,
    parameter  int V_BACK     = 33,
    parameter  int H_POSITIVE = 0,
    parameter  int V_POSITIVE = 0,
    localparam int XBits      = $clog2(H_ACTIVE + H_FRONT + H_SYNC + H_BACK),
    localparam int YBits      = $clog2(V_ACTIVE + V_FRONT + V_SYNC + V_BACK)
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    output logic             active_o,
    output logic             hsync_o,
    output logic             vsync_o,
    output logic [XBits-1:0] x_o,
    output logic [YBits-1:0] y_o,
    output logic             frame_start_o,
    output logic             blank_start_o
);
  if (H_ACTIVE < 2 || H_FRONT < 1 || H_SYNC < 1 || H_BACK < 1) begin : gen_bad_line
    `KAGE_ILLEGAL("a line has two pixels or more, and no porch or sync is 0")
  end
  if (V_ACTIVE < 2 || V_FRONT < 1 || V_SYNC < 1 || V_BACK < 1) begin : gen_bad_frame
    `KAGE_ILLEGAL("a frame has two lines or more, and no porch or sync is 0")
  end
  if (H_POSITIVE < 0 || H_POSITIVE > 1 || V_POSITIVE < 0 || V_POSITIVE > 1) begin : gen_bad_polarity
    `KAGE_ILLEGAL("H_POSITIVE and V_POSITIVE are 0 or 1")
  end

  localparam int SyncX = H_ACTIVE + H_FRONT;
  localparam int SyncY = V_ACTIVE + V_FRONT;
  localparam logic [XBits-1:0] LastX = XBits'(SyncX + H_SYNC + H_BACK - 1);
  localparam logic [YBits-1:0] LastY = YBits'(SyncY + V_SYNC + V_BACK - 1);
  localparam logic HPulse = H_POSITIVE[0];
  localparam logic VPulse = V_POSITIVE[0];

  logic [XBits-1:0] x_q;
  logic [YBits-1:0] y_q;
  logic h_active_q, v_active_q, hsync_q, vsync_q, frame_start_q, blank_start_q, line_end, frame_end, last_line;

  assign line_end      = x_q == LastX;
  assign frame_end     = line_end && y_q == LastY;
  assign last_line     = y_q == YBits'(V_ACTIVE - 1);
  assign active_o      = h_active_q && v_active_q;
  assign hsync_o       = hsync_q;
  assign vsync_o       = vsync_q;
  assign x_o           = x_q;
  assign y_o           = y_q;
  assign frame_start_o = frame_start_q;
  assign blank_start_o = blank_start_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      x_q           <= LastX;
      y_q           <= LastY;
      h_active_q    <= 1'b0;
      v_active_q    <= 1'b0;
      hsync_q       <= !HPulse;
      vsync_q       <= !VPulse;
      frame_start_q <= 1'b0;
      blank_start_q <= 1'b0;
    end else begin
      x_q <= line_end ? '0 : x_q + 1'b1;
      if (line_end) y_q <= frame_end ? '0 : y_q + 1'b1;

      // Each is set and cleared at one place, so that nothing but equality is compared.
      if (line_end) h_active_q <= 1'b1;
      else if (x_q == XBits'(H_ACTIVE - 1)) h_active_q <= 1'b0;
      if (frame_end) v_active_q <= 1'b1;
      else if (line_end && last_line) v_active_q <= 1'b0;
      if (x_q == XBits'(SyncX + H_SYNC - 1)) hsync_q <= !HPulse;
      else if (x_q == XBits'(SyncX - 1)) begin
        hsync_q <= HPulse;
        if (y_q == YBits'(SyncY - 1)) vsync_q <= VPulse;
        else if (y_q == YBits'(SyncY + V_SYNC - 1)) vsync_q <= !VPulse;
      end
      frame_start_q <= frame_end;
      blank_start_q <= line_end && last_line;
    end
  end

endmodule

`default_nettype wire
