// SPDX-License-Identifier: Apache-2.0
// Included inside a module.
//
// Kinds of frames between host and board, and their framing: docs/link.md, which verif/board/link_frame.hpp has in C++.
/* verilator lint_off UNUSEDPARAM */
localparam logic [7:0] Flag = 8'h7E;  // stands before and behind a frame
localparam logic [7:0] Escape = 8'h7D;
localparam logic [7:0] KindPoll = 8'h00;
localparam logic [7:0] KindHello = 8'h01;
localparam logic [7:0] KindWrite = 8'h02;
localparam logic [7:0] KindStream = 8'h03;
localparam logic [7:0] KindRead = 8'h04;
localparam logic [7:0] KindWriteSame = 8'h12;
localparam logic [7:0] KindAck = 8'h80;
localparam logic [7:0] KindData = 8'h81;
localparam logic [7:0] ReadMost = 8'd62;  // words of a READ
/* verilator lint_on UNUSEDPARAM */
