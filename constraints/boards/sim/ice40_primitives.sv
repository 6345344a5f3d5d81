// SPDX-License-Identifier: Apache-2.0
// The primitives of Lattice's iCE40 that boards' tops use, as they behave, for simulation: a PLL, a buffer. Features of
// a primitive that no top uses are refused or left out.
`default_nettype none

// The PLL: it measures REFERENCECLK's period, and 30 periods later its clock runs, 1.3 ns behind the reference's edges.
// Clock paths may differ so much, and data that cross then change just before they are sampled. LOCK follows ten
// periods after the clock. Jitter is not modelled.
module SB_PLL40_CORE #(
    parameter string FEEDBACK_PATH = "SIMPLE",
    parameter logic [3:0] DIVR = 4'd0,
    parameter logic [6:0] DIVF = 7'd0,
    parameter logic [2:0] DIVQ = 3'd0,
    parameter logic [2:0] FILTER_RANGE = 3'd0
) (
    input  wire  REFERENCECLK,
    input  wire  RESETB,
    input  wire  BYPASS,
    output logic PLLOUTGLOBAL,
    output logic LOCK
);
  initial if (FEEDBACK_PATH != "SIMPLE") $fatal(1, "SB_PLL40_CORE: FEEDBACK_PATH is not SIMPLE");

  // The filter's range for a phase detector of so many MHz.
  function automatic int range_of(input longint mhz);
    range_of = mhz < 17 ? 1 : mhz < 26 ? 2 : mhz < 44 ? 3 : mhz < 66 ? 4 : mhz < 101 ? 5 : 6;
  endfunction

  // The reference's period in picoseconds, measured once: the clock's n-th edge stands at its exact time, rounded down
  // to a picosecond, so that no rounding adds up.
  longint last = 0, period = 0, detector_mhz, oscillator_mhz;
  int   edges = 0;
  logic runs = 1'b0;
  initial LOCK = 1'b0;
  always @(posedge REFERENCECLK) begin
    if (edges < 100) edges++;
    if (edges == 30) begin
      period         = longint'($time) - last;
      detector_mhz   = 1_000_000 / (period * (longint'(DIVR) + 1));
      oscillator_mhz = 1_000_000 * (longint'(DIVF) + 1) / (period * (longint'(DIVR) + 1));
      if (!RESETB || BYPASS) $fatal(1, "SB_PLL40_CORE: it is held in reset or passed by");
      if (detector_mhz < 10 || detector_mhz > 133)
        $fatal(1, "SB_PLL40_CORE: the phase detector does not run at 10 to 133 MHz");
      if (oscillator_mhz < 533 || oscillator_mhz > 1066)
        $fatal(1, "SB_PLL40_CORE: the oscillator does not run at 533 to 1066 MHz");
      if (int'(FILTER_RANGE) != range_of(detector_mhz))
        $fatal(1, "SB_PLL40_CORE: FILTER_RANGE is %0d, expected %0d", FILTER_RANGE, range_of(detector_mhz));
      runs = 1'b1;
    end
    last = longint'($time);
    if (edges == 40) LOCK = 1'b1;
  end
  function automatic longint edge_at(input longint n);
    edge_at = n * period * (longint'(DIVR) + 1) * (64'd1 << DIVQ) / (2 * (longint'(DIVF) + 1));
  endfunction

  longint out_edge = 0;
  initial PLLOUTGLOBAL = 1'b0;
  initial begin
    wait (runs);
    #1300;
    forever begin
      PLLOUTGLOBAL = !PLLOUTGLOBAL;
      out_edge++;
      #(edge_at(out_edge) - edge_at(out_edge - 1));
    end
  end
endmodule

// A way into one of the global nets, without its delay.
module SB_GB (
    input  wire  USER_SIGNAL_TO_GLOBAL_BUFFER,
    output logic GLOBAL_BUFFER_OUTPUT
);
  assign GLOBAL_BUFFER_OUTPUT = USER_SIGNAL_TO_GLOBAL_BUFFER;
endmodule

`default_nettype wire
