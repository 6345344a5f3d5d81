// SPDX-License-Identifier: Apache-2.0
// The board's end of the serial link of docs/link.md: bytes of the line on one side, AXI4-Lite and a stream of words on
// the other. All of it is in the core's clock; an async_fifo each way stands between it and uart_receiver and
// uart_transmitter, and belongs to whoever instantiates them.
//
// Handshake: valid/ready on all sides. rx_ready_o is high out of reset, so that no byte is lost here. m_axil is an
//   AXI4-Lite master that writes whole words, m_axis a master of 32-bit words without tlast. A wait ends with
//   AXI4-Lite, with the stream's taker, or with the line; whatever came before, a flag and a valid frame are
//   understood.
// State: fresh_o from reset to the first HELLO; axi_error_o and overrun_o from when it happens to the next HELLO. The
//   counters are modulo 65536: frames that were right, others, and right ones for which no slot was free.
// Latency: 14 clocks from a frame's last flag to its first word on the stream, 22 to its first word on AXI4-Lite; 5 to
//   the first flag of the ACK. Throughput: a byte a clock from the line, a word in 9 clocks to the stream, in 10 to
//   AXI4-Lite, a byte in 2 clocks to the line.
// Cost: with four slots 598 LUT, 342 flip-flops and two block RAMs of an iCE40.
`default_nettype none

module uart_link #(
    parameter int SLOTS = 4
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // bytes of the line
    input  wire logic       rx_valid_i,
    output logic            rx_ready_o,
    input  wire logic [7:0] rx_data_i,
    output logic            tx_valid_o,
    input  wire logic       tx_ready_i,
    output logic      [7:0] tx_data_o,

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
    output logic      [31:0] m_axis_tdata_o,

    // for the board's registers
    output logic        fresh_o,
    output logic        axi_error_o,
    output logic        overrun_o,
    output logic [15:0] good_frames_o,
    output logic [15:0] bad_frames_o,
    output logic [15:0] overruns_o
);

  logic head_valid, head_done, axi_error, answer, ack_taken, dropped;
  logic [5:0] head_words;
  logic [7:0] rd_at, rd_data, expected, limit, done, session, data;
  logic data_valid, data_ready, data_last;

  link_receiver #(
      .SLOTS(SLOTS)
  ) u_receiver (
      .clk_i,
      .rst_ni,
      .rx_valid_i,
      .rx_ready_o,
      .rx_data_i,
      .head_valid_o(head_valid),
      .head_words_o(head_words),
      .head_done_i (head_done),
      .rd_at_i     (rd_at),
      .rd_data_o   (rd_data),
      .axi_error_i (axi_error),
      .answer_o    (answer),
      .ack_taken_i (ack_taken),
      .expected_o  (expected),
      .limit_o     (limit),
      .done_o      (done),
      .session_o   (session),
      .fresh_o,
      .dropped_o   (dropped),
      .axi_error_o,
      .overrun_o,
      .good_frames_o,
      .bad_frames_o,
      .overruns_o
  );

  link_executor u_executor (
      .clk_i,
      .rst_ni,
      .head_valid_i(head_valid),
      .head_words_i(head_words),
      .head_done_o (head_done),
      .rd_at_o     (rd_at),
      .rd_data_i   (rd_data),
      .axi_error_o (axi_error),
      .data_valid_o(data_valid),
      .data_ready_i(data_ready),
      .data_o      (data),
      .data_last_o (data_last),
      .m_axil_awvalid_o,
      .m_axil_awready_i,
      .m_axil_awaddr_o,
      .m_axil_wvalid_o,
      .m_axil_wready_i,
      .m_axil_wdata_o,
      .m_axil_wstrb_o,
      .m_axil_bvalid_i,
      .m_axil_bready_o,
      .m_axil_bresp_i,
      .m_axil_arvalid_o,
      .m_axil_arready_i,
      .m_axil_araddr_o,
      .m_axil_rvalid_i,
      .m_axil_rready_o,
      .m_axil_rdata_i,
      .m_axil_rresp_i,
      .m_axis_tvalid_o,
      .m_axis_tready_i,
      .m_axis_tdata_o
  );

  link_sender u_sender (
      .clk_i,
      .rst_ni,
      .answer_i    (answer),
      .ack_taken_o (ack_taken),
      .expected_i  (expected),
      .limit_i     (limit),
      .done_i      (done),
      .session_i   (session),
      .flags_i     ({4'h0, dropped, overrun_o, axi_error_o, fresh_o}),
      .data_valid_i(data_valid),
      .data_ready_o(data_ready),
      .data_i      (data),
      .data_last_i (data_last),
      .tx_valid_o,
      .tx_ready_i,
      .tx_data_o
  );

endmodule

`default_nettype wire
