// SPDX-License-Identifier: Apache-2.0
// Whether pixel_core gives the arrangement what it is given itself.
`default_nettype none

// The inputs of pixel_core, which are those of the arrangement.
`define KAGE_GIVEN(at) { \
    at.cmd_valid_i, at.cmd_i, at.tree_valid_i, at.tree_i, at.tree_drop_i, at.exit_free_i \
  }

module pixel_core_monitor #(
    parameter int ARRANGEMENT = 1
) (
    input wire logic clk_i,
    input wire logic rst_ni
);
  `include "kage_trace.svh"

  logic same;
  if (ARRANGEMENT == 1) begin : gen_banked
    assign same = `KAGE_GIVEN(pixel_core.gen_banked.u_pixels) == `KAGE_GIVEN(pixel_core);
  end else begin : gen_systolic
    assign same = `KAGE_GIVEN(pixel_core.gen_systolic.u_pixels) == `KAGE_GIVEN(pixel_core);
  end
  always_ff @(posedge clk_i) if (rst_ni) trace_module(PartPixelCore, 512'd1, 512'(same));

endmodule

bind pixel_core pixel_core_monitor #(.ARRANGEMENT(ARRANGEMENT)) u_monitor (.*);

`undef KAGE_GIVEN
`default_nettype wire
