// SPDX-License-Identifier: Apache-2.0
// Included inside a module.
//
// The next value of a cyclic redundancy check when a byte comes, its lowest bit first. Both checks are of the reflected
// form: the register starts at all ones and is sent inverted, its lowest byte first.

// CRC-16/X-25, the FCS-16 of RFC 1662. A register that has taken the inverted check of what came before it holds
// Crc16Good.
/* verilator lint_off UNUSEDPARAM */
localparam logic [15:0] Crc16Good = 16'hF0B8;
/* verilator lint_on UNUSEDPARAM */
function automatic logic [15:0] crc16_next(input logic [15:0] crc, input logic [7:0] data);
  begin
    crc16_next = crc ^ {8'h00, data};
    for (int i = 0; i < 8; i++) crc16_next = {1'b0, crc16_next[15:1]} ^ (crc16_next[0] ? 16'h8408 : 16'h0000);
  end
endfunction

// CRC-32, as Ethernet and zlib have it.
function automatic logic [31:0] crc32_next(input logic [31:0] crc, input logic [7:0] data);
  begin
    crc32_next = crc ^ {24'h000000, data};
    for (int i = 0; i < 8; i++) crc32_next = {1'b0, crc32_next[31:1]} ^ (crc32_next[0] ? 32'hEDB88320 : 32'h00000000);
  end
endfunction

// The same of the four bytes of a word, the lowest first.
function automatic logic [31:0] crc32_word(input logic [31:0] crc, input logic [31:0] data);
  begin
    crc32_word = crc;
    for (int b = 0; b < 4; b++) crc32_word = crc32_next(crc32_word, data[b*8+:8]);
  end
endfunction
