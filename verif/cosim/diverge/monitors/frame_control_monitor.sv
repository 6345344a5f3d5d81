// SPDX-License-Identifier: Apache-2.0
// Outputs of line_phase where frame_control uses them, as events (rtl/defs/stages.yaml); and rules of frame_control's
// own outputs. A segment that waits stays. Nothing is taken or given while a line is on its way out and back. Units are
// told of an error. A frame ends with END or once its input has been dropped.
`default_nettype none

module frame_control_monitor #(
    parameter int DSF_BITS = 1,
    parameter int UNITS = 0
) (
    input wire logic                                     clk_i,
    input wire logic                                     rst_ni,
    input wire logic                                     good,
    input wire logic                                     header,
    input wire logic                                     uses_state,
    input wire logic                                     emit_paint,
    input wire logic                                     resolved,
    input wire logic [(DSF_BITS > 0 ? DSF_BITS : 1)-1:0] bias
);
  `include "kage_trace.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni && (emit_paint || (good && !header && uses_state))) begin
      trace_state(0, 64'(bias), 64'(resolved));
    end
  end

  logic waits_q, loading_q;
  logic [255:0] segment, segment_q;
  assign segment = 256'(frame_control.tree_piece_o);
  always_ff @(posedge clk_i) begin
    waits_q   <= rst_ni && frame_control.tree_seg_valid_o && !frame_control.tree_seg_ready_i;
    segment_q <= segment;
    if (!rst_ni || frame_control.loads_done_i) loading_q <= 1'b0;
    else if (frame_control.line_valid_o && frame_control.line.load) loading_q <= 1'b1;
    if (rst_ni) begin
      if (waits_q) begin
        trace_module(PartFrameControl, 512'({1'b1, segment_q}), 512'({frame_control.tree_seg_valid_o, segment}));
      end
      if (loading_q) begin
        trace_module(PartFrameControl, '0, 512'(frame_control.line_valid_o || frame_control.accept));
      end
      trace_module(PartFrameControl, 512'(UNITS > 0 && frame_control.error_valid_o && !header),
                   512'(frame_control.call.flush));
      if (frame_control.frame_end_o) begin
        trace_module(PartFrameControl, 512'd1,
                     512'((good && frame_control.verdict.end_token) || !frame_control.dropping_i));
      end
    end
  end

endmodule

bind frame_control frame_control_monitor #(
    .DSF_BITS(DSF_BITS),
    .UNITS(UNITS)
) u_monitor (
    .good(accept && verdict.good),
    .header(verdict.header),
    .bias(verdict.bias),
    .uses_state(kind == KindEv || kind == KindEs || kind == KindEol),
    .*
);

`default_nettype wire
