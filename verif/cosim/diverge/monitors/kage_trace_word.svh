// SPDX-License-Identifier: Apache-2.0
// A word of BITS bits in an event, for the monitors of cells that pass words. An event has 512 bits: of longer words those
// that lie on one another there are added modulo 2.
function automatic logic [511:0] folded(input logic [BITS-1:0] word);
  logic [(BITS+511)/512*512-1:0] pieces;
  pieces = ((BITS + 511) / 512 * 512)'(word);
  folded = '0;
  for (int i = 0; i < BITS; i += 512) folded = folded ^ pieces[i+:512];
endfunction
