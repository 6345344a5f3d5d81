// SPDX-License-Identifier: Apache-2.0
// What passes between the modules of kage_top, as events (rtl_model.h): bound into it, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_monitor #(
    `include "kage_pixel_params.svh"
    `include "kage_widths.svh"
    `include "kage_impl_params.svh",
    parameter int FRONT_WORDS = 5,
    parameter int EXIT_LANES  = 4
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic                      token_valid,
    input wire logic                      token_ready,
    input wire logic [FRONT_WORDS*32-1:0] token,
    input wire logic                      token_header,
    input wire logic                      token_lacking,
    input wire logic                      token_cut,
    input wire logic                      token_final,
    input wire logic                      token_at_last,

    input wire logic                 cmd_valid,
    input wire logic                 cmd_ready,
    input wire logic [          3:0] cmd_kind,
    input wire logic [   X_BITS-1:0] cmd_xl,
    input wire logic [   X_BITS-1:0] cmd_xr,
    input wire logic                 pixel_valid,
    input wire logic                 pixel_ready,
    input wire logic [          3:0] pixel_kind,
    input wire logic [   X_BITS-1:0] pixel_xl,
    input wire logic [   X_BITS-1:0] pixel_xr,
    input wire logic [ColorBits-1:0] pixel_color,
    input wire logic [SlopeBits-1:0] pixel_dcolor,
    input wire logic [CountBits-1:0] cmd_count,
    input wire logic [DepthBits-1:0] cmd_z,
    input wire logic [DepthBits-1:0] cmd_dz,
    input wire logic [ShareBits-1:0] cmd_share,

    input wire logic                line_valid,
    input wire logic                line_ready,
    input wire logic                line_first,
    input wire logic                line_blank,
    input wire logic                line_load,
    input wire logic                line_painted,
    input wire logic [  X_BITS-1:0] line_width,
    input wire logic [ RgbBits-1:0] line_background,
    input wire logic [SHADE_FRAC:0] line_shade,

    input wire logic                      table_valid,
    input wire logic [    CLASS_BITS-1:0] table_class,
    input wire logic [     LightBits-1:0] table_light,
    input wire logic [EntryShareBits-1:0] table_share,

    input wire logic                 tree_frame_ready,
    input wire logic                 tree_claim,
    input wire logic                 tree_face_valid,
    input wire logic                 tree_seg_valid,
    input wire logic                 tree_seg_ready,
    input wire logic [ UnitBits-1:0] tree_unit,
    input wire logic [FACE_BITS-1:0] tree_face,
    input wire logic [EntryBits-1:0] tree_entry,
    input wire logic [DepthBits-1:0] tree_seg_z,
    input wire logic [  DX_BITS-1:0] tree_dx,

    input wire logic                  tree_valid,
    input wire logic                  tree_ready,
    input wire logic [    Z_BITS-1:0] tree_z,
    input wire logic [CLASS_BITS-1:0] tree_class,
    input wire logic [   RgbBits-1:0] tree_color,

    input wire logic                           exit_free,
    input wire logic                           exit_take,
    input wire logic                           exit_valid,
    input wire logic                           exit_last,
    input wire logic [EXIT_LANES*ExitBits-1:0] exit_data,

    input wire logic               load_valid,
    input wire logic               load_ready,
    input wire logic [ X_BITS-1:0] load_x,
    input wire logic [RgbBits-1:0] load_color,

    input wire logic               m_axis_tvalid_o,
    input wire logic               m_axis_tready_i,
    input wire logic [RgbBits-1:0] m_axis_tdata_o,
    input wire logic               m_axis_tuser_o,
    input wire logic               m_axis_tlast_o,

    input wire logic queue_valid,
    input wire logic loading,      // frame_control waits for a line to come back
    input wire logic dropping,
    input wire logic frame_end,

    input wire logic        error,
    input wire logic [ 3:0] error_code,
    input wire logic [31:0] error_frame,
    input wire logic [15:0] error_line,
    input wire logic [31:0] error_token,
    input wire logic [ 5:0] error_unit
);
  `include "kage_trace.svh"

  // A channel of a span's colour, of its slope, of a table's share, each as far as there are so many.
  function automatic logic [63:0] ramp(input logic [ColorBits-1:0] color, input int channel);
    ramp = channel < CHANNELS ? 64'(color[(channel<CHANNELS?channel : 0)*RampBits+:RampBits]) : '0;
  endfunction
  function automatic logic [63:0] share(input logic [EntryShareBits-1:0] shares, input int channel);
    share = channel < CHANNELS ? 64'(shares[(channel<CHANNELS?channel : 0)*(SHADE_FRAC+1)+:SHADE_FRAC+1]) : '0;
  endfunction

  logic [ColorBits-1:0] dcolor;
  assign dcolor = SMOOTH > 0 ? ColorBits'(pixel_dcolor) : '0;

  localparam int CountersBits = COUNT_BITS > 0 ? TallyBits : 1;
  // A pixel that leaves: {counts, class, dark, covered, colour}.
  function automatic logic [TraceBits-1:0] leaving(input logic [ExitBits-1:0] pixel);
    leaving = trace5(
        64'(pixel[RgbBits-1:0]),
        64'(pixel[RgbBits]),
        DSF_BITS > 0 && COUNT_BITS == 0 ? 64'(pixel[ExitBits-1]) : 64'd0,
        COUNT_BITS > 0 && CLASS_BITS > 1 ? 64'(pixel[ExitClassAt+:CLASS_BITS]) : 64'd0,
        COUNT_BITS > 0 ? 64'(pixel[ExitCountAt+:CountersBits]) : 64'd0
    );
  endfunction

  // What of a command must not change while it waits.
  localparam int FixedBits = 4 + 2 * X_BITS + 2 * DepthBits + CountBits;
  logic waits_q;
  logic [FixedBits-1:0] fixed, fixed_q;
  assign fixed = {cmd_kind, cmd_xl, cmd_xr, cmd_z, cmd_dz, cmd_count};

  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni && cmd_valid && !cmd_ready;
    fixed_q <= fixed;
    if (rst_ni) begin
      if (waits_q) trace_part(PartTokenCommand, 512'({1'b1, fixed_q}), 512'({cmd_valid, fixed}));
      trace_part(PartPixels, 512'(exit_take && exit_free), 512'(exit_take));
      if (token_valid && token_ready) begin
        kage_trace(
            StageToken, 0, {
            60'd0, token_header, token_lacking, token_cut, token_final, 63'd0, token_at_last, (TraceBits - 128)'(token)
            });
      end
      if (table_valid) begin
        kage_trace(
            StageTable, 0, trace5(
            64'(table_class), 64'(table_light), share(table_share, 0), share(table_share, 1), share(table_share, 2)));
      end
      if (tree_claim) kage_trace(StageClaim, 0, '0);
      if (tree_face_valid) begin
        kage_trace(StageFace, 32'(tree_unit), trace5(
                   64'(tree_face),
                   64'(tree_entry[ORDER_BITS-1:0]),
                   ClassBits > 0 ? 64'(tree_entry[ORDER_BITS+:CLASS_BITS]) : 64'd0,
                   64'(tree_entry[ORDER_BITS+ClassBits+:DepthBits]),
                   64'(tree_entry[EntryBits-1-:RgbBits])
                   ));
      end
      if (tree_seg_valid && tree_seg_ready) begin
        kage_trace(StageSegment, 32'(tree_unit), trace5(64'(tree_seg_z), 64'(tree_dx), 64'(tree_face), 64'd0, 64'd0));
      end
      if (tree_valid && tree_ready) begin
        kage_trace(StageTree, 0, trace5(64'(tree_z), 64'(tree_color), 64'(tree_class), 64'd0, 64'd0));
      end
      if (line_valid && line_ready) begin
        kage_trace(StageLine, 0, TraceBits'({
                   64'(line_shade),
                   64'(line_background),
                   64'(line_width),
                   64'(line_painted),
                   64'(line_load),
                   64'(line_blank),
                   64'(line_first)
                   }));
      end
      if (pixel_valid && pixel_ready) begin
        kage_trace(StageCommand, 0, {
                   ramp(dcolor, 2),
                   ramp(dcolor, 1),
                   ramp(dcolor, 0),
                   ramp(pixel_color, 2),
                   ramp(pixel_color, 1),
                   ramp(pixel_color, 0),
                   64'(cmd_share),
                   64'(cmd_dz),
                   64'(cmd_z),
                   64'(cmd_count),
                   64'(pixel_xr),
                   64'(pixel_xl),
                   64'(pixel_kind)
                   });
      end
      if (exit_valid) begin
        for (int l = 0; l < EXIT_LANES; l++) begin
          kage_trace(StageExit, 32'(exit_last && l == EXIT_LANES - 1), leaving(exit_data[l*ExitBits+:ExitBits]));
        end
      end
      if (load_valid && load_ready) begin
        kage_trace(StageLoad, 0, trace5(64'(load_x), 64'(load_color), 64'd0, 64'd0, 64'd0));
      end
      if (m_axis_tvalid_o && m_axis_tready_i) begin
        kage_trace(StageOut, 0, trace5(64'(m_axis_tdata_o), 64'(m_axis_tuser_o), 64'(m_axis_tlast_o), 64'd0, 64'd0));
      end
      if (error) begin
        kage_trace(StageError, 0, trace5(
                   64'(error_code), 64'(error_frame), 64'(error_line), 64'(error_token), 64'(error_unit)));
      end
      if (frame_end) kage_trace(StageEnd, 0, '0);
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

bind kage_top kage_top_monitor #(
    `include "kage_pixel_param_map.svh"
    `include "kage_impl_param_map.svh",
    .FRONT_WORDS(FrontWords),
    .EXIT_LANES (ExitLanes)
) u_monitor (
    .loading(u_control.loading_q),
    .*
);

`default_nettype wire
