// SPDX-License-Identifier: Apache-2.0
// Stands for a pixel processor of your own: one pixel of a line, at position X, that takes a token a clock. Flat
// colour, shadows by parity, several volumes; docs/stream.md says what it is to do. It knows nothing of kage's RTL.
`default_nettype none

module my_pixel #(
    parameter int X = 0,
    parameter int Z_BITS = 24,
    parameter int Z_FRAC = 11,
    parameter int SHADE_FRAC = 8,
    parameter int X_BITS = 11
) (
    input wire logic clk,
    input wire logic valid,
    input wire logic [3:0] kind,
    input wire logic [X_BITS-1:0] xl,
    input wire logic [X_BITS-1:0] xr,
    input wire logic w,
    input wire logic lit,
    input wire logic [Z_BITS+Z_FRAC+1:0] z,
    input wire logic [Z_BITS+Z_FRAC+1:0] dz,
    input wire logic [23:0] color,
    input wire logic [SHADE_FRAC:0] shade,
    input wire logic bias,
    input wire logic [1:0] defect,  // 1: depth, 2: flag; deliberate
    output logic [Z_BITS-1:0] z_q,
    output logic [23:0] color_q,
    output logic lit_q,
    output logic dsf_q,
    output logic fsf_q
);
  localparam int AccBits = Z_BITS + Z_FRAC + 2;
  localparam logic [3:0] KindOp = 4'd6, KindSp = 4'd7, KindNc = 4'd8, KindEv = 4'd10;
  localparam logic [3:0] KindResolve = 4'd12, KindEol = 4'd14;

  logic signed [AccBits-1:0] acc;
  logic signed [Z_BITS+1:0] whole;
  logic [Z_BITS-1:0] z_here;
  logic in_range, in_front, dark;

  function automatic logic [7:0] darkened(input logic [7:0] c);
    logic [SHADE_FRAC+8:0] product;
    begin
      product  = (SHADE_FRAC + 9)'(c) * ((SHADE_FRAC + 9)'(1 << SHADE_FRAC) - (SHADE_FRAC + 9)'(shade));
      darkened = 8'((product + (SHADE_FRAC + 9)'(1 << (SHADE_FRAC - 1))) >> SHADE_FRAC);
    end
  endfunction

  always_comb begin
    acc   = z + (AccBits'(X) - AccBits'(xl)) * dz;
    whole = (Z_BITS + 2)'(acc >>> Z_FRAC);
    if (defect == 2'd1 && X % 2 == 1) whole = whole + 1'b1;
    if (whole < (Z_BITS + 2)'(1)) z_here = Z_BITS'(1);
    else if (whole > (Z_BITS + 2)'((1 << Z_BITS) - 2)) z_here = Z_BITS'((1 << Z_BITS) - 2);
    else z_here = whole[Z_BITS-1:0];
    in_range = X_BITS'(X) >= xl && X_BITS'(X) < xr;
    in_front = in_range && z_here < z_q;
    dark = fsf_q && lit_q && z_q != '1;
  end

  always_ff @(posedge clk) begin
    if (valid) begin
      case (kind)
        KindOp:
        if (in_front) begin
          z_q <= z_here;
          color_q <= color;
          lit_q <= lit;
        end
        KindSp:  if (in_front) dsf_q <= dsf_q ^ w;
        KindNc:  if (in_range) dsf_q <= dsf_q ^ w;
        KindEv:
        if (in_range) begin
          fsf_q <= fsf_q | (dsf_q ^ bias);
          if (defect != 2'd2) dsf_q <= 1'b0;
        end
        KindResolve: begin
          if (dark) color_q <= {darkened(color_q[23:16]), darkened(color_q[15:8]), darkened(color_q[7:0])};
          dsf_q <= 1'b0;
          fsf_q <= 1'b0;
        end
        KindEol: begin
          z_q   <= '1;
          dsf_q <= 1'b0;
          fsf_q <= 1'b0;
        end
        default: ;
      endcase
    end
  end
endmodule

`default_nettype wire
