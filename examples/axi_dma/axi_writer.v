// SPDX-License-Identifier: Apache-2.0
// Writes video to memory by AXI4: four bytes a pixel, channel 0 first, what the pixel lacks 0, line behind line without a gap.
//
// Handshake: `start` for one clock while `busy` is low, with `destination` and `lines`. Pixels before a frame's first one (TUSER)
// are dropped, so a capture begins with a frame. While nothing is captured no pixel is taken, and the core waits; `discard` lets
// pixels go that nobody captures. `cancel` for one clock ends a capture whose frame has no pixels, or fewer than were expected.
// Latency: 16 pixels or what is left of the line are collected, then written; meanwhile no pixel is taken. A design that needs
// a pixel a clock collects the next 16 in a second buffer. Cost: 16 words of memory, five counters.
`default_nettype none

module axi_writer #(
    parameter PIXEL_BITS = 24  // 8, 16, 24 or 32
) (
    input wire aclk,
    input wire aresetn,

    input wire start,
    input wire cancel,
    input wire discard,
    input wire [31:0] destination,  // in bytes, a multiple of 4
    input wire [15:0] lines,
    output wire busy,
    output reg failed,  // since the last start the memory has answered with an error
    output reg [31:0] pixels,  // taken since the last start

    input wire s_axis_tvalid,
    output wire s_axis_tready,
    input wire [PIXEL_BITS-1:0] s_axis_tdata,
    input wire s_axis_tuser,
    input wire s_axis_tlast,

    output reg m_axi_awvalid,
    input wire m_axi_awready,
    output wire [31:0] m_axi_awaddr,
    output wire [7:0] m_axi_awlen,
    output wire [2:0] m_axi_awsize,
    output wire [1:0] m_axi_awburst,
    output wire m_axi_wvalid,
    input wire m_axi_wready,
    output wire [31:0] m_axi_wdata,
    output wire [3:0] m_axi_wstrb,
    output wire m_axi_wlast,
    input wire m_axi_bvalid,
    output wire m_axi_bready,
    input wire [1:0] m_axi_bresp
);

  localparam [1:0] Idle = 2'd0, Collect = 2'd1, Write = 2'd2, Answer = 2'd3;

  reg [1:0] state_q;
  reg begun_q;  // the frame's first pixel has come
  reg cancel_q;
  reg [31:2] address_q;
  reg [15:0] lines_q;
  reg [4:0] count_q;  // words collected
  reg [4:0] sent_q;  // of them written
  reg [31:0] words[0:15];

  wire taken = s_axis_tvalid && state_q == Collect && !cancel_q && (begun_q || s_axis_tuser);
  // No burst passes a multiple of 4 KB, as AXI4 demands.
  wire [9:0] place = address_q[11:2] + {5'd0, count_q};
  wire full = count_q == 5'd15 || s_axis_tlast || place == 10'h3FF;

  assign busy = state_q != Idle;
  assign s_axis_tready = state_q == Collect ? !cancel_q : state_q == Idle && discard;
  assign m_axi_awaddr = {address_q, 2'b00};
  assign m_axi_awlen = {3'd0, count_q} - 8'd1;
  assign m_axi_awsize = 3'd2;
  assign m_axi_awburst = 2'b01;
  assign m_axi_wvalid = state_q == Write && sent_q != count_q;
  assign m_axi_wdata = words[sent_q[3:0]];
  assign m_axi_wstrb = 4'hF;
  assign m_axi_wlast = sent_q + 5'd1 == count_q;
  assign m_axi_bready = state_q == Answer;

  always @(posedge aclk) begin
    if (cancel && busy) cancel_q <= 1'b1;
    if (taken) begin
      words[count_q[3:0]] <= {{32 - PIXEL_BITS{1'b0}}, s_axis_tdata};
      count_q <= count_q + 5'd1;
      pixels <= pixels + 1'b1;
      begun_q <= 1'b1;
      if (s_axis_tlast) lines_q <= lines_q - 16'd1;
    end
    if (m_axi_awvalid && m_axi_awready) m_axi_awvalid <= 1'b0;
    if (m_axi_wvalid && m_axi_wready) sent_q <= sent_q + 5'd1;
    case (state_q)
      Idle:
      if (start) begin
        state_q <= lines == 0 ? Idle : Collect;
        begun_q <= 1'b0;
        cancel_q <= 1'b0;
        address_q <= destination[31:2];
        lines_q <= lines;
        count_q <= 5'd0;
        pixels <= 32'd0;
        failed <= 1'b0;
      end
      Collect:
      if (taken ? full : cancel_q) begin
        // A cancelled capture that has collected nothing has nothing to write.
        state_q <= taken || count_q != 0 ? Write : Idle;
        m_axi_awvalid <= taken || count_q != 0;
        sent_q <= 5'd0;
      end
      Write: if (!m_axi_awvalid && sent_q == count_q) state_q <= Answer;
      default:
      if (m_axi_bvalid) begin
        if (m_axi_bresp != 2'b00) failed <= 1'b1;
        address_q <= address_q + {25'd0, count_q};
        count_q   <= 5'd0;
        state_q   <= lines_q == 0 || cancel_q ? Idle : Collect;
      end
    endcase
    if (!aresetn) begin
      state_q <= Idle;
      m_axi_awvalid <= 1'b0;
      failed <= 1'b0;
      pixels <= 32'd0;
      count_q <= 5'd0;
      sent_q <= 5'd0;
      cancel_q <= 1'b0;
    end
  end

  // Addresses are of whole beats.
  wire unused = &{1'b0, destination[1:0]};

endmodule

`default_nettype wire
