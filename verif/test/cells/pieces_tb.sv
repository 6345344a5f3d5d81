// SPDX-License-Identifier: Apache-2.0
// pieces.sv beside its netlist, module pieces_netlist: every output the same in every clock, for random inputs. Where
// the RTL's own output is X, as of a RAM's word that nobody has written, the netlist may have anything. A RAM is not
// asked for the word that is written in the same clock: see ram_1r1w.sv.
`default_nettype none

module pieces_tb #(
    parameter int FACTOR = 18
);
  logic clk = 1'b0, rst_n = 1'b0, wr_en = 1'b0, rd_en = 1'b0;
  logic [13:0] wr_addr = '0, rd_addr = '0;
  logic [71:0] data = '0;
  localparam int Width = 70 + 8 + 2 * 36 + 18 + 1 + 1 + 2 * 6;
  wire [Width-1:0] wanted, got;

  pieces #(
      .FACTOR(FACTOR)
  ) u_rtl (
      .clk_i(clk),
      .rst_ni(rst_n),
      .wr_en_i(wr_en),
      .rd_en_i(rd_en),
      .wr_addr_i(wr_addr),
      .rd_addr_i(rd_addr),
      .data_i(data),
      .out_o(wanted)
  );
  pieces_netlist u_netlist (
      .clk_i(clk),
      .rst_ni(rst_n),
      .wr_en_i(wr_en),
      .rd_en_i(rd_en),
      .wr_addr_i(wr_addr),
      .rd_addr_i(rd_addr),
      .data_i(data),
      .out_o(got)
  );

  int known = 0;  // output bits, in each 16th clock, that were held against something
  initial begin
    for (int n = 0; n < 1000 && known >= 0; n++) begin
      #1 clk = 1'b1;
      #1 clk = 1'b0;
      rst_n   = n > 2 && n % 300 > 2;
      wr_en   = $urandom % 4 != 0;
      rd_en   = $urandom % 3 != 0;
      // Few enough places that what is read has been written, and in all parts of the memory.
      wr_addr = 14'($urandom) & 14'h3827;
      rd_addr = 14'($urandom) & 14'h3827;
      data    = {$urandom, $urandom, $urandom};
      if (n % 16 == 0) data[35:0] = {18'h20000, n % 32 == 0 ? 18'h20000 : 18'h1ffff};
      // The least address decides: of 512 words, and of the 16 of the LUT RAM, which is read at once.
      if (wr_addr[8:0] == rd_addr[8:0]) rd_en = 1'b0;
      #1;
      if ((got ==? wanted) !== 1'b1) begin  // what is X in `wanted` is equal to all
        for (int i = 0; i < Width && known >= 0; i++)
        if (wanted[i] !== 1'bx && got[i] !== wanted[i]) begin
          known = -1;
          $display("pieces_tb: FAILED: bit %0d is %b, the RTL's is %b, clock %0d", i, got[i], wanted[i], n);
        end
        $finish;
      end
      if (n % 16 == 0) for (int i = 0; i < Width; i++) if (wanted[i] !== 1'bx) known++;
    end
    if (known >= 0 && known < 62 * Width) $display("pieces_tb: FAILED: only %0d bits were known", known);
    else if (known >= 0) $display("pieces_tb: passed: %0d bits", known);
    $finish;
  end
endmodule

`default_nettype wire
