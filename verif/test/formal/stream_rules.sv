// SPDX-License-Identifier: Apache-2.0
// The duties of a valid/ready output, and so of an AXI4-Stream one, to whom it feeds; a proof puts them on the
// wires of the output.
//
//   stays   valid stays until ready.
//   same    what goes with valid stays as it is until ready.
//   silent  after a clock of reset nothing is valid, so from the second clock of a reset on, and in the first one
//           behind it.
`default_nettype none

module stream_rules #(
    parameter int BITS = 2
) (
    input wire logic            clk_i,
    input wire logic            rst_ni,
    input wire logic            valid_i,
    input wire logic            ready_i,
    input wire logic [BITS-1:0] data_i
);
  logic waits_q = 1'b0, reset_q = 1'b0;
  logic [BITS-1:0] data_q;
  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni && valid_i && !ready_i;
    reset_q <= !rst_ni;
    data_q  <= data_i;
  end
  always_comb begin
    if (waits_q) begin
      stays : assert (valid_i);
      same : assert (data_i == data_q);
    end
    if (reset_q) silent : assert (!valid_i);
  end
endmodule

`default_nettype wire
