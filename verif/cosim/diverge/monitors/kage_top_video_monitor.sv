// SPDX-License-Identifier: Apache-2.0
// The pixels that go out, as events (rtl/defs/stages.yaml). It needs kage_top's ports alone, so it also fits a netlist.
//
// Ports have the names of kage_top's ports, which `.*` connects.
`default_nettype none

module kage_top_video_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input wire logic               clk_i,
    input wire logic               rst_ni,
    input wire logic               m_axis_tvalid_o,
    input wire logic               m_axis_tready_i,
    input wire logic [RgbBits-1:0] m_axis_tdata_o,
    input wire logic               m_axis_tuser_o,
    input wire logic               m_axis_tlast_o
);
  `include "kage_trace.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni && m_axis_tvalid_o && m_axis_tready_i)
      trace_out(0, 64'(m_axis_tdata_o), 64'(m_axis_tuser_o), 64'(m_axis_tlast_o));
  end

endmodule

bind kage_top kage_top_video_monitor #(
    `include "generated/kage_impl_param_map.svh"
    `include "generated/kage_pixel_param_map.svh"
) u_video_monitor (.*);

`default_nettype wire
