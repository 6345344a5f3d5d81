// SPDX-License-Identifier: Apache-2.0
// The plot: the drawing of the SVG file, in which points are chosen by mouse, finger and keys.
"use strict";

const Plot = (() => {
  const {$} = Parts;
  const box = $("plot");
  const kNear = 26;  // pixels of the screen from a point, within which it is meant
  const kSame = 3;   // units of the drawing between points that a reader sees at one place
  let shown = null;  // {wide, narrow}
  let svg = null;
  let width = "";
  let points = [];   // {row, x, y, mark}, in the drawing's units
  let state = {within: () => true, cheapest: null, chosen: null};

  const kind = () => box.clientWidth < 560 ? "narrow" : "wide";

  function draw() {
    width = kind();
    const drawing = new DOMParser().parseFromString(shown[width], "image/svg+xml").documentElement;
    svg = document.importNode(drawing, true);
    svg.querySelector("title").remove();  // the points' own titles come up where they are pointed at
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    box.replaceChildren(svg);
    points = [...svg.querySelectorAll("g[data-row]")].map((mark) => ({
      row: Number(mark.dataset.row), x: Number(mark.dataset.x), y: Number(mark.dataset.y), mark,
    }));
    paint();
  }

  function ring(row, name, radius) {
    const at = points.find((p) => p.row === row);
    if (!at) return;
    const circle = document.createElementNS("http://www.w3.org/2000/svg", "circle");
    for (const [key, value] of Object.entries({cx: at.x, cy: at.y, r: radius, class: `ring ${name}`})) circle.setAttribute(key, value);
    svg.append(circle);
  }

  function paint() {
    if (!svg) return;
    for (const old of svg.querySelectorAll(".ring")) old.remove();
    for (const p of points) p.mark.classList.toggle("beyond", !state.within(p.row));
    if (state.cheapest !== null) ring(state.cheapest, "cheapest", 11.5);
    if (state.chosen !== null) ring(state.chosen, "chosen", 8);
  }

  const around = (at) => points.filter((p) => Math.hypot(p.x - at.x, p.y - at.y) <= kSame);
  const choose = (row) => box.dispatchEvent(new CustomEvent("row", {detail: row}));

  // A point nearest to the pointer; of several at one place, at each click the next.
  box.addEventListener("click", (e) => {
    if (!svg) return;
    const matrix = svg.getScreenCTM();
    const far = (p) => Math.hypot(p.x * matrix.a + matrix.e - e.clientX, p.y * matrix.d + matrix.f - e.clientY);
    const nearest = points.reduce((a, b) => far(b) < far(a) ? b : a);
    if (far(nearest) > kNear) return;
    const here = around(nearest);
    choose(here[(here.findIndex((p) => p.row === state.chosen) + 1) % here.length].row);
  });

  box.addEventListener("keydown", (e) => {
    const steps = {ArrowRight: ["x", 1], ArrowLeft: ["x", -1], ArrowDown: ["y", 1], ArrowUp: ["y", -1]};
    if (!(e.key in steps) || !points.length) return;
    e.preventDefault();
    const [axis, step] = steps[e.key];
    const other = axis === "x" ? "y" : "x";
    const order = [...points].sort((a, b) => a[axis] - b[axis] || a[other] - b[other] || a.row - b.row);
    const at = order.findIndex((p) => p.row === state.chosen);
    choose(order[at < 0 ? 0 : Math.min(Math.max(at + step, 0), order.length - 1)].row);
  });

  new ResizeObserver(() => { if (shown && kind() !== width) draw(); }).observe(box);

  return {
    // A plot {wide, narrow}; null: there is none.
    set(plot) {
      shown = plot;
      svg = null;
      points = [];
      box.hidden = !plot;
      if (plot) draw(); else box.replaceChildren();
    },
    // Which rows are within the limits, which is the cheapest of them, which is shown beside.
    state(next) { state = next; paint(); },
    // The rows at the place of one.
    together(row) {
      const at = points.find((p) => p.row === row);
      return at ? around(at).map((p) => p.row) : [];
    },
    box,
  };
})();
