// SPDX-License-Identifier: Apache-2.0
// The history of a pixel, from the tokens that the page holds: what `kage explain` says, in its words. It follows
// docs/stream.md; cli/report holds it against the program, pixel by pixel. No document is touched here.
"use strict";

const Explain = (() => {
  const data = Parts.data;
  const c = data.run.config;
  const clear = 2 ** c.Z_BITS - 1;
  const dsfMask = 2 ** c.DSF_BITS - 1;
  const blank = 2 ** c.FACE_BITS - 1;
  const stream = Stream.of(c);

  // ---- words and tokens

  const bands = new Map();
  for (const [frame, line, token, ahead, packed, indexed] of data.bands) bands.set(`${frame}/${line}`, {token, ahead, packed, indexed});

  async function unpack(band) {
    if (band.words) return band.words;
    const bytes = Uint8Array.from(atob(band.packed), (s) => s.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const raw = new DataView(await new Response(stream).arrayBuffer());
    band.words = Uint32Array.from({length: raw.byteLength / 4}, (_, i) => raw.getUint32(4 * i, true));
    return band.words;
  }

  const colorText = (color) => color.slice(0, c.CHANNELS).join(",");

  // ---- what a span brings to a pixel

  function ramp(value, step, k, bits, frac) {
    return Number(BigInt.asIntN(bits, BigInt(value) + BigInt(step) * BigInt(k)) >> BigInt(frac));
  }
  const clamp = (v, low, high) => Math.min(Math.max(v, low), high);
  const depthAt = (z, dz, k) => clamp(ramp(z, dz, k, stream.width.depth_bits, c.Z_FRAC), 1, clear - 1);
  const colorAt = (t, x) => !c.SMOOTH ? t.color :
      t.color.map((v, i) => clamp(ramp(v, t.dcolor[i], x - t.xl, stream.width.ramp_bits, c.COLOR_FRAC), 0, 255));

  // ---- the pixel

  class Pixel {
    constructor(frame, state, x, y) {
      this.frame = frame;
      this.state = state;
      this.x = x;
      this.y = y;
      this.z = clear;
      this.color = [0, 0, 0];
      this.class = 0;
      this.dsf = 0;
      this.fsf = 0;
      this.counts = Array(c.COUNT_BITS > 0 ? c.LIGHTS : 0).fill(0);
      this.bias = 0;
      this.painted = false;
      this.touches = [];
      this.background = [0, 8, 16].map((s) => frame.background >>> s & 255).slice(0, c.CHANNELS);
    }

    text() {
      const drawn = this.z !== clear;
      const color = drawn || this.painted ? this.color : [0, 0, 0];
      let text = drawn ? `Z ${this.z}, colour ${colorText(color)}` :
          color.some((v) => v !== 0) ? `clear, colour ${colorText(color)}` : "clear";
      if (c.DSF_BITS === 0) return text;
      if (drawn) text += c.CLASS_BITS > 1 ? `, class ${this.class}` : this.class ? ", lit" : ", unlit";
      text += `, DSF ${this.dsf}`;
      if (c.FSF) text += `, FSF ${this.fsf}`;
      if (c.COUNT_BITS > 0) text += `, counts ${this.counts.join(" ")}`;
      return text;
    }

    sum() { return (this.dsf + this.bias) & dsfMask; }

    order(z) {
      const depth = this.z === clear ? "clear" : this.z;
      if (z < this.z) return `Z ${z} is nearer than ${depth}`;
      return z === this.z ? `Z ${z} is no nearer: equal, and the first stays` : `Z ${z} is behind ${depth}`;
    }

    draw(z, color, cls, of = "") {
      const order = this.order(z);
      if (z >= this.z) return `hidden: ${order}`;
      this.z = z;
      this.color = color.slice(0, c.CHANNELS);
      this.class = c.DSF_BITS > 0 ? cls : 0;
      return `drawn: ${order}${of}; colour ${colorText(this.color)}`;
    }

    // What the token does here and to the line, in words.
    does(t) {
      const here = t.xl === undefined || t.xl <= this.x && this.x < t.xr;
      switch (t.kind) {
        case "OP":
          return here ? this.draw(depthAt(t.z, t.dz, this.x - t.xl), colorAt(t, this.x), t.class) : "";
        case "SP": {
          if (!here) return "";
          const z = depthAt(t.z, t.dz, this.x - t.xl);
          if (z >= this.z) return `not counted: ${this.order(z)}`;
          return `counted: ${this.order(z)}; ${this.count(t.w)}`;
        }
        case "NC":
          return here ? `counted, whatever its depth: ${this.count(t.w)}` : "";
        case "IF":
          this.bias = (this.bias + t.w) & dsfMask;
          return `the eye is in the volume for all the line: bias ${this.bias}`;
        case "EV": {
          const sum = this.sum();
          this.bias = 0;
          if (!here) return "";
          this.dsf = 0;
          if (sum) this.fsf = 1;
          return `end of a volume: DSF + bias = ${sum}, so the pixel is ${sum ? "in" : "not in"} it` +
              (this.fsf ? "; FSF is 1" : "");
        }
        case "ES": {
          const shadow = c.FSF ? this.fsf !== 0 : this.sum() !== 0;
          this.bias = 0;
          if (!here) return "";
          if (shadow) this.counts[t.light] = Math.min(this.counts[t.light] + 1, 2 ** c.COUNT_BITS - 1);
          if (c.FSF) this.fsf = 0;
          else this.dsf = 0;
          return `end of a sample of light ${t.light}: ` +
              `${shadow ? "in shadow" : "not in shadow"}; count ${this.counts[t.light]}`;
        }
        case "RESOLVE": {
          const text = this.resolve();
          this.dsf = this.fsf = this.bias = 0;
          this.counts.fill(0);
          return text;
        }
        case "TP":
          return this.blend(t, here);
        default:
          return "";
      }
    }

    count(w) {
      const before = this.dsf;
      this.dsf = (before + w) & dsfMask;
      return `DSF ${before} ${Stream.withSign(w)} = ${this.dsf}`;
    }

    // Which tells what is lost, and takes it.
    resolve() {
      if (this.z === clear) return "nothing is drawn here";
      if (this.class === 0) return "unlit: no light is lost";
      const one = 2 ** c.SHADE_FRAC;
      const before = this.color;
      const darken = (keep) => this.color.map((v, i) => Math.floor((v * keep(i) + one / 2) / one));
      if (c.COUNT_BITS === 0) {
        if (!(c.FSF ? this.fsf : this.sum())) return "not in shadow";
        this.color = darken(() => one - this.state.shade);
        return `in shadow: colour ${colorText(before)} becomes ${colorText(this.color)}, ` +
            `${one - this.state.shade} of ${one} kept`;
      }
      const lost = this.counts.map((n, l) => n ? `light ${l} lost ${n} sample${n === 1 ? "" : "s"}` : "").filter((s) => s);
      if (lost.length === 0) return "not in shadow";
      this.color = darken((i) => Math.max(0, one - this.counts.reduce((sum, n, l) => sum + n * this.share(l, i), 0)));
      return `in shadow: ${lost.join(", ")}, class ${this.class}; ` +
          `colour ${colorText(before)} becomes ${colorText(this.color)}`;
    }

    share(light, channel) {
      if (c.CLASS_BITS === 1) return this.state.shade;
      return this.state.shares[(this.class - 1) * c.LIGHTS + light]?.[channel] ?? 0;
    }

    // The first TP of a line gives all its clear pixels the background's colour.
    blend(t, here) {
      if (!this.painted && this.z === clear) this.color = this.background;
      this.painted = true;
      if (!here) return "";
      const z = depthAt(t.z, t.dz, this.x - t.xl);
      if (z >= this.z) return `hidden: ${this.order(z)}`;
      const over = colorAt(t, this.x);
      const under = this.color;
      this.color = under.map((v, i) => {
        const sum = 255 * v + t.alpha * (over[i] - v) + 128;
        return sum + (sum >> 8) >> 8;
      });
      return `blended over: ${this.order(z)}; ${t.alpha} of 255 of ${colorText(over)} on ${colorText(under)} ` +
          `gives ${colorText(this.color)}`;
    }
  }

  // ---- units and the tree

  // The SEGs of the units, by unit, as they come; a TREE takes a line of each.
  class Units {
    constructor() { this.waiting = Array.from({length: c.UNITS}, () => []); }

    add(t) { this.waiting[t.unit].push(t); }

    // What each unit has at x, and the line is gone.
    take(width, x, faces) {
      return this.waiting.map((segments, unit) => {
        let at = 0;
        let pixel = {z: clear, index: 65535, color: [0, 0, 0], class: 0};
        while (at < width && segments.length > 0) {
          const s = segments.shift();
          if (at <= x && x < at + s.dx && s.face !== blank) {
            const f = faces[unit][s.face];
            pixel = {z: depthAt(s.z, f.dz, x - at), index: f.index, color: f.color, class: f.class ?? 0};
          }
          at += s.dx;
        }
        return pixel;
      });
    }
  }

  const unitText = (p) => p.z === clear ? "nothing" : `Z ${p.z} of index ${p.index}`;

  // The winner, and the way to it in words.
  function merge(units) {
    const lines = units.flatMap((p, u) => p.z === clear ? [] : [`unit ${u}: ${unitText(p)}`]);
    let now = units;
    for (let level = 1; now.length > 1; ++level) {
      const next = [];
      for (let i = 0; i < now.length; i += 2) {
        const [left, right] = [now[i], now[i + 1]];
        const second = right !== undefined && (right.z < left.z || right.z === left.z && right.index < left.index);
        if (right !== undefined && (left.z !== clear || right.z !== clear))
          lines.push(`level ${level}: ${unitText(left)} against ${unitText(right)}: the ${second ? "second" : "first"} wins`);
        next.push(second ? right : left);
      }
      now = next;
    }
    return {pixel: now[0], lines};
  }

  function tree(pixel, units, frame) {
    const {pixel: p, lines} = merge(units.take(frame.width, pixel.x, pixel.state.faces));
    if (p.z === clear) return {effect: "no polyhedron is here", tree: lines};
    return {effect: pixel.draw(p.z, p.color, p.class, `, of the polyhedron with draw index ${p.index}`), tree: lines};
  }

  // ---- a frame's state and a line's history

  async function frameState(number) {
    const state = {shade: 0, shares: [], faces: Array.from({length: c.UNITS}, () => [])};
    const band = bands.get(`${number}/-1`);
    if (band === undefined) return null;
    if (band.state) return band.state;
    const words = await unpack(band);
    for (let at = 0; at < words.length;) {
      if (band.indexed) ++at;
      const t = stream.decode(words, at);
      at += t.words;
      if (t.kind === "SHADE") state.shade = t.shade;
      if (t.kind === "TABLE") state.shares.push(t.share);
      if (t.kind === "FACE") state.faces[t.unit]?.push(t);
    }
    return band.state = state;
  }

  const bandLine = (y) => Math.floor(y / data.band_lines) * data.band_lines;

  // Whether the tokens of a line are on the page.
  const has = (number, y) => bands.has(`${number}/-1`) && bands.has(`${number}/${bandLine(y)}`);

  function leaves(pixel) {
    if (pixel.z === clear && !pixel.painted) return `nothing was drawn: background ${colorText(pixel.background)}`;
    return `the pixel leaves with colour ${colorText(pixel.color)}`;
  }

  // {touches: [{token, text, effect, now, tree}], color_text, color}, or null where the page lacks the tokens.
  async function history(number, x, y) {
    const frame = data.frames.find((f) => f.frame === number);
    if (!frame || !has(number, y)) return null;
    const failed = frame.error !== null && frame.error.line <= y;
    const state = await frameState(number);
    const band = bands.get(`${number}/${bandLine(y)}`);
    const words = await unpack(band);
    const pixel = new Pixel(frame, state, x, y);
    const units = new Units();
    let line = bandLine(y);
    let index = band.token - band.ahead;
    let text = "";
    for (let at = 0; at < words.length && line <= y; ++index) {
      let made = false;  // by the front end, of the stream's token that a word ahead of it names
      if (band.indexed) {
        index = words[at] % 2 ** 31;
        made = words[at++] >= 2 ** 31;
      }
      const t = stream.decode(words, at);
      at += t.words;
      if (failed && index >= frame.error.token) break;
      if (t.kind === "SEG") units.add(t);
      if (line < y) {
        if (t.kind === "TREE") units.take(frame.width, 0, state.faces);
        if (t.kind === "EOL") ++line;
        continue;
      }
      if (t.kind === "EOL") {
        text = leaves(pixel);
        break;
      }
      const before = pixel.text();
      const done = t.kind === "TREE" ? tree(pixel, units, frame) : {effect: pixel.does(t)};
      if (done.effect === "") continue;
      const after = pixel.text();
      pixel.touches.push({token: index, text: stream.text(t) + (made ? ", made by the front end" : ""), ...done, ...(after === before ? {} : {now: after})});
    }
    if (failed) return {touches: pixel.touches, color_text: "background: the frame has an error on this line or before", color: pixel.background};
    const drawn = pixel.z !== clear || pixel.painted;
    return {touches: pixel.touches, color_text: text, color: drawn ? pixel.color : pixel.background};
  }

  // The program's own history of a pixel, with the RTL's values, where the run told it.
  const told = (number, x, y) => data.told.find((p) => p.frame === number && p.x === x && p.y === y) ?? null;

  const command = (number, x, y, rtl = false) =>
    `${data.explain} --frame ${number} --pixel ${x},${y}${rtl ? data.explain_rtl : ""}`;

  return {data, has, history, told, command};
})();
