// SPDX-License-Identifier: Apache-2.0
// Reads a frame from memory by AXI4 and sends it to a stream; the last beat has TLAST.
//
// Handshake: `start` for one clock while `busy` is low, with `source` and `beats`. Bursts have 16 beats at most and stay within
// 4 KB, as AXI4 demands. One burst is under way at a time: a design that needs more than the memory's latency allows asks for
// the next one ahead of time, and has a FIFO for what comes. Latency: none between R and the stream. Cost: three counters.
`default_nettype none

module axi_reader #(
    parameter DATA_BITS = 32  // of memory and stream: 32, 64, 128 or 256
) (
    input wire aclk,
    input wire aresetn,

    input wire start,
    input wire [31:0] source,  // in bytes; what is not whole beats of it is ignored
    input wire [31:0] beats,
    output wire busy,
    output reg failed,  // since the last start the memory has answered with an error

    output reg m_axi_arvalid,
    input wire m_axi_arready,
    output wire [31:0] m_axi_araddr,
    output reg [7:0] m_axi_arlen,
    output wire [2:0] m_axi_arsize,
    output wire [1:0] m_axi_arburst,
    input wire m_axi_rvalid,
    output wire m_axi_rready,
    input wire [DATA_BITS-1:0] m_axi_rdata,
    input wire [1:0] m_axi_rresp,

    output wire m_axis_tvalid,
    input wire m_axis_tready,
    output wire [DATA_BITS-1:0] m_axis_tdata,
    output wire m_axis_tlast
);

  localparam SHIFT = $clog2(DATA_BITS / 8);

  reg [31:SHIFT] address_q;  // of the next beat that comes, but through a request: of its burst
  reg [31:0] left_q;  // beats that have not come
  reg [4:0] burst_q;  // beats of the burst that have not come

  // Beats up to the next multiple of 4 KB.
  wire [12-SHIFT:0] room = {1'b1, {12 - SHIFT{1'b0}}} - {1'b0, address_q[11:SHIFT]};
  wire [4:0] most = room < 16 ? room[4:0] : 5'd16;
  wire [4:0] count = left_q < {27'd0, most} ? left_q[4:0] : most;
  wire beat = m_axi_rvalid && m_axi_rready;

  assign busy = left_q != 0;
  assign m_axi_araddr = {address_q, {SHIFT{1'b0}}};
  assign m_axi_arsize = SHIFT[2:0];
  assign m_axi_arburst = 2'b01;
  assign m_axi_rready = busy && m_axis_tready;
  assign m_axis_tvalid = busy && m_axi_rvalid;
  assign m_axis_tdata = m_axi_rdata;
  assign m_axis_tlast = left_q == 1;

  always @(posedge aclk) begin
    if (start && !busy) begin
      address_q <= source[31:SHIFT];
      left_q <= beats;
      failed <= 1'b0;
    end else if (beat) begin
      address_q <= address_q + 1'b1;
      left_q <= left_q - 1'b1;
      burst_q <= burst_q - 1'b1;
      if (m_axi_rresp != 2'b00) failed <= 1'b1;
    end else if (busy && burst_q == 0) begin
      m_axi_arvalid <= 1'b1;
      m_axi_arlen <= {3'd0, count} - 1'b1;
      burst_q <= count;
    end
    if (m_axi_arvalid && m_axi_arready) m_axi_arvalid <= 1'b0;
    if (!aresetn) begin
      m_axi_arvalid <= 1'b0;
      left_q <= 32'd0;
      burst_q <= 5'd0;
      failed <= 1'b0;
    end
  end

  // Addresses are of whole beats.
  wire unused = &{1'b0, source[SHIFT-1:0]};

endmodule

`default_nettype wire
