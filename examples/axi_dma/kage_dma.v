// SPDX-License-Identifier: Apache-2.0
// kage_axi between two DMA engines: a frame comes from memory, its pixels go to memory, a processor has the registers of both.
//
// The core's parameters are those of kage_pack.vh, which `kage vectors` writes. A design of one's own has them at the instance.
// s_axil_core has the core's registers, s_axil_dma those of the DMA (kage_driver.h), each at an address that the interconnect of
// the design gives it. Handshake, clock and reset are kage_axi's.
`include "kage_pack.vh"
`default_nettype none

module kage_dma #(
    parameter BEAT_BITS = 32 * `KAGE_PACK_BEAT_WORDS
) (
    input  wire aclk,
    input  wire aresetn,
    output wire irq,

    // the core's registers
    input wire s_axil_core_awvalid,
    output wire s_axil_core_awready,
    input wire [7:0] s_axil_core_awaddr,
    input wire s_axil_core_wvalid,
    output wire s_axil_core_wready,
    input wire [31:0] s_axil_core_wdata,
    input wire [3:0] s_axil_core_wstrb,
    output wire s_axil_core_bvalid,
    input wire s_axil_core_bready,
    output wire [1:0] s_axil_core_bresp,
    input wire s_axil_core_arvalid,
    output wire s_axil_core_arready,
    input wire [7:0] s_axil_core_araddr,
    output wire s_axil_core_rvalid,
    input wire s_axil_core_rready,
    output wire [31:0] s_axil_core_rdata,
    output wire [1:0] s_axil_core_rresp,

    // the DMA's registers
    input wire s_axil_dma_awvalid,
    output wire s_axil_dma_awready,
    input wire [7:0] s_axil_dma_awaddr,
    input wire s_axil_dma_wvalid,
    output wire s_axil_dma_wready,
    input wire [31:0] s_axil_dma_wdata,
    input wire [3:0] s_axil_dma_wstrb,
    output reg s_axil_dma_bvalid,
    input wire s_axil_dma_bready,
    output wire [1:0] s_axil_dma_bresp,
    input wire s_axil_dma_arvalid,
    output wire s_axil_dma_arready,
    input wire [7:0] s_axil_dma_araddr,
    output reg s_axil_dma_rvalid,
    input wire s_axil_dma_rready,
    output reg [31:0] s_axil_dma_rdata,
    output wire [1:0] s_axil_dma_rresp,

    // frames, from memory
    output wire m_axi_frames_arvalid,
    input wire m_axi_frames_arready,
    output wire [31:0] m_axi_frames_araddr,
    output wire [7:0] m_axi_frames_arlen,
    output wire [2:0] m_axi_frames_arsize,
    output wire [1:0] m_axi_frames_arburst,
    input wire m_axi_frames_rvalid,
    output wire m_axi_frames_rready,
    input wire [BEAT_BITS-1:0] m_axi_frames_rdata,
    input wire [1:0] m_axi_frames_rresp,

    // video, to memory
    output wire m_axi_video_awvalid,
    input wire m_axi_video_awready,
    output wire [31:0] m_axi_video_awaddr,
    output wire [7:0] m_axi_video_awlen,
    output wire [2:0] m_axi_video_awsize,
    output wire [1:0] m_axi_video_awburst,
    output wire m_axi_video_wvalid,
    input wire m_axi_video_wready,
    output wire [31:0] m_axi_video_wdata,
    output wire [3:0] m_axi_video_wstrb,
    output wire m_axi_video_wlast,
    input wire m_axi_video_bvalid,
    output wire m_axi_video_bready,
    input wire [1:0] m_axi_video_bresp
);

  localparam PIXEL_BITS = 8 * `KAGE_PACK_CHANNELS;

  wire frames_tvalid, frames_tready, frames_tlast, video_tvalid, video_tready, video_tuser, video_tlast;
  wire [BEAT_BITS-1:0] frames_tdata;
  wire [PIXEL_BITS-1:0] video_tdata;

  // The DMA's registers: a write when address and data are there, a read at once.
  reg discard_q;
  reg [31:0] source_q, beats_q, destination_q;
  reg [15:0] lines_q;
  wire feeding, capturing, feed_failed, capture_failed;
  wire [31:0] pixels;
  wire write = s_axil_dma_awvalid && s_axil_dma_wvalid && !s_axil_dma_bvalid;
  wire command = write && s_axil_dma_awaddr == 8'h00;

  assign s_axil_dma_awready = write;
  assign s_axil_dma_wready  = write;
  assign s_axil_dma_bresp   = 2'b00;
  assign s_axil_dma_arready = !s_axil_dma_rvalid;
  assign s_axil_dma_rresp   = 2'b00;

  always @(posedge aclk) begin
    if (s_axil_dma_bready) s_axil_dma_bvalid <= 1'b0;
    if (write) begin
      s_axil_dma_bvalid <= 1'b1;
      case (s_axil_dma_awaddr)
        8'h00:   discard_q <= s_axil_dma_wdata[3];
        8'h08:   source_q <= s_axil_dma_wdata;
        8'h0C:   beats_q <= s_axil_dma_wdata;
        8'h10:   destination_q <= s_axil_dma_wdata;
        8'h14:   lines_q <= s_axil_dma_wdata[15:0];
        default: ;
      endcase
    end
    if (s_axil_dma_rready) s_axil_dma_rvalid <= 1'b0;
    if (s_axil_dma_arvalid && s_axil_dma_arready) begin
      s_axil_dma_rvalid <= 1'b1;
      case (s_axil_dma_araddr)
        8'h04:   s_axil_dma_rdata <= {28'd0, capture_failed, feed_failed, capturing, feeding};
        8'h08:   s_axil_dma_rdata <= source_q;
        8'h0C:   s_axil_dma_rdata <= beats_q;
        8'h10:   s_axil_dma_rdata <= destination_q;
        8'h14:   s_axil_dma_rdata <= {16'd0, lines_q};
        8'h18:   s_axil_dma_rdata <= pixels;
        8'h1C:   s_axil_dma_rdata <= BEAT_BITS / 8;
        default: s_axil_dma_rdata <= 32'd0;
      endcase
    end
    if (!aresetn) begin
      s_axil_dma_bvalid <= 1'b0;
      s_axil_dma_rvalid <= 1'b0;
      discard_q <= 1'b0;
    end
  end

  axi_reader #(
      .DATA_BITS(BEAT_BITS)
  ) u_reader (
      .aclk(aclk),
      .aresetn(aresetn),
      .start(command && s_axil_dma_wdata[0]),
      .source(source_q),
      .beats(beats_q),
      .busy(feeding),
      .failed(feed_failed),
      .m_axi_arvalid(m_axi_frames_arvalid),
      .m_axi_arready(m_axi_frames_arready),
      .m_axi_araddr(m_axi_frames_araddr),
      .m_axi_arlen(m_axi_frames_arlen),
      .m_axi_arsize(m_axi_frames_arsize),
      .m_axi_arburst(m_axi_frames_arburst),
      .m_axi_rvalid(m_axi_frames_rvalid),
      .m_axi_rready(m_axi_frames_rready),
      .m_axi_rdata(m_axi_frames_rdata),
      .m_axi_rresp(m_axi_frames_rresp),
      .m_axis_tvalid(frames_tvalid),
      .m_axis_tready(frames_tready),
      .m_axis_tdata(frames_tdata),
      .m_axis_tlast(frames_tlast)
  );

  kage_axi #(`KAGE_PACK_PARAMETERS) u_kage (
      .aclk(aclk),
      .aresetn(aresetn),
      .s_axis_tvalid(frames_tvalid),
      .s_axis_tready(frames_tready),
      .s_axis_tdata(frames_tdata),
      .s_axis_tlast(frames_tlast),
      .m_axis_tvalid(video_tvalid),
      .m_axis_tready(video_tready),
      .m_axis_tdata(video_tdata),
      .m_axis_tuser(video_tuser),
      .m_axis_tlast(video_tlast),
      .s_axil_awvalid(s_axil_core_awvalid),
      .s_axil_awready(s_axil_core_awready),
      .s_axil_awaddr(s_axil_core_awaddr),
      .s_axil_wvalid(s_axil_core_wvalid),
      .s_axil_wready(s_axil_core_wready),
      .s_axil_wdata(s_axil_core_wdata),
      .s_axil_wstrb(s_axil_core_wstrb),
      .s_axil_bvalid(s_axil_core_bvalid),
      .s_axil_bready(s_axil_core_bready),
      .s_axil_bresp(s_axil_core_bresp),
      .s_axil_arvalid(s_axil_core_arvalid),
      .s_axil_arready(s_axil_core_arready),
      .s_axil_araddr(s_axil_core_araddr),
      .s_axil_rvalid(s_axil_core_rvalid),
      .s_axil_rready(s_axil_core_rready),
      .s_axil_rdata(s_axil_core_rdata),
      .s_axil_rresp(s_axil_core_rresp),
      .irq(irq)
  );

  axi_writer #(
      .PIXEL_BITS(PIXEL_BITS)
  ) u_writer (
      .aclk(aclk),
      .aresetn(aresetn),
      .start(command && s_axil_dma_wdata[1]),
      .cancel(command && s_axil_dma_wdata[2]),
      .discard(discard_q),
      .destination(destination_q),
      .lines(lines_q),
      .busy(capturing),
      .failed(capture_failed),
      .pixels(pixels),
      .s_axis_tvalid(video_tvalid),
      .s_axis_tready(video_tready),
      .s_axis_tdata(video_tdata),
      .s_axis_tuser(video_tuser),
      .s_axis_tlast(video_tlast),
      .m_axi_awvalid(m_axi_video_awvalid),
      .m_axi_awready(m_axi_video_awready),
      .m_axi_awaddr(m_axi_video_awaddr),
      .m_axi_awlen(m_axi_video_awlen),
      .m_axi_awsize(m_axi_video_awsize),
      .m_axi_awburst(m_axi_video_awburst),
      .m_axi_wvalid(m_axi_video_wvalid),
      .m_axi_wready(m_axi_video_wready),
      .m_axi_wdata(m_axi_video_wdata),
      .m_axi_wstrb(m_axi_video_wstrb),
      .m_axi_wlast(m_axi_video_wlast),
      .m_axi_bvalid(m_axi_video_bvalid),
      .m_axi_bready(m_axi_video_bready),
      .m_axi_bresp(m_axi_video_bresp)
  );

  // A write takes the whole word: the DMA's registers know no strobes.
  wire unused = &{1'b0, s_axil_dma_wstrb};

endmodule

`default_nettype wire
