// SPDX-License-Identifier: Apache-2.0
// The tokens that frame_control has at hand, entries of the light table, errors and ends of frames, as events
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
    input wire logic                      take,         // into token_stage, which holds one
    input wire logic [FRONT_WORDS*32-1:0] token,
    input wire logic [     FlagsBits-1:0] flags,
    input wire logic                      table_valid,
    input wire logic [TableEntryBits-1:0] table_entry,
    input wire logic                      frame_end,
    input wire logic                      error_valid,
    input wire logic [     ErrorBits-1:0] error
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"

  // The buses by their fields.
  table_entry_t entry;
  error_t found;
  assign entry = table_entry;
  assign found = error;

  // The token that token_stage holds, as token_reader or front_end gave it. It is told of in the first clock in which
  // it may be acted on: ahead of what it does, and behind what the token before it did.
  logic new_q;
  logic [FRONT_WORDS*32-1:0] held_q;
  flags_t told_q;
  always_ff @(posedge clk_i) begin
    new_q <= rst_ni && take;
    if (take) begin
      held_q <= token;
      told_q <= flags;
    end
  end

  // A channel of a table's share, as far as there are so many.
  function automatic logic [63:0] share(input logic [EntryShareBits-1:0] shares, input int channel);
    share = channel < CHANNELS ? 64'(shares[(channel<CHANNELS?channel : 0)*FactorBits+:FactorBits]) : '0;
  endfunction

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      if (new_q) begin
        trace_token(0, 704'(held_q), 64'(told_q.at_last), 64'({
                    told_q.fault != ErrNone, told_q.header, told_q.lacking, told_q.cut, told_q.ends}));
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
) u_tokens_monitor (
    .take(u_control.u_stage.take),
    .*
);

`default_nettype wire
