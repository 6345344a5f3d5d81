// SPDX-License-Identifier: Apache-2.0
// A first-in first-out buffer for a valid/ready stream: of up to four words in registers, of more in LUT RAM.
//
// Handshake: valid/ready on both sides; in_ready_o and out_valid_o depend on registers only.
// Capacity: DEPTH words, a power of two, at least 2. Latency: 1 clock. Throughput: a word a clock.
// Cost: DEPTH x BITS flip-flops and a DEPTH to 1 multiplexer; of more than four words LUT RAM, where the device has it.
`default_nettype none
`include "kage_illegal.svh"

module stream_fifo #(
    parameter int BITS  = 8,
    parameter int DEPTH = 4
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic            in_valid_i,
    output logic                 in_ready_o,
    input  wire logic [BITS-1:0] in_data_i,

    output logic                 out_valid_o,
    input  wire logic            out_ready_i,
    output logic      [BITS-1:0] out_data_o
);
  localparam int PtrBits = $clog2(DEPTH);

  if (DEPTH < 2 || DEPTH != 2 ** PtrBits) begin : gen_bad_depth
    `KAGE_ILLEGAL("DEPTH must be a power of two and at least 2")
  end

  // Words that have left and that have come, modulo 2 DEPTH. Nothing is written but the pointer that moves, because a
  // count of both would lengthen the paths of push and pop.
  logic [PtrBits:0] rd_q, wr_q, count;
  logic [PtrBits-1:0] rd_at, wr_at;
  logic push, pop;

  assign count       = wr_q - rd_q;
  assign rd_at       = rd_q[PtrBits-1:0];
  assign wr_at       = wr_q[PtrBits-1:0];
  assign in_ready_o  = !count[PtrBits];
  assign out_valid_o = count != '0;
  assign push        = in_valid_i && in_ready_o;
  assign pop         = out_valid_o && out_ready_i;

  // A free place may be written to no end: so the data wait for nothing but registers.
  if (DEPTH > 4) begin : gen_ram
    logic [BITS-1:0] mem[DEPTH];
    assign out_data_o = mem[rd_at];
    always_ff @(posedge clk_i) if (in_ready_o) mem[wr_at] <= in_data_i;
  end else begin : gen_registers
    // In yosys, AMD's and Intel's words: few places take less of flip-flops than of LUT RAM.
    (* ram_style = "registers", ramstyle = "logic" *)
    logic [BITS-1:0] mem[DEPTH];
    assign out_data_o = mem[rd_at];
    always_ff @(posedge clk_i) if (in_ready_o) mem[wr_at] <= in_data_i;
  end

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      rd_q <= '0;
      wr_q <= '0;
    end else begin
      if (push) wr_q <= wr_q + 1'b1;
      if (pop) rd_q <= rd_q + 1'b1;
    end
  end

endmodule

`default_nettype wire
