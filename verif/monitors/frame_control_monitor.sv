// SPDX-License-Identifier: Apache-2.0
// What line_phase tells frame_control where that makes use of it, as events (rtl_model.h).
`default_nettype none

module frame_control_monitor #(
    parameter int DSF_BITS = 1
) (
    input wire logic                                     clk_i,
    input wire logic                                     rst_ni,
    input wire logic                                     good,
    input wire logic                                     token_header_i,
    input wire logic [                              3:0] kind,
    input wire logic                                     emit_paint,
    input wire logic                                     resolved,
    input wire logic [(DSF_BITS > 0 ? DSF_BITS : 1)-1:0] bias
);
  `include "kage_trace.svh"
  localparam logic [3:0] KindEv = 4'd10;
  localparam logic [3:0] KindEs = 4'd11;
  localparam logic [3:0] KindEol = 4'd14;

  logic used;
  assign used = kind == KindEv || kind == KindEs || kind == KindEol;
  always_ff @(posedge clk_i) begin
    if (rst_ni && (emit_paint || (good && !token_header_i && used))) begin
      kage_trace(StageState, 0, trace5(64'(bias), 64'(resolved), 64'd0, 64'd0, 64'd0));
    end
  end

endmodule

bind frame_control frame_control_monitor #(.DSF_BITS(DSF_BITS)) u_monitor (.*);

`default_nettype wire
