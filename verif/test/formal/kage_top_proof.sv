// SPDX-License-Identifier: Apache-2.0
// Proof of kage_top at its ports, by induction, for anything that comes in and a reset at any time
// (verif/test/formal/run.sh):
//   m_axis.*  a pixel that waits stays as it is, with TUSER and TLAST, and reset silences it (stream_rules);
//   s_axil.*  the rules of AXI4-Lite (lite_rules);
//   in_reset  s_axis is not ready in reset: no beat is taken and lost.
// The modules that drive m_axis, s_axis and s_axil have proofs of their own: line_out, token_reader, registers. This
// proof says that kage_top puts nothing in between. Its covers show traffic on s_axis and s_axil; a pixel is further
// away than the bound.
`default_nettype none

module kage_top_proof #(
    parameter int BEAT_WORDS = 1
) (
    input wire logic                     clk_i,
    input wire logic                     rst_ni,
    input wire logic                     s_axis_tvalid_i,
    input wire logic [BEAT_WORDS*32-1:0] s_axis_tdata_i,
    input wire logic                     s_axis_tlast_i,
    input wire logic                     m_axis_tready_i,
    input wire logic                     awvalid_i,
    input wire logic [              7:0] awaddr_i,
    input wire logic                     wvalid_i,
    input wire logic [             31:0] wdata_i,
    input wire logic [              3:0] wstrb_i,
    input wire logic                     bready_i,
    input wire logic                     arvalid_i,
    input wire logic [              7:0] araddr_i,
    input wire logic                     rready_i
);
  logic s_ready, m_valid, m_user, m_last, awready, wready, bvalid, arready, rvalid, irq;
  logic [7:0] m_data;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;
  kage_top #(
      .X_BITS(4),
      .Z_BITS(8),
      .Z_FRAC(4),
      .CHANNELS(1),
      .DSF_BITS(0),
      .FSF(0),
      .LANES(2),
      .MAX_WIDTH(4),
      .BEAT_WORDS(BEAT_WORDS)
  ) dut (
      .clk_i,
      .rst_ni,
      .s_axis_tvalid_i,
      .s_axis_tready_o (s_ready),
      .s_axis_tdata_i,
      .s_axis_tlast_i,
      .m_axis_tvalid_o (m_valid),
      .m_axis_tready_i,
      .m_axis_tdata_o  (m_data),
      .m_axis_tuser_o  (m_user),
      .m_axis_tlast_o  (m_last),
      .s_axil_awvalid_i(awvalid_i),
      .s_axil_awready_o(awready),
      .s_axil_awaddr_i (awaddr_i),
      .s_axil_wvalid_i (wvalid_i),
      .s_axil_wready_o (wready),
      .s_axil_wdata_i  (wdata_i),
      .s_axil_wstrb_i  (wstrb_i),
      .s_axil_bvalid_o (bvalid),
      .s_axil_bready_i (bready_i),
      .s_axil_bresp_o  (bresp),
      .s_axil_arvalid_i(arvalid_i),
      .s_axil_arready_o(arready),
      .s_axil_araddr_i (araddr_i),
      .s_axil_rvalid_o (rvalid),
      .s_axil_rready_i (rready_i),
      .s_axil_rdata_o  (rdata),
      .s_axil_rresp_o  (rresp),
      .irq_o           (irq)
  );
  stream_rules #(
      .BITS(10)
  ) m_axis (
      .clk_i,
      .rst_ni,
      .valid_i(m_valid),
      .ready_i(m_axis_tready_i),
      .data_i ({m_data, m_user, m_last})
  );
  lite_rules s_axil (
      .clk_i,
      .rst_ni,
      .awvalid_i,
      .awready_i(awready),
      .wvalid_i,
      .wready_i (wready),
      .bvalid_i (bvalid),
      .bready_i,
      .bresp_i  (bresp),
      .arvalid_i,
      .arready_i(arready),
      .rvalid_i (rvalid),
      .rready_i,
      .rdata_i  (rdata),
      .rresp_i  (rresp)
  );

  // ---- surroundings: reset at the start, and whenever it pleases ---------------------------------------------------
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);

  always_comb begin
    if (!rst_ni) in_reset : assert (!s_ready);
    beat_taken : cover (rst_ni && s_ready && s_axis_tvalid_i && s_axis_tlast_i);
  end
endmodule

`default_nettype wire
