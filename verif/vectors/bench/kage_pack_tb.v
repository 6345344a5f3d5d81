// SPDX-License-Identifier: Apache-2.0
// Plays a pack of test vectors (kage vectors) against the core and holds every pixel, each line's signature and the
// registers against the pack. Plain Verilog-2005; run it in the pack's folder (README.md there says how).
//
// +seed=N +stall=P: each stream stops in P per cent of the clocks, N selects which. +dump writes kage_pack.vcd,
// +capture=FILE all pixels that came, as pixels.hex has them.
// The core is kage_axi; with KAGE_PACK_TOP defined it is kage_top, with KAGE_PACK_NETLIST kage_top without parameters,
// as synthesis leaves it.
//
// Exactly one line begins "kage_pack_tb: ", and then the simulation ends by $finish: "passed: ..." or "FAILED: ...", with
// the first wrong pixel by frame, line, x, channel and clock. Inputs change at falling edges and outputs are looked at
// shortly before rising ones, so neither a simulator's order of events nor a netlist's delays matter.
`timescale 1ns / 1ps
`include "kage_pack.vh"
`default_nettype none

module kage_pack_tb;
  localparam BEAT_BITS = `KAGE_PACK_BEAT_WORDS * 32;
  localparam RGB_BITS = `KAGE_PACK_CHANNELS * 8;
  localparam STIMULUS_BITS = BEAT_BITS + 4;  // {TLAST, beat}
  localparam PIXEL_BITS = RGB_BITS + 4;  // {TUSER, TLAST, pixel}

  reg [STIMULUS_BITS-1:0] stimulus[0:`KAGE_PACK_BEATS-1];
  reg [PIXEL_BITS-1:0] pixels[0:`KAGE_PACK_PIXELS-1];
  reg [31:0] signatures[0:`KAGE_PACK_LINES-1];
  reg [127:0] frames[0:`KAGE_PACK_FRAMES-1];  // {beats, height, width, whether the registers are read behind it}
  reg [127:0] reads[0:`KAGE_PACK_READS-1];  // {frame, address, mask, value}
  initial begin
    $readmemh("stimulus.hex", stimulus);
    $readmemh("pixels.hex", pixels);
    $readmemh("signatures.hex", signatures);
    $readmemh("frames.hex", frames);
    $readmemh("registers.hex", reads);
  end

  // ---- what the bench knows, clock, reset ---------------------------------------------------------------------------
  reg clk, rst_n, failed;
  reg [31:0] dice, stall, value, signature;
  reg [PIXEL_BITS-1:0] wanted, held;
  reg taken, waits;
  integer clocks, quiet;
  integer beat, in_frame, in_beat, allowed;  // beats sent, and where that is; frames up to `allowed` may go in
  integer pixel, line, out_frame, out_line, out_x;  // pixels and lines that have come, and where the next one is
  integer c, r, f, lines, capture;
  reg [8*256-1:0] capture_name;
  initial begin
    {clk, rst_n, failed, taken, waits} = 5'd0;
    {clocks, quiet, beat, in_frame, in_beat, pixel, line, out_frame, out_line, out_x, r, lines} = 0;
    allowed = -1;
    signature = 32'hffffffff;
    dice = 32'd1;
    if ($value$plusargs("seed=%d", dice)) dice = dice * 32'h9e3779b9 + 32'd1;
    if (dice == 32'd0) dice = 32'd1;
    if (!$value$plusargs("stall=%d", stall)) stall = 0;
    capture = 0;
    if ($value$plusargs("capture=%s", capture_name)) capture = $fopen(capture_name, "w");
    if ($test$plusargs("dump")) begin
      $dumpfile("kage_pack.vcd");
      $dumpvars;
    end
    repeat (4) @(negedge clk);
    rst_n <= 1'b1;
  end
  always #5 clk = !clk;

  function [31:0] next_dice;
    input [31:0] from;
    reg [31:0] x;
    begin
      x = from ^ (from << 13);
      x = x ^ (x >> 17);
      next_dice = x ^ (x << 5);
    end
  endfunction

  // ---- the core ----------------------------------------------------------------------------------------------------
  reg s_valid, s_last, m_ready;
  reg [BEAT_BITS-1:0] s_data;
  wire s_ready, m_valid, m_user, m_last, irq;
  wire [RGB_BITS-1:0] m_data;
  reg arvalid, rready;
  reg [7:0] araddr;
  wire arready, rvalid, awready, wready, bvalid;
  wire [31:0] rdata;
  wire [1:0] rresp, bresp;
`ifdef KAGE_PACK_NETLIST
  `define KAGE_PACK_TOP
`endif
`ifdef KAGE_PACK_TOP
`ifdef KAGE_PACK_NETLIST
  kage_top dut (
`else
  kage_top #(`KAGE_PACK_PARAMETERS) dut (
`endif
      .clk_i(clk), .rst_ni(rst_n),
      .s_axis_tvalid_i(s_valid), .s_axis_tready_o(s_ready), .s_axis_tdata_i(s_data), .s_axis_tlast_i(s_last),
      .m_axis_tvalid_o(m_valid), .m_axis_tready_i(m_ready), .m_axis_tdata_o(m_data), .m_axis_tuser_o(m_user),
      .m_axis_tlast_o(m_last),
      .s_axil_awvalid_i(1'b0), .s_axil_awready_o(awready), .s_axil_awaddr_i(8'd0),
      .s_axil_wvalid_i(1'b0), .s_axil_wready_o(wready), .s_axil_wdata_i(32'd0), .s_axil_wstrb_i(4'd0),
      .s_axil_bvalid_o(bvalid), .s_axil_bready_i(1'b1), .s_axil_bresp_o(bresp),
      .s_axil_arvalid_i(arvalid), .s_axil_arready_o(arready), .s_axil_araddr_i(araddr),
      .s_axil_rvalid_o(rvalid), .s_axil_rready_i(rready), .s_axil_rdata_o(rdata), .s_axil_rresp_o(rresp),
      .irq_o(irq)
  );
`else
  kage_axi #(`KAGE_PACK_PARAMETERS) dut (
      .aclk(clk), .aresetn(rst_n),
      .s_axis_tvalid(s_valid), .s_axis_tready(s_ready), .s_axis_tdata(s_data), .s_axis_tlast(s_last),
      .m_axis_tvalid(m_valid), .m_axis_tready(m_ready), .m_axis_tdata(m_data), .m_axis_tuser(m_user),
      .m_axis_tlast(m_last),
      .s_axil_awvalid(1'b0), .s_axil_awready(awready), .s_axil_awaddr(8'd0),
      .s_axil_wvalid(1'b0), .s_axil_wready(wready), .s_axil_wdata(32'd0), .s_axil_wstrb(4'd0),
      .s_axil_bvalid(bvalid), .s_axil_bready(1'b1), .s_axil_bresp(bresp),
      .s_axil_arvalid(arvalid), .s_axil_arready(arready), .s_axil_araddr(araddr),
      .s_axil_rvalid(rvalid), .s_axil_rready(rready), .s_axil_rdata(rdata), .s_axil_rresp(rresp),
      .irq(irq)
  );
`endif

  // ---- verdict -----------------------------------------------------------------------------------------------------
  // The first failure is told, no other.
  always @(posedge clk) begin
    clocks <= clocks + 1;
    if (failed) $finish;
  end
  // A file that is missing or short leaves the end of its memory unknown, or 0 where a simulator knows no X.
  initial begin
    #1;
    if (^stimulus[`KAGE_PACK_BEATS-1] === 1'bx || ^pixels[`KAGE_PACK_PIXELS-1] === 1'bx ||
        ^signatures[`KAGE_PACK_LINES-1] === 1'bx || ^frames[`KAGE_PACK_FRAMES-1] === 1'bx ||
        ^reads[`KAGE_PACK_READS-1] === 1'bx || frames[`KAGE_PACK_FRAMES-1][127:96] == 0) begin
      $display("kage_pack_tb: FAILED: a .hex file is missing or short: is this the pack's folder?");
      failed = 1'b1;
    end
  end

  function [31:0] crc;  // CRC-32 of a byte more, as zlib has it
    input [31:0] so_far;
    input [7:0] more;
    integer i;
    begin
      crc = so_far ^ {24'd0, more};
      for (i = 0; i < 8; i = i + 1) crc = crc[0] ? (crc >> 1) ^ 32'hedb88320 : crc >> 1;
    end
  endfunction

  // The sampled pixel is the next one of the pack?
  task check_pixel;
    begin
      // A frame without lines brings no pixels.
      while (frames[out_frame][95:64] == 0) out_frame = out_frame + 1;
      wanted = pixels[pixel];
      for (c = 0; c < `KAGE_PACK_CHANNELS; c = c + 1) begin
        if (m_data[8*c+:8] !== wanted[8*c+:8] && !failed) begin
          $display("kage_pack_tb: FAILED: frame %0d, line %0d, x %0d, channel %0d: expected %0d, got %0d, clock %0d",
                   out_frame, out_line, out_x, c, wanted[8*c+:8], m_data[8*c+:8], clocks);
          failed = 1'b1;
        end
        signature = crc(signature, m_data[8*c+:8]);
      end
      if ({m_user, m_last} !== wanted[RGB_BITS+:2] && !failed) begin
        $display("kage_pack_tb: FAILED: frame %0d, line %0d, x %0d: expected TUSER %b TLAST %b, got %b %b, clock %0d",
                 out_frame, out_line, out_x, wanted[RGB_BITS+1], wanted[RGB_BITS], m_user, m_last, clocks);
        failed = 1'b1;
      end
      signature = crc(signature, {6'd0, m_user, m_last});
      pixel = pixel + 1;
      out_x = out_x + 1;
      if (out_x == frames[out_frame][63:32]) begin
        if (~signature !== signatures[line] && !failed) begin
          $display("kage_pack_tb: FAILED: frame %0d, line %0d: expected signature %h, got %h, clock %0d", out_frame,
                   out_line, signatures[line], ~signature, clocks);
          failed = 1'b1;
        end
        signature = 32'hffffffff;
        line = line + 1;
        out_x = 0;
        out_line = out_line + 1;
        if (out_line == frames[out_frame][95:64]) begin
          out_line  = 0;
          out_frame = out_frame + 1;
        end
      end
    end
  endtask

  // In reset too: from its second clock on.
  always @(negedge clk) begin
    #4;
    if (clocks != 0 && !failed && (m_valid ^ s_ready ^ awready ^ wready ^ bvalid ^ arready ^ rvalid ^ irq) === 1'bx) begin
      $display("kage_pack_tb: FAILED: a handshake or the interrupt is unknown, clock %0d", clocks);
      failed = 1'b1;
    end
  end

  // ---- frames in, pixels out: inputs at the falling edge, a look at the outputs right before the rising one ---------
  initial begin
    {s_valid, s_last, m_ready} = 3'b000;
    s_data = 0;
  end
  always @(negedge clk) begin
    if (rst_n === 1'b1 && !failed) begin
      dice = next_dice(dice);
      if (taken) begin
        s_valid = 1'b0;
        beat = beat + 1;
        in_beat = in_beat + 1;
        if (in_beat == frames[in_frame][127:96]) begin
          in_beat  = 0;
          in_frame = in_frame + 1;
        end
      end
      if (!s_valid && beat != `KAGE_PACK_BEATS && in_frame <= allowed && dice[15:0] % 100 >= stall) begin
        s_valid = 1'b1;
        s_data  = stimulus[beat][BEAT_BITS-1:0];
        s_last  = stimulus[beat][BEAT_BITS];
      end
      m_ready = dice[31:16] % 100 >= stall;
      #4;
      taken = s_valid && s_ready === 1'b1;
      if (waits && {m_valid, m_user, m_last, m_data} !== {1'b1, held[RGB_BITS+1:0]} && !failed) begin
        $display("kage_pack_tb: FAILED: frame %0d, line %0d, x %0d: a pixel that waits changes or goes, clock %0d", out_frame,
                 out_line, out_x, clocks);
        failed = 1'b1;
      end
      waits = m_valid === 1'b1 && !m_ready;
      held  = {2'b00, m_user, m_last, m_data};
      quiet = taken || (m_valid === 1'b1 && m_ready) ? 0 : quiet + 1;
      if (m_valid === 1'b1 && m_ready && capture != 0) $fdisplay(capture, "%h%h", {2'b00, m_user, m_last}, m_data);
      if (m_valid === 1'b1 && m_ready && !failed) begin
        if (pixel != `KAGE_PACK_PIXELS) check_pixel;
        else begin
          $display("kage_pack_tb: FAILED: a pixel more than the pack has, clock %0d", clocks);
          failed = 1'b1;
        end
      end
      if (quiet == `KAGE_PACK_QUIET && !failed) begin
        $display("kage_pack_tb: FAILED: nothing moves: frame %0d, line %0d, x %0d is missing, beat %0d of %0d waits, clock %0d",
                 out_frame, out_line, out_x, beat, `KAGE_PACK_BEATS, clocks);
        failed = 1'b1;
      end
    end
  end

  // ---- registers ---------------------------------------------------------------------------------------------------
  task read;
    input [7:0] address;
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
      if (^rdata === 1'bx && !failed) begin
        $display("kage_pack_tb: FAILED: the register at %h is %h, clock %0d", address, rdata, clocks);
        failed = 1'b1;
      end
      if (rresp !== 2'b00 && !failed) begin
        $display("kage_pack_tb: FAILED: the register at %h answers an error, clock %0d", address, clocks);
        failed = 1'b1;
      end
      @(negedge clk);
      rready = 1'b0;
    end
  endtask

  initial begin
    {arvalid, araddr, rready} = 10'd0;
    @(posedge rst_n);
    for (f = 0; f < `KAGE_PACK_FRAMES && !failed; f = f + 1) begin
      allowed <= f;
      lines = lines + frames[f][95:64];
      if (frames[f][0]) begin
        value = 0;
        while ((value != f + 1 || line != lines) && !failed) read(`KAGE_PACK_REG_FRAMES);
        while (r < `KAGE_PACK_READS && reads[r][127:96] == f && !failed) begin
          read(reads[r][71:64]);
          if ((value & reads[r][63:32]) !== reads[r][31:0] && !failed) begin
            $display("kage_pack_tb: FAILED: behind frame %0d the register at %h is %h, expected %h in the bits %h, clock %0d",
                     f, reads[r][71:64], value, reads[r][31:0], reads[r][63:32], clocks);
            failed = 1'b1;
          end
          r = r + 1;
        end
      end
    end
    repeat (100) if (!failed) @(negedge clk);  // a pixel too many would come by now
    if (!failed && (pixel != `KAGE_PACK_PIXELS || line != `KAGE_PACK_LINES || beat != `KAGE_PACK_BEATS ||
                    r != `KAGE_PACK_READS)) begin
      $display("kage_pack_tb: FAILED: only %0d of %0d pixels, %0d of %0d beats, %0d of %0d registers", pixel,
               `KAGE_PACK_PIXELS, beat, `KAGE_PACK_BEATS, r, `KAGE_PACK_READS);
      failed = 1'b1;
    end
    if (!failed)
      $display("kage_pack_tb: passed: %0d pixels, %0d lines, %0d frames, %0d registers, %0d clocks", pixel, line,
               `KAGE_PACK_FRAMES, r, clocks);
    $finish;
  end

endmodule

`default_nettype wire
