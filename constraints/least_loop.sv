// SPDX-License-Identifier: Apache-2.0
// The least loop that a banked core can have, as a yardstick for its clock on a device. It is a block RAM read into a
// register, a registered adder (the span's depth), a registered comparison of the full width, a select, and the write
// back. It has no control, no forwarding and no checks: a core of BITS = Z_BITS + Z_FRAC that reaches its clock is as
// fast as its arithmetic lets it be.
`default_nettype none

module least_loop #(
    parameter int BITS  = 35,
    parameter int WORDS = 256
) (
    input  wire logic clk_i,
    input  wire logic serial_i,
    output logic      serial_o
);

  localparam int AddrBits = $clog2(WORDS);
  logic [AddrBits-1:0] addr_q, addr1_q, addr2_q, addr3_q, addr4_q;
  logic [BITS-1:0] start_q, step_q, acc_q, acc1_q, acc2_q, stored, stored_q, stored1_q, chosen_q, out_q;
  logic in_front_q;

  ram_1r1w #(
      .BITS (BITS),
      .WORDS(WORDS)
  ) u_ram (
      .clk_i,
      .wr_en_i  (1'b1),
      .wr_addr_i(addr4_q),
      .wr_data_i(chosen_q),
      .rd_en_i  (1'b1),
      .rd_addr_i(addr_q),
      .rd_data_o(stored)
  );

  assign serial_o = out_q[0];

  always_ff @(posedge clk_i) begin
    // what goes in, bit by bit
    start_q <= {start_q[BITS-2:0], serial_i};
    step_q <= {step_q[BITS-2:0], start_q[BITS-1]};
    addr_q <= {addr_q[AddrBits-2:0], step_q[BITS-1]};
    // the loop
    {addr4_q, addr3_q, addr2_q, addr1_q} <= {addr3_q, addr2_q, addr1_q, addr_q};
    {acc2_q, acc1_q, acc_q} <= {acc1_q, acc_q, start_q + step_q};
    {stored1_q, stored_q} <= {stored_q, stored};
    in_front_q <= acc1_q < stored_q;
    chosen_q <= in_front_q ? acc2_q : stored1_q;
    // what comes out, bit by bit
    out_q <= addr_q[0] ? chosen_q : {out_q[0], out_q[BITS-1:1]};
  end

endmodule

`default_nettype wire
