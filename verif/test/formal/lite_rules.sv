// SPDX-License-Identifier: Apache-2.0
// The duties of an AXI4-Lite port to its master; a proof puts them on the wires of the port. The master may do
// anything, even what AXI4 forbids it: nothing is assumed.
//
//   b.*, r.*     responses stay, with what goes with them, until they are taken; reset silences them (stream_rules).
//   in_reset     nothing is ready in reset, so no request is taken and lost.
//   b_answers    a write's response answers an address and data that have been taken and not been answered: none too
//                many.
//   r_answers    so does a read's.
//   b_comes      a write is answered in the second clock after the later of its address and data, or after the answer
//                before it has been taken.
//   r_comes      a read is answered in the clock after its address.
//   takes        whatever has no request under way is ready: no standstill.
//   capacity     at most two addresses, two data and one read are under way.
`default_nettype none

module lite_rules (
    input wire logic        clk_i,
    input wire logic        rst_ni,
    input wire logic        awvalid_i,
    input wire logic        awready_i,
    input wire logic        wvalid_i,
    input wire logic        wready_i,
    input wire logic        bvalid_i,
    input wire logic        bready_i,
    input wire logic [ 1:0] bresp_i,
    input wire logic        arvalid_i,
    input wire logic        arready_i,
    input wire logic        rvalid_i,
    input wire logic        rready_i,
    input wire logic [31:0] rdata_i,
    input wire logic [ 1:0] rresp_i
);
  stream_rules #(
      .BITS(2)
  ) b (
      .clk_i,
      .rst_ni,
      .valid_i(bvalid_i),
      .ready_i(bready_i),
      .data_i (bresp_i)
  );
  stream_rules #(
      .BITS(34)
  ) r (
      .clk_i,
      .rst_ni,
      .valid_i(rvalid_i),
      .ready_i(rready_i),
      .data_i ({rresp_i, rdata_i})
  );

  // Requests that have been taken and whose answer has not.
  logic [2:0] addresses_q, data_q, reads_q;
  logic answered, due_q;  // a write's answer is taken; one is due
  assign answered = bvalid_i && bready_i;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      addresses_q <= '0;
      data_q <= '0;
      reads_q <= '0;
      due_q <= 1'b0;
    end else begin
      addresses_q <= addresses_q + 3'(awvalid_i && awready_i) - 3'(answered);
      data_q <= data_q + 3'(wvalid_i && wready_i) - 3'(answered);
      reads_q <= reads_q + 3'(arvalid_i && arready_i) - 3'(rvalid_i && rready_i);
      due_q <= addresses_q != '0 && data_q != '0 && !answered;
    end
  end

  always_comb begin
    if (!rst_ni) begin
      in_reset : assert (!awready_i && !wready_i && !arready_i);
    end else begin
      if (bvalid_i) b_answers : assert (addresses_q != '0 && data_q != '0);
      if (rvalid_i) r_answers : assert (reads_q != '0);
      if (due_q) b_comes : assert (bvalid_i);
      if (reads_q != '0) r_comes : assert (rvalid_i);
      takes : assert ((awready_i || addresses_q != '0) && (wready_i || data_q != '0) && (arready_i || reads_q != '0));
      capacity : assert (addresses_q <= 3'd2 && data_q <= 3'd2 && reads_q <= 3'd1);
      // The parts of a write that were taken and not answered are being held, or its answer waits.
      lemma_write : assert (addresses_q == 3'(!awready_i) + 3'(bvalid_i) && data_q == 3'(!wready_i) + 3'(bvalid_i));
      lemma_read : assert (reads_q == 3'(!arready_i));

      write_waits : cover (addresses_q == 3'd2 && data_q == 3'd2);
      write_after_write : cover (answered && addresses_q == 3'd2 && data_q == 3'd2);
      data_first : cover (data_q == 3'd1 && addresses_q == '0 && awvalid_i);
      read_waits : cover (rvalid_i && !rready_i && arvalid_i);
    end
  end

endmodule

`default_nettype wire
