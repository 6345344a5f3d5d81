// SPDX-License-Identifier: Apache-2.0
// The kernel compare_cell, made by hls/tool without stages, chooses the data that the RTL's cell takes into its
// register. Whenever the cell takes a pixel of both sides, its data a clock later are the kernel's of those pixels.
`default_nettype none

module compare_cell_proof #(
    localparam int KeyBits  = 44,
    localparam int RestBits = 35
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic left_valid_i,
    input wire logic right_valid_i,
    input wire logic out_ready_i,
    input wire logic [KeyBits-1:0] left_key_i,
    input wire logic [KeyBits-1:0] right_key_i,
    input wire logic [RestBits-1:0] left_rest_i,
    input wire logic [RestBits-1:0] right_rest_i
);
  logic left_ready, right_ready, out_valid;
  logic [KeyBits+RestBits-1:0] out_data;
  compare_cell #(
      .KEY_BITS (KeyBits),
      .DATA_BITS(KeyBits + RestBits)
  ) cell_rtl (
      .clk_i,
      .rst_ni,
      .left_valid_i,
      .left_ready_o(left_ready),
      .left_data_i({left_key_i, left_rest_i}),
      .left_last_i(1'b0),
      .right_valid_i,
      .right_ready_o(right_ready),
      .right_data_i({right_key_i, right_rest_i}),
      .right_last_i(1'b0),
      .out_valid_o(out_valid),
      .out_ready_i,
      .out_data_o(out_data),
      .out_last_o()
  );

  logic [ KeyBits-1:0] key;
  logic [RestBits-1:0] rest;
  hls_compare_cell dut (
      .left_key_i,
      .left_rest_i,
      .right_key_i,
      .right_rest_i,
      .key_o (key),
      .rest_o(rest)
  );

  logic taken_q;
  logic [KeyBits+RestBits-1:0] wanted_q;
  initial taken_q = 1'b0;
  always_ff @(posedge clk_i) begin
    taken_q  <= left_valid_i && left_ready && right_valid_i && right_ready;
    wanted_q <= {key, rest};
  end
  always_comb begin
    if (taken_q) same_data : assert (out_data == wanted_q);
  end
endmodule

`default_nettype wire
