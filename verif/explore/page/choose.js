// SPDX-License-Identifier: Apache-2.0
// Which configuration is the cheapest within limits. It knows rows (docs/schema/sweep.json) and nothing of the page.
"use strict";

const Choose = (() => {
  const costs = {
    luts: {name: "look-up tables", of: (r) => r.area.luts, estimated: (r) => !r.area.counted},
    clocks: {name: "clocks a pixel", of: (r) => r.speed.rtl_cycles_per_pixel, estimated: (r) => r.speed.rtl_cycles_from !== "cosim"},
    ram: {name: "bits of RAM", of: (r) => r.area.ram_bits, estimated: () => false},
    words: {name: "words a frame", of: (r) => r.speed.words_per_frame, estimated: () => false},
  };
  // In a million.
  const wrong = (r) => 1e6 * (r.accuracy.visible_wrong + r.accuracy.shadow_wrong) / r.accuracy.pixels;
  // In dB; colours that are all equal are better than any.
  const psnr = (r) => r.accuracy.psnr ?? Infinity;

  // 0 to 1; a row without FLIP keeps no limit of it.
  const flip = (r) => r.accuracy.flip ?? Infinity;

  // What a row is beyond the limits {wrong, psnr, flip, clocks} in. One with a pixel that is wrong grossly keeps none: that
  // is a bug.
  const beyond = (r, limits) => [
    [r.accuracy.gross_wrong > 0, "gross"], [wrong(r) > limits.wrong, "wrong"], [psnr(r) < limits.psnr, "PSNR"],
    [flip(r) > limits.flip, "FLIP"], [costs.clocks.of(r) > limits.clocks, "clocks"],
  ].filter(([over]) => over).map(([, name]) => name);
  const keeps = (r, limits) => beyond(r, limits).length === 0;

  // Of `members`, numbers of rows, the one that keeps the limits and costs least; of those that cost as much the one with
  // fewest wrong pixels, then the best colours, then the least of the other costs, then the first. None: null.
  function cheapest(rows, members, limits, cost) {
    const figures = [costs[cost].of, wrong, (r) => -psnr(r), ...Object.values(costs).map((c) => c.of)];
    const better = (a, b) => {
      for (const figure of figures) if (figure(a) !== figure(b)) return figure(a) < figure(b);
      return false;
    };
    let best = null;
    for (const i of members) {
      if (keeps(rows[i], limits) && (best === null || better(rows[i], rows[best]))) best = i;
    }
    return best;
  }

  return {costs, wrong, psnr, flip, beyond, keeps, cheapest};
})();
