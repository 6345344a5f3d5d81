// SPDX-License-Identifier: Apache-2.0
// The cells of iCE40 that yosys' synth_ice40 leaves of the core, for `kage cosim --netlist ice40`. Registers and memories
// have no initial value: a simulator gives them X, or random bits. A value that an enable or a reset decides is X where that
// is X. A cell, a clock edge or a reset that is not here is an
// error of elaboration.
//
// verif/test/cells holds each against yosys' own model, and against RTL that becomes such cells.
`default_nettype none

// I3 chooses between the halves of LUT_INIT, I0 between neighbours. Where an input is X and both choices agree, O is known.
module SB_LUT4 #(
    parameter [15:0] LUT_INIT = 16'h0000
) (
    input wire I0,
    input wire I1,
    input wire I2,
    input wire I3,
    output wire O
);
  wire [7:0] half = I3 ? LUT_INIT[15:8] : LUT_INIT[7:0];
  wire [3:0] quarter = I2 ? half[7:4] : half[3:0];
  wire [1:0] pair = I1 ? quarter[3:2] : quarter[1:0];
  assign O = I0 ? pair[1] : pair[0];
endmodule

module SB_CARRY (
    input wire I0,
    input wire I1,
    input wire CI,
    output wire CO
);
  assign CO = (I0 & I1) | (I0 & CI) | (I1 & CI);
endmodule

// Flip-flops on the rising edge: E is an enable, R and S set to 0 and 1 with the clock. In ..ESR and ..ESS the enable rules
// the set and reset too.
module SB_DFF (
    input wire C,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= D;
endmodule

module SB_DFFE (
    input wire C,
    input wire E,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= E ? D : Q;
endmodule

module SB_DFFSR (
    input wire C,
    input wire R,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= R ? 1'b0 : D;
endmodule

module SB_DFFSS (
    input wire C,
    input wire S,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= S ? 1'b1 : D;
endmodule

module SB_DFFESR (
    input wire C,
    input wire E,
    input wire R,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= E ? (R ? 1'b0 : D) : Q;
endmodule

module SB_DFFESS (
    input wire C,
    input wire E,
    input wire S,
    input wire D,
    output reg Q
);
  always @(posedge C) Q <= E ? (S ? 1'b1 : D) : Q;
endmodule

// 4 kbit: 256 words of 16 bits, or, with a mode of 1, 2 or 3, 512 x 8, 1024 x 4 or 2048 x 2. Then address bits 8 and up
// choose one of 2, 4 or 8 neighbouring bits of the word, and each datum has one pin of as many. A bit that is read in the
// clock in which it is written is X: the device may give the old or the new one.
module SB_RAM40_4K #(
    parameter WRITE_MODE = 0,
    parameter READ_MODE = 0,
    // The core asks for no contents.
    parameter [255:0] INIT_0 = 256'd0, INIT_1 = 256'd0, INIT_2 = 256'd0, INIT_3 = 256'd0,
    parameter [255:0] INIT_4 = 256'd0, INIT_5 = 256'd0, INIT_6 = 256'd0, INIT_7 = 256'd0,
    parameter [255:0] INIT_8 = 256'd0, INIT_9 = 256'd0, INIT_A = 256'd0, INIT_B = 256'd0,
    parameter [255:0] INIT_C = 256'd0, INIT_D = 256'd0, INIT_E = 256'd0, INIT_F = 256'd0
) (
    output reg [15:0] RDATA,
    input wire RCLK,
    input wire RCLKE,
    input wire RE,
    input wire [10:0] RADDR,
    input wire WCLK,
    input wire WCLKE,
    input wire WE,
    input wire [10:0] WADDR,
    input wire [15:0] MASK,  // of mode 0: a bit of 1 is not written
    input wire [15:0] WDATA
);
  localparam integer WSTEP = 1 << WRITE_MODE;
  localparam integer RSTEP = 1 << READ_MODE;
  localparam integer WPIN = WRITE_MODE > 0 ? WSTEP / 2 - 1 : 0;
  localparam integer RPIN = READ_MODE > 0 ? RSTEP / 2 - 1 : 0;
  localparam [2:0] WSLOTS = WSTEP - 1;
  localparam [2:0] RSLOTS = RSTEP - 1;

  reg [15:0] memory[0:255];

  reg [15:0] next, word, read, written;
  integer i, j;
  always @(posedge WCLK) begin
    if ((WE & WCLKE) !== 1'b0) begin
      next = memory[WADDR[7:0]];
      for (i = 0; i < 16; i = i + WSTEP)
        if (WRITE_MODE != 0 || !MASK[i]) next[i+{29'd0, WADDR[10:8]&WSLOTS}] = WDATA[i+WPIN];
      memory[WADDR[7:0]] <= (WE & WCLKE) === 1'b1 ? next : 16'hxxxx;
    end
  end
  always @(posedge RCLK) begin
    if ((RE & RCLKE) !== 1'b0) begin
      written = 16'd0;
      for (j = 0; j < 16; j = j + WSTEP)
        if (WRITE_MODE != 0 || !MASK[j]) written[j+{29'd0, WADDR[10:8]&WSLOTS}] = (WE & WCLKE) !== 1'b0;
      word = memory[RADDR[7:0]];
      if (WADDR[7:0] == RADDR[7:0]) word = (word & ~written) | (written & 16'hxxxx);
      read = 16'd0;
      for (j = 0; j < 16; j = j + RSTEP) read[j+RPIN] = word[j+{29'd0, RADDR[10:8]&RSLOTS}];
      RDATA <= (RE & RCLKE) === 1'b1 ? read : 16'hxxxx;
    end
  end
endmodule

`default_nettype wire
