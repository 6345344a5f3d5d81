// SPDX-License-Identifier: Apache-2.0
// From the core's m_axis to a screen that waits for nobody. A FIFO of two lines (of the screen, or of WIDTH pixels if
// that is less) lies between the clocks. The module makes a video mode's timing, and chooses and counts what is shown
// when a pixel comes too late.
//
// Handshake: the port of pixels is AXI4-Stream video, valid/ready: TUSER on a frame's first pixel, TLAST on a line's
// last. Ready is the FIFO's free place and nothing else, so the core rests while the screen is in blanking. Requests
// leave by valid/ready in the core's clock.
// Request: one whenever vertical blanking begins and no frame's first pixel waits yet. Who feeds the core starts a
// frame for each, and remembers one while a frame is under way: a request that is repeated, because that frame is slow,
// only has the next frame begin early. A frame that brings no picture, because its header is refused, is so followed by
// another.
// Shown: a frame begins at the screen's first pixel, if its TUSER waits there; what comes before TUSER is dropped, and
// a TUSER waits for the next screen. The picture lies top left. Right of a line's TLAST and below the frame's last line
// (lines_i of them; the core's clock takes lines_i with TUSER) BORDER is shown. Pixels beyond the screen's right or
// lower edge are dropped. The rest of a wide line must pass, a pixel a clock, before the next line begins, or that one
// runs short.
// Underrun: where a pixel is not there in time, the last colour shown is repeated to the picture's right edge, which is
// that of the line that came whole last (at first the screen's). The pixels that come late are dropped, up to and with
// the line's TLAST; lines whose turn passes meanwhile are shown in that colour too, and are owed likewise. The first
// line that begins with nothing owed is shown again. Where the last line is late the pixel side has not seen that the
// frame ended, and the lines below are shown so too. A frame is late if none waits at the screen's first pixel, but one
// was shown before. The last colour then covers the place of the picture shown last (down to its last line that had a
// pixel in time), and the next screen tries again.
// Counted, in the core's clock, all modulo 2^16: frames_shown_o, screens that began a frame; late_frames_o, screens
// that had none to begin. Output underrun_frames_o counts late frames, and shown ones in which a line ran short. Output
// underrun_lines_o counts the lines that ran short in shown frames (late frames count none). They rise a few clocks
// after vertical blanking begins. Output led_o, in the pixel's clock, is high for 2^LED_BITS - 1 clocks after each line
// that ran short and each late frame.
// Before the first frame all is BORDER and nothing counts.
// Reset: at both sides at once, as async_fifo has it. A frame that it cuts is gone; the next TUSER begins the next.
// Latency: from the FIFO's output to rgb_o 2 clocks. Throughput: a pixel a clock of the slower side.
// Cost: 640x480: block RAM of 2,048 x 27 bits (3 blocks of an ECP5, 14 of an iCE40), 482 flip-flops, 525 LUTs of four
// inputs.
`default_nettype none
`include "kage_illegal.svh"

module video_out #(
    parameter int          CHANNELS   = 3,
    parameter int          H_ACTIVE   = 640,
    parameter int          WIDTH      = H_ACTIVE,    // of the picture at most: room for two lines
    parameter int          H_FRONT    = 16,
    parameter int          H_SYNC     = 96,
    parameter int          H_BACK     = 48,
    parameter int          V_ACTIVE   = 480,
    parameter int          V_FRONT    = 10,
    parameter int          V_SYNC     = 2,
    parameter int          V_BACK     = 33,
    parameter int          H_POSITIVE = 0,
    parameter int          V_POSITIVE = 0,
    // Red in bits 7..0, green in 15..8, blue in 23..16.
    parameter logic [23:0] BORDER     = 24'h402020,
    parameter int          LED_BITS   = 22
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic                  s_axis_tvalid_i,
    output logic                       s_axis_tready_o,
    input  wire logic [8*CHANNELS-1:0] s_axis_tdata_i,
    input  wire logic                  s_axis_tuser_i,
    input  wire logic                  s_axis_tlast_i,
    input  wire logic [          15:0] lines_i,

    output logic             frame_req_valid_o,
    input  wire logic        frame_req_ready_i,
    output logic      [15:0] frames_shown_o,
    output logic      [15:0] late_frames_o,
    output logic      [15:0] underrun_frames_o,
    output logic      [15:0] underrun_lines_o,

    input  wire logic        pix_clk_i,
    input  wire logic        pix_rst_ni,
    output logic             active_o,
    output logic             hsync_o,
    output logic             vsync_o,
    output logic      [23:0] rgb_o,
    output logic             led_o
);
  if (CHANNELS != 1 && CHANNELS != 3) begin : gen_bad_channels
    `KAGE_ILLEGAL("CHANNELS is 1 or 3")
  end

  localparam int XBits = $clog2(H_ACTIVE + H_FRONT + H_SYNC + H_BACK);
  localparam int YBits = $clog2(V_ACTIVE + V_FRONT + V_SYNC + V_BACK);
  localparam int Least = WIDTH < H_ACTIVE ? WIDTH : H_ACTIVE;
  localparam int Longest = Least < 4 ? 4 : Least;  // an async_fifo passes a word a clock from a depth of 8 on
  localparam int DataBits = 8 * CHANNELS;
  localparam int WordBits = DataBits + 3;
  localparam int EventBits = YBits + 3;

  // ---- the core's clock: each pixel with its flags goes into the FIFO -----------------------------------------------
  // Lines of the frame that have not ended; the last of them ends the frame.
  logic [15:0] left_q, left;
  logic push, end_of_frame;
  assign left         = s_axis_tuser_i ? lines_i : left_q;
  assign end_of_frame = s_axis_tlast_i && left == 16'd1;
  assign push         = s_axis_tvalid_i && s_axis_tready_o;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) left_q <= '0;
    else if (push) left_q <= s_axis_tlast_i && left != '0 ? left - 1'b1 : left;
  end

  logic line_valid, line_ready;
  logic [WordBits-1:0] line_word;
  logic head_valid, head_ready, head_eof, head_last, head_user;
  logic [DataBits-1:0] head_data;
  async_fifo #(
      .BITS (WordBits),
      .DEPTH(2 ** $clog2(2 * Longest))
  ) u_lines (
      .in_clk_i   (clk_i),
      .in_rst_ni  (rst_ni),
      .in_valid_i (s_axis_tvalid_i),
      .in_ready_o (s_axis_tready_o),
      .in_data_i  ({end_of_frame, s_axis_tlast_i, s_axis_tuser_i, s_axis_tdata_i}),
      .out_clk_i  (pix_clk_i),
      .out_rst_ni (pix_rst_ni),
      .out_valid_o(line_valid),
      .out_ready_i(line_ready),
      .out_data_o (line_word)
  );

  // A word's flags decide what is done with it, and a block RAM's output comes late in its clock: so it is registered.
  skid_buffer #(
      .BITS(WordBits)
  ) u_head (
      .clk_i      (pix_clk_i),
      .rst_ni     (pix_rst_ni),
      .in_valid_i (line_valid),
      .in_ready_o (line_ready),
      .in_data_i  (line_word),
      .out_valid_o(head_valid),
      .out_ready_i(head_ready),
      .out_data_o ({head_eof, head_last, head_user, head_data})
  );

  // ---- the pixel's clock: what the beam meets -----------------------------------------------------------------------
  logic active, hsync, vsync, frame_start, blank_start;
  logic [XBits-1:0] x;
  logic [YBits-1:0] y;
  video_timing #(
      .H_ACTIVE  (H_ACTIVE),
      .H_FRONT   (H_FRONT),
      .H_SYNC    (H_SYNC),
      .H_BACK    (H_BACK),
      .V_ACTIVE  (V_ACTIVE),
      .V_FRONT   (V_FRONT),
      .V_SYNC    (V_SYNC),
      .V_BACK    (V_BACK),
      .H_POSITIVE(H_POSITIVE),
      .V_POSITIVE(V_POSITIVE)
  ) u_timing (
      .clk_i        (pix_clk_i),
      .rst_ni       (pix_rst_ni),
      .active_o     (active),
      .hsync_o      (hsync),
      .vsync_o      (vsync),
      .x_o          (x),
      .y_o          (y),
      .frame_start_o(frame_start),
      .blank_start_o(blank_start)
  );

  // The frame on the screen: it has begun and its end has not come (showing); there was none to begin (late).
  logic showing_q, showing, late_q, late;
  // The line: its pixels come in time so far (live); its TLAST has been shown (ended); it ran short (short).
  logic live_q, live, ended_q, ended, short_q, short;
  // Line ends that the stream is behind the beam. While there are any, pixels are dropped.
  logic [YBits-1:0] owed_q;
  logic played_q;  // a frame has been shown since reset
  // The picture's right edge, of the line that came whole last; below the last line that had a pixel; the last colour
  // shown.
  logic [XBits-1:0] width_q;
  logic [YBits-1:0] height_q;
  logic [DataBits-1:0] last_q;

  logic line_start, begins, feed, miss, wide, drop;
  assign line_start = active && x == '0;
  assign begins     = frame_start && head_valid && head_user;
  assign showing    = frame_start ? begins : showing_q;
  assign late       = frame_start ? !begins && played_q : late_q;
  assign live       = line_start ? showing && (frame_start || owed_q == '0) : live_q;
  assign ended      = !line_start && ended_q;
  assign feed       = active && live && head_valid && (begins || !head_user);
  assign miss       = line_start ? showing && !feed : active && live_q && !feed;
  assign short      = miss || (!line_start && short_q);
  // A line that goes on past the screen owes its end, and no one is to blame.
  assign wide       = feed && !head_last && x == XBits'(H_ACTIVE - 1);
  // A pixel that nobody waits for is dropped, but a frame's first pixel waits for its screen.
  assign drop       = head_valid && !head_user && !feed && (owed_q != '0 || !showing);
  assign head_ready = feed || drop;

  always_ff @(posedge pix_clk_i) begin
    if (!pix_rst_ni) begin
      showing_q <= 1'b0;
      late_q    <= 1'b0;
      live_q    <= 1'b0;
      ended_q   <= 1'b0;
      short_q   <= 1'b0;
      owed_q    <= '0;
      played_q  <= 1'b0;
      width_q   <= XBits'(H_ACTIVE);
      height_q  <= YBits'(V_ACTIVE);
    end else begin
      late_q  <= late;
      live_q  <= live && !miss && !wide && !(feed && head_last);
      ended_q <= ended || (feed && head_last);
      short_q <= short;

      if (blank_start || (head_ready && head_eof)) showing_q <= 1'b0;
      else showing_q <= showing;
      // With the frame's end, or its screen's, nothing of it is owed any more: what is left of it is dropped to TUSER.
      if (blank_start || frame_start || (head_ready && head_eof)) owed_q <= '0;
      else if ((miss || wide) && !(drop && head_last)) owed_q <= owed_q + 1'b1;
      else if (!miss && !wide && drop && head_last && showing) owed_q <= owed_q - 1'b1;

      if (feed && (head_last || x == XBits'(H_ACTIVE - 1))) width_q <= x + 1'b1;
      if (feed) height_q <= y + 1'b1;
      if (begins) played_q <= 1'b1;
    end
    if (feed) last_q <= head_data;
  end

  // ---- colour -------------------------------------------------------------------------------------------------------
  logic repeats;
  assign repeats = x < width_q && !ended && (short || (late && y < height_q));

  logic [23:0] head_rgb, last_rgb;
  if (CHANNELS == 1) begin : gen_grey
    assign head_rgb = {3{head_data}};
    assign last_rgb = {3{last_q}};
  end else begin : gen_rgb
    assign head_rgb = head_data;
    assign last_rgb = last_q;
  end

  logic active_q, hsync_q, vsync_q;
  logic [23:0] rgb_q;
  assign active_o = active_q;
  assign hsync_o  = hsync_q;
  assign vsync_o  = vsync_q;
  assign rgb_o    = rgb_q;
  always_ff @(posedge pix_clk_i) begin
    active_q <= active && pix_rst_ni;
    hsync_q  <= hsync;
    vsync_q  <= vsync;
    // Black in blanking: an analogue screen takes its black level there.
    if (!active) rgb_q <= '0;
    else if (feed) rgb_q <= head_rgb;
    else rgb_q <= repeats ? last_rgb : BORDER;
  end

  logic [LED_BITS-1:0] led_left_q;
  logic led_q;
  assign led_o = led_q;
  always_ff @(posedge pix_clk_i) begin
    if (!pix_rst_ni) begin
      led_left_q <= '0;
      led_q      <= 1'b0;
    end else begin
      if (miss || (frame_start && late)) led_left_q <= '1;
      else if (led_left_q != '0) led_left_q <= led_left_q - 1'b1;
      led_q <= led_left_q != '0;
    end
  end

  // ---- a word to the core's clock each time vertical blanking begins ------------------------------------------------
  logic shown_q, event_valid_q, event_ready;
  logic [YBits-1:0] short_lines_q;
  logic [EventBits-1:0] event_q;
  always_ff @(posedge pix_clk_i) begin
    if (!pix_rst_ni) begin
      shown_q       <= 1'b0;
      short_lines_q <= '0;
      event_valid_q <= 1'b0;
    end else begin
      if (frame_start) shown_q <= begins;
      if (frame_start) short_lines_q <= '0;
      else if (miss) short_lines_q <= short_lines_q + 1'b1;
      if (blank_start) event_valid_q <= 1'b1;
      else if (event_ready) event_valid_q <= 1'b0;
    end
    if (blank_start) event_q <= {short_lines_q, late_q, shown_q, !(head_valid && head_user)};
  end

  logic done_valid, done_late, done_shown, done_ask;
  logic [YBits-1:0] done_lines;
  async_fifo #(
      .BITS (EventBits),
      .DEPTH(4)
  ) u_events (
      .in_clk_i   (pix_clk_i),
      .in_rst_ni  (pix_rst_ni),
      .in_valid_i (event_valid_q),
      .in_ready_o (event_ready),
      .in_data_i  (event_q),
      .out_clk_i  (clk_i),
      .out_rst_ni (rst_ni),
      .out_valid_o(done_valid),
      .out_ready_i(1'b1),
      .out_data_o ({done_lines, done_late, done_shown, done_ask})
  );

  // ---- the core's clock again: request and counters -----------------------------------------------------------------
  logic ask_q;
  logic [15:0] shown_count_q, late_count_q, frame_count_q, line_count_q;
  assign frame_req_valid_o = ask_q;
  assign frames_shown_o    = shown_count_q;
  assign late_frames_o     = late_count_q;
  assign underrun_frames_o = frame_count_q;
  assign underrun_lines_o  = line_count_q;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      ask_q         <= 1'b0;
      shown_count_q <= '0;
      late_count_q  <= '0;
      frame_count_q <= '0;
      line_count_q  <= '0;
    end else begin
      if (done_valid && done_ask) ask_q <= 1'b1;
      else if (frame_req_ready_i) ask_q <= 1'b0;
      if (done_valid) begin
        if (done_shown) shown_count_q <= shown_count_q + 1'b1;
        if (done_late) late_count_q <= late_count_q + 1'b1;
        if (done_late || done_lines != '0) frame_count_q <= frame_count_q + 1'b1;
        line_count_q <= line_count_q + 16'(done_lines);
      end
    end
  end

endmodule

`default_nettype wire
