// SPDX-License-Identifier: Apache-2.0
// `KAGE_ILLEGAL("why"), an item of a module: illegal parameters stop elaboration, with the reason. Icarus Verilog 11
// does not read $fatal outside a procedure; there the simulation stops at time 0 instead.
`ifndef KAGE_ILLEGAL
`ifdef __ICARUS__
`define KAGE_ILLEGAL(why) initial $fatal(1, why);
`else
`define KAGE_ILLEGAL(why) $fatal(1, why);
`endif
`endif
