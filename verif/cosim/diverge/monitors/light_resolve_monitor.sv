// SPDX-License-Identifier: Apache-2.0
// light_resolve, by the nets of line_out, which alone knows which of its pixels are some: the factors are those of the
// counts, written out.
`default_nettype none

module light_resolve_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int Depth = 5 + LightStages
) (
    input wire logic                           clk_i,
    input wire logic                           rst_ni,
    input wire logic                           table_valid_i,
    input wire logic [     TableEntryBits-1:0] table_i,
    input wire logic [         FactorBits-1:0] keep_q,
    input wire logic                           go,
    input wire logic [              Depth-1:0] valid_q,
    input wire logic [           ExitBits-1:0] pixel_q,
    input wire logic [              RgbBits:0] colored,
    input wire logic [CHANNELS*FactorBits-1:0] factor
);
  `include "kage_trace.svh"
  `include "generated/kage_buses.svh"

  if (COUNT_BITS > 0 && LINEAR_BITS == 0) begin : gen_light
    table_entry_t entry;
    assign entry = table_i;
    localparam int ResultBits = RgbBits + 1 + CHANNELS * FactorBits;
    logic [EntryShareBits-1:0] shares[2**CLASS_BITS*LIGHTS];
    // An entry that nothing has written may hold anything; who asks for it is wrong, not who answers.
    bit written[2**CLASS_BITS*LIGHTS];
    logic [LightStages-1:0] known_q;
    logic [ResultBits-1:0] results_q[LightStages];
    logic [ResultBits-1:0] result;
    logic [CLASS_BITS-1:0] pixel_class;
    int lost, share;
    bit known;

    always_comb begin
      result = '0;
      known = 1'b1;
      lost = 0;
      share = 0;
      pixel_class = pixel_q[ExitClassAt+:CLASS_BITS];
      for (int c = 0; c < CHANNELS; c++) begin
        lost = 0;
        for (int l = 0; l < LIGHTS; l++) begin
          if (HasTable && pixel_q[ExitCountsAt+l*COUNT_BITS+:COUNT_BITS] != '0 &&
              !written[32'(pixel_class)*LIGHTS+l]) begin
            known = 1'b0;
          end
          share = HasTable ? 32'(shares[32'(pixel_class)*LIGHTS+l][c*FactorBits+:FactorBits]) : 32'(keep_q);
          lost  = lost + 32'(pixel_q[ExitCountsAt+l*COUNT_BITS+:COUNT_BITS]) * share;
        end
        result[c*FactorBits+:FactorBits] = lost > 32'(WholeShare) ? '0 : FactorBits'(32'(WholeShare) - lost);
      end
      result[ResultBits-1-:RgbBits+1] = pixel_q[ExitCoveredAt:ExitColorAt];
    end

    always_ff @(posedge clk_i) begin
      if (table_valid_i) begin
        shares[32'(entry.normal_class)*LIGHTS+32'(entry.light)]  <= entry.share;
        written[32'(entry.normal_class)*LIGHTS+32'(entry.light)] <= 1'b1;
      end
      if (go) begin
        known_q <= {known_q[LightStages-2:0], known};
        results_q[0] <= result;
        for (int i = 1; i < LightStages; i++) results_q[i] <= results_q[i-1];
      end
      if (rst_ni && valid_q[2+LightStages] && known_q[LightStages-1]) begin
        trace_module(PartLightResolve, 512'(results_q[LightStages-1]), 512'({colored, factor}));
      end
    end
  end else begin : gen_none
    logic unused;
    assign unused = ^{clk_i, rst_ni, table_valid_i, table_i, keep_q, go, valid_q, pixel_q, colored, factor};
  end

endmodule

bind line_out light_resolve_monitor #(
    `include "generated/kage_pixel_param_map.svh"
) u_light_monitor (.*);

`default_nettype wire
