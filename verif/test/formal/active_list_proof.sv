// SPDX-License-Identifier: Apache-2.0
// Proof of active_list, for anything that front_merge and polygon_walk may do with it, and a reset or a clearing at any
// time (verif/test/formal/run.sh):
//   in_order   the nth polygon that is given is the nth that was written: none is lost, doubled or changed;
//   none_more  a line is given no more polygons than the line above has kept;
//   comes      one that is there is given within Wait clocks, so that none is left behind;
//   left_told, room_told, swap_told   what the ports say of a line and of the room;
//   placed, ends   the comparisons of its place and of its end are of the polygon that is given, and of place_i and
//                  line_i.
//
// How: by induction. The proof keeps a queue of the polygons that have been written and not taken, and counts those
// that each line has kept. Script run.sh connects inside_* to the banks, their pointers and the stages ahead of the
// port. The lemmas say that the queue's words lie in the stages first, then in the bank that is read, then in the
// other.
//
// Why small widths say it for all: a polygon's place and end alone are looked at; its other bits are copied alike.
// ACTIVE is 2, so that a bank is filled, taken again and full.
`default_nettype none

module active_list_proof #(
    localparam int Active = 2,
    localparam int BITS   = 4,
    localparam int Most   = Active,
    localparam int Wait   = 4
) (
    input wire logic            clk_i,
    input wire logic            rst_ni,
    input wire logic            clear_i,
    input wire logic [     1:0] place_i,
    input wire logic            renew_i,
    input wire logic [     1:0] line_i,
    input wire logic            pop_i,
    input wire logic            keep_i,
    input wire logic            swap_i,
    input wire logic            write_i,
    input wire logic [BITS-1:0] polygon_i,
    input wire logic            swap_write_i
);
  logic valid, sooner, same, goes_on, left, room, swap_ready;
  logic [BITS-1:0] polygon;
  active_list #(
      .BITS(BITS),
      .PLACE_AT(0),
      .PLACE_BITS(2),
      .END_AT(2),
      .END_BITS(2),
      .ACTIVE(Active)
  ) dut (
      .clk_i,
      .rst_ni,
      .clear_i,
      .place_i,
      .renew_i,
      .line_i,
      .polygon_valid_o(valid),
      .polygon_o      (polygon),
      .before_o       (sooner),
      .same_o         (same),
      .goes_on_o      (goes_on),
      .pop_i,
      .left_o         (left),
      .keep_i,
      .room_o         (room),
      .swap_i,
      .swap_ready_o   (swap_ready),
      .write_i,
      .polygon_i,
      .swap_write_i
  );

  // ---- what has been kept, written and taken -----------------------------------------------------------------------
  logic clear;
  logic [2:0] left_q, kept_q;  // of this line, for the next
  logic [2:0]
      owed_q,
      owed_next_q;  // kept and not yet written: of this line, while the writer has not seen the swap; of the next
  logic behind_q;  // the writer has not seen the last swap
  logic [2:0] count_q;  // written and not taken
  logic [Most*BITS-1:0] words_q;  // those, the oldest lowest
  logic [2:0] waited_q;
  assign clear = clear_i || !rst_ni;
  logic [2:0] at;
  logic [Most*BITS-1:0] words;
  always_comb begin
    words = pop_i ? words_q >> BITS : words_q;
    at = count_q - 3'(pop_i);
    for (int i = 0; i < Most; i++) if (write_i && 32'(at) == i) words[i*BITS+:BITS] = polygon_i;
  end
  always_ff @(posedge clk_i) begin
    if (clear) begin
      {left_q, kept_q, owed_q, owed_next_q, behind_q, count_q, waited_q} <= '0;
    end else begin
      left_q <= swap_i ? kept_q : left_q - 3'(pop_i);
      kept_q <= swap_i ? 3'd0 : kept_q + 3'(keep_i);
      behind_q <= swap_i || (behind_q && !swap_write_i);
      owed_q <= swap_i ? owed_next_q - 3'(write_i) : owed_q - 3'(behind_q && write_i);
      owed_next_q <= swap_i ? 3'd0 : owed_next_q + 3'(keep_i) - 3'(!behind_q && write_i);
      count_q <= count_q + 3'(write_i) - 3'(pop_i);
      waited_q <= valid || renew_i || left_q == '0 || count_q == '0 ? 3'd0 : waited_q + 3'd1;
    end
    words_q <= words;
  end

  // ---- surroundings ------------------------------------------------------------------------------------------------
  logic started_q = 1'b0;
  logic [1:0] place_q, line_q;
  logic swap_q, clear_q;
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    place_q <= place_i;
    line_q <= line_i;
    swap_q <= swap_i;
    clear_q <= clear;
  end
  always_comb begin
    if (!started_q) assume (!rst_ni);
    // front_merge takes what is there, keeps what it takes or has room for, and ends a line behind its last.
    assume (!pop_i || (valid && left && !renew_i));
    assume (!keep_i || pop_i || room);
    assume (!swap_i || (swap_ready && !left && !pop_i && !keep_i));
    // polygon_walk writes what was kept, in order, some clocks later; a line's end comes behind its last.
    assume (!write_i || (behind_q ? owed_q != '0 : owed_next_q != '0));
    assume (!swap_write_i || (behind_q && owed_q == '0 && !write_i));
    assume (!clear || (!write_i && !swap_write_i && !keep_i && !pop_i && !swap_i));
    // A place changes where renew_i says so, a line's number behind its end.
    if (started_q && !clear_q) begin
      assume (place_i == place_q || renew_i);
      assume (line_i == line_q || swap_q);
    end
  end

  // ---- the properties ----------------------------------------------------------------------------------------------
  always_comb begin
    if (started_q && !clear) begin
      if (valid) in_order : assert (count_q != '0 && polygon == words_q[0+:BITS]);
      if (valid) none_more : assert (left_q != '0);
      comes : assert (waited_q <= Wait);
      left_told : assert (left == (left_q != '0));
      room_told : assert (room == (32'(left_q) + 32'(kept_q) < Active));
      swap_told : assert (swap_ready == !behind_q);
      if (valid && !renew_i) placed : assert (sooner == (polygon[1:0] < place_i) && same == (polygon[1:0] == place_i));
      if (valid) ends : assert (goes_on == ($signed(polygon[3:2]) > $signed(line_i)));
      two_lines : cover (valid && count_q == 3'd2 && kept_q == 3'd1 && !renew_i && sooner);
      late : cover (behind_q && owed_q == 3'd2 && left_q == 3'd2);
    end
  end

  // ---- for induction -----------------------------------------------------------------------------------------------
  (* keep *) logic [4*BITS-1:0] inside_memory;
  (* keep *) logic [BITS-1:0] inside_word, inside_next, inside_first;
  (* keep *) logic inside_read_bank, inside_write_bank, inside_loaded, inside_next_valid, inside_first_valid;
  (* keep *) logic [1:0] inside_read_at, inside_write_at, inside_there, inside_left, inside_kept, inside_all;
  logic [1:0] there;
  logic [2:0] ahead;
  // The bank that is read, then the other: which places hold what is still to be read, and what. No net here is another
  // name of one that run.sh connects.
  logic [2*Active-1:0] holds;
  assign holds = {
    !behind_q && inside_write_at > 2'd1,
    !behind_q && inside_write_at > 2'd0,
    inside_read_at <= 2'd1 && there > 2'd1,
    inside_read_at == 2'd0 && there > 2'd0
  };
  assign there = inside_read_bank != inside_write_bank ? inside_there : inside_write_at;
  assign ahead = 3'(inside_first_valid) + 3'(inside_next_valid) + 3'(inside_loaded);
  // Each holder, in the order in which they are given, has the word behind those that the ones before it have.
  logic [2:0] of_next, of_loaded, of_bank, of_bank1, of_other, of_other1;
  assign of_next   = inside_first_valid ? 3'd1 : 3'd0;
  assign of_loaded = of_next + 3'(inside_next_valid);
  assign of_bank   = ahead;
  assign of_bank1  = of_bank + 3'(holds[0]);
  assign of_other  = of_bank1 + 3'(holds[1]);
  assign of_other1 = of_other + 3'(holds[2]);
  function automatic logic [BITS-1:0] nth(input logic [Most*BITS-1:0] of, input logic [2:0] n);
    nth = n == 3'd0 ? of[0+:BITS] : of[BITS+:BITS];
  endfunction
  logic words_there;
  assign words_there = (!inside_first_valid || inside_first == nth(
      words_q, 3'd0
  )) && (!inside_next_valid || inside_next == nth(
      words_q, of_next
  )) && (!inside_loaded || inside_word == nth(
      words_q, of_loaded
  )) && (!holds[0] || (inside_read_bank ? inside_memory[2*BITS+:BITS] : inside_memory[0+:BITS]) == nth(
      words_q, of_bank
  )) && (!holds[1] || (inside_read_bank ? inside_memory[3*BITS+:BITS] : inside_memory[BITS+:BITS]) == nth(
      words_q, of_bank1
  )) && (!holds[2] || (inside_read_bank ? inside_memory[0+:BITS] : inside_memory[2*BITS+:BITS]) == nth(
      words_q, of_other
  )) && (!holds[3] || (inside_read_bank ? inside_memory[BITS+:BITS] : inside_memory[3*BITS+:BITS]) == nth(
      words_q, of_other1
  ));
  always_comb begin
    if (started_q && !clear) begin
      lemma_words : assert (words_there && of_other1 + 3'(holds[3]) == count_q);
      lemma_line : assert (left_q == ahead + 3'(there) - 3'(inside_read_at) + (behind_q ? owed_q : 3'd0));
      lemma_next_line : assert (kept_q == (behind_q ? 3'd0 : 3'(inside_write_at)) + owed_next_q);
      lemma_pointers :
      assert (ahead <= 3'(inside_read_at) && inside_read_at <= there && there <= 2'd2 && inside_write_at <= 2'd2 &&
              (behind_q || owed_q == '0) &&
                               owed_q <= 3'd2 && owed_next_q <= 3'd2 && 3'(there) + owed_q <= 3'd2);
      lemma_counts :
      assert (3'(inside_left) == left_q && 3'(inside_kept) == kept_q && 3'(inside_all) == left_q + kept_q &&
                             left_q + kept_q <= 3'd2);
      lemma_waited :
      assert (waited_q == '0 || valid ||
          (inside_next_valid ? waited_q <= 3'd3 : inside_loaded ? waited_q <= 3'd2 : waited_q <= 3'd1));
    end
  end
endmodule

`default_nettype wire
