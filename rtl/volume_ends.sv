// SPDX-License-Identifier: Apache-2.0
// The way out of front_end: its items as tokens of the span level, and between them the EV, ES and RESOLVE that frames
// at the polygon level do without. A volume ends where a token of another one comes, or one that is of no volume; its
// range is the union of its spans. With linear light a RESOLVE stands before the first of a light's own spans.
//
// Handshake: valid/ready on both sides, item_* with span_i where the item is a polygon's (item_made_i). Output
//   item_ready_o depends on token_ready_i, which comes from a register.
// Item: {plain, whole, family, index, flags, token}. Plain: a token that passes as it is, whatever volumes are open.
//   Whole: a near cap over the whole line. Family: the place but for its rank. Index: in the frame, of the token at
//   hand. Flags, token: of an item that is not a polygon's.
// Flush: by flush_i nothing is open, as after reset and behind a header.
// Latency: 1 clock. Throughput: a token a clock; an end of a volume, of a sample, and RESOLVE are tokens like others. A
//   polygon without pixels, or whose weight is 0, takes a clock and gives none; without FSF so does a volume's end.
// Cost: a register of an item, four numbers of X_BITS, the family, comparators of X_BITS and of the family; with linear
//   light COUNT_BITS + 2 flip-flops more.
`default_nettype none

module volume_ends #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int TOKEN_WORDS = 5,
    localparam int ItemBits = 2 + FamilyBits + 32 + FlagsBits + TOKEN_WORDS * 32
) (
    input wire logic clk_i,
    input wire logic rst_ni,
    input wire logic flush_i,

    input wire logic [X_BITS-1:0] width_i,

    input  wire logic                    item_valid_i,
    output logic                         item_ready_o,
    input  wire logic                    item_made_i,
    input  wire logic [    ItemBits-1:0] item_i,
    input  wire logic [MadeSpanBits-1:0] span_i,

    output logic                           moving_o,       // an item, or an end before it, is done with
    output logic                           token_valid_o,
    input  wire logic                      token_ready_i,
    output logic      [TOKEN_WORDS*32-1:0] token_o,
    output logic      [     FlagsBits-1:0] token_flags_o,
    output logic      [              31:0] token_index_o
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

  localparam int TokenBits = TOKEN_WORDS * 32;
  localparam int SampleAt = VolumeBits;  // in the family: the light, the sample, the layer
  localparam int SampleFamilyBits = FamilyBits - SampleAt;
  localparam int SamplesBits = PassSamplesBits > 0 ? PassSamplesBits : 1;
  localparam int SomeClassBits = ClassBits > 0 ? ClassBits : 1;

  // ---- an item on its way into the register ------------------------------------------------------------------------
  logic plain, whole;
  logic [FamilyBits-1:0] family;
  logic [31:0] index;
  flags_t flags;
  logic [TokenBits-1:0] token;
  made_span_t coming_span;
  logic [LayerBits-1:0] layer;
  logic lights;  // its place is of a light's own spans
  logic [KindBits-1:0] kind;
  assign {plain, whole, family, index, flags, token} = item_i;
  assign coming_span = span_i;
  assign layer = family[FamilyBits-1-:LayerBits];
  assign lights = LINEAR_BITS > 0 && layer == 2'd1 && family[SampleAt];
  assign kind = token[KindBits-1:0];

  // ---- a polygon's span as a token ---------------------------------------------------------------------------------
  // Functions, because Icarus Verilog does not end where blocks that build a vector by its parts wait for each other.
  function automatic logic [TokenBits-1:0] op_of(input logic [X_BITS-1:0] xl, input logic [X_BITS-1:0] xr,
                                                 input logic [SomeClassBits-1:0] normal_class,
                                                 input logic [DepthBits-1:0] z, input logic [DepthBits-1:0] dz,
                                                 input logic [ColorBits-1:0] color, input logic [SlopeBits-1:0] dcolor);
    logic unused_bits;
    unused_bits = ^{normal_class, dcolor};
    op_of = '0;
    op_of[KindBits-1:0] = KindOp;
    op_of[OpXlLsb+:X_BITS] = xl;
    op_of[OpXrLsb+:X_BITS] = xr;
    if (ClassBits > 0) op_of[OpClassLsb+:SomeClassBits] = normal_class;
    op_of[OpZLsb+:DepthBits] = z;
    op_of[OpDzLsb+:DepthBits] = dz;
    op_of[OpColorLsb+:ColorBits] = color;
    if (SMOOTH > 0) op_of[OpDcolorLsb+:SlopeBits] = dcolor;
  endfunction

  function automatic logic [TokenBits-1:0] sp_of(input logic [X_BITS-1:0] xl, input logic [X_BITS-1:0] xr,
                                                 input logic [DSF_BITS:0] w, input logic [DepthBits-1:0] z,
                                                 input logic [DepthBits-1:0] dz);
    sp_of = '0;
    sp_of[KindBits-1:0] = KindSp;
    sp_of[SpXlLsb+:X_BITS] = xl;
    sp_of[SpXrLsb+:X_BITS] = xr;
    sp_of[SpWLsb+:DSF_BITS+1] = w;
    sp_of[SpZLsb+:DepthBits] = z;
    sp_of[SpDzLsb+:DepthBits] = dz;
  endfunction

  // The token of a near cap of this weight over the whole line.
  function automatic logic [TokenBits-1:0] if_of(input logic [DSF_BITS:0] w);
    if_of = '0;
    if_of[KindBits-1:0] = KindIf;
    if_of[IfWLsb+:DSF_BITS+1] = w;
  endfunction

  logic [TokenBits-1:0] made_op, made_sp, made_tp;
  logic no_weight;
  assign made_op = op_of(
      coming_span.xl,
      coming_span.xr,
      coming_span.look[0+:SomeClassBits],
      coming_span.z,
      coming_span.dz,
      coming_span.color,
      coming_span.dcolor
  );
  if (DSF_BITS > 0) begin : gen_sp
    logic [DSF_BITS:0] w;
    assign w = coming_span.look[PolygonWLsb-KindBits+:DSF_BITS+1];
    assign made_sp = sp_of(coming_span.xl, coming_span.xr, coming_span.turned ? -w : w, coming_span.z, coming_span.dz);
    assign no_weight = coming_span.look[PolygonWLsb-KindBits+:DSF_BITS] == '0;
  end else begin : gen_no_sp
    logic unused_turned;
    assign unused_turned = coming_span.turned;
    assign made_sp = '0;
    assign no_weight = 1'b1;
  end
  if (TRANSLUCENCY > 0) begin : gen_tp
    // Here, because TP's fields may lie beyond the longest token of a core without it.
    function automatic logic [TokenBits-1:0] tp_of(input logic [X_BITS-1:0] xl, input logic [X_BITS-1:0] xr,
                                                   input logic [7:0] alpha, input logic [DepthBits-1:0] z,
                                                   input logic [DepthBits-1:0] dz, input logic [ColorBits-1:0] color,
                                                   input logic [SlopeBits-1:0] dcolor);
      logic unused_bits;
      unused_bits = ^dcolor;
      tp_of = '0;
      tp_of[KindBits-1:0] = KindTp;
      tp_of[TpXlLsb+:X_BITS] = xl;
      tp_of[TpXrLsb+:X_BITS] = xr;
      tp_of[TpAlphaLsb+:8] = alpha;
      tp_of[TpZLsb+:DepthBits] = z;
      tp_of[TpDzLsb+:DepthBits] = dz;
      tp_of[TpColorLsb+:ColorBits] = color;
      if (SMOOTH > 0) tp_of[TpDcolorLsb+:SlopeBits] = dcolor;
    endfunction
    assign made_tp = tp_of(
        coming_span.xl,
        coming_span.xr,
        coming_span.look[PolygonAlphaLsb-KindBits+:8],
        coming_span.z,
        coming_span.dz,
        coming_span.color,
        coming_span.dcolor
    );
  end else begin : gen_no_tp
    assign made_tp = '0;
  end

  // ---- the token that it is, and what it is to volumes -------------------------------------------------------------
  // Which volume was open, or which light had its RESOLVE, is told by the last item before it that was of either.
  typedef struct packed {
    logic none;  // it gives no token
    logic of_volume;
    logic of_light;  // one of a light's own spans
    logic behind_volumes;
    logic other_volume;
    logic other_sample;
    logic whole;  // a near cap over the whole line, which is what IF says
  } judged_t;
  localparam int JudgedBits = 7;
  judged_t judged, is_q;
  logic come, item_valid, leaves;
  logic [FamilyBits-1:0] family_q;
  logic [TokenBits-1:0] comes_to, token_q;
  flags_t comes_with, flags_q;
  logic [LightBits-1:0] volume_light_q;  // the light of its volume
  logic [SamplesBits-1:0] samples_q;  // of its light
  logic [31:0] index_q;
  assign judged.none = item_made_i && (coming_span.empty || (layer == 2'd1 && !lights && no_weight));
  // An item that is not plain has a range, or is an EOL.
  assign judged.of_volume = !plain && DSF_BITS > 0 && (item_made_i ? layer == 2'd1 && !lights : kind_has_range(
      kind
  ) && kind != KindOp && kind != KindTp);
  assign judged.of_light = !plain && lights && (item_made_i || kind == KindOp);
  assign judged.behind_volumes = !plain && (item_made_i ? layer == 2'd2 : kind == KindTp || kind == KindEol);
  assign judged.other_volume = family != family_q;
  assign judged.other_sample = family[FamilyBits-1-:SampleFamilyBits] != family_q[FamilyBits-1-:SampleFamilyBits];
  assign judged.whole = DSF_BITS > 0 && !item_made_i && whole;
  assign comes_with = item_made_i ? '0 : flags;
  assign comes_to = !item_made_i ? (judged.whole ? if_of(
      token[NcWLsb+:DSF_BITS+1]
  ) : token) : layer == 2'd1 && !lights ? made_sp : layer == 2'd2 ? made_tp : made_op;
  assign come = item_valid_i && item_ready_o;
  always_ff @(posedge clk_i) if (come && (judged.of_volume || judged.of_light) && !judged.none) family_q <= family;

  stream_register #(
      .BITS(JudgedBits + LightBits + SamplesBits + 32 + FlagsBits + TokenBits)
  ) u_item (
      .clk_i,
      .rst_ni     (rst_ni && !flush_i),
      .in_valid_i (item_valid_i),
      .in_ready_o (item_ready_o),
      .in_data_i  ({judged, family[SampleAt+:LightBits], family[0+:SamplesBits], index, comes_with, comes_to}),
      .out_valid_o(item_valid),
      .out_ready_i(leaves),
      .out_data_o ({is_q, volume_light_q, samples_q, index_q, flags_q, token_q})
  );

  // ---- what it does to volumes -------------------------------------------------------------------------------------
  logic [X_BITS-1:0] xl, xr;
  logic any_q, volume_here_q, sample_here_q;
  logic pass_here_q;  // the light at hand has its RESOLVE
  logic [LightBits-1:0] light_q;
  logic [X_BITS-1:0] volume_xl_q, volume_xr_q, sample_xl_q, sample_xr_q;
  logic ends_all, ends_volume, ends_sample, resolves, passes, gives, done;
  assign xl = is_q.whole ? '0 : token_q[RangeXlLsb+:X_BITS];
  assign xr = is_q.whole ? width_i : token_q[RangeXrLsb+:X_BITS];
  assign ends_all = is_q.behind_volumes || is_q.of_light;
  assign ends_volume = !is_q.none && volume_here_q && (ends_all || (is_q.of_volume && is_q.other_volume));
  assign ends_sample = !is_q.none && !volume_here_q && sample_here_q &&
      (ends_all || (is_q.of_volume && is_q.other_sample));
  assign resolves = !is_q.none && !volume_here_q && !sample_here_q &&
      (is_q.of_light ? !pass_here_q : any_q && is_q.behind_volumes);
  assign passes = !is_q.none && !ends_volume && !ends_sample && !resolves;
  assign gives = passes || resolves || (ends_volume && FSF > 0) || (ends_sample && COUNT_BITS > 0);
  assign done = item_valid && (token_ready_i || !gives);
  assign moving_o = done || come;
  assign token_valid_o = item_valid && gives;
  assign leaves = done && (passes || is_q.none);

  always_ff @(posedge clk_i) begin
    if (!rst_ni || flush_i || (item_valid && flags_q.header)) begin
      any_q <= 1'b0;
      volume_here_q <= 1'b0;
      sample_here_q <= 1'b0;
    end else if (done) begin
      if (passes && is_q.of_volume) begin
        any_q <= 1'b1;
        volume_here_q <= 1'b1;
      end
      if (ends_volume) begin
        volume_here_q <= 1'b0;
        sample_here_q <= 1'b1;
      end
      if (ends_sample) sample_here_q <= 1'b0;
      if (resolves) any_q <= 1'b0;
    end
    // An item that comes finds the one before it on its way out.
    if (LINEAR_BITS > 0) begin
      if (!rst_ni || flush_i || (come && !judged.none && (!judged.of_light || judged.other_volume)))
        pass_here_q <= 1'b0;
      else if (done && resolves && is_q.of_light) pass_here_q <= 1'b1;
    end else begin
      pass_here_q <= 1'b0;
    end
    if (done && passes && is_q.of_volume) begin
      light_q <= volume_light_q;
      if (!volume_here_q || xl < volume_xl_q) volume_xl_q <= xl;
      if (!volume_here_q || xr > volume_xr_q) volume_xr_q <= xr;
    end
    if (done && ends_volume) begin
      if (!sample_here_q || volume_xl_q < sample_xl_q) sample_xl_q <= volume_xl_q;
      if (!sample_here_q || volume_xr_q > sample_xr_q) sample_xr_q <= volume_xr_q;
    end
  end

  // ---- the token ---------------------------------------------------------------------------------------------------
  logic [TokenBits-1:0] ending;
  always_comb begin
    ending = '0;
    ending[KindBits-1:0] = ends_volume ? KindEv : ends_sample ? KindEs : KindResolve;
    if (ends_volume || ends_sample) begin
      ending[EvXlLsb+:X_BITS] = ends_volume ? volume_xl_q : sample_xl_q;
      ending[EvXrLsb+:X_BITS] = ends_volume ? volume_xr_q : sample_xr_q;
    end
    if (ends_sample) ending[EsLightLsb+:LightBits] = light_q;
    if (PassSamplesBits > 0 && resolves && is_q.of_light) ending[ResolveSamplesLsb+:SamplesBits] = samples_q;
    token_o = passes ? token_q : ending;
    token_flags_o = passes ? flags_q : '0;
  end
  assign token_index_o = index_q;

  logic unused_bits;
  assign unused_bits = ^{token, coming_span, samples_q};

  // ---- assertions --------------------------------------------------------------------------------------------------
`ifndef SYNTHESIS
  logic joined_q;  // a span has joined a volume, and which
  logic [X_BITS-1:0] joined_xl_q, joined_xr_q;
  always @(posedge clk_i) begin
    joined_q <= rst_ni && !flush_i && !flags_q.header && done && passes && is_q.of_volume;
    joined_xl_q <= xl;
    joined_xr_q <= xr;
    if (rst_ni && !flush_i) begin
      // 1. An item passes, or gives way to one end, or is none.
      assert (!item_valid ||
              32'(passes) + 32'(ends_volume) + 32'(ends_sample) + 32'(resolves) + 32'(is_q.none) == 32'd1);
      // 2. An item leaves once all that ends before it has ended.
      assert (!(item_valid && leaves && !is_q.none && ends_all) || !(volume_here_q || sample_here_q || any_q));
      // 3. A volume's range holds every span of it.
      assert (!joined_q || (volume_here_q && volume_xl_q <= joined_xl_q && joined_xr_q <= volume_xr_q));
    end
  end
`endif

endmodule

`default_nettype wire
