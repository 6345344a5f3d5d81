// SPDX-License-Identifier: Apache-2.0
// The polygons that cross a line, in the order of their places: one bank is read while those that cross the next line
// are written to the other, in the same order. So nothing is ever searched.
//
// Reading: polygon_valid_o and polygon_o, the line's next one, which pop_i takes; left_o: there are more of the line,
//   ready or not. keep_i, one clock: one that is taken, or a new one, goes on to the next line; it comes to be written
//   by write_i later, in the same order. room_o: the line and the next one have fewer than ACTIVE.
// A line ends by swap_i, one clock, when nothing is left and swap_ready_o is high; swap_write_i, one clock, when all
//   that the line keeps has been written. clear_i: as after reset, while nothing is to be written.
// Latency: from swap_i 3 clocks to the next line's first polygon; one that is still to be written comes 3 clocks after
//   that. Throughput: a polygon a clock, read and written.
// Cost: 2 x ACTIVE words of block RAM, rounded up to a power of two; 2 x BITS flip-flops; five counters.
`default_nettype none

module active_list #(
    parameter int BITS   = 8,
    parameter int ACTIVE = 512
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic clear_i,

    output logic                 polygon_valid_o,
    output logic      [BITS-1:0] polygon_o,
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
  logic left_any_q;  // left_q is not 0
  assign left_o = left_any_q;
  assign room_o = all_q != TallyBits'(ACTIVE);
  always_ff @(posedge clk_i) begin
    if (clear) begin
      left_q <= '0;
      left_any_q <= 1'b0;
      kept_q <= '0;
      all_q <= '0;
    end else begin
      left_q <= swap_i ? kept_q : left_q - TallyBits'(pop_i);
      left_any_q <= swap_i ? kept_q != '0 : left_q != TallyBits'(pop_i);
      kept_q <= swap_i ? '0 : kept_q + TallyBits'(keep_i);
      all_q <= all_q + TallyBits'(keep_i) - TallyBits'(pop_i);
    end
  end

  // ---- the two banks -----------------------------------------------------------------------------------------------
  // The reader's bank may still be written, if the writer has not seen the last swap: then what is there is what has
  // been written.
  logic read_bank_q, write_bank_q;
  logic [AddrBits:0] read_at_q, write_at_q, there_q, there;
  logic read, loaded_q, out_ready;
  logic [BITS-1:0] word;
  assign swap_ready_o = read_bank_q != write_bank_q;
  assign there = swap_ready_o ? there_q : write_at_q;
  assign read = read_at_q != there && (!loaded_q || out_ready);
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
      loaded_q <= read || (loaded_q && !out_ready);
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

  skid_buffer #(
      .BITS(BITS)
  ) u_out (
      .clk_i,
      .rst_ni     (!clear),
      .in_valid_i (loaded_q),
      .in_ready_o (out_ready),
      .in_data_i  (word),
      .out_valid_o(polygon_valid_o),
      .out_ready_i(pop_i),
      .out_data_o (polygon_o)
  );

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  always @(posedge clk_i) begin
    if (!clear) begin
      // 1. What is taken is there; a line ends behind its last.
      assert (!pop_i || (polygon_valid_o && left_any_q));
      assert (!swap_i || (swap_ready_o && !left_any_q && !polygon_valid_o && !loaded_q));
      // 2. Counts are of each other.
      assert (left_any_q == (left_q != '0) && all_q == left_q + kept_q);
      assert (32'(all_q) <= ACTIVE);
      // 3. Nothing is written past a bank.
      assert (!write_i || write_at_q < (AddrBits + 1)'(ACTIVE));
    end
  end
`endif

endmodule

`default_nettype wire
