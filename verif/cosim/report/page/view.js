// SPDX-License-Identifier: Apache-2.0
// The picture: golden, RTL, difference or golden beside RTL, zoomed and moved, with the pixel that is explained marked.
"use strict";

const View = (() => {
  const canvas = document.getElementById("canvas");
  const context = canvas.getContext("2d");
  let pictures = {};  // golden, rtl, difference: ImageBitmap-like canvases, or undefined
  let width = 1;
  let height = 1;
  let mode = "golden";
  let wipe = 0.5;
  let scale = 0;  // 0: all of it
  let left = 0;   // the picture's column at the left edge
  let top = 0;
  let marked = null;

  const ratio = () => window.devicePixelRatio || 1;
  const fitting = () => Math.min(canvas.clientWidth / width, canvas.clientHeight / height) || 1;
  const now = () => scale || fitting();

  function place() {
    const s = now();
    const wide = canvas.clientWidth / s;
    const high = canvas.clientHeight / s;
    left = wide >= width ? (width - wide) / 2 : Math.min(Math.max(left, 0), width - wide);
    top = high >= height ? (height - high) / 2 : Math.min(Math.max(top, 0), height - high);
    canvas.style.touchAction = scale ? "none" : "pan-y";
  }

  function picture(which, clip) {
    const p = pictures[which];
    if (!p) return;
    const s = now();
    context.save();
    if (clip) {
      context.beginPath();
      context.rect(...clip);
      context.clip();
    }
    if (p.dim) context.filter = "grayscale(1) brightness(0.45)";
    context.imageSmoothingEnabled = s < 1;
    context.drawImage(p.canvas, -left * s, -top * s, width * s, height * s);
    context.restore();
  }

  function mark() {
    if (!marked) return;
    const s = now();
    const size = Math.max(s, 7);
    const x = (marked.x + 0.5 - left) * s;
    const y = (marked.y + 0.5 - top) * s;
    for (const [color, wide] of [["#000000", 5], ["#ffe14d", 2]]) {
      context.strokeStyle = color;
      context.lineWidth = wide;
      context.strokeRect(x - size / 2 - 1, y - size / 2 - 1, size + 2, size + 2);
    }
  }

  function paint() {
    const r = ratio();
    const box = {width: canvas.clientWidth, height: canvas.clientHeight};
    if (canvas.width !== Math.round(box.width * r)) canvas.width = Math.round(box.width * r);
    if (canvas.height !== Math.round(box.height * r)) canvas.height = Math.round(box.height * r);
    context.setTransform(r, 0, 0, r, 0, 0);
    context.clearRect(0, 0, box.width, box.height);
    place();
    if (mode === "wipe") {
      const at = box.width * wipe;
      picture("golden", [0, 0, at, box.height]);
      picture("rtl", [at, 0, box.width - at, box.height]);
      context.fillStyle = "#ffe14d";
      context.fillRect(at - 1, 0, 2, box.height);
    } else {
      picture(mode);
    }
    mark();
    document.getElementById("scale").value = `${Math.round(now() * 100)} %`;
  }

  function zoom(factor, at) {
    const s = now();
    const fit = fitting();
    const next = Math.min(Math.max(s * factor, fit), 64);
    const x = at ? at.x : canvas.clientWidth / 2;
    const y = at ? at.y : canvas.clientHeight / 2;
    const column = left + x / s;
    const line = top + y / s;
    scale = next <= fit * 1.001 ? 0 : next;
    left = column - x / now();
    top = line - y / now();
    paint();
  }

  // The marked pixel comes to be seen, and with `least` at least so large.
  function show(least = 0) {
    if (least > now()) scale = least;
    if (marked) {
      const s = now();
      const wide = canvas.clientWidth / s;
      const high = canvas.clientHeight / s;
      if (least || marked.x < left || marked.x >= left + wide) left = marked.x + 0.5 - wide / 2;
      if (least || marked.y < top || marked.y >= top + high) top = marked.y + 0.5 - high / 2;
    }
    paint();
  }

  function pixelAt(event) {
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(left + (event.clientX - box.left) / now());
    const y = Math.floor(top + (event.clientY - box.top) / now());
    return x < 0 || y < 0 || x >= width || y >= height ? null : {x, y};
  }

  // A press that does not move is a click; one that does moves the picture, if it is zoomed.
  let press = null;
  canvas.addEventListener("pointerdown", (e) => {
    press = {x: e.clientX, y: e.clientY, left, top, moved: false};
    canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener("pointermove", (e) => {
    if (!press) return;
    const [dx, dy] = [e.clientX - press.x, e.clientY - press.y];
    if (Math.hypot(dx, dy) > 5) press.moved = true;
    if (!press.moved || !scale) return;
    left = press.left - dx / now();
    top = press.top - dy / now();
    paint();
  });
  canvas.addEventListener("pointerup", (e) => {
    const clicked = press && !press.moved;
    press = null;
    const at = clicked && pixelAt(e);
    if (at) canvas.dispatchEvent(new CustomEvent("pixel", {detail: at}));
  });
  canvas.addEventListener("pointercancel", () => { press = null; });
  canvas.addEventListener("wheel", (e) => {
    if (!e.ctrlKey) return;  // the page scrolls
    e.preventDefault();
    if (e.deltaY === 0) return;
    const box = canvas.getBoundingClientRect();
    zoom(e.deltaY < 0 ? 1.25 : 0.8, {x: e.clientX - box.left, y: e.clientY - box.top});
  }, {passive: false});
  new ResizeObserver(paint).observe(canvas);

  return {
    paint, zoom, show,
    fit() { scale = 0; paint(); },
    set(frame, shown) {
      width = frame.width || 1;
      height = frame.height || 1;
      canvas.style.aspectRatio = `${width} / ${height}`;
      pictures = shown;
      paint();
    },
    mode(m) { mode = m; paint(); },
    wipe(share) { wipe = share; paint(); },
    mark(pixel) { marked = pixel; },
    rtlColor(x, y) { return pictures.rtl?.color(x, y); },
    goldenColor(x, y) { return pictures.golden?.color(x, y); },
    scale: now,
    canvas,
  };
})();
