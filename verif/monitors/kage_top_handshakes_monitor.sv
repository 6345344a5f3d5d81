// SPDX-License-Identifier: Apache-2.0
// Who waits for whom: kage_rtl_table::handshakes() of rtl_model.h.
// Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_handshakes_monitor #(
    `include "kage_pixel_params.svh"
    `include "kage_widths.svh"
    `include "kage_impl_params.svh"
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic token_valid,
    input wire logic token_ready,
    input wire logic token_header,
    input wire logic cmd_valid,
    input wire logic cmd_ready,
    input wire logic pixel_valid,
    input wire logic pixel_ready,
    input wire logic line_valid,
    input wire logic line_ready,
    input wire logic tree_frame_ready,
    input wire logic tree_seg_valid,
    input wire logic tree_seg_ready,
    input wire logic tree_valid,
    input wire logic tree_ready,
    input wire logic exit_free,
    input wire logic load_valid,
    input wire logic load_ready,
    input wire logic m_axis_tvalid_o,
    input wire logic m_axis_tready_i,
    input wire logic queue_valid,
    input wire logic loading,           // frame_control waits for a line to come back
    input wire logic dropping
);
  `include "kage_trace.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      // Who waits for whom, every clock; the driver keeps the newest.
      kage_trace(StageHandshake, 0, TraceBits'({
                 dropping,
                 loading && !load_valid && !queue_valid,
                 1'b0,
                 pixel_valid && !pixel_ready,
                 exit_free,
                 token_valid && token_header,
                 UNITS == 0 || tree_frame_ready,
                 m_axis_tvalid_o,
                 m_axis_tready_i,
                 load_valid,
                 load_ready,
                 line_valid,
                 line_ready,
                 pixel_valid,
                 pixel_ready,
                 cmd_valid,
                 cmd_ready,
                 tree_valid,
                 tree_ready,
                 tree_seg_valid,
                 tree_seg_ready,
                 token_valid,
                 token_ready
                 }));
    end
  end

endmodule

bind kage_top kage_top_handshakes_monitor #(
    `include "kage_pixel_param_map.svh"
    `include "kage_impl_param_map.svh"
) u_handshakes_monitor (
    .loading(u_control.loading_q),
    .*
);

`default_nettype wire
