// SPDX-License-Identifier: Apache-2.0
// The primitives of Lattice's ECP5 that boards' tops use, as they behave, for simulation: a PLL, an output register of
// double data rate, a flip-flop, a pad. Features of a primitive that no top uses are refused or left out.
`default_nettype none

// The PLL: it measures CLKI's period, and 30 periods later all clocks run, each a part of the oscillator. CLKOP and
// CLKOS have a rising edge at once, CLKOS2 and CLKOS3 run 1.3 and 2.1 ns behind them. Clock paths may differ so much,
// and data that cross then change just before they are sampled. LOCK follows ten periods after the clocks. Jitter and
// phases other than DIV - 1 (0 degrees) are not modelled.
module EHXPLLL #(
    parameter int CLKI_DIV = 1,
    parameter int CLKFB_DIV = 1,
    parameter string FEEDBK_PATH = "CLKOP",
    parameter string CLKOP_ENABLE = "ENABLED",
    parameter string CLKOS_ENABLE = "DISABLED",
    parameter string CLKOS2_ENABLE = "DISABLED",
    parameter string CLKOS3_ENABLE = "DISABLED",
    parameter int CLKOP_DIV = 8,
    parameter int CLKOS_DIV = 8,
    parameter int CLKOS2_DIV = 8,
    parameter int CLKOS3_DIV = 8,
    parameter int CLKOP_CPHASE = 0,
    parameter int CLKOS_CPHASE = 0,
    parameter int CLKOS2_CPHASE = 0,
    parameter int CLKOS3_CPHASE = 0,
    parameter int CLKOP_FPHASE = 0,
    parameter int CLKOS_FPHASE = 0,
    parameter int CLKOS2_FPHASE = 0,
    parameter int CLKOS3_FPHASE = 0,
    parameter string OUTDIVIDER_MUXA = "DIVA",
    parameter string OUTDIVIDER_MUXB = "DIVB",
    parameter string OUTDIVIDER_MUXC = "DIVC",
    parameter string OUTDIVIDER_MUXD = "DIVD"
) (
    input  wire  RST,
    input  wire  STDBY,
    input  wire  CLKI,
    input  wire  CLKFB,
    input  wire  PHASESEL0,
    input  wire  PHASESEL1,
    input  wire  PHASEDIR,
    input  wire  PHASESTEP,
    input  wire  PHASELOADREG,
    input  wire  PLLWAKESYNC,
    input  wire  ENCLKOP,
    output logic CLKOP,
    output logic CLKOS,
    output logic CLKOS2,
    output logic CLKOS3,
    output logic LOCK
);
  initial begin
    if (FEEDBK_PATH != "CLKOP") $fatal(1, "EHXPLLL: FEEDBK_PATH is not CLKOP");
    if (CLKOP_CPHASE != CLKOP_DIV - 1 || CLKOS_CPHASE != CLKOS_DIV - 1 || CLKOP_FPHASE != 0 || CLKOS_FPHASE != 0)
      $fatal(1, "EHXPLLL: a phase that is not 0 degrees");
  end

  // CLKI's period in picoseconds, measured once: a clock's n-th edge stands at its exact time, rounded down to a
  // picosecond, so that no rounding adds up and edges that belong together stay together.
  longint last = 0, period = 0;
  int   edges = 0;
  logic runs = 1'b0;
  initial LOCK = 1'b0;
  always @(posedge CLKI) begin
    if (edges < 100) edges++;
    if (edges == 30) begin
      period = longint'($time) - last;
      if (period * CLKI_DIV > 100_000) $fatal(1, "EHXPLLL: the phase detector does not run at 10 MHz or more");
      if (period * CLKI_DIV * 1000 / (CLKFB_DIV * CLKOP_DIV) < 1_250_000 ||
          period * CLKI_DIV * 1000 / (CLKFB_DIV * CLKOP_DIV) > 2_500_000)
        $fatal(1, "EHXPLLL: the oscillator does not run at 400 to 800 MHz");
      runs = 1'b1;
    end
    last = longint'($time);
    if (edges == 40) LOCK = 1'b1;
  end
  function automatic longint edge_at(input longint n, input int div);
    edge_at = n * period * CLKI_DIV * longint'(div) / (2 * CLKFB_DIV * CLKOP_DIV);
  endfunction

  longint op_edge = 0, os_edge = 0, os2_edge = 0, os3_edge = 0;
  initial {CLKOP, CLKOS, CLKOS2, CLKOS3} = '0;
  initial begin
    wait (runs);
    forever begin
      CLKOP = !CLKOP;
      op_edge++;
      #(edge_at(op_edge, CLKOP_DIV) - edge_at(op_edge - 1, CLKOP_DIV));
    end
  end
  initial begin
    wait (runs);
    if (CLKOS_ENABLE == "ENABLED")
      forever begin
        CLKOS = !CLKOS;
        os_edge++;
        #(edge_at(os_edge, CLKOS_DIV) - edge_at(os_edge - 1, CLKOS_DIV));
      end
  end
  initial begin
    wait (runs);
    #1300;
    if (CLKOS2_ENABLE == "ENABLED")
      forever begin
        CLKOS2 = !CLKOS2;
        os2_edge++;
        #(edge_at(os2_edge, CLKOS2_DIV) - edge_at(os2_edge - 1, CLKOS2_DIV));
      end
  end
  initial begin
    wait (runs);
    #2100;
    if (CLKOS3_ENABLE == "ENABLED")
      forever begin
        CLKOS3 = !CLKOS3;
        os3_edge++;
        #(edge_at(os3_edge, CLKOS3_DIV) - edge_at(os3_edge - 1, CLKOS3_DIV));
      end
  end
endmodule

// Both bits are taken at the rising edge; the first goes out with it, the second at the falling one.
module ODDRX1F (
    input  wire  D0,
    input  wire  D1,
    input  wire  SCLK,
    input  wire  RST,
    output logic Q
);
  logic first_q, second_q;
  always_ff @(posedge SCLK) begin
    first_q  <= RST ? 1'b0 : D0;
    second_q <= RST ? 1'b0 : D1;
  end
  assign Q = SCLK ? first_q : second_q;
endmodule

// The flip-flop, as far as one without reset and enable needs it.
module TRELLIS_FF #(
    parameter string GSR = "ENABLED",
    parameter string CEMUX = "CE",
    parameter string CLKMUX = "CLK",
    parameter string LSRMUX = "LSR",
    parameter string SRMODE = "LSR_OVER_CE",
    parameter string REGSET = "RESET"
) (
    input  wire  CLK,
    input  wire  LSR,
    input  wire  CE,
    input  wire  DI,
    output logic Q
);
  logic unused;
  assign unused = &{1'b0, SRMODE == "ASYNC"};
  initial begin
    if (GSR != "DISABLED" || CEMUX != "CE" || !CE || LSRMUX != "LSR" || LSR)
      $fatal(1, "TRELLIS_FF: it has a reset or an enable");
    Q = REGSET == "SET";
  end
  if (CLKMUX == "INV") begin : gen_falling
    always_ff @(negedge CLK) Q <= DI;
  end else begin : gen_rising
    always_ff @(posedge CLK) Q <= DI;
  end
endmodule

// A pad of both directions: T high lets go of it.
module BB (
    input  wire  I,
    input  wire  T,
    output logic O,
    inout  wire  B
);
  assign B = T ? 1'bz : I;
  assign O = B;
endmodule

`default_nettype wire
