// SPDX-License-Identifier: Apache-2.0
// Plays a module's pack (kage vectors --module): its inputs clock by clock, and holds its outputs against those that were
// recorded, where care.hex is 1. Plain Verilog-2005; run it in the pack's folder. With KAGE_MODULE_NETLIST the module has
// no parameters, as synthesis leaves it. +dump writes kage_module.vcd.
//
// Exactly one line begins "kage_module_tb: ", and then the simulation ends by $finish: "passed: ..." or "FAILED: ...".
// Inputs change at falling edges and outputs are looked at shortly before rising ones.
`timescale 1ns / 1ps
`include "kage_module.vh"
`default_nettype none

module kage_module_tb;
  reg [`KAGE_MODULE_IN_BITS-1:0] inputs[0:`KAGE_MODULE_CLOCKS-1];
  reg [`KAGE_MODULE_OUT_BITS-1:0] outputs[0:`KAGE_MODULE_CLOCKS-1];
  reg [`KAGE_MODULE_OUT_BITS-1:0] cares[0:`KAGE_MODULE_CLOCKS-1];
  reg [`KAGE_MODULE_IN_BITS-1:0] in;
  reg [`KAGE_MODULE_OUT_BITS-1:0] wanted, care;
  wire [`KAGE_MODULE_OUT_BITS-1:0] out;
  reg clk;
  integer n;

`ifdef KAGE_MODULE_NETLIST
  `KAGE_MODULE dut (`KAGE_MODULE_PORTS);
`else
  `KAGE_MODULE #(`KAGE_MODULE_PARAMETERS) dut (`KAGE_MODULE_PORTS);
`endif

  initial begin
    clk = 1'b0;
    in = 0;
    $readmemh("inputs.hex", inputs);
    $readmemh("outputs.hex", outputs);
    $readmemh("care.hex", cares);
    if ($test$plusargs("dump")) begin
      $dumpfile("kage_module.vcd");
      $dumpvars;
    end
    if (^inputs[`KAGE_MODULE_CLOCKS-1] === 1'bx || ^outputs[`KAGE_MODULE_CLOCKS-1] === 1'bx ||
        ^cares[`KAGE_MODULE_CLOCKS-1] === 1'bx || cares[`KAGE_MODULE_CLOCKS-1] == 0) begin
      $display("kage_module_tb: FAILED: a .hex file is missing or short: is this the pack's folder?");
      $finish;
    end
    for (n = 0; n < 4; n = n + 1) begin  // the pack begins behind a reset
      in = inputs[0];
      in[`KAGE_MODULE_RESET] = 1'b0;
      #10 clk = 1'b1;
      #5 clk = 1'b0;
    end
    for (n = 0; n < `KAGE_MODULE_CLOCKS; n = n + 1) begin
      in = inputs[n];
      wanted = outputs[n];
      care = cares[n];
      #9;
      if (((out ^ wanted) & care) !== 0) begin
        $display("kage_module_tb: FAILED: clock %0d of %0d:", n, `KAGE_MODULE_CLOCKS);
        `KAGE_MODULE_TELL
        $finish;
        n = `KAGE_MODULE_CLOCKS + 1;
      end
      #1 clk = 1'b1;
      #5 clk = 1'b0;
    end
    if (n == `KAGE_MODULE_CLOCKS) $display("kage_module_tb: passed: %0d clocks", n);
    $finish;
  end

endmodule

`default_nettype wire
