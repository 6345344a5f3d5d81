// SPDX-License-Identifier: Apache-2.0
// Whether kage_top gives each module what the net of that name has, and says of itself what its nets say.
`default_nettype none

module kage_top_wires_monitor #(
    parameter int UNITS = 0
) (
    input wire logic clk_i,
    input wire logic rst_ni
);
  `include "kage_trace.svh"

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.s_axis_tvalid_i,
                 kage_top.s_axis_tdata_i,
                 kage_top.s_axis_tlast_i,
                 kage_top.token_ready,
                 kage_top.drop
                 } == {
                 kage_top.u_reader.s_valid_i,
                 kage_top.u_reader.s_data_i,
                 kage_top.u_reader.s_last_i,
                 kage_top.u_reader.token_ready_i,
                 kage_top.u_reader.drop_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.token_valid,
                 kage_top.token,
                 kage_top.token_header,
                 kage_top.token_lacking,
                 kage_top.token_cut,
                 kage_top.token_final,
                 kage_top.token_at_last,
                 kage_top.dropping,
                 kage_top.cmd_ready,
                 kage_top.loads_done,
                 kage_top.line_ready,
                 kage_top.table_free,
                 kage_top.tree_frame_ready,
                 kage_top.tree_seg_ready
                 } == {
                 kage_top.u_control.token_valid_i,
                 kage_top.u_control.token_i,
                 kage_top.u_control.token_header_i,
                 kage_top.u_control.token_lacking_i,
                 kage_top.u_control.token_cut_i,
                 kage_top.u_control.token_final_i,
                 kage_top.u_control.token_at_last_i,
                 kage_top.u_control.dropping_i,
                 kage_top.u_control.cmd_ready_i,
                 kage_top.u_control.loads_done_i,
                 kage_top.u_control.line_ready_i,
                 kage_top.u_control.table_free_i,
                 kage_top.u_control.tree_frame_ready_i,
                 kage_top.u_control.tree_seg_ready_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.line_valid,
                 kage_top.line_first,
                 kage_top.line_blank,
                 kage_top.line_load,
                 kage_top.line_painted,
                 kage_top.line_width,
                 kage_top.line_background,
                 kage_top.line_shade,
                 kage_top.queue_ready
                 } == {
                 kage_top.u_lines.in_valid_i, kage_top.u_lines.in_data_i, kage_top.u_lines.out_ready_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.cmd_valid,
                 kage_top.cmd_kind,
                 kage_top.cmd_xl,
                 kage_top.cmd_xr,
                 kage_top.cmd_color,
                 kage_top.cmd_dcolor,
                 kage_top.load_valid,
                 kage_top.load_x,
                 kage_top.load_color,
                 kage_top.load_last,
                 kage_top.pixel_ready
                 } == {
                 kage_top.u_loads.in_valid_i,
                 kage_top.u_loads.in_kind_i,
                 kage_top.u_loads.in_xl_i,
                 kage_top.u_loads.in_xr_i,
                 kage_top.u_loads.in_color_i,
                 kage_top.u_loads.in_dcolor_i,
                 kage_top.u_loads.load_valid_i,
                 kage_top.u_loads.load_x_i,
                 kage_top.u_loads.load_color_i,
                 kage_top.u_loads.load_last_i,
                 kage_top.u_loads.out_ready_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.pixel_valid,
                 kage_top.pixel_kind,
                 kage_top.pixel_xl,
                 kage_top.pixel_xr,
                 kage_top.cmd_count,
                 kage_top.cmd_z,
                 kage_top.cmd_dz,
                 kage_top.pixel_color,
                 kage_top.pixel_dcolor,
                 kage_top.cmd_share,
                 kage_top.tree_valid,
                 kage_top.tree_z,
                 kage_top.tree_class,
                 kage_top.tree_color,
                 kage_top.tree_last,
                 kage_top.tree_drop,
                 kage_top.exit_free
                 } == {
                 kage_top.u_pixels.cmd_valid_i,
                 kage_top.u_pixels.cmd_kind_i,
                 kage_top.u_pixels.cmd_xl_i,
                 kage_top.u_pixels.cmd_xr_i,
                 kage_top.u_pixels.cmd_count_i,
                 kage_top.u_pixels.cmd_z_i,
                 kage_top.u_pixels.cmd_dz_i,
                 kage_top.u_pixels.cmd_color_i,
                 kage_top.u_pixels.cmd_dcolor_i,
                 kage_top.u_pixels.cmd_share_i,
                 kage_top.u_pixels.tree_valid_i,
                 kage_top.u_pixels.tree_z_i,
                 kage_top.u_pixels.tree_class_i,
                 kage_top.u_pixels.tree_color_i,
                 kage_top.u_pixels.tree_last_i,
                 kage_top.u_pixels.tree_drop_i,
                 kage_top.u_pixels.exit_free_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.exit_take,
                 kage_top.exit_valid,
                 kage_top.exit_last,
                 kage_top.exit_data,
                 kage_top.queue_valid,
                 kage_top.queue_first,
                 kage_top.queue_blank,
                 kage_top.queue_load,
                 kage_top.queue_painted,
                 kage_top.queue_width,
                 kage_top.queue_background,
                 kage_top.queue_shade
                 } == {
                 kage_top.u_out.exit_take_i,
                 kage_top.u_out.exit_valid_i,
                 kage_top.u_out.exit_last_i,
                 kage_top.u_out.exit_data_i,
                 kage_top.u_out.line_valid_i,
                 kage_top.u_out.line_first_i,
                 kage_top.u_out.line_blank_i,
                 kage_top.u_out.line_load_i,
                 kage_top.u_out.line_painted_i,
                 kage_top.u_out.line_width_i,
                 kage_top.u_out.line_background_i,
                 kage_top.u_out.line_shade_i
                 }));
      trace_module(PartTop, 512'd1,
                   512'({
                 kage_top.table_valid,
                 kage_top.table_class,
                 kage_top.table_light,
                 kage_top.table_share,
                 kage_top.load_ready,
                 kage_top.m_axis_tready_i
                 } == {
                 kage_top.u_out.table_valid_i,
                 kage_top.u_out.table_class_i,
                 kage_top.u_out.table_light_i,
                 kage_top.u_out.table_share_i,
                 kage_top.u_out.load_ready_i,
                 kage_top.u_out.m_ready_i
                 }));
      // STATUS and the counters
      trace_module(PartTop, 512'({
                   kage_top.in_frame || kage_top.lines_q != '0,
                   kage_top.m_axis_tvalid_o && !kage_top.m_axis_tready_i,
                   kage_top.frame_end,
                   kage_top.error,
                   kage_top.draining,
                   kage_top.behind
                   }), 512'({
                   kage_top.u_registers.open_i,
                   kage_top.u_registers.waiting_output_i,
                   kage_top.u_registers.frame_end_i,
                   kage_top.u_registers.error_i,
                   kage_top.u_registers.draining_i,
                   kage_top.u_registers.behind_i
                   }));
      trace_module(PartTop, 512'({
                   kage_top.error_code,
                   kage_top.error_frame,
                   kage_top.error_line,
                   kage_top.error_token,
                   kage_top.error_unit,
                   kage_top.behind_unit,
                   kage_top.behind_line
                   }), 512'({
                   kage_top.u_registers.error_code_i,
                   kage_top.u_registers.error_frame_i,
                   kage_top.u_registers.error_line_i,
                   kage_top.u_registers.error_token_i,
                   kage_top.u_registers.error_unit_i,
                   kage_top.u_registers.behind_unit_i,
                   kage_top.u_registers.behind_line_i
                   }));
    end
  end

  if (UNITS > 0) begin : gen_tree
    always_ff @(posedge clk_i) begin
      if (rst_ni) begin
        trace_module(PartTop, 512'd1,
                     512'({
                   kage_top.tree_frame_start,
                   kage_top.tree_flush,
                   kage_top.tree_claim,
                   kage_top.line_width,
                   kage_top.tree_face_valid,
                   kage_top.tree_unit,
                   kage_top.tree_face,
                   kage_top.tree_entry,
                   kage_top.tree_seg_valid,
                   kage_top.tree_unit,
                   kage_top.tree_seg_z,
                   kage_top.tree_dx,
                   kage_top.tree_face,
                   kage_top.tree_ready
                   } == {
                   kage_top.gen_tree.u_tree.frame_start_i,
                   kage_top.gen_tree.u_tree.flush_i,
                   kage_top.gen_tree.u_tree.claim_i,
                   kage_top.gen_tree.u_tree.width_i,
                   kage_top.gen_tree.u_tree.face_valid_i,
                   kage_top.gen_tree.u_tree.face_unit_i,
                   kage_top.gen_tree.u_tree.face_number_i,
                   kage_top.gen_tree.u_tree.face_entry_i,
                   kage_top.gen_tree.u_tree.seg_valid_i,
                   kage_top.gen_tree.u_tree.seg_unit_i,
                   kage_top.gen_tree.u_tree.seg_z_i,
                   kage_top.gen_tree.u_tree.seg_dx_i,
                   kage_top.gen_tree.u_tree.seg_face_i,
                   kage_top.gen_tree.u_tree.line_ready_i
                   }));
      end
    end
  end

endmodule

bind kage_top kage_top_wires_monitor #(.UNITS(UNITS)) u_wires_monitor (.*);

`default_nettype wire
