// SPDX-License-Identifier: Apache-2.0
// Proof of registers at its ports, for any masters and any events, and a reset at any time (verif/test/formal/run.sh).
//   By induction (MODEL 0): the rules of AXI4-Lite (lite_rules).
//   To a bound (MODEL 1), against a model of docs/stream.md, and further (MODEL 2) with a plain master, which writes
//   whole words, reads nothing, and resets at the start only:
//     interrupt       irq_o is high while a bit of IRQ is set whose bit in CONTROL is, and only then.
//     bites           once as many clocks as WATCHDOG says have passed in a frame without progress, IRQ's WATCHDOG is
//                     set until it is cleared.
//     never_before    it is set at no other moment: not sooner, not twice for one standstill, and not with a limit of
//                     0.
//     value_read      a read gives what the register held in the clock of its address: what was written, counted, or
//                     kept of an error or of a bite; 0 where there is none.
//     read_answer,    SLVERR for addresses past the last register, OKAY for all others.
//     write_answer
// The limit is free, all 32 bits of it: those beyond the bound must not bite within it.
//
// A signal of the core counts a clock later, and a standstill begins anew in the clock after WATCHDOG was written.
// How: the model keeps what has been written, by the handshakes alone, and counts how many clocks the present
// standstill has lasted. It knows nothing of the module's own counter, which stops at the limit.
`default_nettype none

module registers_proof #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int MODEL = 1
) (
    input wire logic        clk_i,
    input wire logic        rst_ni,
    input wire logic        awvalid_i,
    input wire logic [ 7:0] awaddr_i,
    input wire logic        wvalid_i,
    input wire logic [31:0] wdata_i,
    input wire logic [ 3:0] wstrb_i,
    input wire logic        bready_i,
    input wire logic        arvalid_i,
    input wire logic [ 7:0] araddr_i,
    input wire logic        rready_i,
    input wire logic        open_i,
    input wire logic        draining_i,
    input wire logic        waiting_input_i,
    input wire logic        coming_i,
    input wire logic        waiting_output_i,
    input wire logic        progress_i,
    input wire logic        frame_end_i,
    input wire logic        error_i,
    input wire logic [ 3:0] error_code_i,
    input wire logic [31:0] error_frame_i,
    input wire logic [15:0] error_line_i,
    input wire logic [31:0] error_token_i,
    input wire logic [ 5:0] error_unit_i,
    input wire logic        behind_i,
    input wire logic [ 5:0] behind_unit_i,
    input wire logic [14:0] behind_line_i
);
  `include "generated/kage_registers.svh"
  `include "generated/kage_buses.svh"

  error_t  error_in;
  behind_t behind_in;
  always_comb begin
    error_in.code  = error_code_i;
    error_in.frame = error_frame_i;
    error_in.line  = error_line_i;
    error_in.token = error_token_i;
    error_in.unit  = error_unit_i;
    behind_in.unit = behind_unit_i;
    behind_in.line = behind_line_i;
  end

  logic awready, wready, bvalid, arready, rvalid, irq;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata;
  registers dut (
      .clk_i,
      .rst_ni,
      .s_axil_awvalid_i(awvalid_i),
      .s_axil_awready_o(awready),
      .s_axil_awaddr_i (awaddr_i),
      .s_axil_wvalid_i (wvalid_i),
      .s_axil_wready_o (wready),
      .s_axil_wdata_i  (wdata_i),
      .s_axil_wstrb_i  (wstrb_i),
      .s_axil_bvalid_o (bvalid),
      .s_axil_bready_i (bready_i),
      .s_axil_bresp_o  (bresp),
      .s_axil_arvalid_i(arvalid_i),
      .s_axil_arready_o(arready),
      .s_axil_araddr_i (araddr_i),
      .s_axil_rvalid_o (rvalid),
      .s_axil_rready_i (rready_i),
      .s_axil_rdata_o  (rdata),
      .s_axil_rresp_o  (rresp),
      .irq_o           (irq),
      .open_i,
      .draining_i,
      .waiting_input_i,
      .coming_i,
      .waiting_output_i,
      .progress_i,
      .frame_end_i,
      .error_valid_i   (error_i),
      .error_i         (error_in),
      .behind_valid_i  (behind_i),
      .behind_i        (behind_in)
  );
  if (MODEL < 2) begin : gen_axi
    lite_rules axi (
        .clk_i,
        .rst_ni,
        .awvalid_i,
        .awready_i(awready),
        .wvalid_i,
        .wready_i (wready),
        .bvalid_i (bvalid),
        .bready_i,
        .bresp_i  (bresp),
        .arvalid_i,
        .arready_i(arready),
        .rvalid_i (rvalid),
        .rready_i,
        .rdata_i  (rdata),
        .rresp_i  (rresp)
    );
  end

  // ---- surroundings: reset at the start, and whenever it pleases; with MODEL 2 a plain master ----------------------
  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);
  if (MODEL > 1) begin : gen_plain
    always_comb begin
      assume (rst_ni == started_q);
      assume (wvalid_i == awvalid_i && wstrb_i == '1 && awaddr_i[1:0] == '0);
      assume (bready_i && !arvalid_i);
    end
  end

  // The model's registers with fields. Here, because yosys 0.23 finds no field of a struct in a generate block.
  reg_control_t control_q;
  reg_irq_t irq_q, happens, cleared;
  reg_status_t status;
  reg_error_t  newest_q;
  reg_tree_t   tree;
  reg_stall_t stall_q, read_stall;
  logic only_watchdog, only_error;  // may interrupt
  assign only_watchdog = control_q.watchdog && !control_q.error && !control_q.frame_end;
  assign only_error = control_q.error && !control_q.watchdog && !control_q.frame_end;
  if (MODEL > 0) begin : gen_model
    localparam logic [7:0] Past = RegLast + 8'd4;  // the first address without a register

    // ---- what the core said a clock ago, which is what counts ------------------------------------------------------
    logic open, draining, waiting_input, waiting_output, progress, frame_end, error, behind;
    logic [3:0] error_code;
    logic [31:0] error_frame, error_token;
    logic [15:0] error_line;
    logic [5:0] error_unit, behind_unit;
    logic [14:0] behind_line;
    always_ff @(posedge clk_i) begin
      {open, draining, waiting_output} <= {open_i, draining_i, waiting_output_i};
      waiting_input <= waiting_input_i && !coming_i;
      {progress, frame_end, error, behind} <= {progress_i, frame_end_i, error_i, behind_i};
      {error_code, error_frame, error_line} <= {error_code_i, error_frame_i, error_line_i};
      {error_token, error_unit} <= {error_token_i, error_unit_i};
      {behind_unit, behind_line} <= {behind_unit_i, behind_line_i};
      if (!rst_ni) {open, draining, waiting_input, waiting_output, progress, frame_end, error, behind} <= '0;
    end

    // ---- writes: what has been taken, and the clock in which it counts ---------------------------------------------
    logic address_q, data_q, write;
    logic [7:0] at_q;
    logic [31:0] new_q, mask_q;
    assign write = address_q && data_q && !bvalid;
    always_ff @(posedge clk_i) begin
      if (!rst_ni) begin
        address_q <= 1'b0;
        data_q <= 1'b0;
      end else begin
        if (awvalid_i && awready) address_q <= 1'b1;
        else if (write) address_q <= 1'b0;
        if (wvalid_i && wready) data_q <= 1'b1;
        else if (write) data_q <= 1'b0;
      end
      if (awvalid_i && awready) at_q <= awaddr_i;
      if (wvalid_i && wready) begin
        new_q  <= wdata_i;
        mask_q <= {{8{wstrb_i[3]}}, {8{wstrb_i[2]}}, {8{wstrb_i[1]}}, {8{wstrb_i[0]}}};
      end
    end
    function automatic logic [31:0] after(input logic [31:0] old, input logic [7:0] register);
      after = write && at_q[7:2] == register[7:2] ? (old & ~mask_q) | (new_q & mask_q) : old;
    endfunction

    // ---- the watchdog: how long the standstill lasts ---------------------------------------------------------------
    logic [31:0] limit_q;
    logic [ 4:0] still_q;  // clocks of this standstill so far, since the clock after WATCHDOG was last written
    logic bite, anew, anew_q;
    assign anew = write && at_q[7:2] == RegWatchdog[7:2];
    assign bite = open && !progress && !anew_q && limit_q != '0 && 32'(still_q) + 32'd1 == limit_q;

    // ---- all others ------------------------------------------------------------------------------------------------
    logic [31:0] errors_q, frames_q, cycles_q, starved_q, blocked_q, error_frame_q, error_token_q;
    logic [5:0] unit_q;
    assign cleared = write && at_q[7:2] == RegIrq[7:2] ? RegIrqBits'(new_q & mask_q) : '0;
    always_comb begin
      happens.frame_end = frame_end;
      happens.error = error;
      happens.watchdog = bite;
      status.open = open;
      status.draining = draining;
      status.waiting_input = waiting_input;
      status.waiting_output = waiting_output;
      tree = '0;
      if (waiting_input && behind) begin
        tree.behind = 1'b1;
        tree.line   = behind_line;
        tree.unit   = behind_unit;
      end
    end
    always_ff @(posedge clk_i) begin
      control_q <= RegControlBits'(after(32'(control_q), RegControl));
      limit_q   <= after(limit_q, RegWatchdog);
      still_q   <= open && !progress && !anew && !anew_q ? still_q + 5'd1 : '0;
      anew_q    <= rst_ni && anew;
      irq_q     <= (irq_q & ~cleared) | happens;
      cycles_q  <= cycles_q + 32'd1;
      if (frame_end) frames_q <= frames_q + 32'd1;
      if (error) errors_q <= errors_q + 32'd1;
      if (waiting_input) starved_q <= starved_q + 32'd1;
      if (waiting_output) blocked_q <= blocked_q + 32'd1;
      if (error) begin
        newest_q.line <= error_line;
        newest_q.code <= error_code;
        error_frame_q <= error_frame;
        error_token_q <= error_token;
        unit_q <= error_unit;
      end
      if (bite) begin
        stall_q.behind <= tree.behind;
        stall_q.line <= behind_line;
        stall_q.on_output <= waiting_output;
        stall_q.on_input <= waiting_input;
        stall_q.unit <= tree.unit;
      end
      if (!rst_ni) begin
        {control_q, limit_q, still_q, irq_q, cycles_q, frames_q, errors_q, starved_q, blocked_q} <= '0;
        {newest_q, error_frame_q, error_token_q, unit_q, stall_q} <= '0;
      end
    end

    // ---- reads: what the register holds in the clock of its address ------------------------------------------------
    logic [31:0] value, value_q;
    logic known, known_q;  // PARAM_HASH and SHAPE follow from parameters
    logic [7:0] asked_q;
    always_comb begin
      value = '0;
      known = 1'b1;
      case ({
        araddr_i[7:2], 2'b00
      })
        RegId: value = 32'h4b414745;
        RegVersion: value = 32'd1;
        RegParamHash, RegShape: known = 1'b0;
        RegControl: value = 32'(control_q);
        RegIrq: value = 32'(irq_q);
        RegWatchdog: value = limit_q;
        RegStatus: value = 32'(status);
        RegError: value = newest_q;
        RegErrorFrame: value = error_frame_q;
        RegErrorToken: value = error_token_q;
        RegErrors: value = errors_q;
        RegFrames: value = frames_q;
        RegCycles: value = cycles_q;
        RegStarved: value = starved_q;
        RegBlocked: value = blocked_q;
        RegErrorUnit: value = 32'(unit_q);
        RegTree: value = tree;
        RegStall: value = stall_q;
        RegCapability: value = 32'h00010000;  // the proof's core has no front end
        default: value = '0;
      endcase
    end
    logic answer_bad_q;
    always_ff @(posedge clk_i) begin
      if (arvalid_i && arready) begin
        asked_q <= araddr_i;
        value_q <= value;
        known_q <= known;
      end
      if (write) answer_bad_q <= at_q >= Past;
    end

    assign read_stall = value_q;

    // A bite, whatever has been cleared since, and clocks of the standstill that went on behind it.
    logic bitten_q, cleared_q, again_q;
    always_ff @(posedge clk_i) begin
      bitten_q  <= rst_ni && (bitten_q || bite);
      cleared_q <= rst_ni && (cleared_q || (irq_q.watchdog && cleared.watchdog));
      again_q   <= rst_ni && (again_q || (bite && cleared_q));
    end
    always_comb begin
      if (rst_ni && started_q) begin
        interrupt : assert (irq == ((irq_q & control_q) != '0));
        if (control_q.watchdog && irq_q.watchdog) bites : assert (irq);
        if (only_watchdog && !irq_q.watchdog) never_before : assert (!irq);
        if (rvalid && known_q) value_read : assert (rdata == value_q);
        if (rvalid) read_answer : assert (rresp == (asked_q >= Past ? 2'b10 : 2'b00));
        if (bvalid) write_answer : assert (bresp == (answer_bad_q ? 2'b10 : 2'b00));
      end
    end

    // ---- what the rules are about happens within the bound ---------------------------------------------------------
    always_comb begin
      if (rst_ni && started_q) begin
        bite_at_once : cover (irq && only_watchdog && limit_q == 32'd1);
        bite_in_three : cover (irq && only_watchdog && limit_q == 32'd3);
        other_irq : cover (irq && only_error);
        no_second_bite : cover (cleared_q && still_q == 5'd3 && limit_q == 32'd1 && !irq_q.watchdog);
        second_bite : cover (again_q && irq_q.watchdog);
        if (MODEL == 1)
          bite_read : cover (rvalid && asked_q == RegStall && read_stall.on_output && read_stall.on_input && bitten_q);
        if (MODEL == 1)
          partly_written : cover (limit_q[15:0] == 16'h0100 && limit_q[31:16] == '0 && mask_q == 32'h0000ff00);
        if (MODEL == 1) past_read : cover (rvalid && rresp == 2'b10);
        past_written : cover (bvalid && bresp == 2'b10);
      end
    end
  end

endmodule

`default_nettype wire
