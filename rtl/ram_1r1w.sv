// SPDX-License-Identifier: Apache-2.0
// A RAM with one write port and one read port, in the form that synthesis maps to block RAM.
//
// Latency: 1 clock from rd_en_i to rd_data_o, which holds until the next read. Reading the word that is written in the
// same clock gives old, new or mixed bits: users see to it that such data are not used. Contents are unknown after
// power-up and kept by reset.
// Throughput: a read and a write a clock.
// Cost: block RAM of its size; a RAM of few words becomes flip-flops or LUT RAM, as the tool decides.
`default_nettype none

module ram_1r1w #(
    parameter int BITS = 8,
    parameter int WORDS = 256,
    localparam int AddrBits = WORDS > 1 ? $clog2(WORDS) : 1
) (
    input wire logic clk_i,

    input wire logic                wr_en_i,
    input wire logic [AddrBits-1:0] wr_addr_i,
    input wire logic [    BITS-1:0] wr_data_i,

    input  wire logic                rd_en_i,
    input  wire logic [AddrBits-1:0] rd_addr_i,
    output logic      [    BITS-1:0] rd_data_o
);

  // The same in yosys, AMD's and Intel's words: no logic need make a word right that is read while it is written.
  (* no_rw_check, rw_addr_collision = "no", ramstyle = "no_rw_check" *)
  logic [BITS-1:0] mem  [WORDS];
  logic [BITS-1:0] rd_q;

  assign rd_data_o = rd_q;

  always_ff @(posedge clk_i) begin
    if (wr_en_i) mem[wr_addr_i] <= wr_data_i;
    if (rd_en_i) rd_q <= mem[rd_addr_i];
  end

endmodule

`default_nettype wire
