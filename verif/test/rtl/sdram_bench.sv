// SPDX-License-Identifier: Apache-2.0
// sdram_controller and a chip on its pins, at 100 MHz. With a T_RCD shorter than the chip's RCD, or a T_REF longer than
// its RETENTION, a test sees the chip refuse it.
`default_nettype none

module sdram_bench #(
    parameter int ROW_BITS = 13,
    parameter int CAS_LATENCY = 3,
    parameter int T_INIT = 200_000,
    parameter int T_REF = 64_000_000,
    parameter int RETENTION = 6_400_000,
    parameter int T_RCD = 21,
    parameter int REFI = 781,
    localparam int AddrBits = ROW_BITS + 10
) (
    input  wire logic                clk_i,
    input  wire logic                rst_ni,
    output logic                     ready_o,
    input  wire logic                wr_valid_i,
    output logic                     wr_ready_o,
    input  wire logic [AddrBits-1:0] wr_addr_i,
    input  wire logic [        31:0] wr_data_i,
    input  wire logic                req_valid_i,
    output logic                     req_ready_o,
    input  wire logic [AddrBits-5:0] req_block_i,
    output logic                     rd_valid_o,
    output logic      [        31:0] rd_data_o,
    output logic      [        31:0] lost_o
);
  logic cke, cs_n, ras_n, cas_n, we_n, oe, chip_oe;
  logic [1:0] ba, dqm;
  logic [ROW_BITS-1:0] a;
  logic [15:0] to_chip, from_chip;
  sdram_controller #(
      .ROW_BITS(ROW_BITS),
      .CAS_LATENCY(CAS_LATENCY),
      .T_INIT(T_INIT),
      .T_RCD(T_RCD),
      .T_REF(T_REF)
  ) u_controller (
      .sdram_cke_o(cke),
      .sdram_cs_no(cs_n),
      .sdram_ras_no(ras_n),
      .sdram_cas_no(cas_n),
      .sdram_we_no(we_n),
      .sdram_ba_o(ba),
      .sdram_a_o(a),
      .sdram_dqm_o(dqm),
      .sdram_dq_o(to_chip),
      .sdram_dq_oe_o(oe),
      .sdram_dq_i(from_chip),
      .*
  );
  sdram_chip #(
      .ROW_BITS(ROW_BITS),
      .INIT(T_INIT / 10),
      .REFI(REFI),
      .RETENTION(RETENTION)
  ) u_chip (
      .power_i(rst_ni),
      .cke_i(cke),
      .cs_ni(cs_n),
      .ras_ni(ras_n),
      .cas_ni(cas_n),
      .we_ni(we_n),
      .ba_i(ba),
      .a_i(a),
      .dqm_i(dqm),
      .dq_driven_i(oe),
      .dq_i(to_chip),
      .dq_o(from_chip),
      .dq_oe_o(chip_oe),
      .*
  );
  logic unused;
  assign unused = chip_oe;
endmodule

`default_nettype wire
