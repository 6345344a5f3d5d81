// SPDX-License-Identifier: Apache-2.0
// The models of verif/cosim/model/cells/ice40.v beside yosys' own, which run.sh gives the names tool_SB_...: the same
// outputs for all or for random inputs.
`default_nettype none

module cells_tb;
  logic failed = 1'b0;
  int   compared = 0;
  task automatic same(input string what, input logic [15:0] ours, input logic [15:0] theirs);
    compared++;
    if (ours !== theirs) begin
      $display("cells_tb: FAILED: %s gives %h, yosys' model %h", what, ours, theirs);
      failed = 1'b1;
      $finish;
    end
  endtask

  logic [3:0] in = 4'd0;
  logic clk = 1'b0, d = 1'b0, e = 1'b0, r = 1'b0;

  // ---- without state -----------------------------------------------------------------------------------------------
  wire [15:0] lut, tool_lut;
  for (genvar g = 0; g < 16; g++) begin : gen_lut
    localparam logic [15:0] Init = 16'(g * 40503 + 12345);
    SB_LUT4 #(
        .LUT_INIT(Init)
    ) u_ours (
        .I0(in[0]),
        .I1(in[1]),
        .I2(in[2]),
        .I3(in[3]),
        .O (lut[g])
    );
    tool_SB_LUT4 #(
        .LUT_INIT(Init)
    ) u_tool (
        .I0(in[0]),
        .I1(in[1]),
        .I2(in[2]),
        .I3(in[3]),
        .O (tool_lut[g])
    );
  end
  wire carry, tool_carry;
  SB_CARRY u_carry (
      .I0(in[0]),
      .I1(in[1]),
      .CI(in[2]),
      .CO(carry)
  );
  tool_SB_CARRY u_tool_carry (
      .I0(in[0]),
      .I1(in[1]),
      .CI(in[2]),
      .CO(tool_carry)
  );

  // ---- flip-flops --------------------------------------------------------------------------------------------------
  wire [5:0] q, tool_q;
  SB_DFF u_0 (
      .C(clk),
      .D(d),
      .Q(q[0])
  );
  SB_DFFE u_1 (
      .C(clk),
      .E(e),
      .D(d),
      .Q(q[1])
  );
  SB_DFFSR u_2 (
      .C(clk),
      .R(r),
      .D(d),
      .Q(q[2])
  );
  SB_DFFSS u_3 (
      .C(clk),
      .S(r),
      .D(d),
      .Q(q[3])
  );
  SB_DFFESR u_4 (
      .C(clk),
      .E(e),
      .R(r),
      .D(d),
      .Q(q[4])
  );
  SB_DFFESS u_5 (
      .C(clk),
      .E(e),
      .S(r),
      .D(d),
      .Q(q[5])
  );
  tool_SB_DFF u_tool_0 (
      .C(clk),
      .D(d),
      .Q(tool_q[0])
  );
  tool_SB_DFFE u_tool_1 (
      .C(clk),
      .E(e),
      .D(d),
      .Q(tool_q[1])
  );
  tool_SB_DFFSR u_tool_2 (
      .C(clk),
      .R(r),
      .D(d),
      .Q(tool_q[2])
  );
  tool_SB_DFFSS u_tool_3 (
      .C(clk),
      .S(r),
      .D(d),
      .Q(tool_q[3])
  );
  tool_SB_DFFESR u_tool_4 (
      .C(clk),
      .E(e),
      .R(r),
      .D(d),
      .Q(tool_q[4])
  );
  tool_SB_DFFESS u_tool_5 (
      .C(clk),
      .E(e),
      .S(r),
      .D(d),
      .Q(tool_q[5])
  );

  // ---- memories of all modes ---------------------------------------------------------------------------------------
  logic [10:0] waddr = '0, raddr = '0;
  logic [15:0] mask = '0, wdata = '0;
  logic we = 1'b0, wclke = 1'b0, re = 1'b0, rclke = 1'b0;
  wire [15:0] rdata[16], tool_rdata[16];
  for (genvar g = 0; g < 16; g++) begin : gen_ram
    SB_RAM40_4K #(
        .WRITE_MODE(g % 4),
        .READ_MODE (g / 4)
    ) u_ours (
        .RDATA(rdata[g]),
        .RCLK(clk),
        .RCLKE(rclke),
        .RE(re),
        .RADDR(raddr),
        .WCLK(clk),
        .WCLKE(wclke),
        .WE(we),
        .WADDR(waddr),
        .MASK(mask),
        .WDATA(wdata)
    );
    tool_SB_RAM40_4K #(
        .WRITE_MODE(g % 4),
        .READ_MODE (g / 4)
    ) u_tool (
        .RDATA(tool_rdata[g]),
        .RCLK(clk),
        .RCLKE(rclke),
        .RE(re),
        .RADDR(raddr),
        .WCLK(clk),
        .WCLKE(wclke),
        .WE(we),
        .WADDR(waddr),
        .MASK(mask),
        .WDATA(wdata)
    );
    // Every bit is written before one is read; yosys' memories begin with 0, ours with X.
    initial for (int i = 0; i < 256; i++) u_ours.memory[i] = 16'd0;
  end

  initial begin
    for (int n = 0; n < 16; n++) begin
      in = 4'(n);
      #1 same("SB_LUT4", lut, tool_lut);
      same("SB_CARRY", 16'(carry), 16'(tool_carry));
    end
    for (int n = 0; n < 700; n++) begin
      {d, e, r} = n < 3 ? 3'b010 : 3'($urandom);
      {we, wclke, re, rclke} = n < 3 ? 4'b1111 : 4'($urandom) | 4'($urandom);
      // Eight words, in all slots.
      waddr = 11'($urandom) & 11'h703;
      raddr = 11'($urandom) & 11'h703;
      if (waddr[7:0] == raddr[7:0]) re = 1'b0;  // ours gives X, yosys' the old word
      mask  = n < 3 ? 16'd0 : 16'($urandom);
      wdata = 16'($urandom);
      #1 clk = 1'b1;
      #1 clk = 1'b0;
      if (n > 2) begin
        same("a flip-flop", 16'(q), 16'(tool_q));
        for (int g = 0; g < 16; g++)
        same($sformatf("SB_RAM40_4K of modes %0d, %0d", g % 4, g / 4), rdata[g], tool_rdata[g]);
      end
    end
    if (!failed) $display("cells_tb: passed: %0d comparisons", compared);
    $finish;
  end
endmodule

`default_nettype wire
