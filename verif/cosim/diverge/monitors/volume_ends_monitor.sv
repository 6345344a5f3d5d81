// SPDX-License-Identifier: Apache-2.0
// volume_ends from its ports alone: the tokens that each item leads to. A volume's range is from the least left end of
// its spans to the greatest right one, a sample's that of its volumes.
`default_nettype none
/* verilator lint_off UNUSEDSIGNAL */  // whole words are taken apart
/* verilator lint_off BLKSEQ */  // a model, in the order of its lines

module volume_ends_monitor #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int TOKEN_WORDS = 5,
    localparam int ItemBits = 2 + FamilyBits + 32 + FlagsBits + TOKEN_WORDS * 32
) (
    input wire logic                      clk_i,
    input wire logic                      rst_ni,
    input wire logic                      flush_i,
    input wire logic [        X_BITS-1:0] width_i,
    input wire logic                      item_valid_i,
    input wire logic                      item_ready_o,
    input wire logic                      item_made_i,
    input wire logic [      ItemBits-1:0] item_i,
    input wire logic [  MadeSpanBits-1:0] span_i,
    input wire logic                      token_valid_o,
    input wire logic                      token_ready_i,
    input wire logic [TOKEN_WORDS*32-1:0] token_o,
    input wire logic [     FlagsBits-1:0] token_flags_o,
    input wire logic [              31:0] token_index_o
);
  `include "kage_trace.svh"
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  `include "generated/kage_order.svh"

  localparam int Wide = 1024;  // more than any token, so that a field that the core lacks has a place too
  localparam int OutBits = TOKEN_WORDS * 32;
  localparam int DueBits = 32 + FlagsBits + OutBits;

  localparam int Depth = 16;  // more than an item leads to
  logic [DueBits-1:0] queue_q[Depth];  // tokens that are due, from head_q to tail_q: {index, flags, token}
  int head_q = 0, tail_q = 0;
  bit fault_q;  // a token at fault has come: what is behind it does not matter
  bit any_q, volume_q, sample_q;  // something is to be resolved; a volume, a sample is open
  bit light_q;  // spans of a light are at hand, whose RESOLVE has come
  logic [FamilyBits-1:0] family_q, light_family_q;
  int volume_xl_q, volume_xr_q, sample_xl_q, sample_xr_q;
  int waited_q;  // clocks in which a token was due and none was there

  logic plain, whole;
  logic [FamilyBits-1:0] family;
  logic [31:0] index;
  flags_t flags;
  logic [OutBits-1:0] token;
  made_span_t span;
  assign {plain, whole, family, index, flags, token} = item_i;
  assign span = span_i;

  task automatic due(input logic [FlagsBits-1:0] with_flags, input logic [Wide-1:0] word);
    queue_q[tail_q%Depth] = {index, with_flags, word[OutBits-1:0]};
    tail_q = tail_q + 1;
  endtask

  // A polygon's span as a token.
  function automatic logic [Wide-1:0] made(input logic [LayerBits-1:0] layer);
    logic [DSF_BITS:0] w;
    made = '0;
    w = (DSF_BITS + 1)'(span.look >> (PolygonWLsb - KindBits));
    made[KindBits-1:0] = layer == 2'd1 ? KindSp : layer == 2'd2 ? KindTp : KindOp;
    made[RangeXlLsb+:X_BITS] = span.xl;
    made[RangeXrLsb+:X_BITS] = span.xr;
    case (layer)
      2'd1: begin
        made[SpWLsb+:DSF_BITS+1] = span.turned ? -w : w;
        made[SpZLsb+:DepthBits]  = span.z;
        made[SpDzLsb+:DepthBits] = span.dz;
      end
      2'd2: begin
        made[TpAlphaLsb+:8] = 8'(span.look >> (PolygonAlphaLsb - KindBits));
        made[TpZLsb+:DepthBits] = span.z;
        made[TpDzLsb+:DepthBits] = span.dz;
        made[TpColorLsb+:ColorBits] = span.color;
        if (SMOOTH > 0) made[TpDcolorLsb+:SlopeBits] = span.dcolor;
      end
      default: begin
        if (ClassBits > 0) made[OpClassLsb+:CLASS_BITS] = CLASS_BITS'(span.look);
        made[OpZLsb+:DepthBits] = span.z;
        made[OpDzLsb+:DepthBits] = span.dz;
        made[OpColorLsb+:ColorBits] = span.color;
        if (SMOOTH > 0) made[OpDcolorLsb+:SlopeBits] = span.dcolor;
      end
    endcase
  endfunction

  task automatic take();
    logic [LayerBits-1:0] layer;
    logic [KindBits-1:0] kind;
    logic [Wide-1:0] word;
    bit of_volume, of_light, behind, none;
    int xl, xr;
    if (fault_q && (item_made_i || !flags.header)) return;
    fault_q = !item_made_i && flags.fault != ErrNone;
    layer = family[FamilyBits-1-:LayerBits];
    kind = token[KindBits-1:0];
    of_light = LINEAR_BITS > 0 && !plain && layer == 2'd1 && family[VolumeBits] && (item_made_i || kind == KindOp);
    none = item_made_i && (span.empty || (layer == 2'd1 && !of_light && (DSF_BITS == 0 ||
        DsfBits'(span.look >> (PolygonWLsb - KindBits)) == '0)));
    if (none) return;
    of_volume = !plain && DSF_BITS > 0 && !of_light &&
        (item_made_i ? layer == 2'd1 : kind_has_range(kind) && kind != KindOp && kind != KindTp);
    behind = !plain && (item_made_i ? layer == 2'd2 : kind == KindTp || kind == KindEol);
    if (volume_q && (behind || of_light || (of_volume && family != family_q))) begin
      word = '0;
      word[KindBits-1:0] = KindEv;
      word[EvXlLsb+:X_BITS] = X_BITS'(volume_xl_q);
      word[EvXrLsb+:X_BITS] = X_BITS'(volume_xr_q);
      if (FSF > 0) due('0, word);
      if (!sample_q || volume_xl_q < sample_xl_q) sample_xl_q = volume_xl_q;
      if (!sample_q || volume_xr_q > sample_xr_q) sample_xr_q = volume_xr_q;
      volume_q = 1'b0;
      sample_q = 1'b1;
    end
    if (sample_q && !volume_q &&
        (behind || of_light ||
        (of_volume && family[FamilyBits-1:VolumeBits] != family_q[FamilyBits-1:VolumeBits]))) begin
      word = '0;
      word[KindBits-1:0] = KindEs;
      word[EsXlLsb+:X_BITS] = X_BITS'(sample_xl_q);
      word[EsXrLsb+:X_BITS] = X_BITS'(sample_xr_q);
      word[EsLightLsb+:LightBits] = family_q[VolumeBits+:LightBits];
      if (COUNT_BITS > 0) due('0, word);
      sample_q = 1'b0;
    end
    if ((any_q && behind) || (of_light && !(light_q && family == light_family_q))) begin
      word = '0;
      word[KindBits-1:0] = KindResolve;
      if (of_light && COUNT_BITS > 0)
        word[ResolveSamplesLsb+:(COUNT_BITS>0?COUNT_BITS : 1)] = family[0+:(COUNT_BITS>0?COUNT_BITS : 1)];
      due('0, word);
      any_q = 1'b0;
      light_q = of_light;
      light_family_q = family;
    end
    word = Wide'(token);
    if (item_made_i) word = made(of_light ? 2'd0 : layer);
    xl = 32'(X_BITS'(word >> RangeXlLsb));
    xr = 32'(X_BITS'(word >> RangeXrLsb));
    if (!item_made_i && whole && DSF_BITS > 0) begin
      word = '0;
      word[KindBits-1:0] = KindIf;
      word[IfWLsb+:DSF_BITS+1] = token[NcWLsb+:DSF_BITS+1];
      xl = 0;
      xr = 32'(width_i);
    end
    due(item_made_i ? '0 : flags, word);
    if (!item_made_i && flags.header) {any_q, volume_q, sample_q, light_q} = '0;
    if (behind || of_volume) light_q = 1'b0;
    if (!of_volume) return;
    if (!volume_q || xl < volume_xl_q) volume_xl_q = xl;
    if (!volume_q || xr > volume_xr_q) volume_xr_q = xr;
    family_q = family;
    {any_q, volume_q} = 2'b11;
  endtask

  logic [DueBits-1:0] first;
  always @(posedge clk_i) begin
    if (!rst_ni || flush_i) begin
      head_q = tail_q;
      {fault_q, any_q, volume_q, sample_q, light_q} = '0;
      waited_q = 0;
    end else begin
      if (token_valid_o) begin
        first = tail_q != head_q ? queue_q[head_q%Depth] : ~{token_index_o, token_flags_o, token_o};
        if (tail_q != head_q || !fault_q)
          trace_module(PartVolumeEnds, 512'(first), 512'({token_index_o, token_flags_o, token_o}));
        if (token_ready_i && tail_q != head_q) head_q = head_q + 1;
      end
      // An end that the core does not tell takes a clock all the same: two at most, and the register before them.
      waited_q = token_valid_o || tail_q == head_q ? 0 : waited_q + 1;
      trace_module(PartVolumeEnds, '0, {511'd0, waited_q > 3});
      if (item_valid_i && item_ready_o) take();
    end
  end

endmodule

bind volume_ends volume_ends_monitor #(
    .TOKEN_WORDS(TOKEN_WORDS),
    `include "generated/kage_pixel_param_map.svh"
) u_monitor (.*);

/* verilator lint_on BLKSEQ */
/* verilator lint_on UNUSEDSIGNAL */
`default_nettype wire
