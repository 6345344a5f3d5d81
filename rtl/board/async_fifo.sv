// SPDX-License-Identifier: Apache-2.0
// A first-in first-out buffer between two clocks that know nothing of each other: the one way in which anything crosses
// from a clock to another in kage.
//
// Handshake: valid/ready on both sides, each at its own clock; in_ready_o and out_valid_o depend on registers only. A
// word that is offered stays until it is taken.
// Crossing: each side sends the other its pointer in Gray code, in which one bit changes at a time, through a
// synchronizer. A pointer caught in the middle of a change reads as the old or the new one. A side that sees an old one
// believes that less is free, or less has come, than is true. The words themselves are read two clocks or more after
// they were written.
// Reset: at both sides at once, for as long as both are in it; each may leave it when it likes. Whoever resets one side
// alone loses words.
// Capacity: DEPTH words, a power of two, at least 4, and one more in the output's register. Latency: a clock of the
// input and three to four of the output. Throughput: a word a clock of the slower side, from DEPTH 8 on.
// Cost: a RAM of DEPTH x BITS (block RAM, LUT RAM or flip-flops, as the tool decides), BITS flip-flops, eight pointers.
// Timing constraints: the paths between the clocks need no constraint but that no bit of a pointer comes more than a
// clock of the faster side later than another.
`default_nettype none
`include "kage_illegal.svh"

module async_fifo #(
    parameter  int BITS    = 8,
    parameter  int DEPTH   = 16,
    localparam int PtrBits = $clog2(DEPTH) + 1
) (
    input  wire logic            in_clk_i,
    input  wire logic            in_rst_ni,
    input  wire logic            in_valid_i,
    output logic                 in_ready_o,
    input  wire logic [BITS-1:0] in_data_i,

    input  wire logic            out_clk_i,
    input  wire logic            out_rst_ni,
    output logic                 out_valid_o,
    input  wire logic            out_ready_i,
    output logic      [BITS-1:0] out_data_o
);
  if (DEPTH < 4 || DEPTH != 2 ** (PtrBits - 1)) begin : gen_bad_depth
    `KAGE_ILLEGAL("DEPTH must be a power of two and at least 4")
  end

  // A word that is read in the clock of its own writing is never used.
  (* no_rw_check, rw_addr_collision = "no", ramstyle = "no_rw_check" *)
  logic [BITS-1:0] mem[DEPTH];

  // Words that have come (wr), and words that have been taken out of mem (rd), modulo 2 DEPTH: as numbers and in Gray
  // code. The copy of the Gray code on the other side (_seen) is some clocks old.
  logic [PtrBits-1:0] wr_q, wr_d, wr_gray_q, wr_seen, rd_q, rd_d, rd_gray_q, rd_seen;

  // ---- the input's side --------------------------------------------------------------------------------------------
  // Full: as many words have come as fit behind those that were taken, which in Gray code turns the two highest bits.
  logic push;
  assign in_ready_o = wr_gray_q != {~rd_seen[PtrBits-1:PtrBits-2], rd_seen[PtrBits-3:0]};
  assign push       = in_valid_i && in_ready_o;
  assign wr_d       = push ? wr_q + 1'b1 : wr_q;

  synchronizer #(
      .BITS(PtrBits)
  ) u_rd_seen (
      .clk_i (in_clk_i),
      .rst_ni(in_rst_ni),
      .in_i  (rd_gray_q),
      .out_o (rd_seen)
  );

  always_ff @(posedge in_clk_i) begin
    if (push) mem[wr_q[PtrBits-2:0]] <= in_data_i;
    if (!in_rst_ni) begin
      wr_q      <= '0;
      wr_gray_q <= '0;
    end else begin
      wr_q      <= wr_d;
      wr_gray_q <= wr_d ^ (wr_d >> 1);
    end
  end

  // ---- the output's side -------------------------------------------------------------------------------------------
  logic take, out_valid_q;
  logic [BITS-1:0] out_q;
  assign take        = rd_gray_q != wr_seen && (!out_valid_q || out_ready_i);
  assign rd_d        = take ? rd_q + 1'b1 : rd_q;
  assign out_valid_o = out_valid_q;
  assign out_data_o  = out_q;

  synchronizer #(
      .BITS(PtrBits)
  ) u_wr_seen (
      .clk_i (out_clk_i),
      .rst_ni(out_rst_ni),
      .in_i  (wr_gray_q),
      .out_o (wr_seen)
  );

  always_ff @(posedge out_clk_i) begin
    if (take) out_q <= mem[rd_q[PtrBits-2:0]];
    if (!out_rst_ni) begin
      rd_q        <= '0;
      rd_gray_q   <= '0;
      out_valid_q <= 1'b0;
    end else begin
      rd_q      <= rd_d;
      rd_gray_q <= rd_d ^ (rd_d >> 1);
      if (take) out_valid_q <= 1'b1;
      else if (out_ready_i) out_valid_q <= 1'b0;
    end
  end

endmodule

`default_nettype wire
