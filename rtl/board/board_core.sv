// SPDX-License-Identifier: Apache-2.0
// Everything of a board that is not the vendor's: kage_top, fed by a player from a memory that a host fills over a
// serial line, its lines signed, and its picture on a screen (docs/boards.md). A board's top, in constraints/boards,
// adds clocks and pins.
//
//   rx -> uart_receiver -> async_fifo -> uart_link -> board_registers -> kage_top's registers
//   tx <- uart_transmitter <- async_fifo <-'  '-> memory -> stream_player -> kage_top -> video_out -> screen
//                                                                              '-> line_signature, line_capture
//
// Clocks: the core's (clk_i), the UART's, and, where there are an SDRAM and a screen, the memory's and the pixel's.
//   They cross by async_fifo alone. Each has a reset of its own, synchronous and active low; all are asserted together
//   for three clocks of the slowest at least, and released in any order (reset_release).
// MEMORY 0: block RAM of MEMORY_WORDS. 1: an SDRAM, of ROW_BITS, COLUMN_BITS and BANK_BITS.
// SCREEN 0: no screen; the core's pixels are taken at once. 1: a screen of H_... and V_....
// CAPTURE 0: no line_capture, so a line that is wrong is known by its signature alone; 1: its pixels can be read.
// LEDs, high is on. 0: the core's clock runs (blinks). 1: the player is in a list. 2: lines were compared and all were
//   right. 3: one was wrong. 4: the screen had to repeat a colour. 5: no host has greeted since reset. 6: the memory is
//   set up. 7: the core's interrupt.
// Latency, throughput: a frame moves at the pace of the slowest of memory, core and screen; each module says its own.
// Cost: docs/boards.md.
`default_nettype none
`include "kage_illegal.svh"

module board_core #(
    `include "generated/kage_pixel_params.svh"
    `include "generated/kage_widths.svh"
    parameter logic [31:0] BOARD_NAME = "NONE",
    parameter int UART_HZ = 25_000_000,
    parameter int BAUD = 3_000_000,
    parameter int MEMORY = 0,
    parameter int MEMORY_WORDS = 4096,
    parameter int SDRAM_HZ = 100_000_000,
    parameter int ROW_BITS = 13,
    parameter int COLUMN_BITS = 9,
    parameter int BANK_BITS = 2,
    parameter int CAS_LATENCY = 3,
    parameter int READ_DELAY = CAS_LATENCY,
    parameter int T_INIT = 200_000,
    parameter int LINES = 512,
    parameter int CAPTURE = 1,
    parameter int SCREEN = 1,
    parameter int H_ACTIVE = 640,
    parameter int H_FRONT = 16,
    parameter int H_SYNC = 96,
    parameter int H_BACK = 48,
    parameter int V_ACTIVE = 480,
    parameter int V_FRONT = 10,
    parameter int V_SYNC = 2,
    parameter int V_BACK = 33,
    parameter int H_POSITIVE = 0,
    parameter int V_POSITIVE = 0,
    parameter int LED_BITS = 22,
    localparam int AddrBits = MEMORY == 1 ? ROW_BITS + COLUMN_BITS + BANK_BITS - 1 : $clog2(MEMORY_WORDS),
    `include "generated/kage_impl_params.svh"
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // serial line
    input  wire logic uart_clk_i,
    input  wire logic uart_rst_ni,
    input  wire logic rx_i,
    output logic      tx_o,

    // SDRAM
    input  wire logic                 mem_clk_i,
    input  wire logic                 mem_rst_ni,
    output logic                      sdram_cke_o,
    output logic                      sdram_cs_no,
    output logic                      sdram_ras_no,
    output logic                      sdram_cas_no,
    output logic                      sdram_we_no,
    output logic      [BANK_BITS-1:0] sdram_ba_o,
    output logic      [ ROW_BITS-1:0] sdram_a_o,
    output logic      [          1:0] sdram_dqm_o,
    output logic      [         15:0] sdram_dq_o,
    output logic                      sdram_dq_oe_o,
    input  wire logic [         15:0] sdram_dq_i,

    // screen
    input  wire logic        pix_clk_i,
    input  wire logic        pix_rst_ni,
    output logic             active_o,
    output logic             hsync_o,
    output logic             vsync_o,
    output logic      [23:0] rgb_o,

    output logic [7:0] led_o
);
  localparam int Pixels = CAPTURE == 0 ? 0 : MAX_WIDTH > 4096 ? 4096 : MAX_WIDTH;
  localparam int PixelAddrBits = Pixels > 1 ? $clog2(Pixels) : 1;

  // ---- the serial line ---------------------------------------------------------------------------------------------
  logic framing_error, rx_valid, rx_taken, rx_ready, rx_word_valid, tx_valid, tx_ready, tx_word_valid, tx_word_ready;
  logic [7:0] rx_data, rx_word, tx_data, tx_word;
  uart_receiver #(
      .CLOCK_HZ(UART_HZ),
      .BAUD    (BAUD)
  ) u_receiver (
      .clk_i          (uart_clk_i),
      .rst_ni         (uart_rst_ni),
      .rx_i,
      .valid_o        (rx_valid),
      .data_o         (rx_data),
      .framing_error_o(framing_error)
  );
  // The link takes a byte a clock, so this FIFO is never full. A byte lost here makes the frame's CRC wrong.
  async_fifo #(
      .BITS (8),
      .DEPTH(16)
  ) u_rx_fifo (
      .in_clk_i   (uart_clk_i),
      .in_rst_ni  (uart_rst_ni),
      .in_valid_i (rx_valid),
      .in_ready_o (rx_taken),
      .in_data_i  (rx_data),
      .out_clk_i  (clk_i),
      .out_rst_ni (rst_ni),
      .out_valid_o(rx_word_valid),
      .out_ready_i(rx_ready),
      .out_data_o (rx_word)
  );
  async_fifo #(
      .BITS (8),
      .DEPTH(16)
  ) u_tx_fifo (
      .in_clk_i   (clk_i),
      .in_rst_ni  (rst_ni),
      .in_valid_i (tx_word_valid),
      .in_ready_o (tx_word_ready),
      .in_data_i  (tx_word),
      .out_clk_i  (uart_clk_i),
      .out_rst_ni (uart_rst_ni),
      .out_valid_o(tx_valid),
      .out_ready_i(tx_ready),
      .out_data_o (tx_data)
  );
  uart_transmitter #(
      .CLOCK_HZ(UART_HZ),
      .BAUD    (BAUD)
  ) u_transmitter (
      .clk_i  (uart_clk_i),
      .rst_ni (uart_rst_ni),
      .valid_i(tx_valid),
      .ready_o(tx_ready),
      .data_i (tx_data),
      .tx_o
  );

  logic awvalid, awready, wvalid, wready, bvalid, bready, arvalid, arready, rvalid, rready;
  logic [15:0] awaddr, araddr;
  logic [31:0] wdata, rdata;
  logic [3:0] wstrb;
  logic [1:0] bresp, rresp;
  logic stream_valid, stream_ready, fresh, axi_error, overrun;
  logic [31:0] stream_data;
  logic [15:0] link_good, link_bad, link_overruns;
  uart_link u_link (
      .clk_i,
      .rst_ni,
      .rx_valid_i      (rx_word_valid),
      .rx_ready_o      (rx_ready),
      .rx_data_i       (rx_word),
      .tx_valid_o      (tx_word_valid),
      .tx_ready_i      (tx_word_ready),
      .tx_data_o       (tx_word),
      .m_axil_awvalid_o(awvalid),
      .m_axil_awready_i(awready),
      .m_axil_awaddr_o (awaddr),
      .m_axil_wvalid_o (wvalid),
      .m_axil_wready_i (wready),
      .m_axil_wdata_o  (wdata),
      .m_axil_wstrb_o  (wstrb),
      .m_axil_bvalid_i (bvalid),
      .m_axil_bready_o (bready),
      .m_axil_bresp_i  (bresp),
      .m_axil_arvalid_o(arvalid),
      .m_axil_arready_i(arready),
      .m_axil_araddr_o (araddr),
      .m_axil_rvalid_i (rvalid),
      .m_axil_rready_o (rready),
      .m_axil_rdata_i  (rdata),
      .m_axil_rresp_i  (rresp),
      .m_axis_tvalid_o (stream_valid),
      .m_axis_tready_i (stream_ready),
      .m_axis_tdata_o  (stream_data),
      .fresh_o         (fresh),
      .axi_error_o     (axi_error),
      .overrun_o       (overrun),
      .good_frames_o   (link_good),
      .bad_frames_o    (link_bad),
      .overruns_o      (link_overruns)
  );

  // ---- registers ---------------------------------------------------------------------------------------------------
  logic hold, loop_list, paced, check, direct, start, stop, load_set, playing, memory_ready, irq;
  logic [31:0] load_address, play_address, load_next, words_crc;
  logic [15:0]
      capture_line,
      played,
      lines,
      mismatches,
      loop_lines,
      video_lines,
      mismatch_place,
      captured,
      frames_shown,
      late_frames;
  logic [15:0] underrun_frames, underrun_lines;
  logic signature_wr_en;
  logic [$clog2(LINES)-1:0] signature_addr;
  logic [31:0] signature_wr_data, signature_rd_data, pixel_rd_data;
  logic [PixelAddrBits-1:0] pixel_addr;
  logic core_awvalid, core_awready, core_wvalid, core_wready, core_bvalid, core_bready, core_arvalid, core_arready;
  logic core_rvalid, core_rready;
  logic [7:0] core_awaddr, core_araddr;
  logic [31:0] core_wdata, core_rdata;
  logic [3:0] core_wstrb;
  logic [1:0] core_bresp, core_rresp;
  board_registers #(
      .BOARD_NAME   (BOARD_NAME),
      .MEMORY_WORDS (2 ** AddrBits),
      .LINES        (LINES),
      .PIXELS       (Pixels),
      .SCREEN_WIDTH (SCREEN == 1 ? H_ACTIVE : 0),
      .SCREEN_HEIGHT(SCREEN == 1 ? V_ACTIVE : 0)
  ) u_registers (
      .clk_i,
      .rst_ni,
      .s_axil_awvalid_i   (awvalid),
      .s_axil_awready_o   (awready),
      .s_axil_awaddr_i    (awaddr),
      .s_axil_wvalid_i    (wvalid),
      .s_axil_wready_o    (wready),
      .s_axil_wdata_i     (wdata),
      .s_axil_wstrb_i     (wstrb),
      .s_axil_bvalid_o    (bvalid),
      .s_axil_bready_i    (bready),
      .s_axil_bresp_o     (bresp),
      .s_axil_arvalid_i   (arvalid),
      .s_axil_arready_o   (arready),
      .s_axil_araddr_i    (araddr),
      .s_axil_rvalid_o    (rvalid),
      .s_axil_rready_i    (rready),
      .s_axil_rdata_o     (rdata),
      .s_axil_rresp_o     (rresp),
      .m_axil_awvalid_o   (core_awvalid),
      .m_axil_awready_i   (core_awready),
      .m_axil_awaddr_o    (core_awaddr),
      .m_axil_wvalid_o    (core_wvalid),
      .m_axil_wready_i    (core_wready),
      .m_axil_wdata_o     (core_wdata),
      .m_axil_wstrb_o     (core_wstrb),
      .m_axil_bvalid_i    (core_bvalid),
      .m_axil_bready_o    (core_bready),
      .m_axil_bresp_i     (core_bresp),
      .m_axil_arvalid_o   (core_arvalid),
      .m_axil_arready_i   (core_arready),
      .m_axil_araddr_o    (core_araddr),
      .m_axil_rvalid_i    (core_rvalid),
      .m_axil_rready_o    (core_rready),
      .m_axil_rdata_i     (core_rdata),
      .m_axil_rresp_i     (core_rresp),
      .hold_o             (hold),
      .loop_o             (loop_list),
      .paced_o            (paced),
      .check_o            (check),
      .direct_o           (direct),
      .start_o            (start),
      .stop_o             (stop),
      .load_set_o         (load_set),
      .load_address_o     (load_address),
      .play_address_o     (play_address),
      .loop_lines_o       (loop_lines),
      .capture_line_o     (capture_line),
      .video_lines_o      (video_lines),
      .playing_i          (playing),
      .memory_ready_i     (memory_ready),
      .irq_i              (irq),
      .load_next_i        (load_next),
      .words_crc_i        (words_crc),
      .played_i           (played),
      .lines_i            (lines),
      .mismatches_i       (mismatches),
      .mismatch_place_i   (mismatch_place),
      .captured_i         (captured),
      .frames_shown_i     (frames_shown),
      .late_frames_i      (late_frames),
      .underrun_frames_i  (underrun_frames),
      .underrun_lines_i   (underrun_lines),
      .link_good_i        (link_good),
      .link_bad_i         (link_bad),
      .link_overruns_i    (link_overruns),
      .signature_wr_en_o  (signature_wr_en),
      .signature_addr_o   (signature_addr),
      .signature_wr_data_o(signature_wr_data),
      .signature_rd_data_i(signature_rd_data),
      .pixel_addr_o       (pixel_addr),
      .pixel_rd_data_i    (pixel_rd_data)
  );

  // ---- the memory: the link's words go in one by one, the player reads runs ----------------------------------------
  logic wr_valid, wr_ready, run_valid, run_ready, rd_valid, rd_ready, direct_ready;
  logic [AddrBits-1:0] wr_addr_q, run_addr;
  logic [15:0] run_words;
  logic [31:0] rd_data;
  assign wr_valid     = stream_valid && !direct;
  assign stream_ready = direct ? direct_ready : wr_ready;
  assign load_next    = 32'(wr_addr_q);
  always_ff @(posedge clk_i) begin
    if (load_set) wr_addr_q <= load_address[AddrBits-1:0];
    else if (wr_valid && wr_ready) wr_addr_q <= wr_addr_q + 1'b1;
  end
  if (MEMORY == 1) begin : gen_sdram
    // From a flip-flop: what comes out of logic may glitch.
    logic mem_ready, mem_ready_q;
    always_ff @(posedge mem_clk_i) mem_ready_q <= mem_ready && mem_rst_ni;
    synchronizer u_ready (
        .clk_i,
        .rst_ni,
        .in_i (mem_ready_q),
        .out_o(memory_ready)
    );
    sdram_memory #(
        .CLOCK_HZ   (SDRAM_HZ),
        .ROW_BITS   (ROW_BITS),
        .COLUMN_BITS(COLUMN_BITS),
        .BANK_BITS  (BANK_BITS),
        .CAS_LATENCY(CAS_LATENCY),
        .READ_DELAY (READ_DELAY),
        .T_INIT     (T_INIT)
    ) u_memory (
        .clk_i,
        .rst_ni,
        .wr_valid_i (wr_valid),
        .wr_ready_o (wr_ready),
        .wr_addr_i  (wr_addr_q),
        .wr_data_i  (stream_data),
        .run_valid_i(run_valid),
        .run_ready_o(run_ready),
        .run_addr_i (run_addr),
        .run_words_i(run_words),
        .rd_valid_o (rd_valid),
        .rd_ready_i (rd_ready),
        .rd_data_o  (rd_data),
        .mem_clk_i,
        .mem_rst_ni,
        .mem_ready_o(mem_ready),
        .sdram_cke_o,
        .sdram_cs_no,
        .sdram_ras_no,
        .sdram_cas_no,
        .sdram_we_no,
        .sdram_ba_o,
        .sdram_a_o,
        .sdram_dqm_o,
        .sdram_dq_o,
        .sdram_dq_oe_o,
        .sdram_dq_i
    );
  end else begin : gen_block
    block_memory #(
        .WORDS    (MEMORY_WORDS),
        .ADDR_BITS(AddrBits)
    ) u_memory (
        .clk_i,
        .rst_ni,
        .wr_valid_i (wr_valid),
        .wr_ready_o (wr_ready),
        .wr_addr_i  (wr_addr_q),
        .wr_data_i  (stream_data),
        .run_valid_i(run_valid),
        .run_ready_o(run_ready),
        .run_addr_i (run_addr),
        .run_words_i(run_words),
        .rd_valid_o (rd_valid),
        .rd_ready_i (rd_ready),
        .rd_data_o  (rd_data)
    );
    assign memory_ready = 1'b1;
    assign {sdram_cke_o, sdram_dq_oe_o, sdram_ba_o, sdram_a_o, sdram_dqm_o, sdram_dq_o} = '0;
    assign {sdram_cs_no, sdram_ras_no, sdram_cas_no, sdram_we_no} = '1;
    logic unused;
    assign unused = &{1'b0, mem_clk_i, mem_rst_ni, sdram_dq_i, 1'(SDRAM_HZ), 1'(READ_DELAY), 1'(T_INIT)};
  end

  // ---- player and core, which the host can hold in reset -----------------------------------------------------------
  logic core_rst_n_q = 1'b0;
  always_ff @(posedge clk_i) core_rst_n_q <= rst_ni && !hold;

  logic s_valid, s_ready, s_last, m_valid, m_ready, m_user, m_last, word, req_valid, req_ready;
  logic [BEAT_WORDS*32-1:0] s_data;
  logic [RgbBits-1:0] m_data;
  logic [31:0] word_data;
  stream_player #(
      .ADDR_BITS (AddrBits),
      .BEAT_WORDS(BEAT_WORDS)
  ) u_player (
      .clk_i,
      .rst_ni           (core_rst_n_q),
      .start_i          (start),
      .stop_i           (stop),
      .direct_i         (direct),
      .loop_i           (loop_list),
      .paced_i          (paced),
      .address_i        (play_address[AddrBits-1:0]),
      .playing_o        (playing),
      .played_o         (played),
      .word_o           (word),
      .data_o           (word_data),
      .frame_req_valid_i(req_valid),
      .frame_req_ready_o(req_ready),
      .run_valid_o      (run_valid),
      .run_ready_i      (run_ready),
      .run_addr_o       (run_addr),
      .run_words_o      (run_words),
      .rd_valid_i       (rd_valid),
      .rd_ready_o       (rd_ready),
      .rd_data_i        (rd_data),
      .link_valid_i     (stream_valid),
      .link_ready_o     (direct_ready),
      .link_data_i      (stream_data),
      .m_axis_tvalid_o  (s_valid),
      .m_axis_tready_i  (s_ready),
      .m_axis_tdata_o   (s_data),
      .m_axis_tlast_o   (s_last)
  );
  // One check serves both: no word is loaded that counts while a list is played.
  crc32_words u_crc (
      .clk_i,
      .rst_ni,
      .clear_i(load_set || start),
      .word_i (playing ? word : wr_valid && wr_ready),
      .data_i (playing ? word_data : stream_data),
      .crc_o  (words_crc)
  );
  kage_top #(
      `include "generated/kage_impl_param_map.svh"
      `include "generated/kage_pixel_param_map.svh"
  ) u_kage (
      .clk_i,
      .rst_ni          (core_rst_n_q),
      .s_axis_tvalid_i (s_valid),
      .s_axis_tready_o (s_ready),
      .s_axis_tdata_i  (s_data),
      .s_axis_tlast_i  (s_last),
      .m_axis_tvalid_o (m_valid),
      .m_axis_tready_i (m_ready),
      .m_axis_tdata_o  (m_data),
      .m_axis_tuser_o  (m_user),
      .m_axis_tlast_o  (m_last),
      .s_axil_awvalid_i(core_awvalid),
      .s_axil_awready_o(core_awready),
      .s_axil_awaddr_i (core_awaddr),
      .s_axil_wvalid_i (core_wvalid),
      .s_axil_wready_o (core_wready),
      .s_axil_wdata_i  (core_wdata),
      .s_axil_wstrb_i  (core_wstrb),
      .s_axil_bvalid_o (core_bvalid),
      .s_axil_bready_i (core_bready),
      .s_axil_bresp_o  (core_bresp),
      .s_axil_arvalid_i(core_arvalid),
      .s_axil_arready_o(core_arready),
      .s_axil_araddr_i (core_araddr),
      .s_axil_rvalid_o (core_rvalid),
      .s_axil_rready_i (core_rready),
      .s_axil_rdata_o  (core_rdata),
      .s_axil_rresp_o  (core_rresp),
      .irq_o           (irq)
  );

  // ---- what comes out ----------------------------------------------------------------------------------------------
  logic beat;
  assign beat = m_valid && m_ready;
  line_signature #(
      .CHANNELS(CHANNELS),
      .LINES   (LINES)
  ) u_signature (
      .clk_i,
      .rst_ni          (core_rst_n_q),
      .beat_i          (beat),
      .data_i          (m_data),
      .user_i          (m_user),
      .last_i          (m_last),
      .clear_i         (start),
      .check_i         (check),
      .wrap_i          (loop_lines),
      .lines_o         (lines),
      .mismatches_o    (mismatches),
      .mismatch_place_o(mismatch_place),
      .host_wr_en_i    (signature_wr_en),
      .host_addr_i     (signature_addr),
      .host_wr_data_i  (signature_wr_data),
      .host_rd_data_o  (signature_rd_data)
  );
  if (CAPTURE == 1) begin : gen_capture
    line_capture #(
        .CHANNELS(CHANNELS),
        .PIXELS  (Pixels)
    ) u_capture (
        .clk_i,
        .rst_ni        (core_rst_n_q),
        .beat_i        (beat),
        .data_i        (m_data),
        .user_i        (m_user),
        .last_i        (m_last),
        .clear_i       (start),
        .line_i        (capture_line),
        .pixels_o      (captured),
        .host_addr_i   (pixel_addr),
        .host_rd_data_o(pixel_rd_data)
    );
  end else begin : gen_no_capture
    assign captured      = '0;
    assign pixel_rd_data = '0;
    logic unused;
    assign unused = &{1'b0, capture_line, pixel_addr};
  end

  logic screen_led;
  if (SCREEN == 1) begin : gen_screen
    logic pix_led;
    synchronizer u_led (
        .clk_i,
        .rst_ni,
        .in_i (pix_led),
        .out_o(screen_led)
    );
    video_out #(
        .CHANNELS  (CHANNELS),
        .H_ACTIVE  (H_ACTIVE),
        .WIDTH     (MAX_WIDTH),
        .H_FRONT   (H_FRONT),
        .H_SYNC    (H_SYNC),
        .H_BACK    (H_BACK),
        .V_ACTIVE  (V_ACTIVE),
        .V_FRONT   (V_FRONT),
        .V_SYNC    (V_SYNC),
        .V_BACK    (V_BACK),
        .H_POSITIVE(H_POSITIVE),
        .V_POSITIVE(V_POSITIVE),
        .LED_BITS  (LED_BITS)
    ) u_video (
        .clk_i,
        .rst_ni,
        .s_axis_tvalid_i  (m_valid),
        .s_axis_tready_o  (m_ready),
        .s_axis_tdata_i   (m_data),
        .s_axis_tuser_i   (m_user),
        .s_axis_tlast_i   (m_last),
        .lines_i          (video_lines),
        .frame_req_valid_o(req_valid),
        .frame_req_ready_i(req_ready),
        .frames_shown_o   (frames_shown),
        .late_frames_o    (late_frames),
        .underrun_frames_o(underrun_frames),
        .underrun_lines_o (underrun_lines),
        .pix_clk_i,
        .pix_rst_ni,
        .active_o,
        .hsync_o,
        .vsync_o,
        .rgb_o,
        .led_o            (pix_led)
    );
  end else begin : gen_no_screen
    assign m_ready = 1'b1;
    assign req_valid = 1'b0;
    assign {frames_shown, late_frames, underrun_frames, underrun_lines} = '0;
    assign {active_o, hsync_o, vsync_o, rgb_o, screen_led} = '0;
    logic unused;
    assign unused = &{1'b0, pix_clk_i, pix_rst_ni, video_lines, req_ready};
  end

  // ---- LEDs --------------------------------------------------------------------------------------------------------
  logic [LED_BITS+1:0] blink_q;
  always_ff @(posedge clk_i) begin
    blink_q <= rst_ni ? blink_q + 1'b1 : '0;
    led_o <= {
      irq,
      memory_ready,
      fresh,
      screen_led,
      check && mismatches != '0,
      check && lines != '0 && mismatches == '0,
      playing,
      blink_q[LED_BITS+1]
    };
  end

  logic unused_here;
  assign unused_here = &{1'b0, rx_taken, framing_error, axi_error, overrun, load_address, play_address};

endmodule

`default_nettype wire
