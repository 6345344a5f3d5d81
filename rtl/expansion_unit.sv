// SPDX-License-Identifier: Apache-2.0
// An expansion unit: makes pixels of the segments of convex polyhedra that do not overlap on the screen. [Ohno 1985]
//
// Segments: seg_* is valid/ready, with the segment in piece_i. A line's segments come in order, of 1 .. 2^DX_BITS - 1
//   pixels each, at most 2^SEG_BITS of them; one that `completes` is its line's last. Two lines are buffered, a
//   half of the RAM each: seg_ready_o falls while both halves hold a line that has not been read out whole. A line is
//   expanded only when it is complete, so it has no bubble from its first pixel to its last.
// Faces: face_valid_i writes piece_i into the table of the frame that came in last; segments may name it from the next
//   clock on. The table has two banks, which frame_start_i exchanges, so that lines of the frame before keep theirs
//   while they leave. A frame_start_i may come only when no line is left of the frame before that one, and no line is
//   half filled.
// Pixels: px_* is valid/ready, with px_last_o at a line's last. At pixel k of a segment Z = clamp((z + k * dz) >>
//   Z_FRAC, 1, 2^Z_BITS - 2), with the face's index, colour and class. The blank face has a Z and an index of all ones,
//   colour and class 0. Output px_data_o is a point (kage_widths.svh).
// flush_i drops all lines, in one clock; the table stays.
// Latency: 6 clocks from the segment that completes a line to its first pixel. Throughput: a pixel a clock, lines that
//   are buffered without a gap.
// Cost: RAMs of 2^(SEG_BITS + 1) segments and 2^(FACE_BITS + 1) entries, an adder of DepthBits, about 4 registers of a
//   segment's width, a skid_buffer of a pixel.
`default_nettype none

module expansion_unit #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int SegmentBits = SegmentDepthBits + DX_BITS + FACE_BITS
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic frame_start_i,
    input wire logic flush_i,

    input  wire logic                 face_valid_i,
    input  wire logic                 seg_valid_i,
    output logic                      seg_ready_o,
    input  wire logic [PieceBits-1:0] piece_i,

    output logic                      px_valid_o,
    input  wire logic                 px_ready_i,
    output logic      [PointBits-1:0] px_data_o,
    output logic                      px_last_o
);
  `include "generated/kage_buses.svh"

  piece_t piece;
  logic   unused_unit;
  assign piece = piece_i;
  assign unused_unit = ^piece.unit;  // the parent's choice

  // A segment as the RAM has it.
  typedef struct packed {
    logic [SegmentDepthBits-1:0] z;
    logic [DX_BITS-1:0] dx;
    logic [FACE_BITS-1:0] face;
  } segment_t;

  // ---- filling -----------------------------------------------------------------------------------------------------
  logic clear, seg_take, line_complete, line_read;
  logic wr_half_q, rd_half_q, wr_bank_q;
  logic [1:0] full_q;  // the half has a line that has not been read out whole
  logic [1:0] bank_q;  // of the table, for the line in the half
  logic [SEG_BITS-1:0] wr_at_q, rd_at_q;
  logic [2*SEG_BITS-1:0] end_q;  // place of the last segment in each half

  assign clear = !rst_ni || flush_i;
  assign seg_ready_o = !full_q[wr_half_q];
  assign seg_take = seg_valid_i && seg_ready_o;
  assign line_complete = seg_take && piece.completes;

  always_ff @(posedge clk_i) begin
    if (clear) begin
      wr_half_q <= 1'b0;
      wr_at_q   <= '0;
      full_q    <= '0;
    end else begin
      if (line_complete) begin
        wr_half_q <= !wr_half_q;
        wr_at_q   <= '0;
      end else if (seg_take) begin
        wr_at_q <= wr_at_q + 1'b1;
      end
      for (int h = 0; h < 2; h++) begin
        if (line_complete && wr_half_q == 1'(h)) full_q[h] <= 1'b1;
        else if (line_read && rd_half_q == 1'(h)) full_q[h] <= 1'b0;
      end
    end
    for (int h = 0; h < 2; h++) begin
      if (line_complete && wr_half_q == 1'(h)) begin
        bank_q[h] <= wr_bank_q;
        end_q[h*SEG_BITS+:SEG_BITS] <= wr_at_q;
      end
    end
    if (!rst_ni) wr_bank_q <= 1'b0;
    else if (frame_start_i) wr_bank_q <= !wr_bank_q;
  end

  // ---- prefetch: the word of a segment, a register behind it, its face ---------------------------------------------
  // Stage k holds a segment while valid_q[k]; move k lets it take what is before it. Nothing is read ahead of its time:
  // a RAM keeps what it gave until the stage moves.
  logic load;  // the Z generator takes a segment
  logic read, read_end;
  logic [2:0] valid_q, last_q;
  logic move0, move1, move2;
  logic [1:0] face_bank_q;
  segment_t segment_in, segment_q;
  logic [SegmentBits-1:0] segment_out;
  logic [EntryBits-1:0] entry;
  logic [SegmentDepthBits-1:0] z3_q;
  logic [DX_BITS-1:0] dx3_q;
  logic blank3_q;

  assign move2     = !valid_q[2] || load;
  assign move1     = !valid_q[1] || move2;
  assign move0     = !valid_q[0] || move1;
  assign read      = full_q[rd_half_q] && move0;
  assign read_end  = rd_at_q == end_q[rd_half_q*SEG_BITS+:SEG_BITS];
  assign line_read = read && read_end;

  always_ff @(posedge clk_i) begin
    if (clear) begin
      rd_half_q <= 1'b0;
      rd_at_q   <= '0;
      valid_q   <= '0;
    end else begin
      if (line_read) begin
        rd_half_q <= !rd_half_q;
        rd_at_q   <= '0;
      end else if (read) begin
        rd_at_q <= rd_at_q + 1'b1;
      end
      if (move0) valid_q[0] <= read;
      if (move1) valid_q[1] <= valid_q[0];
      if (move2) valid_q[2] <= valid_q[1];
    end
    if (move0) begin
      last_q[0] <= read_end;
      face_bank_q[0] <= bank_q[rd_half_q];
    end
    if (move1) begin
      segment_q <= segment_out;
      last_q[1] <= last_q[0];
      face_bank_q[1] <= face_bank_q[0];
    end
    if (move2) begin
      z3_q <= segment_q.z;
      dx3_q <= segment_q.dx;
      blank3_q <= segment_q.face == BlankFace;
      last_q[2] <= last_q[1];
    end
  end

  assign segment_in.z = piece.z[SegmentDepthBits-1:0];
  assign segment_in.dx = piece.dx;
  assign segment_in.face = piece.face;
  ram_1r1w #(
      .BITS (SegmentBits),
      .WORDS(2 << SEG_BITS)
  ) u_segments (
      .clk_i,
      .wr_en_i  (seg_take),
      .wr_addr_i({wr_half_q, wr_at_q}),
      .wr_data_i(segment_in),
      .rd_en_i  (read),
      .rd_addr_i({rd_half_q, rd_at_q}),
      .rd_data_o(segment_out)
  );

  ram_1r1w #(
      .BITS (EntryBits),
      .WORDS(2 << FACE_BITS)
  ) u_faces (
      .clk_i,
      .wr_en_i  (face_valid_i),
      .wr_addr_i({wr_bank_q, piece.face}),
      .wr_data_i(piece.entry),
      .rd_en_i  (move2),
      .rd_addr_i({face_bank_q[1], segment_q.face}),
      .rd_data_o(entry)
  );

  // ---- Z generator: the registers Z, X and DEF, and what the segment's pixels share --------------------------------
  logic busy_q, step, px_free, x_end_q, end_seg_q, blank_q;  // x_end_q: x_q is 1
  logic [DepthBits-1:0] z_q, def_q;
  logic [DX_BITS-1:0] x_q;  // pixels left
  logic [PointBits-1:0] face, face_q;  // the point of the face, its depth 0

  always_comb begin
    face = '0;
    face[PointIndexAt+:ORDER_BITS] = entry[EntryIndexAt+:ORDER_BITS];
    face[PointColorAt+:PixelRgbBits] = entry[EntryColorAt+:PixelRgbBits];
    if (ClassBits > 0) face[PointClassAt+:CLASS_BITS] = entry[EntryClassAt+:CLASS_BITS];
  end

  assign step = busy_q && px_free;
  assign load = valid_q[2] && (!busy_q || (step && x_end_q));

  always_ff @(posedge clk_i) begin
    if (clear) busy_q <= 1'b0;
    else if (load) busy_q <= 1'b1;
    else if (step && x_end_q) busy_q <= 1'b0;
    if (load) begin
      z_q <= DepthBits'(z3_q);
      x_q <= dx3_q;
      x_end_q <= dx3_q == DX_BITS'(1);
      def_q <= entry[EntryDzAt+:DepthBits];
      face_q <= face;
      blank_q <= blank3_q;
      end_seg_q <= last_q[2];
    end else if (step) begin
      z_q <= z_q + def_q;
      x_q <= x_q - 1'b1;
      x_end_q <= x_q == DX_BITS'(2);
    end
  end

  // ---- clamp and the pixel's buffer --------------------------------------------------------------------------------
  logic [Z_BITS+1:0] whole;
  logic [Z_BITS-1:0] depth;
  logic [PointBits-1:0] point, blank;
  assign whole = z_q[DepthBits-1:Z_FRAC];
  always_comb begin
    if (whole[Z_BITS+1] || whole == '0) depth = Z_BITS'(1);
    else if (whole[Z_BITS] || &whole[Z_BITS-1:0]) depth = MostDepth;
    else depth = whole[Z_BITS-1:0];
    point = face_q;
    point[PointZAt+:Z_BITS] = depth;
    blank = '0;
    blank[PointZAt+:Z_BITS] = ClearDepth;
    blank[PointIndexAt+:ORDER_BITS] = '1;
  end

  // The buffer's ready is a flip-flop, so that reading segments does not wait for the tree's cells in the same clock.
  skid_buffer #(
      .BITS(PointBits + 1)
  ) u_pixel (
      .clk_i,
      .rst_ni     (!clear),
      .in_valid_i (busy_q),
      .in_ready_o (px_free),
      .in_data_i  ({x_end_q && end_seg_q, blank_q ? blank : point}),
      .out_valid_o(px_valid_o),
      .out_ready_i(px_ready_i),
      .out_data_o ({px_last_o, px_data_o})
  );

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic mid_line_q;  // a line has begun to leave and not ended
  logic full_half_q;  // the last place of the half that fills has been written, and the line is not complete
  always @(posedge clk_i) begin
    if (clear || line_complete) full_half_q <= 1'b0;
    else if (seg_take && wr_at_q == '1) full_half_q <= 1'b1;
    if (clear) mid_line_q <= 1'b0;
    else if (px_valid_o && px_ready_i) mid_line_q <= !px_last_o;
    if (rst_ni) begin
      // 1. A segment has pixels, and the line stays in its half: no segment is written past the last place. If the
      // segment there leaves the line short, the line is never completed.
      assert (!seg_take || (piece.dx != '0 && !full_half_q));
      // 2. No frame begins in the middle of a line.
      assert (!frame_start_i || flush_i || (wr_at_q == '0 && !full_half_q));
      // 3. A line has no bubble.
      assert (!mid_line_q || px_valid_o);
      // 4. The paper's depth is unsigned.
      assert (!seg_take || DepthBits'(piece.z[SegmentDepthBits-1:0]) == piece.z);
    end
  end
`endif

endmodule

`default_nettype wire
