// SPDX-License-Identifier: Apache-2.0
// A plane at a span's first pixel, rounded to the start and the step of the span's token: the kernels plane_step and
// span_setup, one behind the other.
//
// Handshake: a pipeline that moves each clock: what comes in leaves, of use or not.
// In: the plane at pixel 0 of the line above, SHIFT + FRAC of its BITS a fraction, modulo 2^BITS, and the span's first
//   pixel. Out: fields of FIELD bits, FRAC of them a fraction.
// Latency: 4 clocks. Throughput: a span a clock.
// Cost: a product of BITS x 17 bits, four registers of BITS bits, an adder each for start and step.
`default_nettype none

module plane_at #(
    parameter int BITS  = 50,
    parameter int SHIFT = 13,  // fraction bits of the plane that a field has not
    parameter int FRAC  = 11,
    parameter int FIELD = 37
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input wire logic [BITS-1:0] value_i,
    input wire logic [BITS-1:0] right_i,
    input wire logic [BITS-1:0] down_i,
    input wire logic [    16:0] xl_i,
    input wire logic            single_i, // the span has one pixel

    output logic [FIELD-1:0] start_o,
    output logic [FIELD-1:0] step_o
);
  localparam int KernelBits = 54;
  // Rounding that is added before a value is cut (span_rounding in hls/kernels/span_setup.hpp): half of the bit that
  // stays last, and to a start also half an LSB.
  localparam logic [KernelBits-1:0] StepRounding = SHIFT > 0 ? KernelBits'(1) << (SHIFT - 1) : '0;
  localparam logic [KernelBits-1:0] HalfLsb = FRAC > 0 ? KernelBits'(1) << (SHIFT + FRAC - 1) : '0;
  localparam logic [KernelBits-1:0] StartRounding = StepRounding + HalfLsb;

  logic [KernelBits-1:0] here, start, step;
  logic [3*BITS-1:0] right_q;
  logic [2:0] single_q;
  logic [3:0] unused_handshake;
  always_ff @(posedge clk_i) begin
    right_q  <= {right_q[0+:2*BITS], right_i};
    single_q <= {single_q[1:0], single_i};
  end

  hls_plane_step u_step (
      .clk_i,
      .rst_ni,
      .in_valid_i (1'b1),
      .in_ready_o (unused_handshake[0]),
      .out_valid_o(unused_handshake[1]),
      .out_ready_i(1'b1),
      .value_i    (KernelBits'(value_i)),
      .right_i    (KernelBits'(right_i)),
      .down_i     (KernelBits'(down_i)),
      .move_i     (xl_i),
      .value_o    (here)
  );

  hls_span_setup u_setup (
      .clk_i,
      .rst_ni,
      .in_valid_i      (1'b1),
      .in_ready_o      (unused_handshake[2]),
      .out_valid_o     (unused_handshake[3]),
      .out_ready_i     (1'b1),
      .value_i         (here),
      .slope_i         (KernelBits'(right_q[2*BITS+:BITS])),
      .single_i        (single_q[2]),
      .start_rounding_i(StartRounding),
      .step_rounding_i (StepRounding),
      .start_o         (start),
      .step_o          (step)
  );

  assign start_o = start[SHIFT+:FIELD];
  assign step_o  = step[SHIFT+:FIELD];

  logic unused_bits;
  assign unused_bits = ^{start, step};

endmodule

`default_nettype wire
