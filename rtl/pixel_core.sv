// SPDX-License-Identifier: Apache-2.0
// The pixels of a line behind one interface, in the arrangement that the configuration names; handshake, latency,
// throughput and cost are those of pixel_banked or pixel_systolic. A group that leaves has ExitLanes pixels: LANES if
// banked, 1 if systolic.
// Ports are those of kage_pixel_ports.svh in all three, so they are connected by name.
`default_nettype none

module pixel_core #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int ARRANGEMENT = 1,
    parameter int LANES = 4,
    parameter int MAX_WIDTH = 640,
    localparam int ExitLanes = ARRANGEMENT == 1 ? LANES : 1
) (
    `include "kage_pixel_ports.svh"
);

  if (ARRANGEMENT == 1) begin : gen_banked
    pixel_banked #(
        .LANES(LANES),
        .MAX_WIDTH(MAX_WIDTH),
        `include "generated/kage_pixel_param_map.svh"
    ) u_pixels (
        .*
    );
  end else begin : gen_systolic
    pixel_systolic #(
        .MAX_WIDTH(MAX_WIDTH),
        `include "generated/kage_pixel_param_map.svh"
    ) u_pixels (
        .*
    );
  end

endmodule

`default_nettype wire
