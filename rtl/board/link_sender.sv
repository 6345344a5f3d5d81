// SPDX-License-Identifier: Apache-2.0
// The board's end of what the host is sent (docs/link.md): frames of ACK and DATA, with flags, escapes and CRC-16.
//
// Handshake: answer_i, of one clock, asks for an ACK; all that ask before an ACK begins get that one. ack_taken_o marks
//   the clock in which an ACK takes its fields. A DATA frame's bytes behind its kind come with valid/ready, data_last_i
//   with the last; the flags follow. tx: valid/ready, a byte is offered until it is taken.
// ACK and DATA take turns when both wait, so neither waits for more than one frame of the other.
// Latency: 3 clocks from answer_i to the first flag. Throughput: a byte in 2 clocks, 3 with an escape.
// Cost: 140 LUT and 83 flip-flops of an iCE40, of which 40 hold an ACK's fields.
`default_nettype none

module link_sender (
    input wire logic clk_i,
    input wire logic rst_ni,

    // what an ACK says
    input  wire logic       answer_i,
    output logic            ack_taken_o,
    input  wire logic [7:0] expected_i,
    input  wire logic [7:0] limit_i,
    input  wire logic [7:0] done_i,
    input  wire logic [7:0] session_i,
    input  wire logic [7:0] flags_i,

    // an answer to a READ
    input  wire logic       data_valid_i,
    output logic            data_ready_o,
    input  wire logic [7:0] data_i,
    input  wire logic       data_last_i,

    output logic            tx_valid_o,
    input  wire logic       tx_ready_i,
    output logic      [7:0] tx_data_o
);
  `include "kage_link.svh"
  `include "kage_crc.svh"

  typedef enum logic [2:0] {
    Idle,
    Opening,  // the flag at the start goes out
    Kind,
    Fields,   // of an ACK
    Words,    // of DATA
    Flags,    // of DATA
    Check,
    Closing
  } state_e;
  state_e state_q;

  // fields_q: what is left of an ACK's fields, or of the CRC; left_q: how many bytes that is, but one.
  logic [39:0] fields_q;
  logic [2:0] left_q;
  logic [15:0] crc_q;
  logic due_q, acks_q, data_next_q, wants_ack, begins;

  // ---- the body's next byte ----------------------------------------------------------------------------------------
  logic has, plain_flag, give;
  logic [7:0] next;
  always_comb begin
    plain_flag = 1'b0;
    has = 1'b1;
    unique case (state_q)
      Kind:   next = acks_q ? KindAck : KindData;
      Fields: next = fields_q[7:0];
      Words: begin
        next = data_i;
        has  = data_valid_i;
      end
      Flags:  next = flags_i;
      Check:  next = fields_q[7:0];
      default: begin
        next = Flag;
        plain_flag = 1'b1;
        has = state_q != Idle;
      end
    endcase
  end

  // ---- the byte on its way out -------------------------------------------------------------------------------------
  // escaping_q: tx_data_o is the escape, and held_q goes behind it.
  logic valid_q, escaping_q, needs_escape;
  logic [7:0] held_q;
  assign tx_valid_o = valid_q;
  assign needs_escape = !plain_flag && (next == Flag || next == Escape);
  assign give = has && !valid_q;
  assign data_ready_o = state_q == Words && !valid_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      escaping_q <= 1'b0;
    end else if (give) begin
      valid_q <= 1'b1;
      escaping_q <= needs_escape;
    end else if (tx_ready_i) begin
      valid_q <= escaping_q;
      escaping_q <= 1'b0;
    end
    if (give) begin
      tx_data_o <= needs_escape ? Escape : next;
      held_q <= next ^ 8'h20;
    end else if (tx_ready_i && escaping_q) begin
      tx_data_o <= held_q;
    end
  end

  // ---- frames ------------------------------------------------------------------------------------------------------
  assign wants_ack = due_q && !(data_next_q && data_valid_i);
  assign begins = state_q == Idle && (due_q || data_valid_i);
  assign ack_taken_o = begins && wants_ack;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      state_q <= Idle;
      due_q <= 1'b0;
      data_next_q <= 1'b0;
    end else begin
      if (answer_i) due_q <= 1'b1;
      else if (ack_taken_o) due_q <= 1'b0;
      if (begins) data_next_q <= wants_ack;
      if (begins) state_q <= Opening;
      else if (give) begin
        unique case (state_q)
          Opening: state_q <= Kind;
          Kind: state_q <= acks_q ? Fields : Words;
          Fields: if (left_q == '0) state_q <= Check;
          Words: if (data_last_i) state_q <= Flags;
          Flags: state_q <= Check;
          Check: if (left_q == '0) state_q <= Closing;
          default: state_q <= Idle;
        endcase
      end
    end

    if (begins) begin
      acks_q   <= wants_ack;
      fields_q <= {flags_i, session_i, done_i, limit_i, expected_i};
      left_q   <= 3'd4;
      crc_q    <= '1;
    end else if (give) begin
      if (!plain_flag) crc_q <= crc16_next(crc_q, next);
      if (state_q == Fields || state_q == Check) begin
        fields_q <= {8'h00, fields_q[39:8]};
        left_q   <= left_q - 3'd1;
      end
      // The byte before the CRC is on its way: the CRC is its, inverted.
      if (state_q == Flags || (state_q == Fields && left_q == '0)) begin
        fields_q[15:0] <= ~crc16_next(crc_q, next);
        left_q <= 3'd1;
      end
    end
  end

endmodule

`default_nettype wire
