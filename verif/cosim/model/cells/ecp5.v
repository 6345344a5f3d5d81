// SPDX-License-Identifier: Apache-2.0
// The cells of ECP5 that yosys' synth_ecp5 leaves of the core, for `kage cosim --netlist ecp5`. Registers and memories have
// no initial value: a simulator gives them X, or random bits. A value that an enable or a reset decides is X where that
// is X. A cell or a mode that is not here is an error of
// elaboration, in which a missing module's name says what it is.
//
// verif/test/cells holds each against yosys' own model where yosys has one, and against RTL that becomes such cells.
`default_nettype none

// D chooses between the halves of INIT, A between neighbours. Where an input is X and both choices agree, Z is known.
module LUT4 #(
    parameter [15:0] INIT = 16'h0000
) (
    input wire A,
    input wire B,
    input wire C,
    input wire D,
    output wire Z
);
  wire [7:0] half = D ? INIT[15:8] : INIT[7:0];
  wire [3:0] quarter = C ? half[7:4] : half[3:0];
  wire [1:0] pair = B ? quarter[3:2] : quarter[1:0];
  assign Z = A ? pair[1] : pair[0];
endmodule

// The multiplexers between two and between four LUTs of a slice.
module PFUMX (
    input wire ALUT,
    input wire BLUT,
    input wire C0,
    output wire Z
);
  assign Z = C0 ? ALUT : BLUT;
endmodule

module L6MUX21 (
    input wire D0,
    input wire D1,
    input wire SD,
    output wire Z
);
  assign Z = SD ? D1 : D0;
endmodule

// Two bits of a carry chain. A bit's LUT says by 1 that the carry goes through it and turns its sum. By 0 it says
// that the bit makes a carry of its own, which the LUT's first quarter, of A and B, gives. INJECT1 leaves the carry before the bit out
// of its sum, and its own carry is 0.
module CCU2C #(
    parameter [15:0] INIT0 = 16'h0000,
    parameter [15:0] INIT1 = 16'h0000,
    parameter INJECT1_0 = "YES",
    parameter INJECT1_1 = "YES"
) (
    input wire CIN,
    input wire A0, input wire B0, input wire C0, input wire D0,
    input wire A1, input wire B1, input wire C1, input wire D1,
    output wire S0,
    output wire S1,
    output wire COUT
);
  wire through0, through1, middle;
  LUT4 #(.INIT(INIT0)) u_lut0 (.A(A0), .B(B0), .C(C0), .D(D0), .Z(through0));
  LUT4 #(.INIT(INIT1)) u_lut1 (.A(A1), .B(B1), .C(C1), .D(D1), .Z(through1));
  wire own0 = INJECT1_0 != "YES" && INIT0[{B0, A0}];
  wire own1 = INJECT1_1 != "YES" && INIT1[{B1, A1}];
  assign middle = through0 ? CIN : own0;
  assign COUT = through1 ? middle : own1;
  assign S0 = INJECT1_0 == "YES" ? through0 : through0 ^ CIN;
  assign S1 = INJECT1_1 == "YES" ? through1 : through1 ^ middle;
endmodule

// A flip-flop; LSR sets it with the clock to what REGSET says, enabled or not. A pin without a net is inactive.
module TRELLIS_FF #(
    parameter GSR = "ENABLED",  // the reset behind configuration: no simulation begins with it
    parameter CEMUX = "1",
    parameter CLKMUX = "CLK",
    parameter LSRMUX = "LSR",
    parameter SRMODE = "LSR_OVER_CE",
    parameter REGSET = "RESET"
) (
    input wire CLK,
    input wire LSR,
    input wire CE,
    input wire DI,
    output reg Q
);
  wire enable = CEMUX == "1" ? 1'b1 : CEMUX == "0" ? 1'b0 : CEMUX == "INV" ? ~CE : CE;
  wire set = LSRMUX == "INV" ? ~LSR : LSR;
  always @(posedge CLK) Q <= set ? REGSET == "SET" : enable ? DI : Q;
  generate
    if (CLKMUX != "CLK") TRELLIS_FF_on_the_falling_edge_is_not_modelled u_refused ();
    if (SRMODE != "LSR_OVER_CE") TRELLIS_FF_of_another_SRMODE_is_not_modelled u_refused ();
  endgenerate
endmodule

// 16 words of 4 bits in LUTs: written with the clock, read at once.
module TRELLIS_DPR16X4 #(
    parameter WCKMUX = "WCK",
    parameter WREMUX = "WRE",
    parameter [63:0] INITVAL = 64'd0
) (
    input wire [3:0] DI,
    input wire [3:0] WAD,
    input wire WRE,
    input wire WCK,
    input wire [3:0] RAD,
    output wire [3:0] DO
);
  reg [3:0] memory[0:15];
  wire write = WREMUX == "1" ? 1'b1 : WREMUX == "0" ? 1'b0 : WREMUX == "INV" ? ~WRE : WRE;
  always @(posedge WCK) if (write !== 1'b0) memory[WAD] <= write === 1'b1 ? DI : 4'bxxxx;
  assign DO = memory[RAD];
  generate
    if (WCKMUX != "WCK") TRELLIS_DPR16X4_on_the_falling_edge_is_not_modelled u_refused ();
  endgenerate
endmodule

// A product without registers; SIGNEDA and SIGNEDB say how each factor is meant.
module MULT18X18D #(
    parameter REG_INPUTA_CLK = "NONE",
    parameter REG_INPUTB_CLK = "NONE",
    parameter REG_INPUTC_CLK = "NONE",
    parameter REG_PIPELINE_CLK = "NONE",
    parameter REG_OUTPUT_CLK = "NONE"
) (
    input wire A0, input wire A1, input wire A2, input wire A3, input wire A4, input wire A5,
    input wire A6, input wire A7, input wire A8, input wire A9, input wire A10, input wire A11,
    input wire A12, input wire A13, input wire A14, input wire A15, input wire A16, input wire A17,
    input wire B0, input wire B1, input wire B2, input wire B3, input wire B4, input wire B5,
    input wire B6, input wire B7, input wire B8, input wire B9, input wire B10, input wire B11,
    input wire B12, input wire B13, input wire B14, input wire B15, input wire B16, input wire B17,
    input wire C0, input wire C1, input wire C2, input wire C3, input wire C4, input wire C5,
    input wire C6, input wire C7, input wire C8, input wire C9, input wire C10, input wire C11,
    input wire C12, input wire C13, input wire C14, input wire C15, input wire C16, input wire C17,
    input wire SIGNEDA, input wire SIGNEDB, input wire SOURCEA, input wire SOURCEB,
    output wire P0, output wire P1, output wire P2, output wire P3, output wire P4, output wire P5,
    output wire P6, output wire P7, output wire P8, output wire P9, output wire P10, output wire P11,
    output wire P12, output wire P13, output wire P14, output wire P15, output wire P16, output wire P17,
    output wire P18, output wire P19, output wire P20, output wire P21, output wire P22, output wire P23,
    output wire P24, output wire P25, output wire P26, output wire P27, output wire P28, output wire P29,
    output wire P30, output wire P31, output wire P32, output wire P33, output wire P34, output wire P35
);
  wire signed [18:0] a = {SIGNEDA & A17,
      A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
  wire signed [18:0] b = {SIGNEDB & B17,
      B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
  wire signed [37:0] product = a * b;
  assign {
      P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17, P16, P15, P14,
      P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0
  } = product[35:0];
  generate
    if (REG_INPUTA_CLK != "NONE" || REG_INPUTB_CLK != "NONE" || REG_INPUTC_CLK != "NONE" || REG_PIPELINE_CLK != "NONE" ||
        REG_OUTPUT_CLK != "NONE")
      MULT18X18D_with_registers_is_not_modelled u_refused ();
  endgenerate
endmodule

// 18 kbit, kept as 2048 bytes of 9 bits. A port of 1, 2 or 4 bits takes a part of a byte's lowest eight, one of 9 a byte,
// one of 18 two; address pins 13 .. 3 choose the byte, and the lowest two pins of a port of 18 say which bytes are written.
// At a width of 36 port A writes four bytes, the pins 3 .. 0 say which, and port B reads them; the lower half of the data
// is at the pins of A, the upper half at those of B, as yosys has it. At a width of 36 a read of what is written in the same
// clock gives X. In mode NORMAL a port that writes keeps its output.
module DP16KD #(
    parameter DATA_WIDTH_A = 18,
    parameter DATA_WIDTH_B = 18,
    parameter REGMODE_A = "NOREG",
    parameter REGMODE_B = "NOREG",
    parameter RESETMODE = "SYNC",
    parameter ASYNC_RESET_RELEASE = "SYNC",
    parameter CSDECODE_A = "0b000",
    parameter CSDECODE_B = "0b000",
    parameter WRITEMODE_A = "NORMAL",
    parameter WRITEMODE_B = "NORMAL",
    parameter CLKAMUX = "CLKA",
    parameter CLKBMUX = "CLKB",
    parameter GSR = "DISABLED",
    // The core asks for no contents.
    parameter [319:0] INITVAL_00 = 320'd0, INITVAL_01 = 320'd0, INITVAL_02 = 320'd0, INITVAL_03 = 320'd0,
    parameter [319:0] INITVAL_04 = 320'd0, INITVAL_05 = 320'd0, INITVAL_06 = 320'd0, INITVAL_07 = 320'd0,
    parameter [319:0] INITVAL_08 = 320'd0, INITVAL_09 = 320'd0, INITVAL_0A = 320'd0, INITVAL_0B = 320'd0,
    parameter [319:0] INITVAL_0C = 320'd0, INITVAL_0D = 320'd0, INITVAL_0E = 320'd0, INITVAL_0F = 320'd0,
    parameter [319:0] INITVAL_10 = 320'd0, INITVAL_11 = 320'd0, INITVAL_12 = 320'd0, INITVAL_13 = 320'd0,
    parameter [319:0] INITVAL_14 = 320'd0, INITVAL_15 = 320'd0, INITVAL_16 = 320'd0, INITVAL_17 = 320'd0,
    parameter [319:0] INITVAL_18 = 320'd0, INITVAL_19 = 320'd0, INITVAL_1A = 320'd0, INITVAL_1B = 320'd0,
    parameter [319:0] INITVAL_1C = 320'd0, INITVAL_1D = 320'd0, INITVAL_1E = 320'd0, INITVAL_1F = 320'd0,
    parameter [319:0] INITVAL_20 = 320'd0, INITVAL_21 = 320'd0, INITVAL_22 = 320'd0, INITVAL_23 = 320'd0,
    parameter [319:0] INITVAL_24 = 320'd0, INITVAL_25 = 320'd0, INITVAL_26 = 320'd0, INITVAL_27 = 320'd0,
    parameter [319:0] INITVAL_28 = 320'd0, INITVAL_29 = 320'd0, INITVAL_2A = 320'd0, INITVAL_2B = 320'd0,
    parameter [319:0] INITVAL_2C = 320'd0, INITVAL_2D = 320'd0, INITVAL_2E = 320'd0, INITVAL_2F = 320'd0,
    parameter [319:0] INITVAL_30 = 320'd0, INITVAL_31 = 320'd0, INITVAL_32 = 320'd0, INITVAL_33 = 320'd0,
    parameter [319:0] INITVAL_34 = 320'd0, INITVAL_35 = 320'd0, INITVAL_36 = 320'd0, INITVAL_37 = 320'd0,
    parameter [319:0] INITVAL_38 = 320'd0, INITVAL_39 = 320'd0, INITVAL_3A = 320'd0, INITVAL_3B = 320'd0,
    parameter [319:0] INITVAL_3C = 320'd0, INITVAL_3D = 320'd0, INITVAL_3E = 320'd0, INITVAL_3F = 320'd0
) (
    input wire CLKA, input wire CEA, input wire OCEA, input wire WEA, input wire RSTA,
    input wire CSA0, input wire CSA1, input wire CSA2,
    input wire ADA0, input wire ADA1, input wire ADA2, input wire ADA3, input wire ADA4, input wire ADA5,
    input wire ADA6, input wire ADA7, input wire ADA8, input wire ADA9, input wire ADA10, input wire ADA11,
    input wire ADA12, input wire ADA13,
    input wire DIA0, input wire DIA1, input wire DIA2, input wire DIA3, input wire DIA4, input wire DIA5,
    input wire DIA6, input wire DIA7, input wire DIA8, input wire DIA9, input wire DIA10, input wire DIA11,
    input wire DIA12, input wire DIA13, input wire DIA14, input wire DIA15, input wire DIA16, input wire DIA17,
    output wire DOA0, output wire DOA1, output wire DOA2, output wire DOA3, output wire DOA4,
    output wire DOA5, output wire DOA6, output wire DOA7, output wire DOA8, output wire DOA9,
    output wire DOA10, output wire DOA11, output wire DOA12, output wire DOA13, output wire DOA14,
    output wire DOA15, output wire DOA16, output wire DOA17,
    input wire CLKB, input wire CEB, input wire OCEB, input wire WEB, input wire RSTB,
    input wire CSB0, input wire CSB1, input wire CSB2,
    input wire ADB0, input wire ADB1, input wire ADB2, input wire ADB3, input wire ADB4, input wire ADB5,
    input wire ADB6, input wire ADB7, input wire ADB8, input wire ADB9, input wire ADB10, input wire ADB11,
    input wire ADB12, input wire ADB13,
    input wire DIB0, input wire DIB1, input wire DIB2, input wire DIB3, input wire DIB4, input wire DIB5,
    input wire DIB6, input wire DIB7, input wire DIB8, input wire DIB9, input wire DIB10, input wire DIB11,
    input wire DIB12, input wire DIB13, input wire DIB14, input wire DIB15, input wire DIB16, input wire DIB17,
    output wire DOB0, output wire DOB1, output wire DOB2, output wire DOB3, output wire DOB4,
    output wire DOB5, output wire DOB6, output wire DOB7, output wire DOB8, output wire DOB9,
    output wire DOB10, output wire DOB11, output wire DOB12, output wire DOB13, output wire DOB14,
    output wire DOB15, output wire DOB16, output wire DOB17
);
  wire [13:0] ad_a = {
      ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0
  };
  wire [17:0] di_a = {
      DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1,
      DIA0
  };
  wire [13:0] ad_b = {
      ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0
  };
  wire [17:0] di_b = {
      DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9, DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2, DIB1,
      DIB0
  };
  wire on_a = CEA && {CSA2, CSA1, CSA0} == 3'b000;
  wire on_b = CEB && {CSB2, CSB1, CSB0} == 3'b000;

  reg [8:0] memory[0:2047];
  reg [17:0] do_a, do_b;
  assign {
      DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1,
      DOA0
  } = do_a;
  assign {
      DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1,
      DOB0
  } = do_b;

  generate
    if (DATA_WIDTH_A == 36 || DATA_WIDTH_B == 36) begin : gen_simple
      wire [10:0] to = {ad_a[13:5], 2'd0};
      wire [10:0] from = {ad_b[13:5], 2'd0};
      wire [3:0] writes = {4{on_a && WEA}} & ad_a[3:0];
      wire [3:0] meets = to == from ? writes : 4'd0;  // the device may give old, new or mixed bits
      always @(posedge CLKA) begin
        if (writes[0] !== 1'b0) memory[to] <= writes[0] === 1'b1 ? di_a[8:0] : 9'bx;
        if (writes[1] !== 1'b0) memory[to|11'd1] <= writes[1] === 1'b1 ? di_a[17:9] : 9'bx;
        if (writes[2] !== 1'b0) memory[to|11'd2] <= writes[2] === 1'b1 ? di_b[8:0] : 9'bx;
        if (writes[3] !== 1'b0) memory[to|11'd3] <= writes[3] === 1'b1 ? di_b[17:9] : 9'bx;
      end
      always @(posedge CLKB) begin
        if (RSTB) {do_b, do_a} <= 36'd0;
        else if (on_b !== 1'b0) begin
          do_a[8:0] <= on_b !== 1'b1 || meets[0] !== 1'b0 ? 9'bx : memory[from];
          do_a[17:9] <= on_b !== 1'b1 || meets[1] !== 1'b0 ? 9'bx : memory[from|11'd1];
          do_b[8:0] <= on_b !== 1'b1 || meets[2] !== 1'b0 ? 9'bx : memory[from|11'd2];
          do_b[17:9] <= on_b !== 1'b1 || meets[3] !== 1'b0 ? 9'bx : memory[from|11'd3];
        end
      end
      if (DATA_WIDTH_A != DATA_WIDTH_B) DP16KD_of_36_and_fewer_bits_is_not_modelled u_refused ();
    end else begin : gen_dual
      reg [8:0] part_a;
      wire [10:0] at_a = ad_a[13:3];
      // The bits of a byte that a narrow port means, and how far up they are.
      wire [2:0] up_a = DATA_WIDTH_A == 1 ? ad_a[2:0] : DATA_WIDTH_A == 2 ? {ad_a[2:1], 1'b0} : {ad_a[2], 2'd0};
      wire [8:0] mask_a = DATA_WIDTH_A == 1 ? 9'd1 : DATA_WIDTH_A == 2 ? 9'd3 : 9'd15;
      always @(posedge CLKA) begin
        part_a = memory[at_a];
        if (on_a && WEA) begin
          if (DATA_WIDTH_A == 18) begin
            if (ad_a[0]) memory[at_a&11'h7fe] <= di_a[8:0];
            if (ad_a[1]) memory[at_a|11'd1] <= di_a[17:9];
          end else if (DATA_WIDTH_A == 9) memory[at_a] <= di_a[8:0];
          else memory[at_a] <= (part_a & ~(mask_a << up_a)) | ((di_a[8:0] & mask_a) << up_a);
        end
        if (RSTA) do_a <= 18'd0;
        else if (on_a && !(WEA && WRITEMODE_A == "NORMAL")) begin
          if (DATA_WIDTH_A == 18) do_a <= {memory[at_a|11'd1], memory[at_a&11'h7fe]};
          else if (DATA_WIDTH_A == 9) do_a <= {9'd0, part_a};
          else do_a <= {9'd0, (part_a >> up_a) & mask_a};
        end
      end
      reg [8:0] part_b;
      wire [10:0] at_b = ad_b[13:3];
      // The bits of a byte that a narrow port means, and how far up they are.
      wire [2:0] up_b = DATA_WIDTH_B == 1 ? ad_b[2:0] : DATA_WIDTH_B == 2 ? {ad_b[2:1], 1'b0} : {ad_b[2], 2'd0};
      wire [8:0] mask_b = DATA_WIDTH_B == 1 ? 9'd1 : DATA_WIDTH_B == 2 ? 9'd3 : 9'd15;
      always @(posedge CLKB) begin
        part_b = memory[at_b];
        if (on_b && WEB) begin
          if (DATA_WIDTH_B == 18) begin
            if (ad_b[0]) memory[at_b&11'h7fe] <= di_b[8:0];
            if (ad_b[1]) memory[at_b|11'd1] <= di_b[17:9];
          end else if (DATA_WIDTH_B == 9) memory[at_b] <= di_b[8:0];
          else memory[at_b] <= (part_b & ~(mask_b << up_b)) | ((di_b[8:0] & mask_b) << up_b);
        end
        if (RSTB) do_b <= 18'd0;
        else if (on_b && !(WEB && WRITEMODE_B == "NORMAL")) begin
          if (DATA_WIDTH_B == 18) do_b <= {memory[at_b|11'd1], memory[at_b&11'h7fe]};
          else if (DATA_WIDTH_B == 9) do_b <= {9'd0, part_b};
          else do_b <= {9'd0, (part_b >> up_b) & mask_b};
        end
      end
    end
    // RESETMODE says whether RSTA and RSTB wait for the clock. The core resets no output, so here they always do.
    if (REGMODE_A != "NOREG" || REGMODE_B != "NOREG") DP16KD_with_output_registers_is_not_modelled u_refused ();
    if (CSDECODE_A != "0b000" || CSDECODE_B != "0b000") DP16KD_of_another_CSDECODE_is_not_modelled u_refused ();
    if (CLKAMUX != "CLKA" || CLKBMUX != "CLKB") DP16KD_on_the_falling_edge_is_not_modelled u_refused ();
    if (WRITEMODE_A == "WRITETHROUGH" || WRITEMODE_B == "WRITETHROUGH")
      DP16KD_that_writes_through_is_not_modelled u_refused ();
  endgenerate
endmodule

`default_nettype wire
