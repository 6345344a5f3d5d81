// SPDX-License-Identifier: Apache-2.0
// hls_edge_setup from its ports alone: where an edge crosses a line's centre, and its step, by division. The kernel's
// result is not checked for an edge that does not go down, nor for a line that the edge does not cross.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module hls_edge_setup_monitor #(
    parameter int LINE_BITS = 1
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 in_valid_i,
    input wire logic                 in_ready_o,
    input wire logic                 out_valid_o,
    input wire logic                 out_ready_i,
    input wire logic [         23:0] top_x_i,
    input wire logic [         23:0] top_y_i,
    input wire logic [         23:0] bottom_x_i,
    input wire logic [         23:0] bottom_y_i,
    input wire logic [LINE_BITS-1:0] line_i,
    input wire logic [         16:0] x_o,
    input wire logic [         16:0] step_o,
    input wire logic [         23:0] rest_o,
    input wire logic [         23:0] rest_step_o,
    input wire logic [         23:0] dy_o
);
  `include "kage_trace.svh"

  function automatic longint floored(input longint value, input longint by);
    floored = value / by;
    if (floored * by > value) floored = floored - 1;
  endfunction

  localparam int Depth = 64;  // more than it has stages
  logic [107:0] queue_q[Depth];  // from head_q to tail_q: {x, step, rest, step's rest, dy, are the steps asked, is it}
  int head_q = 0, tail_q = 0;
  logic [107:0] expected;
  bit steps;
  longint top_x, top_y, dx, dy, centre, least, x, step;
  always @(posedge clk_i) begin
    if (!rst_ni) begin
      head_q = tail_q;
    end else begin
      if (out_valid_o) begin
        expected = tail_q != head_q ? queue_q[head_q%Depth] : '0;
        if (tail_q == head_q) trace_module(PartHlsEdgeSetup, '0, 512'(1));
        else if (expected[0]) begin
          trace_module(PartHlsEdgeSetup, 512'({expected[107:91], expected[73:50], expected[25:2]}), 512'({
                       x_o, rest_o, dy_o}));
          if (expected[1])
            trace_module(PartHlsEdgeSetup, 512'({expected[90:74], expected[49:26]}), 512'({step_o, rest_step_o}));
        end
        if (out_ready_i && tail_q != head_q) head_q = head_q + 1;
      end
      if (in_valid_i && in_ready_o) begin
        top_x = 64'($signed(top_x_i));
        top_y = 64'($signed(top_y_i));
        dx = 64'($signed(bottom_x_i)) - top_x;
        dy = 64'($signed(bottom_y_i)) - top_y;
        centre = 64'(line_i) * 256 + 128;
        if (dy > 0 && centre >= top_y && centre < top_y + dy) begin
          least = ((top_x - 128) * dy + (centre - top_y) * dx + 256 * dy - 1) >>> 8;
          x = floored(least, dy);
          step = floored(dx, dy);
          // A step of 2^16 pixels and more is that of an edge which crosses no second line: it is not asked either.
          steps = dx < (dy << 16) && dx >= -(dy << 16);
          queue_q[tail_q%Depth] = {17'(x), 17'(step), 24'(least - x * dy), 24'(dx - step * dy), 24'(dy), steps, 1'b1};
          tail_q = tail_q + 1;
        end else begin
          queue_q[tail_q%Depth] = '0;
          tail_q = tail_q + 1;
        end
      end
    end
  end

endmodule

bind hls_edge_setup hls_edge_setup_monitor #(.LINE_BITS($bits(line_i))) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
