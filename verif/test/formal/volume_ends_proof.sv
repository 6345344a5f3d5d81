// SPDX-License-Identifier: Apache-2.0
// Proof of volume_ends, for any items, stalls, and a reset or a flush at any time (verif/test/formal/run.sh):
//   volume_range   an EV ends a volume that is open; its range is from the least left end to the greatest right end of
//                  the volume's spans, of NC's over the whole line, which leave as IF, too;
//   sample_range   an ES likewise ends a sample, of the range of its volumes;
//   resolved       RESOLVE comes once, behind the last end;
//   all_ended      a TP and an EOL come behind all of that;
//   one_volume     a span joins the volume that is open only if it is of it, and the sample likewise;
//   lit            with linear light one of a light's own spans comes behind the RESOLVE of that light, with no volume
//                  between, and that RESOLVE tells the light's samples;
//   steady         a token that waits stays as it is.
//
// How: by induction. The proof reads the tokens that leave, and keeps their spans' least and greatest ends; of items it
// keeps the family alone. Items are any that front_merge gives of a frame at the polygon level: spans have the layer of
// their kind. Script run.sh connects inside_* to the module's registers; the lemmas say that these agree with the
// tokens.
//
// Why small widths say it for all: ends of spans are compared and copied alike whatever their bits.
`default_nettype none

module volume_ends_proof #(
    parameter int X_BITS = 3,
    parameter int Z_BITS = 4,
    parameter int Z_FRAC = 1,
    parameter int CHANNELS = 1,
    parameter int SMOOTH = 0,
    parameter int COLOR_FRAC = 0,
    parameter int DSF_BITS = 1,
    parameter int FSF = 1,
    parameter int SHADE_FRAC = 1,
    parameter int COUNT_BITS = 1,
    parameter int LIGHTS = 2,
    parameter int CLASS_BITS = 1,
    parameter int TRANSLUCENCY = 1,
    parameter int UNITS = 0,
    parameter int FACE_BITS = 2,
    parameter int DX_BITS = 2,
    parameter int SEG_BITS = 1,
    parameter int ORDER_BITS = 1,
    parameter int CLASSIC = 0,
    parameter int LINEAR_BITS = 0,
    `include "generated/kage_widths.svh"
    localparam int Words = 2,
    localparam int ItemBits = 2 + FamilyBits + 32 + FlagsBits + Words * 32
) (
    input wire logic                    clk_i,
    input wire logic                    rst_ni,
    input wire logic                    flush_i,
    input wire logic                    item_valid_i,
    input wire logic                    item_made_i,
    input wire logic [    ItemBits-1:0] item_i,
    input wire logic [MadeSpanBits-1:0] span_i,
    input wire logic                    token_ready_i
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_buses.svh"
  localparam logic [X_BITS-1:0] Width = '1;
  logic item_ready, moving, valid;
  logic [Words*32-1:0] token;
  logic [FlagsBits-1:0] token_flags;
  logic [31:0] index;
  volume_ends #(
      .TOKEN_WORDS(Words),
      `include "generated/kage_pixel_param_map.svh"
  ) dut (
      .clk_i,
      .rst_ni,
      .flush_i,
      .width_i      (Width),
      .item_valid_i,
      .item_ready_o (item_ready),
      .item_made_i,
      .item_i,
      .span_i,
      .moving_o     (moving),
      .token_valid_o(valid),
      .token_ready_i,
      .token_o      (token),
      .token_flags_o(token_flags),
      .token_index_o(index)
  );

  // ---- items: as front_merge has them ------------------------------------------------------------------------------
  logic plain, whole;
  logic [FamilyBits-1:0] family;
  logic [31:0] item_index;
  flags_t flags;
  logic [Words*32-1:0] item_token;
  logic [LayerBits-1:0] layer;
  logic [KindBits-1:0] item_kind;
  assign {plain, whole, family, item_index, flags, item_token} = item_i;
  assign layer = family[FamilyBits-1-:LayerBits];
  assign item_kind = item_token[KindBits-1:0];
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  logic of_volume_kind, ends_kind, lights;
  assign lights = LINEAR_BITS > 0 && layer == 2'd1 && family[VolumeBits];
  assign of_volume_kind = item_kind == KindSp || item_kind == KindNc;
  assign ends_kind = item_kind == KindEv || item_kind == KindEs || item_kind == KindIf || item_kind == KindResolve;
  always_comb begin
    if (!started_q) assume (!rst_ni);
    assume (layer != 2'd3);
    if (item_made_i)
      assume (!plain && !whole);
      else if (plain)
        assume (!whole && !ends_kind && !of_volume_kind && item_kind != KindTp && item_kind != KindEol);
        else begin
          assume (of_volume_kind || item_kind == KindOp || item_kind == KindTp || item_kind == KindEol);
          assume (!of_volume_kind || (layer == 2'd1 && !lights));
          assume (!whole || item_kind == KindNc);
        end
    assume (!flags.header || plain);
  end

  // ---- what the tokens that leave say ------------------------------------------------------------------------------
  logic fire, spans, all_of_line, any_q, volume_q, sample_q;
  logic [X_BITS-1:0] xl, xr, volume_xl_q, volume_xr_q, sample_xl_q, sample_xr_q;
  logic [FamilyBits-1:0] family_q, item_family_q;  // of the last span of a volume; of the item that is held
  logic item_light_q = 1'b0;  // which is one of a light's own spans
  logic pass_q;  // that light's RESOLVE is the last before it, and spans of it
  logic [FamilyBits-1:0] pass_family_q, last_family_q;  // of that light; of the last span of a volume or a light
  logic [KindBits-1:0] kind;
  flags_t out_flags;
  assign out_flags = token_flags;
  assign kind = token[KindBits-1:0];
  assign fire = valid && token_ready_i;
  assign all_of_line = kind == KindIf;
  assign spans = kind == KindSp || kind == KindNc || all_of_line;
  assign xl = all_of_line ? '0 : token[RangeXlLsb+:X_BITS];
  assign xr = all_of_line ? Width : token[RangeXrLsb+:X_BITS];
  always_ff @(posedge clk_i) begin
    if (item_valid_i && item_ready) begin
      item_family_q <= family;
      item_light_q  <= lights && !plain && (item_made_i || item_kind == KindOp);
    end
    if (!rst_ni || flush_i || (valid && out_flags.header)) pass_q <= 1'b0;
    else if (fire && kind == KindResolve) pass_q <= item_light_q;
    else if (fire && kind != KindEv && kind != KindEs && !item_light_q) pass_q <= 1'b0;
    if (fire && kind == KindResolve) pass_family_q <= item_family_q;
    if (fire && (spans || (item_light_q && kind == KindOp))) last_family_q <= item_family_q;
    if (!rst_ni || flush_i || (valid && out_flags.header)) begin
      {any_q, volume_q, sample_q} <= '0;
    end else if (fire) begin
      if (spans) {any_q, volume_q} <= 2'b11;
      if (kind == KindEv) {volume_q, sample_q} <= 2'b01;
      if (kind == KindEs) sample_q <= 1'b0;
      if (kind == KindResolve) any_q <= 1'b0;
    end
    if (fire && spans) begin
      family_q <= item_family_q;
      volume_xl_q <= volume_q && volume_xl_q < xl ? volume_xl_q : xl;
      volume_xr_q <= volume_q && volume_xr_q > xr ? volume_xr_q : xr;
    end
    if (fire && kind == KindEv) begin
      sample_xl_q <= sample_q && sample_xl_q < xl ? sample_xl_q : xl;
      sample_xr_q <= sample_q && sample_xr_q > xr ? sample_xr_q : xr;
    end
  end

  logic waits_q;
  logic [Words*32+FlagsBits+31:0] waiting_q;
  always_ff @(posedge clk_i) begin
    waits_q   <= rst_ni && !flush_i && valid && !token_ready_i;
    waiting_q <= {token, token_flags, index};
  end

  // ---- the properties ----------------------------------------------------------------------------------------------
  logic same_sample;
  assign same_sample = item_family_q[FamilyBits-1:VolumeBits] == family_q[FamilyBits-1:VolumeBits];
  always_comb begin
    if (started_q && rst_ni && !flush_i) begin
      if (waits_q) steady : assert (valid && {token, token_flags, index} == waiting_q);
      if (valid) begin
        if (kind == KindEv) volume_range : assert (volume_q && xl == volume_xl_q && xr == volume_xr_q);
        if (kind == KindEs) sample_range : assert (!volume_q && sample_q && xl == sample_xl_q && xr == sample_xr_q);
        if (kind == KindResolve) begin
          resolved :
          assert (!volume_q && !sample_q && (any_q || (item_light_q && !(pass_q && pass_family_q == item_family_q))));
          if (COUNT_BITS > 0 && item_light_q && LINEAR_BITS > 0)
            samples_told : assert (token[ResolveSamplesLsb+:COUNT_BITS] == item_family_q[0+:COUNT_BITS]);
        end
        if (item_light_q && kind == KindOp)
          lit : assert (pass_q && pass_family_q == item_family_q && !any_q && !volume_q && !sample_q);
        if (kind == KindTp || kind == KindEol) all_ended : assert (!any_q && !volume_q && !sample_q);
        if (spans) one_volume : assert ((!volume_q || item_family_q == family_q) && (!sample_q || same_sample));
        wide : cover (kind == KindEs && xl == X_BITS'(1) && xr == X_BITS'(5) && fire);
        between : cover (kind == KindEol && fire && started_q && family_q != '0);
      end
    end
  end

  // ---- for induction -----------------------------------------------------------------------------------------------
  (* keep *) logic inside_any, inside_volume, inside_sample, inside_of_volume, inside_none, inside_other_volume;
  (* keep *) logic inside_other_sample, inside_there, inside_whole, inside_behind, inside_of_light, inside_pass;
  (* keep *) logic [(COUNT_BITS > 0 && LINEAR_BITS > 0 ? COUNT_BITS : 1)-1:0] inside_samples;
  (* keep *) logic [X_BITS-1:0] inside_volume_xl, inside_volume_xr, inside_sample_xl, inside_sample_xr;
  (* keep *) logic [FamilyBits-1:0] inside_family;
  (* keep *) logic [KindBits-1:0] inside_kind;
  (* keep *) logic inside_header;
  always_comb begin
    if (LINEAR_BITS == 0 && started_q) lemma_no_light : assert (!item_light_q && !pass_q);
    if (started_q && rst_ni && !flush_i) begin
      lemma_open : assert (inside_any == any_q && inside_volume == volume_q && inside_sample == sample_q);
      lemma_any : assert (any_q || !(volume_q || sample_q));
      if (volume_q) lemma_volume : assert (inside_volume_xl == volume_xl_q && inside_volume_xr == volume_xr_q);
      if (sample_q) lemma_sample : assert (inside_sample_xl == sample_xl_q && inside_sample_xr == sample_xr_q);
      if (inside_there && !inside_none) begin
        lemma_light : assert (inside_of_light == item_light_q && !(inside_of_light && inside_kind != KindOp));
      end
      if (!inside_there || inside_none) begin
        lemma_pass : assert (inside_pass == pass_q && (!pass_q || inside_family == pass_family_q));
      end else if (inside_there && inside_of_light) begin
        lemma_light_family :
        assert (inside_family == item_family_q && inside_samples == item_family_q[0+:$bits(inside_samples)]);
        lemma_lit : assert (inside_pass == (pass_q && pass_family_q == item_family_q));
        lemma_lit_ends : assert (!inside_pass || !(any_q || volume_q || sample_q));
      end else begin
        lemma_not_lit : assert (!inside_pass);
      end
      if (pass_q) lemma_pass_ends : assert (!(any_q || volume_q || sample_q));
      if (inside_there && inside_of_volume && !inside_none) begin
        lemma_family : assert (inside_family == item_family_q);
        if (volume_q || sample_q)
          lemma_other :
          assert (inside_other_volume == (item_family_q != family_q) && inside_other_sample == !same_sample);
      end else if ((volume_q || sample_q) && !(inside_there && inside_of_light && !inside_none)) begin
        lemma_last : assert (inside_family == family_q);
      end
      if (inside_there && !inside_none) begin
        lemma_kind :
        assert (inside_of_volume == (inside_kind == KindSp || inside_kind == KindNc || inside_kind == KindIf));
        lemma_behind : assert (inside_behind == (inside_kind == KindTp || inside_kind == KindEol));
        lemma_whole : assert (inside_whole == (inside_kind == KindIf));
        lemma_no_end : assert (inside_kind != KindEv && inside_kind != KindEs && inside_kind != KindResolve);
      end
      if (inside_there && inside_header)
        lemma_header : assert (!inside_of_volume && !inside_of_light && !inside_behind && !inside_none);
    end
  end
endmodule

`default_nettype wire
