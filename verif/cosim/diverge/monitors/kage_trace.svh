// SPDX-License-Identifier: Apache-2.0
// Included inside a monitor: how an event is handed to the model's driver. rtl/defs/stages.yaml says what the stages'
// events hold.
/* verilator lint_off UNUSEDPARAM */
`include "kage_trace_numbers.svh"
localparam int TraceBits = 64 * TraceValues;
/* verilator lint_on UNUSEDPARAM */

import "DPI-C" function void kage_trace(input int stage, input int unit, input bit [TraceBits-1:0] values);
import "DPI-C" function void kage_trace_part(input int part, input bit [511:0] expected, input bit [511:0] actual);

`include "kage_trace_stages.svh"

// A watched module's outputs as they should be, and as they are: an event where they differ, with the lowest 64 bits that do.
// The driver looks for them: Verilator would write that search out at each of hundreds of places.
function automatic void trace_module(input int part, input logic [511:0] expected, input logic [511:0] actual);
  if (expected != actual) kage_trace_part(part, expected, actual);
endfunction
