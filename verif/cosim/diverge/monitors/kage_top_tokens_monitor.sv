// SPDX-License-Identifier: Apache-2.0
// The tokens that frame_control takes, entries of the light table, errors and ends of frames, as events
// (rtl/defs/stages.yaml). Bound into kage_top, so the netlist never sees it.
//
// Ports have the names of kage_top's nets, which `.*` connects.
`default_nettype none

module kage_top_tokens_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int FRONT_WORDS = 5
) (
    input wire logic                      clk_i,
    input wire logic                      rst_ni,
    input wire logic                      token_valid,
    input wire logic                      token_ready,
    input wire logic [FRONT_WORDS*32-1:0] token,
    input wire logic [     FlagsBits-1:0] flags,
    input wire logic                      table_valid,
    input wire logic [TableEntryBits-1:0] table_entry,
    input wire logic                      frame_end,
    input wire logic                      error_valid,
    input wire logic [     ErrorBits-1:0] error
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  // The buses by their fields.
  table_entry_t entry;
  error_t found;
  flags_t told;
  assign entry = table_entry;
  assign found = error;
  assign told  = flags;

  // A channel of a table's share, as far as there are so many.
  function automatic logic [63:0] share(input logic [EntryShareBits-1:0] shares, input int channel);
    share = channel < CHANNELS ? 64'(shares[(channel<CHANNELS?channel : 0)*FactorBits+:FactorBits]) : '0;
  endfunction

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      if (token_valid && token_ready) begin
        trace_token(0, 704'(token), 64'(told.at_last), 64'({told.header, told.lacking, told.cut, told.ends}));
      end
      if (table_valid) begin
        trace_table(0, 64'(entry.normal_class), 64'(entry.light), {
                    share(entry.share, 2), share(entry.share, 1), share(entry.share, 0)});
      end
      if (error_valid) begin
        trace_error(0, 64'(found.code), 64'(found.frame), 64'(found.line), 64'(found.token), 64'(found.unit));
      end
      if (frame_end) trace_end(0);
    end
  end

endmodule

bind kage_top kage_top_tokens_monitor #(
    .FRONT_WORDS(FrontWords),
    `include "generated/kage_pixel_param_map.svh"
) u_tokens_monitor (.*);

`default_nettype wire
