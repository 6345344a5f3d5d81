// SPDX-License-Identifier: Apache-2.0
// RTL that becomes the cells of verif/cosim/model/cells: memories in shapes that take each width of a block RAM, LUT
// RAM, products, chains of carries and wide choices, in the forms that the core has them. Script run.sh synthesizes it
// for a family and plays the netlist beside it.
`default_nettype none

module pieces #(
    parameter int FACTOR = 18,  // bits of a factor: few where products become LUTs, which simulate slowly
    parameter int WIDTH = 70 + 8 + 2 * 36 + 18 + 1 + 1 + 2 * 6
) (
    input  wire logic             clk_i,
    input  wire logic             rst_ni,
    input  wire logic             wr_en_i,
    input  wire logic             rd_en_i,
    input  wire logic [     13:0] wr_addr_i,
    input  wire logic [     13:0] rd_addr_i,
    input  wire logic [     71:0] data_i,
    output logic      [WIDTH-1:0] out_o       // all that follows, from the uppermost bits on
);

  // ---- block RAMs: words of 36, 18, 9, 4, 2 bits and of one -------------------------------------------------------
  wire [69:0] ram;
  for (genvar g = 0; g < 6; g++) begin : gen_ram
    localparam int Bits = g < 3 ? 36 >> g : 4 >> (g - 3);
    localparam int Words = 512 << g;
    localparam int At = g < 3 ? 72 - 2 * Bits : g == 3 ? 63 : 70 - (2 * Bits - 1);  // 0, 36, 54, 63, 67, 69
    ram_1r1w #(
        .BITS (Bits),
        .WORDS(Words)
    ) u_ram (
        .clk_i,
        .wr_en_i,
        .wr_addr_i(wr_addr_i[$clog2(Words)-1:0]),
        .wr_data_i(data_i[Bits-1:0]),
        .rd_en_i,
        .rd_addr_i(rd_addr_i[$clog2(Words)-1:0]),
        .rd_data_o(ram[At+:Bits])
    );
  end

  // ---- a RAM that is read at once -----------------------------------------------------------------------------------
  logic [7:0] few[16];
  always_ff @(posedge clk_i) if (wr_en_i) few[wr_addr_i[3:0]] <= data_i[7:0];
  wire  [ 7:0] lut_ram = few[rd_addr_i[3:0]];

  // ---- arithmetic ---------------------------------------------------------------------------------------------------
  logic [17:0] sum_q;
  logic [5:0] count_q, hash_q;
  logic less_q, choice_q;
  wire [35:0] unsigned_product = 36'(data_i[FACTOR-1:0]) * 36'(data_i[18+:FACTOR]);
  wire signed [35:0] signed_product = 36'($signed(data_i[FACTOR-1:0])) * 36'($signed(data_i[18+:FACTOR]));
  assign out_o = {ram, lut_ram, unsigned_product, signed_product, sum_q, less_q, choice_q, count_q, hash_q};
  always_ff @(posedge clk_i) begin
    if (wr_en_i) sum_q <= data_i[17:0] - data_i[35:18] + {17'd0, rd_en_i};
    less_q   <= data_i[31:0] < data_i[63:32];
    choice_q <= data_i[wr_addr_i[5:0]] ^ (rd_en_i && data_i[6'(rd_addr_i)]);
    if (!rst_ni) count_q <= 6'd41;  // some bits set, some reset
    else if (rd_en_i) count_q <= count_q + 6'd1;
    if (!rst_ni) hash_q <= 6'd22;
    else hash_q <= {hash_q[4:0], hash_q[5]} ^ data_i[5:0];
  end

endmodule

`default_nettype wire
