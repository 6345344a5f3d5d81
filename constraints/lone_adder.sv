// SPDX-License-Identifier: Apache-2.0
// A registered adder of BITS: the fastest that arithmetic of this width can be on a device, a yardstick beside
// least_loop.
`default_nettype none

module lone_adder #(
    parameter int BITS = 35
) (
    input  wire logic clk_i,
    input  wire logic serial_i,
    output logic      serial_o
);

  logic [BITS-1:0] a_q, b_q, sum_q, out_q;

  assign serial_o = out_q[0];

  always_ff @(posedge clk_i) begin
    a_q   <= {a_q[BITS-2:0], serial_i};
    b_q   <= {b_q[BITS-2:0], a_q[BITS-1]};
    sum_q <= a_q + b_q;
    out_q <= b_q[0] ? sum_q : {out_q[0], out_q[BITS-1:1]};
  end

endmodule

`default_nettype wire
