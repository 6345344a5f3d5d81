// SPDX-License-Identifier: Apache-2.0
// sdram_memory and a chip on its pins, which are in the memory's clock.
`default_nettype none

module frame_memory_bench #(
    parameter  int T_INIT   = 2_000,
    localparam int AddrBits = 23
) (
    input  wire logic                clk_i,
    input  wire logic                rst_ni,
    input  wire logic                wr_valid_i,
    output logic                     wr_ready_o,
    input  wire logic [AddrBits-1:0] wr_addr_i,
    input  wire logic [        31:0] wr_data_i,
    input  wire logic                run_valid_i,
    output logic                     run_ready_o,
    input  wire logic [AddrBits-1:0] run_addr_i,
    input  wire logic [        15:0] run_words_i,
    output logic                     rd_valid_o,
    input  wire logic                rd_ready_i,
    output logic      [        31:0] rd_data_o,
    input  wire logic                mem_clk_i,
    input  wire logic                mem_rst_ni,
    output logic                     mem_ready_o,
    output logic      [        31:0] lost_o
);
  logic cke, cs_n, ras_n, cas_n, we_n, oe, chip_oe;
  logic [1:0] ba, dqm;
  logic [12:0] a;
  logic [15:0] to_chip, from_chip;
  sdram_memory #(
      .T_INIT(T_INIT)
  ) u_memory (
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
      .INIT(T_INIT / 10)
  ) u_chip (
      .power_i(mem_rst_ni),
      .clk_i(mem_clk_i),
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
