// SPDX-License-Identifier: Apache-2.0
// Proof of line_phase, for any number of tokens of a line that are in order (verif/test/formal/run.sh):
//   order          a token is in order where docs/stream.md ("Order in a line") lets it stand, and nowhere else, for
//                  each kind;
//   resolved_last  resolved_o says that the line has had a RESOLVE and since then no volume and no TP;
//   bias_sum       bias_o is the sum of the IFs since the line began, or since the last EV, ES or TP, with linear light
//                  also RESOLVE, modulo 2^DSF_BITS;
//   pass_told      with linear light pass_o is the number of the line's RESOLVEs modulo 2, and the last one's samples,
//                  or without counters the bias that it found.
//
// How: the proof keeps which kinds the line has had, and decides by that; the module keeps a phase. Only tokens that
// the proof lets stand are taken, of kinds that the configuration has: behind others nobody asks. By induction: run.sh
// connects inside_* to the phase and the marks, and the lemmas say what they are by the kinds.
//
// Why small widths say it for all: a count is only added to, modulo its width. DSF_BITS is 2 here, 1 and 0 besides.
// proofs.bash has seven sets of parameters: with and without FSF, counters, translucency and linear light.
`default_nettype none

module line_phase_proof #(
    parameter int DSF_BITS = 2,
    parameter int FSF = 1,
    parameter int COUNT_BITS = 0,
    parameter int TRANSLUCENCY = 1,
    parameter int LINEAR_BITS = 0,
    localparam int DsfBits = DSF_BITS > 0 ? DSF_BITS : 1,
    localparam int SamplesBits = COUNT_BITS > 0 ? COUNT_BITS : 1,
    localparam int RestBits = LINEAR_BITS > 0 && COUNT_BITS > 0 ? COUNT_BITS : DsfBits,
    localparam int PassBits = LINEAR_BITS > 0 ? 1 + RestBits : 1
) (
    input wire logic                   clk_i,
    input wire logic                   start_i,
    input wire logic                   take_i,
    input wire logic [            3:0] kind_i,
    input wire logic [    DsfBits-1:0] w_i,
    input wire logic [SamplesBits-1:0] samples_i
);
  // The kinds by docs/stream.md.
  localparam logic [3:0] Op = 4'd6, Sp = 4'd7, Nc = 4'd8, If = 4'd9, Ev = 4'd10, Es = 4'd11, Resolve = 4'd12;
  localparam logic [3:0] Tp = 4'd13, Eol = 4'd14;

  logic in_order, resolved;
  logic [ DsfBits-1:0] bias;
  logic [PassBits-1:0] pass;
  line_phase #(
      .DSF_BITS(DSF_BITS),
      .FSF(FSF),
      .COUNT_BITS(COUNT_BITS),
      .TRANSLUCENCY(TRANSLUCENCY),
      .LINEAR_BITS(LINEAR_BITS)
  ) dut (
      .clk_i,
      .start_i,
      .take_i,
      .kind_i,
      .w_i,
      .samples_i,
      .in_order_o(in_order),
      .resolved_o(resolved),
      .pass_o    (pass),
      .bias_o    (bias)
  );

  // ---- what the line has had ---------------------------------------------------------------------------------------
  logic shadow_q, shadow_since_ev_q, shadow_since_es_q, resolve_q, tp_q;
  logic [ DsfBits-1:0] sum_q;
  logic [PassBits-1:0] told_q;
  logic linear, is_shadow, closed, may;
  assign linear = LINEAR_BITS > 0;
  assign is_shadow = kind_i == Sp || kind_i == Nc || kind_i == If;
  assign closed = !(FSF > 0 && shadow_since_ev_q);
  always_comb begin
    case (kind_i)
      Op: may = !shadow_q && !tp_q;
      Sp, Nc, If: may = (linear || !resolve_q) && !tp_q;
      Ev: may = shadow_since_ev_q && (linear || !resolve_q);
      Es: may = shadow_since_es_q && closed && (linear || !resolve_q);
      Resolve: may = (linear ? !tp_q : shadow_q && !resolve_q) && closed && !(COUNT_BITS > 0 && shadow_since_es_q);
      Tp, Eol: may = !shadow_q || (!linear && resolve_q);
      default: may = 1'b1;  // not of a line
    endcase
  end
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      {shadow_q, shadow_since_ev_q, shadow_since_es_q, resolve_q, tp_q} <= '0;
      sum_q <= '0;
      told_q <= '0;
    end else begin
      if (take_i) begin
        if (is_shadow) {shadow_q, shadow_since_ev_q, shadow_since_es_q} <= '1;
        if (kind_i == Ev) shadow_since_ev_q <= 1'b0;
        if (kind_i == Es) shadow_since_es_q <= 1'b0;
        if (kind_i == Ev || kind_i == Es || kind_i == Tp) sum_q <= '0;
        if (kind_i == If) sum_q <= sum_q + w_i;
        if (kind_i == Resolve) resolve_q <= 1'b1;
        if (kind_i == Resolve && linear) begin  // as if no volume had been there
          {shadow_q, shadow_since_ev_q, shadow_since_es_q} <= '0;
          sum_q <= '0;
          told_q <= PassBits'({COUNT_BITS > 0 ? RestBits'(samples_i) : RestBits'(sum_q), !told_q[0]});
        end
        if (kind_i == Tp) tp_q <= 1'b1;
      end
    end
  end

  // ---- surroundings ------------------------------------------------------------------------------------------------
  logic started_q = 1'b0;
  logic has;  // the configuration has the kind
  always_comb begin
    case (kind_i)
      Sp, Nc, If, Resolve: has = DSF_BITS > 0;
      Ev: has = FSF > 0;
      Es: has = COUNT_BITS > 0;
      Tp: has = TRANSLUCENCY > 0;
      default: has = 1'b1;
    endcase
  end
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    assume (start_i || started_q);
    if (take_i) assume (has && may);
  end

  // ---- the answer --------------------------------------------------------------------------------------------------
  always_comb begin
    if (started_q) begin
      if (has) order : assert (in_order == may);
      resolved_last : assert (resolved == (resolve_q && !tp_q && !(linear && shadow_q)));
      if (linear) pass_told : assert (pass == told_q);
      bias_sum : assert (bias == sum_q);
    end
  end

  // ---- for induction: the phase and the marks are what the kinds say -----------------------------------------------
  (* keep *) logic [1:0] inside_phase, inside_marks;
  always_comb begin
    if (started_q) begin
      lemma_phase :
      assert (inside_phase == (tp_q ? 2'd3 : linear && shadow_q ? 2'd1 : resolve_q ? 2'd2 : shadow_q ? 2'd1 : 2'd0));
      lemma_marks : assert (inside_marks == {COUNT_BITS > 0 && shadow_since_es_q, FSF > 0 && shadow_since_ev_q});
      lemma_since : assert (shadow_q || !(shadow_since_ev_q || shadow_since_es_q || (!linear && resolve_q)));
      lemma_resolved : assert (!(tp_q && shadow_q) || (!linear && resolve_q));
      lemma_closed : assert (linear || !resolve_q || (closed && !(COUNT_BITS > 0 && shadow_since_es_q)));
    end
  end

  // ---- what the rules are about happens within the bound -----------------------------------------------------------
  logic [3:0] taken_q;  // tokens of the line
  logic samples_q;  // it has had two samples, or two volumes
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      taken_q   <= '0;
      samples_q <= 1'b0;
    end else if (take_i && !(&taken_q)) begin
      taken_q <= taken_q + 1'b1;
      if (is_shadow && shadow_q && (COUNT_BITS > 0 ? !shadow_since_es_q : FSF > 0 && !shadow_since_ev_q))
        samples_q <= 1'b1;
    end
  end
  always_comb begin
    if (started_q) begin
      whole_line : cover (take_i && kind_i == Eol && taken_q >= 4'd6);
      out_of_order : cover (has && !may && taken_q >= 4'd4);
      if (DSF_BITS > 0)
        resolved_line : cover (resolved && taken_q >= 4'd5 && (samples_q || (FSF == 0 && COUNT_BITS == 0)));
      if (DSF_BITS > 0 && TRANSLUCENCY > 0) translucent_line : cover (resolve_q && tp_q && kind_i == Eol && take_i);
      if (DSF_BITS > 1) wraps : cover (take_i && kind_i == If && DsfBits'(sum_q + w_i) < sum_q);
    end
  end

endmodule

`default_nettype wire
