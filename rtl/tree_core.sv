// SPDX-License-Identifier: Apache-2.0
// The expansion units and their compare tree: one opaque layer, a line at a time, of faces and segments. [Ohno 1985]
//
// In: piece_i is of a FACE or of a SEG, sound ones only: segment_check sees to it. `face` of call_i takes a face's
//   entry a clock; seg_valid_i and seg_ready_o are valid and ready of a segment. Segments pass through a buffer of two,
//   in their order, so seg_ready_o depends on registers only; the oldest one waits for its unit.
// Out: line_* is valid/ready: Z, class and colour of the nearest face at each pixel, `last` at a line's last. Z all
//   ones: none. All pixels of a line but the last are offered as soon as every unit has the line. The last pixel
//   waits for a claim.
// Lines asked for: `claim`, one clock, says that a TREE was good: whoever reads line_* will take one line more. All
//   segments of the line have come in by then. drop_o, one clock, says that a line of which a part has been taken
//   will not come; nothing taken then counts.
// Frames: `start` exchanges the tables; it may come while frame_ready_o, two clocks or more behind a segment, a flush
//   or another start. Lines of the frame before may still be leaving then, none of the one before that, and its
//   segments are all in their units. After a frame with an error `flush`, one clock or more, drops what has not been
//   claimed: lines claimed leave first, and frame_ready_o is low until the rest is gone. No face, segment or claim
//   comes from a flush until the next start.
// Status: moving_o: a line that was asked for comes nearer, and only line_ready_i could hold it up; or a flush does its
//   work. It also stays high for some clocks after something has entered a unit or the tree, because the effect may not
//   be visible before.
// Latency: 7 clocks from the segment that completes a line in the last unit to its first pixel, and those of the tree.
// Throughput: a pixel a clock, no bubble in a line.
// Cost: UNITS times expansion_unit, a compare_tree, and a stream_fifo of two segments.
// Needs UNITS > 0: a core without units leaves it out.
`default_nettype none

module tree_core #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int ClaimBits = 5  // no more than 18 lines fit in units and tree: 64 units, lines of one pixel
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic [TreeCallBits-1:0] call_i,
    output logic                         frame_ready_o,

    input  wire logic                 seg_valid_i,
    output logic                      seg_ready_o,
    input  wire logic [PieceBits-1:0] piece_i,

    output logic                          line_valid_o,
    input  wire logic                     line_ready_i,
    output logic      [TreePixelBits-1:0] line_o,
    output logic                          drop_o,

    output logic moving_o
);
  `include "generated/kage_buses.svh"

  // From the segment that completes a line in its unit to its first pixel at line_* nothing shows. A watchdog with
  // a lower limit than that would take it for a standstill, and the pixel for progress behind it.
  localparam int Levels = $clog2(UNITS);
  localparam int Way = 6 + Levels + (Levels > 0 ? (Levels - 1) / 2 : 0);  // the latency behind the buffer
  logic [Way-1:0] way_q;

  tree_call_t call;
  tree_pixel_t line;
  assign call   = call_i;
  assign line_o = line;

  // ---- lines claimed, flush ----------------------------------------------------------------------------------------
  logic [ClaimBits-1:0] claimed_q, claimed;  // lines asked for that have not left
  logic [ClaimBits-1:0] old_q;  // those of them that belong to earlier frames
  logic flushing_q, flush, line_left, point_valid, point_ready, held;
  logic held_valid, held_ready, seg_moves;  // of the segment that is next to enter its unit
  assign line_left = line_valid_o && line_ready_i && line.last;
  assign claimed = claimed_q + ClaimBits'(call.claim) - ClaimBits'(line_left);
  assign flush = flushing_q && claimed_q == '0;
  // frame_ready_o is a clock late, so that a header waits for a flip-flop. From what ends it, a start, a flush or a
  // segment, to the next header two clocks pass at least.
  logic frame_ready;
  assign frame_ready = !flushing_q && old_q == '0 && !held_valid;
  always_ff @(posedge clk_i) frame_ready_o <= rst_ni && frame_ready;
  assign drop_o = flush;
  assign held = line.last && claimed_q == '0;
  assign line_valid_o = point_valid && !held;
  assign point_ready = line_ready_i && !held;
  assign moving_o = flush || (claimed_q != '0 && (line_ready_i || !point_valid)) || seg_moves || way_q != '0 ||
      frame_ready != frame_ready_o;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      claimed_q  <= '0;
      old_q      <= '0;
      flushing_q <= 1'b0;
    end else begin
      claimed_q <= claimed;
      if (call.start) old_q <= claimed;
      else if (line_left && old_q != '0) old_q <= old_q - 1'b1;
      if (call.flush) flushing_q <= 1'b1;
      else if (flush) flushing_q <= 1'b0;
    end
  end

  // ---- segments on their way to a unit -----------------------------------------------------------------------------
  // No FACE comes while a segment is here, because a header waits for frame_ready_o and no FACE follows a SEG.
  localparam int SegmentBits = UnitBits + FACE_BITS + DepthBits + DX_BITS + 1;
  piece_t piece, held_piece, unit_piece;
  logic [SegmentBits-1:0] held_segment;
  assign piece = piece_i;
  stream_fifo #(
      .BITS (SegmentBits),
      .DEPTH(2)
  ) u_segments (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (seg_valid_i),
      .in_ready_o (seg_ready_o),
      .in_data_i  ({piece.unit, piece.face, piece.z, piece.dx, piece.completes}),
      .out_valid_o(held_valid),
      .out_ready_i(held_ready),
      .out_data_o (held_segment)
  );
  assign seg_moves = held_valid && held_ready;
  always_comb begin
    held_piece = piece;
    {held_piece.unit, held_piece.face, held_piece.z, held_piece.dx, held_piece.completes} = held_segment;
    unit_piece = held_piece;
    unit_piece.face = held_valid ? held_piece.face : piece.face;
  end

  // ---- units -------------------------------------------------------------------------------------------------------
  logic [UNITS-1:0] seg_ready, px_valid, px_ready, px_last;
  logic [UNITS*PointBits-1:0] px_data;

  always_comb begin
    held_ready = 1'b0;
    for (int u = 0; u < UNITS; u++) if (held_piece.unit == UnitBits'(u)) held_ready = seg_ready[u];
  end

  for (genvar u = 0; u < UNITS; u++) begin : gen_unit
    expansion_unit #(
        `include "generated/kage_pixel_param_map.svh"
    ) u_unit (
        .clk_i,
        .rst_ni,
        .frame_start_i(call.start),
        .flush_i      (flush),
        .face_valid_i (call.face && piece.unit == UnitBits'(u)),
        .seg_valid_i  (held_valid && held_piece.unit == UnitBits'(u)),
        .seg_ready_o  (seg_ready[u]),
        .piece_i      (unit_piece),
        .px_valid_o   (px_valid[u]),
        .px_ready_i   (px_ready[u]),
        .px_data_o    (px_data[u*PointBits+:PointBits]),
        .px_last_o    (px_last[u])
    );
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) way_q <= '0;
    else way_q <= {way_q[Way-2:0], seg_moves || (px_valid & px_ready) != '0 || (line_valid_o && line_ready_i)};
  end

  // ---- tree --------------------------------------------------------------------------------------------------------
  logic [PointBits-1:0] point;
  logic last;
  compare_tree #(
      .UNITS    (UNITS),
      .KEY_BITS (KeyBits),
      .DATA_BITS(PointBits)
  ) u_tree (
      .clk_i,
      .rst_ni     (rst_ni && !flush),
      .in_valid_i (px_valid),
      .in_ready_o (px_ready),
      .in_data_i  (px_data),
      .in_last_i  (px_last),
      .out_valid_o(point_valid),
      .out_ready_i(point_ready),
      .out_data_o (point),
      .out_last_o (last)
  );

  logic unused_index;
  assign unused_index = ^point[PointIndexAt+:ORDER_BITS];
  assign line.z = point[PointZAt+:Z_BITS];
  assign line.color = point[PointColorAt+:PixelRgbBits];
  assign line.normal_class = ClassBits > 0 ? point[PointClassAt+:CLASS_BITS] : '0;
  assign line.last = last;

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (rst_ni) begin
      // 1. A frame starts when it may.
      assert (!call.start || (frame_ready && frame_ready_o));
      // 2. No line leaves that was not claimed, and no more are claimed than fit.
      assert (!line_left || claimed_q != '0);
      assert (claimed_q <= ClaimBits'(18));
      // 3. Nothing is given between a flush and the next frame.
      assert (!flushing_q || !(call.face || seg_valid_i || call.claim));
      // 4. Entries and segments come to the units one at a time.
      assert (!call.face || !held_valid);
    end
  end
`endif

endmodule

`default_nettype wire
