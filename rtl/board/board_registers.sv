// SPDX-License-Identifier: Apache-2.0
// The registers of a board (rtl/defs/board.yaml, docs/boards.md) and the way to the core's, for the one master behind
// the serial link.
//
// Handshake: an AXI4-Lite slave, and a master towards the core. One write and one read are under way at a time.
//   Addresses below 0x100 go to the core; where the core is held in reset, they answer SLVERR, as do addresses without
//   a register or word. Writes to what is read only are taken and ignored. WSTRB is passed on to the core; the board's
//   own registers are written whole.
//   The lowest two bits of an address choose nothing. A read of the core that is under way when a write holds the core
//   answers SLVERR.
// Latency, with the first clock and the answer's: 4 clocks for a write, 3 for a read, 4 for a read of a RAM's word. The
//   core's registers take 6 and 5 where the core answers in the next clock. Throughput: one write and one read in that
//   time.
// PIXELS 0: there is no line_capture, and no word of PIXELS.
// Cost: about 300 flip-flops.
`default_nettype none
`include "kage_illegal.svh"

module board_registers #(
    parameter logic [31:0] BOARD_NAME = "NONE",
    parameter int MEMORY_WORDS = 4096,
    parameter int LINES = 512,
    parameter int PIXELS = 640,
    parameter int SCREEN_WIDTH = 640,
    parameter int SCREEN_HEIGHT = 480,
    localparam int PlaceBits = $clog2(LINES),
    localparam int PixelBits = PIXELS > 1 ? $clog2(PIXELS) : 1
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    input  wire logic        s_axil_awvalid_i,
    output logic             s_axil_awready_o,
    input  wire logic [15:0] s_axil_awaddr_i,
    input  wire logic        s_axil_wvalid_i,
    output logic             s_axil_wready_o,
    input  wire logic [31:0] s_axil_wdata_i,
    input  wire logic [ 3:0] s_axil_wstrb_i,
    output logic             s_axil_bvalid_o,
    input  wire logic        s_axil_bready_i,
    output logic      [ 1:0] s_axil_bresp_o,
    input  wire logic        s_axil_arvalid_i,
    output logic             s_axil_arready_o,
    input  wire logic [15:0] s_axil_araddr_i,
    output logic             s_axil_rvalid_o,
    input  wire logic        s_axil_rready_i,
    output logic      [31:0] s_axil_rdata_o,
    output logic      [ 1:0] s_axil_rresp_o,

    output logic             m_axil_awvalid_o,
    input  wire logic        m_axil_awready_i,
    output logic      [ 7:0] m_axil_awaddr_o,
    output logic             m_axil_wvalid_o,
    input  wire logic        m_axil_wready_i,
    output logic      [31:0] m_axil_wdata_o,
    output logic      [ 3:0] m_axil_wstrb_o,
    input  wire logic        m_axil_bvalid_i,
    output logic             m_axil_bready_o,
    input  wire logic [ 1:0] m_axil_bresp_i,
    output logic             m_axil_arvalid_o,
    input  wire logic        m_axil_arready_i,
    output logic      [ 7:0] m_axil_araddr_o,
    input  wire logic        m_axil_rvalid_i,
    output logic             m_axil_rready_o,
    input  wire logic [31:0] m_axil_rdata_i,
    input  wire logic [ 1:0] m_axil_rresp_i,

    // what a host sets
    output logic        hold_o,
    output logic        loop_o,
    output logic        paced_o,
    output logic        check_o,
    output logic        direct_o,
    output logic        start_o,         // for a clock
    output logic        stop_o,          // for a clock
    output logic        load_set_o,      // for a clock: load_address_o is new
    output logic [31:0] load_address_o,
    output logic [31:0] play_address_o,
    output logic [15:0] loop_lines_o,
    output logic [15:0] capture_line_o,
    output logic [15:0] video_lines_o,

    // what a host reads
    input wire logic        playing_i,
    input wire logic        memory_ready_i,
    input wire logic        irq_i,
    input wire logic [31:0] load_next_i,
    input wire logic [31:0] words_crc_i,        // of the words loaded, or played
    input wire logic [15:0] played_i,
    input wire logic [15:0] lines_i,
    input wire logic [15:0] mismatches_i,
    input wire logic [15:0] mismatch_place_i,
    input wire logic [15:0] captured_i,
    input wire logic [15:0] frames_shown_i,
    input wire logic [15:0] late_frames_i,
    input wire logic [15:0] underrun_frames_i,
    input wire logic [15:0] underrun_lines_i,
    input wire logic [15:0] link_good_i,
    input wire logic [15:0] link_bad_i,
    input wire logic [15:0] link_overruns_i,

    // the RAMs of line_signature and line_capture: a word a clock after its address
    output logic                      signature_wr_en_o,
    output logic      [PlaceBits-1:0] signature_addr_o,
    output logic      [         31:0] signature_wr_data_o,
    input  wire logic [         31:0] signature_rd_data_i,
    output logic      [PixelBits-1:0] pixel_addr_o,
    input  wire logic [         31:0] pixel_rd_data_i
);
  `include "board_registers.svh"

  if (LINES > WindowSignaturesWords || PIXELS > WindowPixelsWords) begin : gen_bad_window
    `KAGE_ILLEGAL("LINES and PIXELS must fit in their windows")
  end

  localparam logic [1:0] RespOkay = 2'b00;
  localparam logic [1:0] RespSlverr = 2'b10;

  function automatic logic is_core(input logic [15:0] address);
    is_core = address < 16'h0100;
  endfunction
  function automatic logic is_here(input logic [15:0] address);
    is_here = address >= RegBoardId && address < RegLast + 16'd4;
  endfunction
  function automatic logic is_signature(input logic [15:0] address);
    is_signature = address >= WindowSignatures && address < WindowSignatures + 16'(4 * LINES);
  endfunction
  function automatic logic is_pixel(input logic [15:0] address);
    is_pixel = PIXELS != 0 && address >= WindowPixels && address < WindowPixels + 16'(4 * PIXELS);
  endfunction

  // ---- writes ------------------------------------------------------------------------------------------------------
  typedef enum logic [1:0] {
    WriteTake,
    WriteDo,
    WriteCore,
    WriteAnswer
  } write_t;
  write_t write_q;
  logic aw_held_q, w_held_q, aw_left_q, w_left_q;  // held: taken from the host; left: not taken by the core yet
  logic [15:0] wr_addr_q;
  logic [31:0] wr_data_q;
  logic [3:0] wr_strb_q;
  reg_control_t control_q;
  logic write_here;
  assign s_axil_awready_o    = rst_ni && write_q == WriteTake && !aw_held_q;
  assign s_axil_wready_o     = rst_ni && write_q == WriteTake && !w_held_q;
  assign s_axil_bvalid_o     = write_q == WriteAnswer;
  assign m_axil_awvalid_o    = aw_left_q;
  assign m_axil_awaddr_o     = wr_addr_q[7:0];
  assign m_axil_wvalid_o     = w_left_q;
  assign m_axil_wdata_o      = wr_data_q;
  assign m_axil_wstrb_o      = wr_strb_q;
  assign m_axil_bready_o     = write_q == WriteCore;
  assign write_here          = write_q == WriteDo && is_here(wr_addr_q);

  assign hold_o              = control_q.hold;
  assign loop_o              = control_q.loop;
  assign paced_o             = control_q.paced;
  assign check_o             = control_q.check;
  assign direct_o            = control_q.direct;
  assign signature_wr_data_o = wr_data_q;

  reg_command_t command;
  assign command = wr_data_q[RegCommandBits-1:0];

  always_ff @(posedge clk_i) begin
    start_o           <= 1'b0;
    stop_o            <= 1'b0;
    load_set_o        <= 1'b0;
    signature_wr_en_o <= 1'b0;
    if (s_axil_awready_o) wr_addr_q <= s_axil_awaddr_i;
    if (s_axil_wready_o) begin
      wr_data_q <= s_axil_wdata_i;
      wr_strb_q <= s_axil_wstrb_i;
    end
    if (s_axil_awvalid_i && s_axil_awready_o) aw_held_q <= 1'b1;
    if (s_axil_wvalid_i && s_axil_wready_o) w_held_q <= 1'b1;
    if (m_axil_awready_i) aw_left_q <= 1'b0;
    if (m_axil_wready_i) w_left_q <= 1'b0;
    case (write_q)
      WriteTake:
      if (aw_held_q && w_held_q) begin
        aw_held_q <= 1'b0;
        w_held_q  <= 1'b0;
        write_q   <= WriteDo;
      end
      WriteDo: begin
        write_q        <= WriteAnswer;
        s_axil_bresp_o <= RespOkay;
        if (is_core(wr_addr_q) && !control_q.hold) begin
          write_q   <= WriteCore;
          aw_left_q <= 1'b1;
          w_left_q  <= 1'b1;
        end else if (is_signature(wr_addr_q)) begin
          signature_wr_en_o <= 1'b1;
        end else if (!is_here(wr_addr_q) && !is_pixel(wr_addr_q)) begin
          s_axil_bresp_o <= RespSlverr;
        end
      end
      WriteCore:
      if (m_axil_bvalid_i) begin
        write_q        <= WriteAnswer;
        s_axil_bresp_o <= m_axil_bresp_i;
      end
      default: if (s_axil_bready_i) write_q <= WriteTake;
    endcase
    if (write_here) begin
      case ({
        wr_addr_q[15:2], 2'b00
      })
        RegControl:     control_q <= wr_data_q[RegControlBits-1:0];
        RegCommand: begin
          start_o <= command.start;
          stop_o  <= command.stop;
        end
        RegLoadAddress: begin
          load_address_o <= wr_data_q;
          load_set_o     <= 1'b1;
        end
        RegPlayAddress: play_address_o <= wr_data_q;
        RegLoopLines:   loop_lines_o <= wr_data_q[15:0];
        RegCaptureLine: capture_line_o <= wr_data_q[15:0];
        RegVideoLines:  video_lines_o <= wr_data_q[15:0];
        default:        ;
      endcase
    end
    if (!rst_ni) begin
      write_q        <= WriteTake;
      aw_held_q      <= 1'b0;
      w_held_q       <= 1'b0;
      aw_left_q      <= 1'b0;
      w_left_q       <= 1'b0;
      control_q      <= '0;
      control_q.hold <= 1'b1;
      play_address_o <= '0;
      loop_lines_o   <= '0;
      capture_line_o <= '0;
      video_lines_o  <= 16'(SCREEN_HEIGHT);
    end
  end

  // ---- reads -------------------------------------------------------------------------------------------------------
  typedef enum logic [2:0] {
    ReadTake,
    ReadDo,
    ReadRam,
    ReadCore,
    ReadAnswer
  } read_t;
  read_t read_q;
  logic [15:0] rd_addr_q;
  logic ar_left_q;
  assign s_axil_arready_o = rst_ni && read_q == ReadTake;
  assign s_axil_rvalid_o  = read_q == ReadAnswer;
  assign m_axil_arvalid_o = ar_left_q;
  assign m_axil_araddr_o  = rd_addr_q[7:0];
  assign m_axil_rready_o  = read_q == ReadCore;
  assign pixel_addr_o     = rd_addr_q[PixelBits+1:2];
  assign signature_addr_o = signature_wr_en_o ? wr_addr_q[PlaceBits+1:2] : rd_addr_q[PlaceBits+1:2];

  reg_sizes_t sizes;
  reg_screen_t screen;
  reg_state_t state;
  logic [31:0] value;
  always_comb begin
    sizes.lines        = 16'(LINES);
    sizes.pixels       = 16'(PIXELS);
    screen.width       = 16'(SCREEN_WIDTH);
    screen.height      = 16'(SCREEN_HEIGHT);
    state.playing      = playing_i;
    state.memory_ready = memory_ready_i;
    state.irq          = irq_i;
    case ({
      rd_addr_q[15:2], 2'b00
    })
      RegBoardId:        value = BoardIdValue;
      RegBoardLayout:    value = BoardLayoutValue;
      RegBoardName:      value = BOARD_NAME;
      RegMemoryWords:    value = 32'(MEMORY_WORDS);
      RegSizes:          value = sizes;
      RegScreen:         value = screen;
      RegControl:        value = 32'(control_q);
      RegState:          value = 32'(state);
      RegLoadAddress:    value = load_next_i;
      RegLoadCrc:        value = words_crc_i;
      RegPlayAddress:    value = play_address_o;
      RegPlayCrc:        value = words_crc_i;
      RegPlayed:         value = 32'(played_i);
      RegLines:          value = 32'(lines_i);
      RegLoopLines:      value = 32'(loop_lines_o);
      RegMismatches:     value = 32'(mismatches_i);
      RegMismatchLine:   value = 32'(mismatch_place_i);
      RegCaptureLine:    value = 32'(capture_line_o);
      RegCaptured:       value = 32'(captured_i);
      RegVideoLines:     value = 32'(video_lines_o);
      RegFramesShown:    value = 32'(frames_shown_i);
      RegLateFrames:     value = 32'(late_frames_i);
      RegUnderrunFrames: value = 32'(underrun_frames_i);
      RegUnderrunLines:  value = 32'(underrun_lines_i);
      RegLinkGood:       value = 32'(link_good_i);
      RegLinkBad:        value = 32'(link_bad_i);
      RegLinkOverruns:   value = 32'(link_overruns_i);
      default:           value = '0;
    endcase
  end

  always_ff @(posedge clk_i) begin
    if (s_axil_arready_o) rd_addr_q <= s_axil_araddr_i;
    if (m_axil_arready_i) ar_left_q <= 1'b0;
    case (read_q)
      ReadTake: if (s_axil_arvalid_i) read_q <= ReadDo;
      ReadDo: begin
        read_q         <= ReadAnswer;
        s_axil_rresp_o <= RespOkay;
        s_axil_rdata_o <= value;
        if (is_core(rd_addr_q) && !control_q.hold) begin
          read_q    <= ReadCore;
          ar_left_q <= 1'b1;
        end else if (is_signature(rd_addr_q) || is_pixel(rd_addr_q)) begin
          // In the clock of a write the RAM has the write's address: the read comes a clock later.
          read_q <= signature_wr_en_o ? ReadDo : ReadRam;
        end else if (!is_here(rd_addr_q)) begin
          s_axil_rresp_o <= RespSlverr;
          s_axil_rdata_o <= '0;
        end
      end
      ReadRam: begin
        read_q         <= ReadAnswer;
        s_axil_rdata_o <= is_pixel(rd_addr_q) ? pixel_rd_data_i : signature_rd_data_i;
      end
      ReadCore:
      if (m_axil_rvalid_i) begin
        read_q         <= ReadAnswer;
        s_axil_rdata_o <= m_axil_rdata_i;
        s_axil_rresp_o <= m_axil_rresp_i;
      end else if (control_q.hold) begin
        // A write has held the core meanwhile: what it was asked is lost.
        read_q         <= ReadAnswer;
        ar_left_q      <= 1'b0;
        s_axil_rdata_o <= '0;
        s_axil_rresp_o <= RespSlverr;
      end
      default:  if (s_axil_rready_i) read_q <= ReadTake;
    endcase
    if (!rst_ni) begin
      read_q    <= ReadTake;
      ar_left_q <= 1'b0;
    end
  end

endmodule

`default_nettype wire
