// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor: how an event is handed to the model's driver. Stages are those of rtl_model.h.
/* verilator lint_off UNUSEDPARAM */
localparam int TraceValues = 13;
localparam int TraceBits = 64 * TraceValues;
localparam int StageToken = 0;
localparam int StageTable = 1;
localparam int StageFace = 2;
localparam int StageSegment = 3;
localparam int StageUnit = 4;
localparam int StageTree = 5;
localparam int StageLine = 6;
localparam int StageCommand = 7;
localparam int StagePixel = 8;
localparam int StageExit = 9;
localparam int StageLoad = 10;
localparam int StageOut = 11;
localparam int StageError = 12;
localparam int StagePart = 13;
localparam int StageClaim = 14;
localparam int StageState = 15;
localparam int StageEnd = 16;
localparam int StageHandshake = 17;
/* verilator lint_on UNUSEDPARAM */

import "DPI-C" function void kage_trace(input int stage, input int unit, input bit [TraceBits-1:0] values);

// The values of an event, the first lowest.
function automatic logic [TraceBits-1:0] trace5(input logic [63:0] v0, input logic [63:0] v1, input logic [63:0] v2,
                                                input logic [63:0] v3, input logic [63:0] v4);
  trace5 = TraceBits'({v4, v3, v2, v1, v0});
endfunction

// A small module's outputs as they should be, and as they are: an event where they differ.
/* verilator lint_off UNUSEDPARAM */
localparam int PartRam1r1w = 0;
localparam int PartStreamFifo = 1;
localparam int PartSkidBuffer = 2;
localparam int PartCompareCell = 3;
localparam int PartLightResolve = 4;
localparam int PartPixelLoads = 5;
localparam int PartLaneRamp = 6;
localparam int PartTokenCommand = 7;
localparam int PartPixels = 8;
localparam int PartTreeCore = 9;
localparam int PartTop = 10;
localparam int PartPixelCore = 11;
localparam int PartCompareTree = 12;
localparam int PartExpansionUnit = 13;
localparam int PartFrameControl = 14;
localparam int PartTableCheck = 15;
/* verilator lint_on UNUSEDPARAM */
function automatic void trace_part(input int part, input logic [511:0] expected, input logic [511:0] actual);
  logic [511:0] off;
  off = expected ^ actual;
  if (off != '0) begin
    for (int i = 0; i < 8; i++) begin
      if (off[i*64+:64] != '0) begin
        kage_trace(StagePart, 0, trace5(64'(part), expected[i*64+:64], actual[i*64+:64], 64'd0, 64'd0));
        off = '0;
      end
    end
  end
endfunction
