// SPDX-License-Identifier: Apache-2.0
// kage_top with one serial pin in and one out: what is placed and routed when a device is measured without a board, so
// that its pins neither limit the clock nor flatter it.
//
// Every input of the core comes from a shift register that serial_i fills, every output goes into a register that
// shifts out on serial_o whenever it is not loaded. So each path of the core begins and ends in a flip-flop, and no
// input is known to be constant. Cost: a flip-flop for each port bit, and a LUT for each output bit.
`default_nettype none

module kage_wrap #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    `include "generated/kage_impl_params.svh"
) (
    input  wire logic clk_i,
    input  wire logic serial_i,
    output logic      serial_o
);

  localparam int RegisterIn = 1 + 8 + 1 + 32 + 4 + 1 + 1 + 8 + 1;  // awvalid to rready
  localparam int In = 1 + 1 + BEAT_WORDS * 32 + 1 + 1 + RegisterIn;
  localparam int RegisterOut = 1 + 1 + 1 + 2 + 1 + 1 + 32 + 2;  // awready to rresp
  localparam int Out = 1 + 1 + RgbBits + 1 + 1 + RegisterOut + 1;

  logic [In-1:0] in_q;
  logic [Out-1:0] out, out_q;
  logic rst_n;
  logic s_valid, s_last, m_ready;
  logic [BEAT_WORDS*32-1:0] s_data;
  logic awvalid, wvalid, bready, arvalid, rready;
  logic [7:0] awaddr, araddr;
  logic [31:0] wdata;
  logic [ 3:0] wstrb;
  logic s_ready, m_valid, m_user, m_last, awready, wready, bvalid, arready, rvalid, irq;
  logic [RgbBits-1:0] m_data;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;

  logic [RegisterIn-1:0] register_in;
  assign {rst_n, s_valid, s_data, s_last, m_ready, register_in} = in_q;
  assign {awvalid, awaddr, wvalid, wdata, wstrb, bready, arvalid, araddr, rready} = register_in;
  assign out = {
    s_ready, m_valid, m_data, m_user, m_last, awready, wready, bvalid, bresp, arready, rvalid, rdata, rresp, irq
  };
  assign serial_o = out_q[0];

  always_ff @(posedge clk_i) begin
    in_q  <= {in_q[In-2:0], serial_i};
    out_q <= in_q[0] ? out : {out_q[0], out_q[Out-1:1]};
  end

  kage_top #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh"
  ) u_kage (
      .clk_i,
      .rst_ni          (rst_n),
      .s_axis_tvalid_i (s_valid),
      .s_axis_tready_o (s_ready),
      .s_axis_tdata_i  (s_data),
      .s_axis_tlast_i  (s_last),
      .m_axis_tvalid_o (m_valid),
      .m_axis_tready_i (m_ready),
      .m_axis_tdata_o  (m_data),
      .m_axis_tuser_o  (m_user),
      .m_axis_tlast_o  (m_last),
      .s_axil_awvalid_i(awvalid),
      .s_axil_awready_o(awready),
      .s_axil_awaddr_i (awaddr),
      .s_axil_wvalid_i (wvalid),
      .s_axil_wready_o (wready),
      .s_axil_wdata_i  (wdata),
      .s_axil_wstrb_i  (wstrb),
      .s_axil_bvalid_o (bvalid),
      .s_axil_bready_i (bready),
      .s_axil_bresp_o  (bresp),
      .s_axil_arvalid_i(arvalid),
      .s_axil_arready_o(arready),
      .s_axil_araddr_i (araddr),
      .s_axil_rvalid_o (rvalid),
      .s_axil_rready_i (rready),
      .s_axil_rdata_o  (rdata),
      .s_axil_rresp_o  (rresp),
      .irq_o           (irq)
  );

endmodule

`default_nettype wire
