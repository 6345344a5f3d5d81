// SPDX-License-Identifier: Apache-2.0
// Does what the frames that link_receiver keeps say, one after the other: words to AXI4-Lite or to the stream, words of
// AXI4-Lite into an answer.
//
// Handshake: head_valid_i offers a frame; its bytes are read by rd_at_o, and head_done_o, of one clock, ends it.
//   AXI4-Lite: one write or read at a time; address and data are offered together, and each stays until it is taken.
//   m_axis: a word is offered until it is taken. The answer to a READ goes out as bytes with valid/ready: its sequence,
//   then the words, lowest byte first; data_last_o marks the last.
// An address of more than 16 bits is nobody's: no word is written or read, the answer to a READ has no words, and
//   axi_error_o is high for a clock, as for SLVERR and DECERR. Addresses go on at 0 behind 65535.
// Every wait is for AXI4-Lite, for the stream's taker, or for the taker of an answer.
// Latency: 12 clocks from a frame's offer to its first word on the stream, 20 to its first word on AXI4-Lite.
// Throughput: a word in 9 clocks to the stream, in 10 to AXI4-Lite, and what the takers make it wait.
// Cost: 188 LUT and 98 flip-flops of an iCE40.
`default_nettype none

module link_executor (
    input wire logic clk_i,
    input wire logic rst_ni,

    // the oldest frame
    input  wire logic       head_valid_i,
    input  wire logic [5:0] head_words_i,
    output logic            head_done_o,
    output logic      [7:0] rd_at_o,
    input  wire logic [7:0] rd_data_i,
    output logic            axi_error_o,

    // an answer
    output logic            data_valid_o,
    input  wire logic       data_ready_i,
    output logic      [7:0] data_o,
    output logic            data_last_o,

    output logic             m_axil_awvalid_o,
    input  wire logic        m_axil_awready_i,
    output logic      [15:0] m_axil_awaddr_o,
    output logic             m_axil_wvalid_o,
    input  wire logic        m_axil_wready_i,
    output logic      [31:0] m_axil_wdata_o,
    output logic      [ 3:0] m_axil_wstrb_o,
    input  wire logic        m_axil_bvalid_i,
    output logic             m_axil_bready_o,
    input  wire logic [ 1:0] m_axil_bresp_i,
    output logic             m_axil_arvalid_o,
    input  wire logic        m_axil_arready_i,
    output logic      [15:0] m_axil_araddr_o,
    input  wire logic        m_axil_rvalid_i,
    output logic             m_axil_rready_o,
    input  wire logic [31:0] m_axil_rdata_i,
    input  wire logic [ 1:0] m_axil_rresp_i,

    output logic             m_axis_tvalid_o,
    input  wire logic        m_axis_tready_i,
    output logic      [31:0] m_axis_tdata_o
);
  `include "kage_link.svh"

  typedef enum logic [3:0] {
    AtKind,      // waits for a frame, and takes its first byte
    AtSequence,
    AtAddress,
    AtCount,
    AtWord,      // takes a word of the frame
    AtWrite,     // address and data have not been taken
    AtResponse,
    AtStream,
    AtAnswer,    // gives the sequence
    AtRead,      // the address has not been taken
    AtValue,
    AtGive,      // gives a word that was read
    AtDone
  } state_e;
  state_e state_q;

  // A byte of the frame takes two clocks: in the first its place stands at the RAM, in the second it is there.
  logic there_q, fetching, took;
  logic [7:0] at_q;
  assign rd_at_o = at_q;
  assign fetching = (state_q == AtKind && head_valid_i) || state_q == AtSequence || state_q == AtAddress ||
      state_q == AtCount || state_q == AtWord;
  assign took = fetching && there_q;

  // word_q takes bytes at its high end, so four bytes stand in it with the first as the lowest; byte_q counts them.
  logic [31:0] word_q, word_next;
  logic [1:0] byte_q;
  logic [7:0] kind_q, sequence_q;
  logic [15:0] address_q;
  logic [ 5:0] left_q;
  logic outside_q, aw_q, w_q, aw_gone, w_gone, last_word, stays;
  assign word_next = {rd_data_i, word_q[31:8]};
  assign last_word = left_q == 6'd1;
  assign stays = kind_q == KindWriteSame;

  // ---- ports -------------------------------------------------------------------------------------------------------
  assign m_axil_awvalid_o = aw_q;
  assign m_axil_awaddr_o = address_q;
  assign m_axil_wvalid_o = w_q;
  assign m_axil_wdata_o = word_q;
  assign m_axil_wstrb_o = 4'hF;
  assign m_axil_bready_o = state_q == AtResponse;
  assign m_axil_arvalid_o = state_q == AtRead;
  assign m_axil_araddr_o = address_q;
  assign m_axil_rready_o = state_q == AtValue;
  assign m_axis_tvalid_o = state_q == AtStream;
  assign m_axis_tdata_o = word_q;
  assign data_valid_o = state_q == AtAnswer || state_q == AtGive;
  assign data_o = state_q == AtAnswer ? sequence_q : word_q[7:0];
  assign data_last_o = state_q == AtAnswer ? outside_q : byte_q == 2'd3 && last_word;
  assign head_done_o = state_q == AtDone;
  assign aw_gone = !aw_q || m_axil_awready_i;
  assign w_gone = !w_q || m_axil_wready_i;

  always_ff @(posedge clk_i) begin
    axi_error_o <= 1'b0;
    if (!rst_ni) begin
      state_q <= AtKind;
      there_q <= 1'b0;
      aw_q <= 1'b0;
      w_q <= 1'b0;
    end else begin
      there_q <= fetching && !there_q;
      unique case (state_q)
        AtKind: if (took) state_q <= AtSequence;
        AtSequence: if (took) state_q <= kind_q != KindStream ? AtAddress : left_q == '0 ? AtDone : AtWord;
        AtAddress:
        if (took && byte_q == 2'd3) begin
          if (word_next[31:16] != '0) axi_error_o <= 1'b1;
          if (kind_q == KindRead) state_q <= AtCount;
          else state_q <= left_q == '0 || word_next[31:16] != '0 ? AtDone : AtWord;
        end
        AtCount: if (took) state_q <= AtAnswer;
        AtWord:
        if (took && byte_q == 2'd3) begin
          state_q <= kind_q == KindStream ? AtStream : AtWrite;
          aw_q <= kind_q != KindStream;
          w_q <= kind_q != KindStream;
        end
        AtWrite: begin
          if (m_axil_awready_i) aw_q <= 1'b0;
          if (m_axil_wready_i) w_q <= 1'b0;
          if (aw_gone && w_gone) state_q <= AtResponse;
        end
        AtResponse:
        if (m_axil_bvalid_i) begin
          axi_error_o <= m_axil_bresp_i != '0;
          state_q <= last_word ? AtDone : AtWord;
        end
        AtStream: if (m_axis_tready_i) state_q <= last_word ? AtDone : AtWord;
        AtAnswer: if (data_ready_i) state_q <= outside_q ? AtDone : AtRead;
        AtRead: if (m_axil_arready_i) state_q <= AtValue;
        AtValue:
        if (m_axil_rvalid_i) begin
          axi_error_o <= m_axil_rresp_i != '0;
          state_q <= AtGive;
        end
        AtGive: if (data_ready_i && byte_q == 2'd3) state_q <= last_word ? AtDone : AtRead;
        AtDone: state_q <= AtKind;
        default: state_q <= AtKind;
      endcase
    end

    if (state_q == AtKind && !took) begin
      at_q   <= '0;
      byte_q <= '0;
      left_q <= head_words_i;
    end
    if (took) at_q <= at_q + 8'd1;
    else if (state_q == AtDone) at_q <= '0;  // so that the next frame's first byte is read at once
    if ((took && (state_q == AtAddress || state_q == AtWord)) || (state_q == AtGive && data_ready_i))
      byte_q <= byte_q + 2'd1;
    if (took && (state_q == AtAddress || state_q == AtWord)) word_q <= word_next;
    else if (state_q == AtValue) word_q <= m_axil_rdata_i;
    else if (state_q == AtGive && data_ready_i) word_q <= {8'h00, word_q[31:8]};
    if (took && state_q == AtKind) kind_q <= rd_data_i;
    if (took && state_q == AtSequence) sequence_q <= rd_data_i;
    if (took && state_q == AtAddress && byte_q == 2'd3) begin
      address_q <= word_next[15:0];
      outside_q <= word_next[31:16] != '0;
    end
    if (took && state_q == AtCount) left_q <= rd_data_i[5:0];
    // After a word: of a write with its response, of the stream with its taking, of a read with its last byte.
    if ((state_q == AtResponse && m_axil_bvalid_i) || (state_q == AtStream && m_axis_tready_i) ||
        (state_q == AtGive && data_ready_i && byte_q == 2'd3)) begin
      left_q <= left_q - 6'd1;
      if (!stays) address_q[15:2] <= address_q[15:2] + 14'd1;
    end
  end

endmodule

`default_nettype wire
