// SPDX-License-Identifier: Apache-2.0
// The compare tree: of UNITS streams of pixels the one with the least key at each pixel. [Ohno 1985]
//
// Shape: ceil(log2 UNITS) levels. A level pairs its neighbours in compare cells. A stream left over at the end passes
//   through a register, so that the pixels of one place in a line are in the same level at the same time. Behind every
//   second level but the last, skid buffers cut the path of `ready`.
// Result: the pixel with the least key, the upper KEY_BITS of its data; on equal keys that of the lowest unit.
// Handshake: valid/ready on all sides. A pixel of each unit is taken in the same clock or later, level by level: a
//   unit's ready depends on its neighbours' valids and, through two levels at most, on the ready behind them. All
//   units' lines have the same width.
// Latency: levels + floor((levels - 1) / 2) clocks (0 with one unit: wires). Throughput: a pixel a clock. rst_ni low
//   empties the tree.
// Cost: UNITS - 1 compare cells, a register for each pixel that passes, a skid_buffer for each node of level 2 with
//   more than four units, and of level 4 with more than sixteen.
`default_nettype none
`include "kage_illegal.svh"

module compare_tree #(
    parameter int UNITS = 4,
    parameter int KEY_BITS = 32,
    parameter int DATA_BITS = 57
) (
    input wire logic clk_i,
    input wire logic rst_ni,

    // unit u has bit u, and bits u * DATA_BITS and up
    input  wire logic [          UNITS-1:0] in_valid_i,
    output logic      [          UNITS-1:0] in_ready_o,
    input  wire logic [UNITS*DATA_BITS-1:0] in_data_i,
    input  wire logic [          UNITS-1:0] in_last_i,

    output logic                      out_valid_o,
    input  wire logic                 out_ready_i,
    output logic      [DATA_BITS-1:0] out_data_o,
    output logic                      out_last_o
);

  localparam int Levels = $clog2(UNITS);

  if (UNITS < 1 || UNITS > 64) begin : gen_bad_units
    `KAGE_ILLEGAL("UNITS must be 1 .. 64")
  end
  if (KEY_BITS < 1 || KEY_BITS > DATA_BITS) begin : gen_bad_key
    `KAGE_ILLEGAL("KEY_BITS must be 1 .. DATA_BITS")
  end

  // Level 0 is the units; level k has ceil(UNITS / 2^k) nodes. All nodes lie behind each other, level by level.
  function automatic integer nodes(input integer level);
    nodes = (UNITS + (1 << level) - 1) >> level;
  endfunction
  function automatic integer first(input integer level);
    integer below;  // declared here: Icarus Verilog 11 takes no loop variable in a constant function
    first = 0;
    for (below = 0; below < level; below++) first = first + nodes(below);
  endfunction
  localparam int Nodes = first(Levels + 1);

  if (UNITS == 1) begin : gen_wires
    logic unused_clock;
    assign unused_clock = clk_i ^ rst_ni;
    assign out_valid_o  = in_valid_i;
    assign in_ready_o   = out_ready_i;
    assign out_data_o   = in_data_i;
    assign out_last_o   = in_last_i;
  end else begin : gen_tree
    logic [Nodes-1:0] valid, last;
    logic [Nodes-1:0] ready  /* verilator split_var */;  // of a node, from that of the node it goes to
    logic [Nodes*DATA_BITS-1:0] data;

    assign valid[UNITS-1:0] = in_valid_i;
    assign data[UNITS*DATA_BITS-1:0] = in_data_i;
    assign last[UNITS-1:0] = in_last_i;
    assign in_ready_o = ready[UNITS-1:0];
    assign out_valid_o = valid[Nodes-1];
    assign out_data_o = data[(Nodes-1)*DATA_BITS+:DATA_BITS];
    assign out_last_o = last[Nodes-1];
    assign ready[Nodes-1] = out_ready_i;

    for (genvar k = 0; k < Levels; k++) begin : gen_level
      for (genvar i = 0; i < nodes(k + 1); i++) begin : gen_node
        localparam int Left = first(k) + 2 * i;
        localparam int Out = first(k + 1) + i;
        logic own_valid, own_ready, own_last;  // in front of its buffer, if it has one
        logic [DATA_BITS-1:0] own_data;
        if (2 * i + 1 < nodes(k)) begin : gen_cell
          compare_cell #(
              .KEY_BITS (KEY_BITS),
              .DATA_BITS(DATA_BITS)
          ) u_cell (
              .clk_i,
              .rst_ni,
              .left_valid_i (valid[Left]),
              .left_ready_o (ready[Left]),
              .left_data_i  (data[Left*DATA_BITS+:DATA_BITS]),
              .left_last_i  (last[Left]),
              .right_valid_i(valid[Left+1]),
              .right_ready_o(ready[Left+1]),
              .right_data_i (data[(Left+1)*DATA_BITS+:DATA_BITS]),
              .right_last_i (last[Left+1]),
              .out_valid_o  (own_valid),
              .out_ready_i  (own_ready),
              .out_data_o   (own_data),
              .out_last_o   (own_last)
          );
        end else begin : gen_pass
          logic valid_q, last_q;
          logic [DATA_BITS-1:0] data_q;
          assign ready[Left] = !valid_q || own_ready;
          assign own_valid = valid_q;
          assign own_data = data_q;
          assign own_last = last_q;
          always_ff @(posedge clk_i) begin
            if (!rst_ni) valid_q <= 1'b0;
            else if (ready[Left]) valid_q <= valid[Left];
            if (ready[Left]) begin
              data_q <= data[Left*DATA_BITS+:DATA_BITS];
              last_q <= last[Left];
            end
          end
        end
        if (k % 2 == 1 && k + 1 < Levels) begin : gen_buffer
          skid_buffer #(
              .BITS(DATA_BITS + 1)
          ) u_buffer (
              .clk_i,
              .rst_ni,
              .in_valid_i (own_valid),
              .in_ready_o (own_ready),
              .in_data_i  ({own_last, own_data}),
              .out_valid_o(valid[Out]),
              .out_ready_i(ready[Out]),
              .out_data_o ({last[Out], data[Out*DATA_BITS+:DATA_BITS]})
          );
        end else begin : gen_direct
          assign own_ready = ready[Out];
          assign valid[Out] = own_valid;
          assign last[Out] = own_last;
          assign data[Out*DATA_BITS+:DATA_BITS] = own_data;
        end
      end
    end
  end

endmodule

`default_nettype wire
