// SPDX-License-Identifier: Apache-2.0
// The models of verif/cosim/model/cells/ecp5.v beside yosys' own, which run.sh gives the names tool_...: the same
// outputs for all or for random inputs. Models of DP16KD and MULT18X18D are missing in yosys: those are held against
// RTL alone (pieces.sv).
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

  logic [8:0] in = 9'd0;
  logic clk = 1'b0;

  // ---- without state -----------------------------------------------------------------------------------------------
  wire [15:0] lut, tool_lut, chain[32], tool_chain[32];
  for (genvar g = 0; g < 16; g++) begin : gen_lut
    localparam logic [15:0] Init = 16'(g * 40503 + 12345);
    LUT4 #(
        .INIT(Init)
    ) u_ours (
        .A(in[0]),
        .B(in[1]),
        .C(in[2]),
        .D(in[3]),
        .Z(lut[g])
    );
    tool_LUT4 #(
        .INIT(Init)
    ) u_tool (
        .A(in[0]),
        .B(in[1]),
        .C(in[2]),
        .D(in[3]),
        .Z(tool_lut[g])
    );
  end
  for (genvar g = 0; g < 32; g++) begin : gen_chain
    // An adder's, a subtractor's, and any.
    localparam logic [15:0] Init0 = g < 4 ? 16'h96aa : 16'(g * 40503 + 777);
    localparam logic [15:0] Init1 = g < 8 ? 16'h96aa : 16'(g * 30011 + 4242);
    assign chain[g][15:3] = '0;
    assign tool_chain[g][15:3] = '0;
    CCU2C #(
        .INIT0(Init0),
        .INIT1(Init1),
        .INJECT1_0(g % 2 ? "YES" : "NO"),
        .INJECT1_1(g / 2 % 2 ? "YES" : "NO")
    ) u_ours (
        .CIN (in[8]),
        .A0  (in[0]),
        .B0  (in[1]),
        .C0  (in[2]),
        .D0  (in[3]),
        .A1  (in[4]),
        .B1  (in[5]),
        .C1  (in[6]),
        .D1  (in[7]),
        .S0  (chain[g][0]),
        .S1  (chain[g][1]),
        .COUT(chain[g][2])
    );
    tool_CCU2C #(
        .INIT0(Init0),
        .INIT1(Init1),
        .INJECT1_0(g % 2 ? "YES" : "NO"),
        .INJECT1_1(g / 2 % 2 ? "YES" : "NO")
    ) u_tool (
        .CIN (in[8]),
        .A0  (in[0]),
        .B0  (in[1]),
        .C0  (in[2]),
        .D0  (in[3]),
        .A1  (in[4]),
        .B1  (in[5]),
        .C1  (in[6]),
        .D1  (in[7]),
        .S0  (tool_chain[g][0]),
        .S1  (tool_chain[g][1]),
        .COUT(tool_chain[g][2])
    );
  end
  wire [1:0] mux, tool_mux;
  PFUMX u_mux0 (
      .ALUT(in[0]),
      .BLUT(in[1]),
      .C0(in[2]),
      .Z(mux[0])
  );
  L6MUX21 u_mux1 (
      .D0(in[0]),
      .D1(in[1]),
      .SD(in[2]),
      .Z (mux[1])
  );
  tool_PFUMX u_tool_mux0 (
      .ALUT(in[0]),
      .BLUT(in[1]),
      .C0(in[2]),
      .Z(tool_mux[0])
  );
  tool_L6MUX21 u_tool_mux1 (
      .D0(in[0]),
      .D1(in[1]),
      .SD(in[2]),
      .Z (tool_mux[1])
  );

  // ---- with state --------------------------------------------------------------------------------------------------
  logic ce = 1'b0, lsr = 1'b0, di = 1'b0, wre = 1'b0;
  logic [3:0] data = '0, wad = '0, rad = '0;
  wire [15:0] q, tool_q;
  for (genvar g = 0; g < 16; g++) begin : gen_ff
    localparam logic [23:0] CeMux = g % 4 == 0 ? "1" : g % 4 == 1 ? "INV" : "CE";
    TRELLIS_FF #(
        .CEMUX (CeMux),
        .LSRMUX(g / 4 % 2 ? "INV" : "LSR"),
        .REGSET(g / 8 ? "SET" : "RESET")
    ) u_ours (
        .CLK(clk),
        .LSR(lsr),
        .CE (ce),
        .DI (di),
        .Q  (q[g])
    );
    tool_TRELLIS_FF #(
        .CEMUX (CeMux),
        .LSRMUX(g / 4 % 2 ? "INV" : "LSR"),
        .REGSET(g / 8 ? "SET" : "RESET")
    ) u_tool (
        .CLK(clk),
        .LSR(lsr),
        .CE (ce),
        .DI (di),
        .M  (1'b0),
        .Q  (tool_q[g])
    );
  end
  // Not WREMUX "1": in yosys' model a constant wakes nobody.
  wire [3:0] few[3], tool_few[3];
  for (genvar g = 0; g < 3; g++) begin : gen_few
    localparam logic [23:0] WreMux = g == 0 ? "0" : g == 1 ? "INV" : "WRE";
    TRELLIS_DPR16X4 #(
        .WREMUX(WreMux)
    ) u_ours (
        .DI (data),
        .WAD(wad),
        .WRE(wre),
        .WCK(clk),
        .RAD(rad),
        .DO (few[g])
    );
    tool_TRELLIS_DPR16X4 #(
        .WREMUX(WreMux)
    ) u_tool (
        .DI (data),
        .WAD(wad),
        .WRE(wre),
        .WCK(clk),
        .RAD(rad),
        .DO (tool_few[g])
    );
    initial for (int i = 0; i < 16; i++) u_ours.memory[i] = 4'd0;  // as yosys' begins
  end

  initial begin
    for (int n = 0; n < 512; n++) begin
      in = 9'(n);
      #1 same("LUT4", lut, tool_lut);
      same("PFUMX or L6MUX21", 16'(mux), 16'(tool_mux));
      for (int g = 0; g < 32; g++) same($sformatf("CCU2C %0d", g), chain[g], tool_chain[g]);
    end
    wre = 1'b1;  // yosys' model looks at WRE when it changes
    #1;
    for (int n = 0; n < 4000; n++) begin
      // First each of the ways in which a flip-flop is set, so that none is X.
      {ce, lsr, di, wre} = n < 4 ? {2'(n), 2'b10} : 4'($urandom);
      data = 4'($urandom);
      wad = 4'($urandom);
      rad = 4'($urandom);
      #1 clk = 1'b1;
      #1 clk = 1'b0;
      if (n > 3) same("TRELLIS_FF", q, tool_q);
      if (n > 3) for (int g = 0; g < 3; g++) same($sformatf("TRELLIS_DPR16X4 %0d", g), 16'(few[g]), 16'(tool_few[g]));
    end
    if (!failed) $display("cells_tb: passed: %0d comparisons", compared);
    $finish;
  end
endmodule

`default_nettype wire
