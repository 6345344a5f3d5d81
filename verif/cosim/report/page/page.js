// SPDX-License-Identifier: Apache-2.0
// The page of a run: tables, buttons, keys, and the history of the pixel that is chosen.
"use strict";

const Report = (() => {
  const {data, $, make, count, plural, table, command} = Parts;
  const {run} = data;  // its record: docs/schema/cosim.json
  const first = run.first_difference;
  const channels = run.config.CHANNELS;

  // ---- verdict

  const boardText = (b) => `${b.name} at ${b.port}: ${plural(b.lines_compared, "line")} by ${b.lines_compared === 1 ? "its signature" : "their signatures"}, ` +
      `${count(b.lines_different)} of them different, ${plural(b.registers_compared, "register")}, ${plural(b.runs, "list")}` +
      (b.screen.shown ? `, ${count(b.screen.underrun_lines)} lines too late for the screen` : "") +
      (b.loop ? `; ${plural(b.loop.frames, "frame")} ${count(b.loop.repetitions)} times, ${plural(b.loop.mismatches, "line")} different` : "");

  function verdict() {
    const terms = [];
    if (first) terms.push(["First difference", first.text], ...Parts.divergenceTerms(first, data.gtkwave));
    if (data.different_pixels !== null)
      terms.push(["Differing pixels", `${count(data.different_pixels)} in ${plural(data.region_count, "region")}`]);
    if (run.board) terms.push(["Board", boardText(run.board)]);
    if (run.degraded.length) terms.push(["Left out", run.degraded.join("; ")]);
    Parts.verdict(run.same, run.board ? "kage board" : "kage cosim", run.scene, data.headline.replace(/^\w+: /, "") + (run.same ? "" : "; a difference ends the run"), terms);
    if (first && first.x !== null) {
      const button = make("button", "Show that pixel", {type: "button", id: "show-first"});
      button.addEventListener("click", () => {
        select(first.frame, first.x, first.line, 16);
        View.canvas.scrollIntoView({block: "center"});
        View.canvas.focus({preventScroll: true});
      });
      $("first").append(button);
    }
  }

  // ---- frames and pictures

  let frame = data.frames[0];
  let mode = "golden";
  let chosen = null;

  const address = (picture) => `data:image/png;base64,${data.pictures[picture.data]}`;

  async function decoded(picture) {
    if (!picture || picture.data === null) return undefined;
    if (picture.shown) return picture.shown;
    const image = new Image();
    image.src = address(picture);
    await image.decode();
    const canvas = make("canvas");
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const context = canvas.getContext("2d", {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    const color = (x, y) => [...context.getImageData(x, y, 1, 1).data].slice(0, channels);
    return picture.shown = {canvas, color};
  }

  const modes = [["golden", "Golden"], ["rtl", "RTL"], ["difference", "Difference"], ["wipe", "Slider"]];

  function setMode(m) {
    mode = m;
    for (const b of $("modes").children) {
      const on = b.dataset.mode === m;
      b.setAttribute("aria-checked", on);
      b.tabIndex = on ? 0 : -1;
    }
    $("wipe-label").hidden = m !== "wipe";
    View.mode(m);
    caption();
  }

  // What the RTL drew of a frame that differs, where it is not on the page.
  const missing = () => !frame.same && frame.rtl && frame.rtl.data === null ? frame.rtl : null;

  function caption() {
    const name = modes.find(([m]) => m === mode)[1];
    let text = `Frame ${frame.frame}, ${mode === "wipe" ? "golden on the left, RTL on the right" : name.replace(/^[GD]/, (s) => s.toLowerCase())}.`;
    if (!frame.golden) text += " It has no pixels.";
    else if (frame.golden.data === null) text += ` Its picture is not on this page, which would be too large: see ${frame.golden.name}.`;
    else if (missing()) text += ` The RTL's picture is not on this page, which would be too large: see ${missing().name}.`;
    else if (frame.taken) text += " Not run this time: an earlier run found that golden model and RTL are the same, bit for bit.";
    else if (frame.same) text += " Golden model and RTL are the same, bit for bit.";
    else if (mode === "difference") text += " Red differs, the brighter the further apart.";
    if (frame.missing && mode !== "golden") text += ` ${plural(frame.missing, "pixel")} never came: black.`;
    if (frame.error) text += ` ${frame.same ? "Both cores" : "The golden model"} ended it with ${frame.error.text}.`;
    $("caption").textContent = text;
  }

  async function setFrame(number) {
    const mine = frame = data.frames.find((f) => f.frame === number) ?? frame;
    for (const b of $("strip").children) b.setAttribute("aria-pressed", b.dataset.frame === String(frame.frame));
    const golden = await decoded(frame.golden);
    const rtl = frame.same ? golden : await decoded(frame.rtl);
    const difference = frame.same ? golden && {...golden, dim: true} : await decoded(frame.difference);
    if (frame !== mine) return false;  // another was chosen meanwhile
    View.set(frame, {golden, rtl, difference});
    $("x").max = frame.width - 1;
    $("y").max = frame.height - 1;
    caption();
    regions();
    phases();
    return true;
  }

  function step(by) {
    const at = data.frames.indexOf(frame) + by;
    if (at < 0 || at >= data.frames.length) return;
    select(data.frames[at].frame, chosen?.x ?? 0, chosen?.y ?? 0);
    $("strip").children[at].scrollIntoView({block: "nearest", inline: "nearest"});
  }

  function strip() {
    for (const f of data.frames) {
      const picture = f.golden && f.golden.data !== null
        ? make("img", "", {src: address(f.golden), alt: "", loading: "lazy"})
        : make("span", "no picture", {class: "none"});
      const label = make("span", f.same ? `${f.frame}: same` : `${f.frame}: different`, f.same ? {} : {class: "bad"});
      const button = make("button", [picture, label], {type: "button", "data-frame": f.frame, "aria-pressed": false});
      button.addEventListener("click", () => select(f.frame, chosen?.x ?? 0, chosen?.y ?? 0));
      $("strip").append(button);
    }
    for (const [m, name] of modes) {
      const b = make("button", name, {type: "button", role: "radio", "data-mode": m, title: `${name} (${modes.findIndex((k) => k[0] === m) + 1})`});
      b.addEventListener("click", () => setMode(m));
      $("modes").append(b);
    }
    // As radio buttons have it: one stop for Tab, arrows choose.
    $("modes").addEventListener("keydown", (e) => {
      const by = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
      if (!by) return;
      e.preventDefault();
      const at = modes.findIndex(([m]) => m === mode);
      setMode(modes[(at + by + modes.length) % modes.length][0]);
      $("modes").querySelector("[aria-checked=true]").focus();
    });
  }

  function regions() {
    $("regions").replaceChildren();
    if (frame.same) return;
    const jump = (text, x, y) => {
      const b = make("button", text, {type: "button"});
      b.addEventListener("click", () => select(frame.frame, x, y, 16));
      $("regions").append(b);
    };
    const told = data.told.filter((p) => p.frame === frame.frame);
    if (told.length) {
      $("regions").append(run.board ? "The first that differs:" : "Told with the RTL's values:");
      for (const p of told) jump(`${p.x},${p.y}`, p.x, p.y);
    }
  }

  // ---- the pixel

  const swatch = (name, color) => {
    const css = color.length === 1 ? [color[0], color[0], color[0]] : color;
    const box = make("i");
    box.style.background = `rgb(${css.join(",")})`;
    return make("span", [box, `${name} ${color.join(",")}`], {class: "swatch"});
  };

  function touchItem(t, rtl) {
    const item = make("li", [
      make("div", `${t.token}  ${t.text}`, {class: "token mono"}),
      ...t.from ? [make("div", `from ${t.from}`, {class: "from"})] : [],
      make("div", t.effect),
    ]);
    for (const line of t.tree ?? []) item.append(make("div", line, {class: "tree"}));
    if (t.now) item.append(make("div", `now ${t.now}`, {class: "now"}));
    for (const r of rtl) item.append(rtlLine(r, true));
    return item;
  }

  // With the token where it does not stand below its own.
  function rtlLine(r, own) {
    const place = `RTL, ${own || !r.state ? "" : `token ${r.token}, `}cycle ${r.cycle}, ${r.stage}${r.load ? " (its colour comes back)" : ""}: `;
    // Each value that differs is marked, with the golden model's.
    const values = r.values.flatMap((v, i) => [i ? ", " : "", v.golden ? make("b", `${v.text} (golden ${v.golden})`) : v.text]);
    const end = r.same || r.values.some((v) => v.golden) ? [] : [make("b", " differs")];
    return make("div", [place, ...values, ...end], {class: r.same ? "rtl" : "rtl bad"});
  }

  function historyList(h, rtl) {
    const list = make("ol", "", {class: "history"});
    const rest = [...rtl];
    const take = (is) => {
      const taken = [];
      while (rest.length && is(rest[0].nth)) taken.push(rest.shift());
      return taken;
    };
    for (const t of h.touches) {
      // At tokens of which the history has nothing, as a line's first TP paints pixels beside its span.
      const before = take((nth) => nth < t.nth);
      if (before.length) list.append(make("li", before.map((r) => rtlLine(r, false))));
      list.append(touchItem(t, take((nth) => nth === t.nth)));
    }
    const end = make("li", make("div", h.color_text, {class: "end"}));
    const last = h.touches.at(-1)?.token;
    for (const r of rest) end.append(rtlLine(r, false));
    if (h.left_out?.length) {
      end.append(make("div", "left out, for it changes nothing here (--all-spans shows it):", {class: "from"}));
      for (const line of h.left_out) end.append(make("div", line, {class: "from"}));
    }
    if (last === undefined) end.prepend(make("div", "no token of the line touches it"));
    list.append(end);
    return list;
  }

  let asked = 0;

  async function explain(number, x, y) {
    const mine = ++asked;
    const golden = View.goldenColor(x, y);
    const rtl = frame.same ? golden : View.rtlColor(x, y);
    const differs = golden && rtl && golden.some((v, i) => v !== rtl[i]);
    const parts = [make("p", `Frame ${number}, column ${x}, line ${y}`, {id: "where"})];
    if (golden) {
      parts.push(make("div", [swatch("golden", golden), ...rtl ? [swatch("RTL", rtl)] : []], {class: "swatches"}));
      const came = y * frame.width + x < frame.width * frame.height - (frame.missing ?? 0);
      if (differs) parts.push(make("p", came ? "They differ here." : "The RTL's pixel never came.", {class: "badly"}));
    }
    let told = Explain.told(number, x, y);
    let history = told;
    if (!history) {
      try {
        history = await Explain.history(number, x, y);
      } catch (e) {
        parts.push(make("p", `The tokens on this page cannot be unpacked: ${e}`, {class: "badly"}));
      }
    }
    if (mine !== asked) return;
    if (history) {
      const wrong = golden && history.color && history.color.some((v, i) => v !== golden[i]);
      if (wrong) parts.push(make("p", `This history ends with ${history.color.join(",")}, and the picture has another ` +
          "colour: trust the command below.", {class: "badly"}));
      parts.push(historyList(history, told?.rtl ?? []));
      const more = !told && run.options && !run.options.all_spans ? ", with what is left out here" : "";
      if (Explain.data.explain) parts.push(make("p", `The same in a terminal${more}:`, {class: "note"}));
    } else {
      parts.push(make("p", "This page has no room for the tokens of this line." +
          (Explain.data.explain ? " This prints the pixel's history:" : "")));
    }
    if (Explain.data.explain) parts.push(command(Explain.command(number, x, y, differs || (!frame.same && !rtl))));
    $("pixel").replaceChildren(...parts);
    $("said").textContent = `column ${x}, line ${y}` + (golden ? `, golden ${golden.join(" ")}` : "") +
        (differs ? `, RTL ${rtl.join(" ")}` : "") + (history ? `, ${history.color_text}` : "");
    $("pixel").dataset.done = `${number}/${x}/${y}`;
  }

  async function select(number, x, y, least = 0) {
    const there = number === frame.frame && $("strip").querySelector("[aria-pressed=true]");
    if (!there && !await setFrame(number)) return;
    chosen = {x: Math.min(Math.max(x, 0), frame.width - 1), y: Math.min(Math.max(y, 0), frame.height - 1)};
    if (!frame.golden) chosen = null;
    View.mark(chosen);
    View.show(least);
    if (!chosen) return;
    $("x").value = chosen.x;
    $("y").value = chosen.y;
    await explain(frame.frame, chosen.x, chosen.y);
  }

  // ---- tables

  function frames() {
    const heads = ["frame", "verdict", "clocks", "no input", "output blocked", "spans", "span pixels", "segments", "words"];
    // On a board no clock is counted, and none is lost that anybody saw.
    const known = (row) => run.board ? row.map((n, i) => i < 3 ? null : n) : row;
    const numbers = data.frames.map((f) => known([...Parts.numbers(f), f.words]));
    const sums = known(numbers.reduce((sum, row) => sum.map((n, i) => n + row[i])));
    table($("table"), heads,
          data.frames.map((f, i) => [f.frame, Parts.verdictWord(f), ...numbers[i].map(count)]),
          data.frames.length > 1 ? ["all", "", ...sums.map(count)] : null);
    data.frames.forEach((f, i) => { if (!f.same) $("table").tBodies[0].rows[i].className = "bad"; });
    if (data.frames.length < run.frames)
      $("table").after(make("p", `${plural(run.frames, "frame")} were compared; this page has the first ` +
          "of them, and one that is different.", {class: "note"}));
  }

  function phases() {
    $("phases-title").textContent = `Frame ${frame.frame} by phase`;
    if (!frame.phases) return $("phases").replaceChildren();
    const stalls = (name) => Parts.stalls(frame.stalled_by_phase[name] ?? {input_starved: 0, output_blocked: 0}).map(count);
    const share = (n) => frame.cycles ? `${(100 * n / frame.cycles).toFixed(1)} %` : "";
    // What stays in the front end takes no clocks of the core behind it.
    const work = (name, tokens, pixels, clocks) => name === "polygons" ? ["", "", count(tokens), ""]
        : [count(clocks), share(clocks), count(tokens), count(pixels)];
    const rows = frame.phases.map((sum, i) => [data.phase_names[i], ...work(data.phase_names[i], ...sum), ...stalls(data.phase_names[i]), data.phase_tokens[i]])
        .filter(([name]) => name !== "polygons" || run.config.ACTIVE > 0);
    rows.push(["video", count(frame.video), share(frame.video), "", "", "", "", ""]);
    const left = frame.cycles - frame.designed;
    if (frame.cycles) rows.push(["the rest", count(left), share(left), "", "", ...stalls("behind the last token"), ""]);
    table($("phases"), ["phase", "clocks", "of the frame's", "tokens", "pixels", "no input", "output blocked", "which"], rows,
          ["RTL", count(frame.cycles), "", "", "", ...Parts.stalls(frame.stalled).map(count), ""]);
    for (const row of $("phases").rows) row.cells[7].className = "words";
  }

  function rest() {
    const on = run.board ? [", with board ", make("code", run.board.name)] : [", with the RTL of ", make("code", run.rtl)];
    const where = ["In ", make("code", run.folder), ...on];
    if (run.again) $("again").append(make("p", [...where, ":"]), command(run.again));
    else $("again").append(make("p", [...where, ", by a program whose own scene this is: no command line has it."]));
    $("again").append(make("p", run.board ? `The board played for ${run.board.seconds.toFixed(3)} s; its clocks are not counted.`
        : `Seed ${run.seed}. Golden model ${run.golden_seconds.toFixed(3)} s, RTL ${run.rtl_seconds.toFixed(3)} s.`));
    $("again").append(make("p", `Made by ${run.versions.join("; ")}.`, {class: "note"}));
    for (const note of run.notes) $("again").append(make("p", note, {class: "note"}));
    $("config-name").textContent = run.config_name;
    Parts.configTable($("config"), run.config);
  }

  // ---- keys and buttons

  function key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const far = e.shiftKey ? 10 : 1;
    const move = {ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far]}[e.key];
    if (move && chosen) select(frame.frame, chosen.x + move[0], chosen.y + move[1]);
    else if (e.key === " ") setMode(mode === "rtl" ? "golden" : "rtl");
    else if (["1", "2", "3", "4"].includes(e.key)) setMode(modes[e.key - 1][0]);
    else if (e.key === "+" || e.key === "=") zoom(2);
    else if (e.key === "-") zoom(0.5);
    else if (e.key === "0") View.fit();
    else if (e.key === "n") step(1);
    else if (e.key === "p") step(-1);
    else return;
    e.preventDefault();
  }

  // By buttons and keys the chosen pixel is what stays in view.
  function zoom(factor) {
    View.zoom(factor);
    if (chosen && factor > 1) View.show(View.scale());
  }

  async function start() {
    verdict();
    strip();
    frames();
    rest();
    setMode(run.same ? "golden" : "difference");
    Parts.sideways();
    View.canvas.addEventListener("keydown", key);  // single letters are the picture's alone
    View.canvas.addEventListener("pixel", (e) => select(frame.frame, e.detail.x, e.detail.y));
    $("in").addEventListener("click", () => zoom(2));
    $("out").addEventListener("click", () => zoom(0.5));
    $("fit").addEventListener("click", () => View.fit());
    $("wipe").addEventListener("input", () => View.wipe($("wipe").value / 100));
    $("goto").addEventListener("submit", (e) => {
      e.preventDefault();
      select(frame.frame, Number($("x").value), Number($("y").value));
    });
    // A page over several runs links to frames: #frame=3.
    const linked = /^#frame=(\d+)$/.exec(location.hash);
    const shown = linked ? Number(linked[1]) : first?.frame ?? frame.frame;
    const pixel = first && first.x !== null && first.frame === shown ? {x: first.x, y: first.line} : null;
    frame = data.frames.find((f) => f.frame === shown) ?? frame;
    View.set(frame, {});  // the size is known before the pictures are
    await select(frame.frame, pixel ? pixel.x : Math.floor(frame.width / 2), pixel ? pixel.y : Math.floor(frame.height / 2));
    document.body.dataset.ready = "yes";
  }

  return {start, select};
})();

Report.start();
