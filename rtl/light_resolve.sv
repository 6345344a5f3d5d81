// SPDX-License-Identifier: Apache-2.0
// RESOLVE for counters: what a pixel keeps of its colour, from its counts and class. One pixel a clock, where pixels
// leave one by one, so table and products exist once, not LANES times.
//
// Pixels: pixel_i is a word of ExitBits (kage_widths.svh), its counts 0 where the class is. LightStages clocks of go_i
//   later pixel_o is its {covered, colour}, and factor_o has each channel's factor in 2^-SHADE_FRAC, channel 0 lowest.
//   A factor is max(0, 2^SHADE_FRAC - sum over lights of count x share). Without a table the share is shade_i, which
//   holds still while pixels are within.
// Table (CLASS_BITS > 1): table_valid_i writes the entry of a class and a light. No pixel within may be of a frame
//   before: frame_control waits for the way out to be empty. An entry that was never written is looked up only with a
//   count of 0. No share is more than 1.
// Latency: with a table 5 clocks: RAM, the register behind it, products, sums, factors; without one 2: product, factor.
//   Throughput: a pixel a clock.
// Cost: with a table a RAM of 2^CLASS_BITS x CHANNELS x (SHADE_FRAC + 1) bits and CHANNELS products of COUNT_BITS x
//   (SHADE_FRAC + 1) bits for each light; without one a single product.
// Needs COUNT_BITS > 0: a core without counters leaves it out.
`default_nettype none

module light_resolve #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    localparam int Passed = RgbBits + 1
) (
    input wire logic clk_i,

    input wire logic                      table_valid_i,
    input wire logic [TableEntryBits-1:0] table_i,
    input wire logic [    FactorBits-1:0] shade_i,

    input  wire logic                           go_i,
    input  wire logic [           ExitBits-1:0] pixel_i,
    output logic      [             Passed-1:0] pixel_o,
    output logic      [CHANNELS*FactorBits-1:0] factor_o
);
  `include "generated/kage_buses.svh"

  // At least 1, so that the file can be read with its defaults.
  localparam int Stages = LightStages > 0 ? LightStages : 1;
  localparam int CountOne = COUNT_BITS > 0 ? COUNT_BITS : 1;
  localparam int Counts = LIGHTS * CountOne;
  localparam int Shares = HasTable ? CHANNELS : 1;  // of a light: without a table all channels have one
  localparam int ProductBits = CountOne + SHADE_FRAC;  // no share is more than 1, nor a count 2^CountOne
  localparam int SumBits = ProductBits + $clog2(LIGHTS);

  // ---- the colour goes along ---------------------------------------------------------------------------------------
  logic [Stages*Passed-1:0] passed_q;
  always_ff @(posedge clk_i) begin
    if (go_i) passed_q <= (Stages * Passed)'({passed_q, pixel_i[ExitCoveredAt:ExitColorAt]});
  end
  assign pixel_o = passed_q[(Stages-1)*Passed+:Passed];

  // ---- share of each light and channel, with the counts ------------------------------------------------------------
  logic [LIGHTS*Shares*FactorBits-1:0] shares;
  logic [Counts-1:0] counts;
  table_entry_t entry;
  assign entry = table_i;
  if (HasTable) begin : gen_table
    logic [LIGHTS*EntryShareBits-1:0] entries, entries_q;
    logic [2*Counts-1:0] counts_q;
    logic unused_shade;
    assign unused_shade = ^shade_i;
    for (genvar l = 0; l < LIGHTS; l++) begin : gen_light
      ram_1r1w #(
          .BITS (EntryShareBits),
          .WORDS(2 ** CLASS_BITS)
      ) u_shares (
          .clk_i,
          .wr_en_i  (table_valid_i && entry.light == LightBits'(l)),
          .wr_addr_i(entry.normal_class),
          .wr_data_i(entry.share),
          .rd_en_i  (go_i),
          .rd_addr_i(pixel_i[ExitClassAt+:CLASS_BITS]),
          .rd_data_o(entries[l*EntryShareBits+:EntryShareBits])
      );
    end
    always_ff @(posedge clk_i) begin
      if (go_i) begin
        entries_q <= entries;
        counts_q  <= {counts_q[Counts-1:0], pixel_i[ExitCountsAt+:Counts]};
      end
    end
    assign shares = entries_q;
    assign counts = counts_q[Counts+:Counts];
  end else begin : gen_shade
    logic unused_table;
    assign unused_table = ^{table_valid_i, entry};
    assign shares = shade_i;
    assign counts = pixel_i[ExitCountsAt+:Counts];
  end

  // ---- products ----------------------------------------------------------------------------------------------------
  logic [LIGHTS*Shares*ProductBits-1:0] products_q;
  always_ff @(posedge clk_i) begin
    if (go_i) begin
      for (int l = 0; l < LIGHTS; l++) begin
        for (int c = 0; c < Shares; c++) begin
          products_q[(l*Shares+c)*ProductBits+:ProductBits] <=
              ProductBits'(counts[l*CountOne+:CountOne]) *
              ProductBits'(shares[(l*Shares+c)*FactorBits+:FactorBits]);
`ifndef SYNTHESIS
          // No sample loses nothing, even of an entry that no TABLE has written: where a simulator knows X, 0 * X is X.
          if (counts[l*CountOne+:CountOne] == '0) products_q[(l*Shares+c)*ProductBits+:ProductBits] <= '0;
`endif
        end
      end
    end
  end

  // ---- sums over the lights ----------------------------------------------------------------------------------------
  logic [Shares*SumBits-1:0] lost;
  if (HasTable) begin : gen_sums
    logic [Shares*SumBits-1:0] sums, sums_q;
    always_comb begin
      sums = '0;
      for (int c = 0; c < Shares; c++) begin
        for (int l = 0; l < LIGHTS; l++) begin
          sums[c*SumBits+:SumBits] = sums[c*SumBits+:SumBits] +
              SumBits'(products_q[(l*Shares+c)*ProductBits+:ProductBits]);
        end
      end
    end
    always_ff @(posedge clk_i) if (go_i) sums_q <= sums;
    assign lost = sums_q;
`ifndef SYNTHESIS
    always @(posedge clk_i) begin
      for (int c = 0; c < Shares; c++) begin
        for (int l = 0; l < LIGHTS; l++) begin
          // A sum has bits for all of it: no term is more, of whatever the registers hold at first.
          assert ((64'(sums[c*SumBits+:SumBits]) < 64'(products_q[(l*Shares+c)*ProductBits+:ProductBits])) !== 1'b1);
        end
      end
    end
`endif
  end else begin : gen_one_product
    assign lost = products_q;
  end

  // ---- factors -----------------------------------------------------------------------------------------------------
  localparam logic [SumBits-1:0] One = SumBits'(WholeShare);
  logic [Shares*FactorBits-1:0] factors_q;
  always_ff @(posedge clk_i) begin
    if (go_i) begin
      for (int c = 0; c < Shares; c++) begin
        if (lost[c*SumBits+:SumBits] >= One) factors_q[c*FactorBits+:FactorBits] <= '0;
        else factors_q[c*FactorBits+:FactorBits] <= FactorBits'(One - lost[c*SumBits+:SumBits]);
      end
    end
  end
  assign factor_o = {(CHANNELS / Shares) {factors_q}};

endmodule

`default_nettype wire
