// SPDX-License-Identifier: Apache-2.0
// A testbench of kage_axi for any simulator and any parameters. It reads the registers, and sends a frame without a
// token in its lines and one for another core, both with stalls. It holds every pixel, the counters and the interrupt
// against docs/stream.md. It needs no other program, as it takes the frame's parameter hash from the core.
//
// Its last line is "kage_axi_tb: passed" or "kage_axi_tb: FAILED: ..."; then the simulation ends, by $finish or $fatal.
`timescale 1ns / 1ps
`default_nettype none

module kage_axi_tb #(
    parameter int GBR_ORDER = 0,
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_registers.svh"

  localparam int Lines = 2;
  localparam int Width = MAX_WIDTH;
  localparam int Words = HeaderWords + Lines * EolWords + EndWords;
  localparam int Beats = (Words + BEAT_WORDS - 1) / BEAT_WORDS;
  localparam logic [31:0] Background = 32'h00c0a080;
  localparam logic [31:0] Shown = GBR_ORDER > 0 && CHANNELS == 3 ? 32'h0080c0a0 : Background;  // red lowest, or green

  logic clk = 1'b0;
  logic rst_n = 1'b0;
  always #5 clk = !clk;

  logic s_valid, s_ready, s_last, m_valid, m_ready, m_user, m_last;
  logic [BEAT_WORDS*32-1:0] s_data;
  logic [RgbBits-1:0] m_data;
  logic arvalid, arready, rvalid, rready, awvalid, awready, wvalid, wready, bvalid, irq;
  logic [7:0] araddr, awaddr;
  logic [31:0] rdata, wdata;
  logic [1:0] rresp, bresp;

  kage_axi #(
      .GBR_ORDER(GBR_ORDER),
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh"
  ) dut (
      .aclk          (clk),
      .aresetn       (rst_n),
      .s_axis_tvalid (s_valid),
      .s_axis_tready (s_ready),
      .s_axis_tdata  (s_data),
      .s_axis_tlast  (s_last),
      .m_axis_tvalid (m_valid),
      .m_axis_tready (m_ready),
      .m_axis_tdata  (m_data),
      .m_axis_tuser  (m_user),
      .m_axis_tlast  (m_last),
      .s_axil_awvalid(awvalid),
      .s_axil_awready(awready),
      .s_axil_awaddr (awaddr),
      .s_axil_wvalid (wvalid),
      .s_axil_wready (wready),
      .s_axil_wdata  (wdata),
      .s_axil_wstrb  (4'hf),
      .s_axil_bvalid (bvalid),
      .s_axil_bready (1'b1),
      .s_axil_bresp  (bresp),
      .s_axil_arvalid(arvalid),
      .s_axil_arready(arready),
      .s_axil_araddr (araddr),
      .s_axil_rvalid (rvalid),
      .s_axil_rready (rready),
      .s_axil_rdata  (rdata),
      .s_axil_rresp  (rresp),
      .irq           (irq)
  );

  // ---- what goes wrong, and time that runs out -------------------------------------------------------------------
  task automatic fail(input string what);
    begin
      $display("kage_axi_tb: FAILED: %0s, at %0t", what, $time);
      $fatal(1);
    end
  endtask
  initial begin
    repeat (2000 + 100 * Lines * Width) @(posedge clk);
    fail("the core came to no end");
  end

  // ---- registers: inputs change at falling edges, so no simulator's order of events matters ------------------------
  logic [31:0] value;
  task automatic read(input logic [7:0] address);
    begin
      @(negedge clk);
      arvalid = 1'b1;
      araddr  = address;
      while (!arready) @(negedge clk);
      @(negedge clk);
      arvalid = 1'b0;
      rready  = 1'b1;
      while (!rvalid) @(negedge clk);
      value = rdata;
      if (rresp !== 2'b00) fail("a register answers an error");
      @(negedge clk);
      rready = 1'b0;
    end
  endtask
  task automatic expect_register(input logic [7:0] address, input logic [31:0] wanted, input string name);
    begin
      read(address);
      if (value !== wanted) begin
        $display("%0s is %h, not %h", name, value, wanted);
        fail("a register has another value");
      end
    end
  endtask
  task automatic write(input logic [7:0] address, input logic [31:0] data);
    begin
      @(negedge clk);
      {awvalid, wvalid, awaddr, wdata} = {2'b11, address, data};
      while (!awready || !wready) @(negedge clk);
      @(negedge clk);
      {awvalid, wvalid} = 2'b00;
      while (!bvalid) @(negedge clk);
      if (bresp !== 2'b00) fail("a write answers an error");
    end
  endtask

  // ---- a frame of background ---------------------------------------------------------------------------------------
  logic [Beats*BEAT_WORDS*32-1:0] frame;
  task automatic make_frame(input logic [31:0] hash, input logic [31:0] number);
    integer at;
    begin
      frame = '0;
      frame[HeaderVersionLsb+:HeaderVersionBits] = HeaderVersionBits'(StreamVersion);
      frame[HeaderMagicLsb+:HeaderMagicBits] = HeaderMagicBits'(StreamMagic);
      frame[HeaderWidthLsb+:HeaderWidthBits] = HeaderWidthBits'(Width);
      frame[HeaderHeightLsb+:HeaderHeightBits] = HeaderHeightBits'(Lines);
      frame[HeaderParamHashLsb+:32] = hash;
      frame[HeaderBackgroundLsb+:32] = Background & 32'((64'd1 << RgbBits) - 64'd1);
      frame[HeaderFrameLsb+:32] = number;
      at = 32 * HeaderWords;
      for (int y = 0; y < Lines; y++) begin
        frame[at+:KindBits] = KindEol;
        frame[at+EolYLsb+:EolYBits] = EolYBits'(y);
        at = at + 32 * EolWords;
      end
      frame[at+:KindBits] = KindEnd;
    end
  endtask

  logic [15:0] dice = 16'h1d0e;  // stalls: a shift register's bits
  always @(negedge clk) dice <= {dice[14:0], dice[15] ^ dice[13] ^ dice[12] ^ dice[10]};
  always @(negedge clk) m_ready <= dice[0] || dice[3];

  task automatic send;
    begin
      for (int b = 0; b < Beats; b++) begin
        @(negedge clk);
        while (dice[2:1] == 2'b00) @(negedge clk);
        s_valid = 1'b1;
        s_data  = frame[b*BEAT_WORDS*32+:BEAT_WORDS*32];
        s_last  = b == Beats - 1;
        while (!s_ready) @(negedge clk);
        @(posedge clk);
        #1 s_valid = 1'b0;
      end
    end
  endtask

  // ---- pixels ------------------------------------------------------------------------------------------------------
  integer pixels = 0;
  always @(posedge clk) begin
    if (rst_n && m_valid !== 1'b0 && m_ready) begin
      if (m_data !== Shown[RgbBits-1:0]) fail("a pixel is not the background");
      if (m_user !== (pixels == 0)) fail("TUSER is not on the first pixel, or on another");
      if (m_last !== (pixels % Width == Width - 1)) fail("TLAST is not on a line's last pixel, or on another");
      if (pixels == Lines * Width) fail("more pixels come than the frame has");
      pixels <= pixels + 1;
    end
  end

  // ---- the run -----------------------------------------------------------------------------------------------------
  initial begin
    {s_valid, s_last, arvalid, araddr, rready, awvalid, awaddr, wvalid, wdata, m_ready} = '0;
    s_data = '0;
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
    expect_register(RegId, IdValue, "ID");
    expect_register(RegVersion, 32'(StreamVersion), "VERSION");
    write(RegControl, 32'd1);  // interrupt at a frame's end
    read(RegParamHash);
    make_frame(value, 32'd7);
    send;
    while (pixels != Lines * Width) @(negedge clk);
    while (irq !== 1'b1) @(negedge clk);
    write(RegIrq, 32'd1);
    expect_register(RegFrames, 32'd1, "FRAMES");
    expect_register(RegErrors, 32'd0, "ERRORS");
    if (irq !== 1'b0) fail("the interrupt stays though it was cleared");
    read(RegParamHash);
    make_frame(~value, 32'd8);
    send;
    while (irq !== 1'b1) @(negedge clk);
    expect_register(RegFrames, 32'd2, "FRAMES");
    expect_register(RegErrors, 32'd1, "ERRORS");
    expect_register(RegErrorFrame, 32'd8, "ERROR_FRAME");
    if (pixels != Lines * Width) fail("a frame for another core brings pixels");
    $display("kage_axi_tb: passed: %0d pixels, 2 frames, an error where one belongs", pixels);
    $finish;
  end

endmodule

`default_nettype wire
