// SPDX-License-Identifier: Apache-2.0
// Whether tree_core gives an expansion unit its own faces: they come in turn, from 0 in each frame.
`default_nettype none

module expansion_unit_monitor #(
    parameter int FACE_BITS = 7
) (
    input wire logic                 clk_i,
    input wire logic                 rst_ni,
    input wire logic                 frame_start_i,
    input wire logic                 face_valid_i,
    input wire logic [FACE_BITS-1:0] face_number_i
);
  `include "kage_trace.svh"

  logic [FACE_BITS-1:0] faces_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni || frame_start_i) faces_q <= '0;
    else if (face_valid_i) faces_q <= faces_q + 1'b1;
    if (rst_ni && face_valid_i) trace_part(PartTreeCore, 512'(faces_q), 512'(face_number_i));
  end

endmodule

bind expansion_unit expansion_unit_monitor #(.FACE_BITS(FACE_BITS)) u_monitor (.*);

`default_nettype wire
