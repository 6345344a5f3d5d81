// SPDX-License-Identifier: Apache-2.0
// Who waits for whom: kage_rtl_table::handshakes() of rtl_model.h.
// Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_handshakes_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic token_valid,
    input wire logic token_ready,
    input wire logic held_valid,        // a token waits in token_stage
    input wire logic held_ready,
    input wire logic header,            // it is one
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
    input wire logic dropping,
    input wire logic rest_comes         // the token behind one at fault is waited for, to be dropped
);
  `include "kage_trace.svh"

  // Who waits for whom, every clock; the driver keeps the newest.
  logic [HandshakeBits-1:0] now;
  always_comb begin
    now = '0;
    now[HandshakeTokenReady] = held_valid ? held_ready : token_ready;
    now[HandshakeTokenValid] = held_valid || token_valid;
    now[HandshakeSegmentReady] = tree_seg_ready;
    now[HandshakeSegmentValid] = tree_seg_valid;
    now[HandshakeTreeReady] = tree_ready;
    now[HandshakeTreeValid] = tree_valid;
    now[HandshakeCommandReady] = cmd_ready;
    now[HandshakeCommandValid] = cmd_valid;
    now[HandshakePixelReady] = pixel_ready;
    now[HandshakePixelValid] = pixel_valid;
    now[HandshakeLineReady] = line_ready;
    now[HandshakeLineValid] = line_valid;
    now[HandshakeLoadReady] = load_ready;
    now[HandshakeLoadValid] = load_valid;
    now[HandshakeVideoReady] = m_axis_tready_i;
    now[HandshakeVideoValid] = m_axis_tvalid_o;
    now[HandshakeFrameReady] = UNITS == 0 || tree_frame_ready;
    now[HandshakeFrameValid] = held_valid && header;
    now[HandshakeExitReady] = exit_free;
    now[HandshakeExitValid] = pixel_valid && !pixel_ready;
    now[HandshakeReturnLineValid] = loading && !load_valid && !queue_valid;  // never ready
    now[HandshakeDropping] = dropping || rest_comes;
  end

  always_ff @(posedge clk_i) if (rst_ni) kage_trace(StageHandshake, 0, TraceBits'(now));

endmodule

bind kage_top kage_top_handshakes_monitor #(
    `include "generated/kage_impl_param_map.svh"
    `include "generated/kage_pixel_param_map.svh"
) u_handshakes_monitor (
    .held_valid(u_control.held_valid),
    .held_ready(u_control.held_ready),
    .header    (u_control.verdict.header),
    .loading   (u_control.loading_q),
    .rest_comes(u_control.rest_comes),
    .*
);

`default_nettype wire
