// SPDX-License-Identifier: Apache-2.0
// The registers of docs/stream.md on AXI4-Lite, the interrupt, the counters and the watchdog.
//
// Handshake: AXI4-Lite. Address and data of a write are taken in either order, and held. A write is done, and answered,
//   in the clock in which both are held and no response waits. So the next write's address and data are taken while the
//   response before waits, and that write is done once the response has been taken. One read is under way at a time:
//   the next address is taken when the data of the one before have been. Addresses without a register answer SLVERR and
//   change nothing; writes to read-only registers are taken and ignored. WSTRB is honoured. In reset nothing is ready.
// Latency: 1 clock from the address to a read's data, 2 from the later of address and data to a write's response.
// Throughput: a read and a write in two clocks each, beside each other.
// Interrupt: irq_o is high while a bit of IRQ is set whose bit in CONTROL is set. An event that comes in the clock of
//   its clearing wins.
// The core's signals are registered here first, so that counters add nothing to the core's paths. Registers, interrupt
//   and watchdog are therefore one clock late.
// Cost: the registers, most of them of 32 bits; an adder for each counter; a second set of flip-flops for the core's
//   signals. The PARTS bits of progress_i are joined behind theirs, so that the parts' paths end where they are.
// Watchdog: bites once when WATCHDOG clocks have passed in a frame without progress; progress, or a write to it, starts
//   it anew, a write a clock later. Any limit from 1 on will do: kage_top sees to it that whatever moves is progress.
`default_nettype none

module registers #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter int PARTS = 1,
    `include "generated/kage_impl_params.svh"
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    `include "kage_axil_ports.svh"

    output logic irq_o,

    // from the core
    input wire logic                  open_i,            // a frame is open, or pixels of one have not left
    input wire logic                  draining_i,
    input wire logic                  waiting_input_i,   // unless coming_i
    input wire logic                  coming_i,          // something in the front end comes to what waits for input
    input wire logic                  waiting_output_i,
    input wire logic [     PARTS-1:0] progress_i,        // which parts of the core something moves in
    input wire logic                  frame_end_i,
    input wire logic                  error_valid_i,
    input wire logic [ ErrorBits-1:0] error_i,
    input wire logic                  behind_valid_i,    // a unit has less of the frame than another
    input wire logic [BehindBits-1:0] behind_i
);
  `include "generated/kage_layout.svh"
  `include "generated/kage_registers.svh"
  `include "generated/kage_buses.svh"

  // ---- what the core says ------------------------------------------------------------------------------------------
  logic open_q, draining_q, asking_q, coming_q, waiting_output_q, frame_end_q, error_valid_q, behind_valid_q;
  logic progress, waiting_input;
  logic [PARTS-1:0] progress_q;
  error_t error_q;
  behind_t behind_q;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      {open_q, draining_q, asking_q, coming_q, waiting_output_q} <= '0;
      {progress_q, frame_end_q, error_valid_q, behind_valid_q}   <= '0;
    end else begin
      {open_q, draining_q, asking_q, coming_q, waiting_output_q} <= {
        open_i, draining_i, waiting_input_i, coming_i, waiting_output_i
      };
      {progress_q, frame_end_q, error_valid_q, behind_valid_q} <= {
        progress_i, frame_end_i, error_valid_i, behind_valid_i
      };
    end
    error_q  <= error_i;
    behind_q <= behind_i;
  end
  assign progress = progress_q != '0;
  assign waiting_input = asking_q && !coming_q;

  localparam logic [1:0] RespOkay = 2'b00;
  localparam logic [1:0] RespSlverr = 2'b10;

  // ---- write channel -----------------------------------------------------------------------------------------------
  logic aw_held_q, w_held_q, write;
  logic [7:0] aw_addr_q;
  logic [31:0] w_data_q, w_mask, written;  // written: the bits that a write sets
  logic [3:0] w_strb_q;
  assign s_axil_awready_o = rst_ni && !aw_held_q;
  assign s_axil_wready_o = rst_ni && !w_held_q;
  assign write = aw_held_q && w_held_q && !s_axil_bvalid_o;
  assign written = w_data_q & w_mask;
  assign w_mask = {{8{w_strb_q[3]}}, {8{w_strb_q[2]}}, {8{w_strb_q[1]}}, {8{w_strb_q[0]}}};

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      aw_held_q <= 1'b0;
      w_held_q <= 1'b0;
      s_axil_bvalid_o <= 1'b0;
    end else begin
      if (s_axil_awvalid_i && s_axil_awready_o) aw_held_q <= 1'b1;
      if (s_axil_wvalid_i && s_axil_wready_o) w_held_q <= 1'b1;
      if (s_axil_bvalid_o && s_axil_bready_i) s_axil_bvalid_o <= 1'b0;
      if (write) begin
        aw_held_q <= 1'b0;
        w_held_q <= 1'b0;
        s_axil_bvalid_o <= 1'b1;
      end
    end
    if (s_axil_awready_o) aw_addr_q <= s_axil_awaddr_i;
    if (s_axil_wready_o) w_data_q <= s_axil_wdata_i;
    if (s_axil_wready_o) w_strb_q <= s_axil_wstrb_i;
    if (write) s_axil_bresp_o <= aw_addr_q > RegLast + 8'd3 ? RespSlverr : RespOkay;
  end

  // ---- registers ---------------------------------------------------------------------------------------------------
  reg_irq_t irq_set, irq_q;
  reg_control_t control_q;
  // idle_q counts clocks without progress. Comparing 32 bits takes a clock of its own: before_last_q is limit_q - 2, a
  // clock late; at_limit_q says that idle_q was that a clock ago, so it is limit_q - 1 unless it began anew (fresh_q).
  logic [31:0] limit_q, before_last_q, idle_q;
  logic limited_q, limit_new_q, limit_one_q, at_limit_q, fresh_q, bitten_q, anew;
  logic [31:0] error_frame_q, error_token_q, errors_q, frames_q, cycles_q, starved_q, blocked_q;
  logic [RegErrorLineBits-1:0] error_line_q;
  logic [CodeBits-1:0] error_code_q;
  logic [UnitNumberBits-1:0] error_unit_q;
  reg_stall_t stall_q;
  logic bite, unit_waited, write_control, write_irq, write_limit;

  assign write_control = write && aw_addr_q[7:2] == RegControl[7:2];
  assign write_irq = write && aw_addr_q[7:2] == RegIrq[7:2];
  assign write_limit = write && aw_addr_q[7:2] == RegWatchdog[7:2];
  assign bite = limited_q && open_q && !progress && !limit_new_q && !bitten_q &&
      (limit_one_q || (at_limit_q && !fresh_q));
  assign anew = write_limit || limit_new_q || progress || !open_q;
  assign unit_waited = waiting_input && behind_valid_q;
  always_comb begin
    irq_set.frame_end = frame_end_q;
    irq_set.error = error_valid_q;
    irq_set.watchdog = bite;
  end
  assign irq_o = (irq_q & control_q) != '0;

  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      control_q <= '0;
      irq_q <= '0;
      limit_q <= '0;
      limited_q <= 1'b0;
      limit_new_q <= 1'b0;
      idle_q <= '0;
      bitten_q <= 1'b0;
      error_code_q <= ErrNone;
      error_line_q <= '0;
      error_frame_q <= '0;
      error_token_q <= '0;
      error_unit_q <= '0;
      stall_q <= '0;
      errors_q <= '0;
      frames_q <= '0;
      cycles_q <= '0;
      starved_q <= '0;
      blocked_q <= '0;
    end else begin
      if (write_control) control_q <= (control_q & ~w_mask[RegIrqBits-1:0]) | written[RegIrqBits-1:0];
      if (write_limit) limit_q <= (limit_q & ~w_mask) | written;
      irq_q <= irq_set | (write_irq ? irq_q & ~written[RegIrqBits-1:0] : irq_q);
      limited_q <= limit_q != '0;
      limit_new_q <= write_limit;
      if (anew) begin
        idle_q   <= '0;
        bitten_q <= 1'b0;
      end else begin
        if (limited_q && !bitten_q) idle_q <= idle_q + 32'd1;
        if (bite) bitten_q <= 1'b1;  // one bite for one standstill
      end
      if (error_valid_q) begin
        error_code_q <= error_q.code;
        error_line_q <= error_q.line;
        error_frame_q <= error_q.frame;
        error_token_q <= error_q.token;
        error_unit_q <= error_q.unit;
        errors_q <= errors_q + 32'd1;
      end
      if (bite) begin
        stall_q.behind <= unit_waited;
        stall_q.line <= behind_q.line;
        stall_q.on_output <= waiting_output_q;
        stall_q.on_input <= waiting_input;
        stall_q.unit <= unit_waited ? behind_q.unit : '0;
      end
      if (frame_end_q) frames_q <= frames_q + 32'd1;
      cycles_q <= cycles_q + 32'd1;
      if (waiting_input) starved_q <= starved_q + 32'd1;
      if (waiting_output_q) blocked_q <= blocked_q + 32'd1;
    end
    before_last_q <= limit_q - 32'd2;
    limit_one_q <= limit_q == 32'd1;
    at_limit_q <= idle_q == before_last_q;
    fresh_q <= anew || !rst_ni;
  end

  // ---- read channel ------------------------------------------------------------------------------------------------
  logic [31:0] value;
  reg_shape_t shape;
  reg_status_t status;
  reg_error_t error;
  reg_tree_t tree;
  reg_capability_t capability;
  always_comb begin
    shape = '0;
    shape.arrangement = 1'(ARRANGEMENT);
    shape.beat_words = RegShapeBeatWordsBits'(BEAT_WORDS);
    shape.lanes = RegShapeLanesBits'(LANES);
    shape.max_width = RegShapeMaxWidthBits'(MAX_WIDTH);
    status.open = open_q;
    status.draining = draining_q;
    status.waiting_input = waiting_input;
    status.waiting_output = waiting_output_q;
    capability = '0;
    capability.active = RegCapabilityActiveBits'(ACTIVE);
    capability.spans = 1'b1;
    capability.polygons = ACTIVE > 0;
    error = '0;
    error.code = error_code_q;
    error.line = error_line_q;
    tree = '0;
    tree.behind = unit_waited;
    tree.line = unit_waited ? behind_q.line : '0;
    tree.unit = unit_waited ? behind_q.unit : '0;
  end
  always_comb begin
    unique case ({
      s_axil_araddr_i[7:2], 2'b00
    })
      RegId: value = IdValue;
      RegVersion: value = 32'(StreamVersion);
      RegParamHash: value = ParamHash;
      RegShape: value = shape;
      RegControl: value = 32'(control_q);
      RegIrq: value = 32'(irq_q);
      RegWatchdog: value = limit_q;
      RegStatus: value = 32'(status);
      RegError: value = error;
      RegErrorFrame: value = error_frame_q;
      RegErrorToken: value = error_token_q;
      RegErrors: value = errors_q;
      RegFrames: value = frames_q;
      RegCycles: value = cycles_q;
      RegStarved: value = starved_q;
      RegBlocked: value = blocked_q;
      RegErrorUnit: value = 32'(error_unit_q);
      RegTree: value = tree;
      RegStall: value = stall_q;
      RegCapability: value = 32'(capability);
      default: value = '0;
    endcase
  end

  assign s_axil_arready_o = rst_ni && !s_axil_rvalid_o;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) begin
      s_axil_rvalid_o <= 1'b0;
    end else begin
      if (s_axil_rvalid_o && s_axil_rready_i) s_axil_rvalid_o <= 1'b0;
      if (s_axil_arvalid_i && s_axil_arready_o) s_axil_rvalid_o <= 1'b1;
    end
    if (s_axil_arready_o) s_axil_rdata_o <= value;
    if (s_axil_arready_o) s_axil_rresp_o <= s_axil_araddr_i > RegLast + 8'd3 ? RespSlverr : RespOkay;
  end

endmodule

`default_nettype wire
