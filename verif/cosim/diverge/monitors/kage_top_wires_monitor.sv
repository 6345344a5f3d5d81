// SPDX-License-Identifier: Apache-2.0
// Whether kage_top gives each module what the net of that name has, and says of itself what its nets say.
`default_nettype none

module kage_top_wires_monitor #(
    parameter int UNITS  = 0,
    parameter int ACTIVE = 0
) (
    input wire logic clk_i,
    input wire logic rst_ni
);
  `include "kage_trace.svh"

  // A bit for each module: its inputs are the nets.
  logic reader, front, control, lines, loads, pixels, out, given, tree;
  assign reader = {
    kage_top.s_axis_tvalid_i, kage_top.s_axis_tdata_i, kage_top.s_axis_tlast_i, kage_top.read_ready,
    kage_top.reader_drop
  } == {
    kage_top.u_reader.s_axis_tvalid_i, kage_top.u_reader.s_axis_tdata_i, kage_top.u_reader.s_axis_tlast_i,
    kage_top.u_reader.token_ready_i, kage_top.u_reader.drop_i
  };
  assign control = {
    kage_top.token_valid, kage_top.token, kage_top.flags, kage_top.token_index, kage_top.dropping, kage_top.cmd_ready,
    kage_top.loads_done, kage_top.line_ready, kage_top.table_free, kage_top.tree_frame_ready, kage_top.tree_seg_ready
  } == {
    kage_top.u_control.token_valid_i, kage_top.u_control.token_i,
    kage_top.u_control.token_flags_i, kage_top.u_control.token_index_i, kage_top.u_control.dropping_i,
    kage_top.u_control.cmd_ready_i,
    kage_top.u_control.loads_done_i, kage_top.u_control.line_ready_i, kage_top.u_control.table_free_i,
    kage_top.u_control.tree_frame_ready_i, kage_top.u_control.tree_seg_ready_i
  };
  assign lines = {kage_top.line_valid, kage_top.line, kage_top.queue_ready} == {
    kage_top.u_lines.in_valid_i, kage_top.u_lines.in_data_i, kage_top.u_lines.out_ready_i
  };
  assign loads = {kage_top.cmd_valid, kage_top.cmd, kage_top.load_valid, kage_top.load, kage_top.pixel_ready} == {
    kage_top.u_loads.in_valid_i, kage_top.u_loads.in_i, kage_top.u_loads.load_valid_i, kage_top.u_loads.load_i,
    kage_top.u_loads.out_ready_i
  };
  assign pixels = {
    kage_top.pixel_valid, kage_top.pixel_cmd, kage_top.tree_valid, kage_top.tree_pixel, kage_top.tree_drop,
    kage_top.exit_free
  } == {
    kage_top.u_pixels.cmd_valid_i, kage_top.u_pixels.cmd_i, kage_top.u_pixels.tree_valid_i,
    kage_top.u_pixels.tree_i, kage_top.u_pixels.tree_drop_i, kage_top.u_pixels.exit_free_i
  };
  assign out = {
    kage_top.exit_take, kage_top.exit_valid, kage_top.exit_last, kage_top.exit_data, kage_top.queue_valid,
    kage_top.queue_line, kage_top.table_valid, kage_top.table_entry, kage_top.load_ready, kage_top.m_axis_tready_i
  } == {
    kage_top.u_out.exit_take_i, kage_top.u_out.exit_valid_i, kage_top.u_out.exit_last_i,
    kage_top.u_out.exit_data_i, kage_top.u_out.line_valid_i, kage_top.u_out.line_i, kage_top.u_out.table_valid_i,
    kage_top.u_out.table_i, kage_top.u_out.load_ready_i, kage_top.u_out.m_axis_tready_i
  };
  // STATUS and the counters
  assign given = {
    kage_top.in_frame || kage_top.lines_q != '0, kage_top.m_axis_tvalid_o && !kage_top.m_axis_tready_i,
    kage_top.frame_end, kage_top.draining, kage_top.error_valid, kage_top.error, kage_top.behind_valid,
    kage_top.behind
  } == {
    kage_top.u_registers.open_i, kage_top.u_registers.waiting_output_i, kage_top.u_registers.frame_end_i,
    kage_top.u_registers.draining_i, kage_top.u_registers.error_valid_i, kage_top.u_registers.error_i,
    kage_top.u_registers.behind_valid_i, kage_top.u_registers.behind_i
  };
  if (ACTIVE > 0) begin : gen_front
    assign front = {
      kage_top.read_valid, kage_top.read, kage_top.read_flags, kage_top.reader_dropping, kage_top.token_ready,
      kage_top.drop
    } == {
      kage_top.gen_front_end.u_front_end.token_valid_i, kage_top.gen_front_end.u_front_end.token_i,
      kage_top.gen_front_end.u_front_end.token_flags_i, kage_top.gen_front_end.u_front_end.dropping_i,
      kage_top.gen_front_end.u_front_end.token_ready_i, kage_top.gen_front_end.u_front_end.drop_i
    };
  end else begin : gen_no_front
    assign front = 1'b1;
  end
  if (UNITS > 0) begin : gen_tree
    assign tree = {
      kage_top.tree_call, kage_top.tree_seg_valid, kage_top.tree_piece, kage_top.tree_ready
    } == {
      kage_top.gen_tree.u_tree.call_i, kage_top.gen_tree.u_tree.seg_valid_i, kage_top.gen_tree.u_tree.piece_i,
      kage_top.gen_tree.u_tree.line_ready_i
    };
  end else begin : gen_no_tree
    assign tree = 1'b1;
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      trace_module(PartTop, 512'h1ff, 512'({reader, front, control, lines, loads, pixels, out, given, tree}));
    end
  end

endmodule

bind kage_top kage_top_wires_monitor #(
    .UNITS (UNITS),
    .ACTIVE(ACTIVE)
) u_wires_monitor (.*);

`default_nettype wire
