// SPDX-License-Identifier: Apache-2.0
// The polygons that cross a line, in the order of their places: one bank is read while those that cross the next line
// are written to the other, in the same order. So nothing is ever searched.
//
// Reading: polygon_valid_o and polygon_o give the line's next polygon, which pop_i takes; left_o: the line has more,
//   ready or not. Three outputs judge that polygon: before_o and same_o, its place is less than place_i, or is place_i;
//   goes_on_o, its end is behind line_i. They are registers: in the clock in which renew_i says that place_i is new
//   they are those of the place before, and nothing is taken.
// Writing: keep_i, one clock: a polygon that is taken, or a new one, goes on to the next line. It is written by write_i
//   later, in the same order. room_o: the line and the next one have fewer than ACTIVE together.
// A line ends by swap_i, one clock, when nothing is left and swap_ready_o is high. Input swap_write_i comes, one clock,
//   when all that the line keeps has been written. clear_i: as after reset, while nothing is to be written.
// Latency: from swap_i 4 clocks to the next line's first polygon; one that is still to be written comes 4 clocks after
//   that. Throughput: a polygon a clock, read and written.
// Cost: 2 x ACTIVE words of block RAM, rounded up to a power of two; 2 x BITS flip-flops; five counters, a comparator
//   of places and one of lines.
`default_nettype none

module active_list #(
    parameter int BITS = 8,
    parameter int PLACE_AT = 0,  // where in a polygon its place lies
    parameter int PLACE_BITS = 2,
    parameter int END_AT = 2,  // and the line behind its last, signed
    parameter int END_BITS = 2,
    parameter int ACTIVE = 512
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic clear_i,

    input wire logic [PLACE_BITS-1:0] place_i,
    input wire logic                  renew_i,
    input wire logic [  END_BITS-1:0] line_i,

    output logic                 polygon_valid_o,
    output logic      [BITS-1:0] polygon_o,
    output logic                 before_o,
    output logic                 same_o,
    output logic                 goes_on_o,
    input  wire logic            pop_i,
    output logic                 left_o,
    input  wire logic            keep_i,
    output logic                 room_o,
    input  wire logic            swap_i,
    output logic                 swap_ready_o,

    input wire logic            write_i,
    input wire logic [BITS-1:0] polygon_i,
    input wire logic            swap_write_i
);
  localparam int AddrBits = ACTIVE > 1 ? $clog2(ACTIVE) : 1;
  localparam int TallyBits = $clog2(ACTIVE + 1);

  logic clear;
  assign clear = clear_i || !rst_ni;

  // ---- how many ----------------------------------------------------------------------------------------------------
  logic [TallyBits-1:0] left_q, kept_q, all_q;  // of this line, of the next, together
  logic left_any_q, full_q;  // left_q is not 0, all_q is ACTIVE
  assign left_o = left_any_q;
  assign room_o = !full_q;
  always_ff @(posedge clk_i) begin
    if (clear) begin
      left_q <= '0;
      left_any_q <= 1'b0;
      full_q <= 1'b0;
      kept_q <= '0;
      all_q <= '0;
    end else begin
      left_q <= swap_i ? kept_q : left_q - TallyBits'(pop_i);
      // Counters alone give all results here; pop_i, which comes late, only selects one.
      left_any_q <= swap_i ? kept_q != '0 : pop_i ? left_q != TallyBits'(1) : left_any_q;
      full_q <= pop_i == keep_i ? full_q : keep_i && all_q == TallyBits'(ACTIVE - 1);
      kept_q <= swap_i ? '0 : kept_q + TallyBits'(keep_i);
      all_q <= all_q + TallyBits'(keep_i) - TallyBits'(pop_i);
    end
  end

  // ---- the two banks -----------------------------------------------------------------------------------------------
  // The reader's bank may still be written, if the writer has not seen the last swap: then what is there is what has
  // been written.
  logic read_bank_q, write_bank_q;
  logic [AddrBits:0] read_at_q, write_at_q, there_q, there;
  logic read, loaded_q, next_free;
  logic [BITS-1:0] word;
  assign swap_ready_o = read_bank_q != write_bank_q;
  assign there = swap_ready_o ? there_q : write_at_q;
  assign read = read_at_q != there && (!loaded_q || next_free);
  always_ff @(posedge clk_i) begin
    if (clear) begin
      read_bank_q <= 1'b0;
      write_bank_q <= 1'b1;
      read_at_q <= '0;
      write_at_q <= '0;
      there_q <= '0;
      loaded_q <= 1'b0;
    end else begin
      if (swap_i) read_bank_q <= !read_bank_q;
      if (swap_write_i) write_bank_q <= !write_bank_q;
      read_at_q  <= swap_i ? '0 : read_at_q + (AddrBits + 1)'(read);
      write_at_q <= swap_write_i ? '0 : write_at_q + (AddrBits + 1)'(write_i);
      if (swap_write_i) there_q <= write_at_q;
      loaded_q <= read || (loaded_q && !next_free);
    end
  end

  ram_1r1w #(
      .BITS (BITS),
      .WORDS(2 ** (AddrBits + 1))
  ) u_banks (
      .clk_i,
      .wr_en_i  (write_i),
      .wr_addr_i({write_bank_q, write_at_q[AddrBits-1:0]}),
      .wr_data_i(polygon_i),
      .rd_en_i  (read),
      .rd_addr_i({read_bank_q, read_at_q[AddrBits-1:0]}),
      .rd_data_o(word)
  );

  // ---- the next polygon, compared on its way to be the first -------------------------------------------------------
  logic next_valid_q, first_valid_q, first_free, before_q, same_q, goes_on_q;
  logic [BITS-1:0] next_q, first_q;
  logic [PLACE_BITS-1:0] compared;
  assign polygon_valid_o = first_valid_q;
  assign polygon_o = first_q;
  assign before_o = before_q;
  assign same_o = same_q;
  assign goes_on_o = goes_on_q;
  assign first_free = !renew_i && (!first_valid_q || pop_i);
  assign next_free = !next_valid_q || first_free;
  assign compared = renew_i ? first_q[PLACE_AT+:PLACE_BITS] : next_q[PLACE_AT+:PLACE_BITS];
  always_ff @(posedge clk_i) begin
    if (clear) begin
      next_valid_q  <= 1'b0;
      first_valid_q <= 1'b0;
    end else begin
      next_valid_q  <= loaded_q || !next_free;
      first_valid_q <= (next_valid_q && first_free) || (first_valid_q && !pop_i);
    end
    if (next_free) next_q <= word;
    if (first_free) begin
      first_q   <= next_q;
      goes_on_q <= $signed(next_q[END_AT+:END_BITS]) > $signed(line_i);
    end
    if (first_free || renew_i) begin
      before_q <= compared < place_i;
      same_q   <= compared == place_i;
    end
  end

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (!clear) begin
      // 1. A polygon that is taken is there; a line ends behind its last.
      assert (!pop_i || (polygon_valid_o && left_any_q && !renew_i));
      assert (!swap_i || (swap_ready_o && !left_any_q && !first_valid_q && !next_valid_q && !loaded_q));
      // 2. The counts agree.
      assert (left_any_q == (left_q != '0) && full_q == (32'(all_q) == ACTIVE) && all_q == left_q + kept_q);
      assert (32'(all_q) <= ACTIVE);
      // 3. Nothing is written past a bank.
      assert (!write_i || write_at_q < (AddrBits + 1)'(ACTIVE));
    end
  end
`endif

endmodule

`default_nettype wire
