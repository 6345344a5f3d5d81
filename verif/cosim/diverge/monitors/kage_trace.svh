// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor: how an event is handed to the model's driver. rtl/defs/stages.yaml says what the stages'
// events hold.
/* verilator lint_off UNUSEDPARAM */
`include "kage_trace_numbers.svh"
localparam int TraceBits = 64 * TraceValues;
/* verilator lint_on UNUSEDPARAM */

import "DPI-C" function void kage_trace(input int stage, input int unit, input bit [TraceBits-1:0] values);

`include "kage_trace_stages.svh"

// A watched module's outputs as they should be, and as they are: an event where they differ.
function automatic void trace_module(input int part, input logic [511:0] expected, input logic [511:0] actual);
  logic [511:0] differing;
  differing = expected ^ actual;
  if (differing != '0) begin
    for (int i = 0; i < 8; i++) begin
      if (differing[i*64+:64] != '0) begin
        trace_part(0, 64'(part), expected[i*64+:64], actual[i*64+:64]);
        differing = '0;
      end
    end
  end
endfunction
