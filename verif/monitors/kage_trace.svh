// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor: how an event is handed to the model's driver. build.py makes
// kage_trace_numbers.svh of rtl_model.h: KAGE_STAGE_TOKEN is StageToken, KAGE_PART_RAM_1R1W PartRam1r1w.
/* verilator lint_off UNUSEDPARAM */
`include "kage_trace_numbers.svh"
localparam int TraceBits = 64 * TraceValues;
/* verilator lint_on UNUSEDPARAM */

import "DPI-C" function void kage_trace(input int stage, input int unit, input bit [TraceBits-1:0] values);

// The values of an event, the first lowest.
function automatic logic [TraceBits-1:0] trace5(input logic [63:0] v0, input logic [63:0] v1, input logic [63:0] v2,
                                                input logic [63:0] v3, input logic [63:0] v4);
  trace5 = TraceBits'({v4, v3, v2, v1, v0});
endfunction

// A small module's outputs as they should be, and as they are: an event where they differ.
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
