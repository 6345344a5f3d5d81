// SPDX-License-Identifier: Apache-2.0
// The page of a sweep: limits, the cheapest row within them, the plot, the row that is shown, the table.
"use strict";

const Sweep = (() => {
  const {data, $, make, count, plural, table, command, configTable} = Parts;
  const {rows, more, groups} = data;
  const {costs, wrong, psnr, flip} = Choose;

  let group = 0;
  let tab = 0;
  let cost = "luts";
  let limits = {wrong: Infinity, psnr: -Infinity, flip: Infinity, clocks: Infinity};
  let cheapest = null;
  let chosen = null;
  let frame = 0;
  let sorted = {column: -1, down: false};

  // Figures as a person reads them.
  const digits = (value, most) => value === null || value === undefined ? "\u2212" :
      Number.isInteger(value) ? count(value) : value.toLocaleString("en", {maximumFractionDigits: most}).replaceAll(",", "\u202f");
  const short = (value) => value === null || value === undefined ? "\u2212" : value === 0 || Math.abs(value) >= 100 ? digits(value, 0) :
      String(Number(value.toPrecision(3)));
  const about = (text, estimated) => estimated ? `${text}\u202f~` : text;
  const decibel = (row) => row.accuracy.psnr === null ? "equal" : row.accuracy.psnr.toFixed(1);
  const costText = (row, name) => `${name === "clocks" ? costs.clocks.of(row).toFixed(3) : digits(costs[name].of(row), 0)} ${costs[name].name}` +
      (costs[name].estimated(row) ? " (estimated)" : "");
  // A file is named by as much of its path as tells it from the others; the head and the command have all of it.
  const scenes = [...new Set(groups.map((g) => g.scene))];
  const end = (path, parts) => path.split("/").slice(-parts).join("/");
  const shortName = (path) => {
    let parts = 1;
    while (end(path, parts) !== path && scenes.some((s) => s !== path && end(s, parts) === end(path, parts))) ++parts;
    return end(path, parts);
  };
  const groupName = (g) => `${shortName(g.scene)} at ${g.width}x${g.height}`;
  const groupOf = (i) => groups.findIndex((g) => g.rows.includes(i));

  // ---- limits: a slider over marked values beside a box for any

  // 1, 1.5, 2, 3, 5, 7, 10 and so on, from `least` to the first that is not below `most`.
  function series(least, most) {
    const out = [];
    for (let ten = 10 ** Math.floor(Math.log10(least)); ; ten *= 10) {
      for (const d of [1, 1.5, 2, 3, 5, 7]) {
        const value = Number((d * ten).toPrecision(2));
        if (value >= least) out.push(value);
        if (value >= most) return out;
      }
    }
  }

  // What the sliders stand at, from the laxest to the strictest or the other way round; any and equal are infinite.
  let stops = {wrong: [], psnr: [], flip: [], clocks: []};

  function makeStops() {
    const of = groups[group].rows.map((i) => rows[i]);
    const most = Math.max(...of.map(wrong), 1);
    stops.wrong = [0, ...series(1, most), Infinity];
    const finite = of.map(psnr).filter(Number.isFinite);
    const low = finite.length ? Math.floor(Math.min(...finite)) : 30;
    const high = finite.length ? Math.ceil(Math.max(...finite)) : 60;
    stops.psnr = [-Infinity];
    for (let v = low; v <= high; v += 0.5) stops.psnr.push(v);
    stops.psnr.push(Infinity);
    const seen = of.map(flip);
    const measured = seen.every(Number.isFinite);
    stops.flip = measured ? [0, ...series(Math.max(1e-5, Math.min(1, ...seen.filter((v) => v > 0))), Math.max(1e-5, ...seen)), Infinity] : [Infinity];
    $("flip-limit").hidden = !measured;
    const clocks = of.map(costs.clocks.of);
    stops.clocks = [...series(Math.min(...clocks), Math.max(...clocks)), Infinity];
    for (const [name, values] of Object.entries(stops)) $(name).max = values.length - 1;
  }

  const limitText = (name) => limits[name] === Infinity ? name === "psnr" ? "equal" : "any" :
      limits[name] === -Infinity ? "any" : String(limits[name]);

  // The limit that a text means, or null.
  function limitOf(name, text) {
    const t = text.replace(/\s/g, "").toLowerCase();  // figures of the page are parted by thin spaces
    if (t === "any" || t === "") return name === "psnr" ? -Infinity : Infinity;
    if (t === "equal" && name === "psnr") return Infinity;
    const value = Number(t.replace(",", "."));
    return Number.isFinite(value) && value >= 0 ? value : null;
  }

  function showLimits(typed) {
    for (const [name, values] of Object.entries(stops)) {
      const text = $(`${name}-text`);
      if (name !== typed) text.value = limitText(name);
      text.removeAttribute("aria-invalid");
      // The slider stands at the strictest stop that is not stricter than the limit.
      const at = name === "psnr" ? values.findLastIndex((v) => v <= limits[name]) : values.findIndex((v) => v >= limits[name]);
      $(name).value = at;
      $(name).setAttribute("aria-valuetext", limitText(name));
    }
    const pixels = rows[groups[group].rows[0]].accuracy.pixels;
    $("wrong-note").textContent = limits.wrong === Infinity ? "any number of them" :
        `${count(Math.floor(limits.wrong * pixels / 1e6))} of ${count(pixels)}`;
    $("psnr-note").textContent = limits.psnr === Infinity ? "all colours as in the finest picture" :
        limits.psnr === -Infinity ? "any colours" :
        `off by ${short(255 / 10 ** (limits.psnr / 20))} of 255 steps (root of the mean square)`;
    $("flip-note").textContent = limits.flip === Infinity ? "any colours" : limits.flip === 0 ? "all colours as in the finest picture" :
        "mean over pixels; 0: alike, 1: black on white";
    $("clocks-note").textContent = limits.clocks === Infinity ? "however long it takes" :
        `${short(100 / limits.clocks)} million pixels a second at 100 MHz`;
  }

  function setLimit(name, value, typed) {
    limits[name] = value;
    showLimits(typed);
    find();
    if (cheapest !== null) { choose(cheapest); return; }
    showRow();
    paint();
  }

  // At first no worse than what the scene is drawn with by itself.
  function firstLimits() {
    const members = groups[group].rows;
    const base = rows[members.find((i) => rows[i].axis === "base") ?? members[0]];
    limits = {
      wrong: stops.wrong.find((v) => v >= wrong(base)),
      psnr: stops.psnr.findLast((v) => v <= psnr(base)),
      flip: stops.flip.find((v) => v >= flip(base)),
      clocks: Infinity,
    };
  }

  // ---- the cheapest row

  function find() {
    const members = groups[group].rows;
    cheapest = Choose.cheapest(rows, members, limits, cost);
    const within = members.filter((i) => Choose.keeps(rows[i], limits)).length;
    const box = $("found");
    box.classList.toggle("none", cheapest === null);
    if (cheapest === null) {
      box.replaceChildren(make("p", make("strong", "None of these configurations keeps the limits.")),
                          make("p", "Allow more errors or clocks, or measure further ones by --axes.", {class: "note"}));
      return;
    }
    const row = rows[cheapest];
    const config = make("details", [make("summary", "Its parameters, and how to draw with them"), ...again(cheapest)]);
    config.open = wasOpen;
    config.addEventListener("toggle", () => { wasOpen = config.open; });
    const show = make("button", "Show it", {type: "button", id: "show"});
    show.addEventListener("click", () => choose(cheapest));
    box.replaceChildren(
      make("p", [make("strong", more[cheapest].name, {id: "found-name"}), `: ${costText(row, cost)}`], {class: "name"}),
      make("p", `${short(wrong(row))} wrong pixels in a million, PSNR ${decibel(row)}${row.accuracy.psnr === null ? "" : " dB"}; ` +
          ["luts", "clocks", "ram", "words"].filter((c) => c !== cost).map((c) => costText(row, c)).join(", ") +
          `. ${within} of ${plural(members.length, "configuration")} keep${within === 1 ? "s" : ""} the limits.`),
      show, config);
  }
  let wasOpen = false;

  // The parameters as a file, and the command line that takes it.
  function again(i) {
    const code = make("code", more[i].yaml, {class: "yaml"});
    const button = make("button", "Copy", {type: "button", "aria-label": "Copy the parameters"});
    button.addEventListener("click", () => Parts.copy(more[i].yaml, code, button));
    return [make("p", ["Save these as ", make("code", data.config_file), ", for ", make("code", "--config"), ":"]),
            make("div", [code, button], {class: "command"}),
            make("p", "This draws its pictures:"), command(more[i].command)];
  }

  // ---- the row that is shown

  // How a row stands to the limits, in words. They are those of the scene and size that is chosen.
  const stateOf = (i) => !groups[group].rows.includes(i) ? "\u2212" : i === cheapest ? "cheapest" :
      Choose.keeps(rows[i], limits) ? "within" : `beyond: ${Choose.beyond(rows[i], limits).join(", ")}`;

  function figures(row, i) {
    const {accuracy: a, speed: s, area} = row;
    const share = (n) => `${count(n)} of ${count(a.pixels)}`;
    return [
      ["Limits", stateOf(i)],
      ["Wrong faces", share(a.visible_wrong)],
      ["Wrong shadows", share(a.shadow_wrong)],
      ["Wrong grossly", a.gross_wrong === 0 ? "0" : `${count(a.gross_wrong)}: a bug`],
      ["Colours", a.psnr === null ? "equal to the finest picture's" : `PSNR ${a.psnr.toFixed(2)} dB`],
      ["FLIP", a.flip === null ? "not measured" : short(a.flip)],
      ["Depth, in its steps", `off by ${a.z_error_max_lsb.toFixed(2)}, bound ${a.z_error_bound_lsb.toFixed(2)}`],
      ["Clocks a pixel", about(s.rtl_cycles_per_pixel.toFixed(3), costs.clocks.estimated(row))],
      ["Words a frame", digits(s.words_per_frame, 0)],
      ["Golden core", `${s.golden_ns_per_pixel.toFixed(1)} ns a pixel`],
      ["Look-up tables", about(digits(area.luts, 0), !area.counted)],
      ["Flip-flops", about(digits(area.ffs, 0), !area.counted)],
      ["RAM", `${digits(area.ram_bits, 0)} bits, ${digits(area.bits_per_pixel, 0)} a pixel`],
    ];
  }

  // All that the row has besides its parameters, by the names of docs/schema/sweep.json.
  function flat(value, name = "") {
    if (value === null || typeof value !== "object") return [[name, value === null ? "none" : String(value)]];
    return Object.entries(value).flatMap(([key, inner]) => flat(inner, name ? `${name}.${key}` : key));
  }

  function picture(file, caption) {
    const words = make("figcaption", caption);
    const image = make("img", "", {src: file, alt: words.textContent, decoding: "async"});
    return make("figure", [make("a", image, {href: file, target: "_blank", rel: "noopener"}), words]);
  }

  function pictures(i) {
    const all = more[i].pictures;
    if (!all.length) return [];
    const now = all[Math.min(frame, all.length - 1)];
    const out = [];
    if (all.length > 1) {
      out.push(radios("Frame", all.map((p) => `Frame ${p.frame}`), all.indexOf(now), (k) => { frame = k; showRow(); }));
    }
    const shown = [picture(now.picture, `Frame ${now.frame} as drawn`)];
    if (now.map) {
      const key = (color, text) => make("span", [make("i", "", {style: `background: ${color}`}), text], {class: "swatch"});
      const {face, shadow, color, gross} = data.map_colors;
      shown.push(picture(now.map, ["What is wrong: ", key(face, `face ${count(now.visible_wrong)}`), " ",
        key(shadow, `shadow ${count(now.shadow_wrong)}`), " ", key(color, `colour alone ${count(now.color_wrong)}`),
        ...(now.gross_wrong ? [" ", key(gross, `gross ${count(now.gross_wrong)}, a bug`)] : [])]));
    }
    out.push(make("div", shown, {class: "pictures"}));
    if (!now.map) out.push(make("p", "No pixel of this frame is wrong, in face, shadow or colour.", {class: "note"}));
    return out;
  }

  const opened = new Set();  // which details the reader has open
  function details(name, content) {
    const d = make("details", [make("summary", name), ...content]);
    d.open = opened.has(name);
    d.addEventListener("toggle", () => { if (d.open) opened.add(name); else opened.delete(name); });
    return d;
  }

  function scroll(content, name) {
    return make("div", content, {class: "scroll", tabindex: "0", role: "region", "aria-label": name});
  }

  function showRow() {
    if (chosen === null) return;
    const row = rows[chosen];
    $("row-title").textContent = more[chosen].name;
    const parts = [];
    const here = Plot.together(chosen);
    if (here.length > 1) {
      parts.push(make("p", `${here.length} configurations are at this place of the plot; a click there again goes to the next: ` +
          here.map((i) => more[i].name).join("; "), {class: "note"}));
    }
    parts.push(...pictures(chosen));
    const list = make("dl", figures(row, chosen).flatMap(([name, value]) => [make("dt", name), make("dd", value)]), {class: "figures"});
    const sources = make("table");
    table(sources, ["alone", "wrong faces", "shadow, share", "PSNR, dB"],
          Object.entries(row.accuracy.sources).map(([name, s]) => [
            name === "all" ? "all together" : name, count(s.visible_wrong), short(s.shadow_share),
            s.psnr === null ? "equal" : s.psnr.toFixed(1)]));
    const parameters = make("table");
    configTable(parameters, row.config);
    const {config, ...rest} = row;
    const every = make("table");
    table(every, ["figure", "value"], flat(rest));
    parts.push(list,
               details("What each source of error does", [scroll(sources, "Sources of error"),
                 make("p", ["With the parameters saved as ", make("code", data.config_file), ", this draws a map of each source, and of all:"]),
                 command(`${more[chosen].command} --error-map`)]),
               details("Use it", again(chosen)),
               details("Its parameters in words", [scroll(parameters, "Parameters")]),
               details("Every figure, as --json names it", [scroll(every, "Every figure")]));
    $("row").replaceChildren(...parts);
    $("said").textContent = `${more[chosen].name}, ${stateOf(chosen)}: ${costText(row, cost)}, ${short(wrong(row))} wrong pixels in a million`;
    $("row").dataset.row = chosen;
  }

  function choose(i) {
    const other = groupOf(i);
    if (other !== group) setGroup(other, i);
    chosen = i;
    showRow();
    paint();
  }

  // ---- plot and tabs

  function radios(label, names, at, use) {
    const box = make("div", [], {class: "group", role: "radiogroup", "aria-label": label});
    fillRadios(box, names, at, use);
    return box;
  }

  // Buttons of which one is on, and which the arrow keys go along.
  function fillRadios(box, names, at, use) {
    for (const old of [...box.querySelectorAll("button")]) old.remove();
    const buttons = names.map((name, k) => {
      const b = make("button", name, {type: "button", role: "radio", "aria-checked": String(k === at), tabindex: k === at ? "0" : "-1"});
      b.addEventListener("click", () => take(k));
      return b;
    });
    const take = (k) => {
      buttons.forEach((b, n) => {
        b.setAttribute("aria-checked", String(n === k));
        b.tabIndex = n === k ? 0 : -1;
      });
      use(k);
    };
    box.onkeydown = (e) => {
      const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[e.key];
      const from = buttons.indexOf(document.activeElement);
      if (!step || from < 0) return;
      e.preventDefault();
      const to = (from + step + buttons.length) % buttons.length;
      const label = box.getAttribute("aria-label");
      take(to);
      // The panel may have been filled anew, buttons and all.
      const now = buttons[to].isConnected ? buttons[to] :
          document.querySelectorAll(`[aria-label="${label}"] button`)[to];
      now?.focus();
    };
    box.append(...buttons);
  }

  function showPlot() {
    const plots = groups[group].plots;
    const plot = plots[tab] ?? null;
    fillRadios($("tabs"), plots.map((p) => p.tab), tab, (k) => { tab = k; showPlot(); showRow(); });
    Plot.set(plot);
    $("plot-note").textContent = plot ?
        "Choose a point to see its picture and figures. Green ring: the cheapest within the limits. Ring in the text's colour: " +
        "what is shown beside. Pale: beyond the limits." :
        "There is no plot, because only one configuration of this scene and size was measured.";
    const link = (p, end) => make("a", end.toUpperCase(), {href: `${p.file}.${end}`, target: "_blank", rel: "noopener"});
    $("plot-files").replaceChildren(...(plot ? ["This plot as ", link(plot, "svg"), " and ", link(plot, "png"), "."] : []));
    paint();
  }

  function paint() {
    Plot.state({within: (i) => Choose.keeps(rows[i], limits), cheapest, chosen});
    for (const line of $("table").tBodies[0]?.rows ?? []) {
      const i = Number(line.dataset.row);
      line.querySelector(".state").textContent = stateOf(i);
      line.classList.toggle("chosen", i === chosen);
      line.classList.toggle("cheapest", i === cheapest);
      line.classList.toggle("beyond", groups[group].rows.includes(i) && !Choose.keeps(rows[i], limits));
    }
  }

  function setGroup(g, next = null) {
    group = g;
    tab = Math.min(tab, Math.max(groups[g].plots.length - 1, 0));
    $("group").value = String(g);
    makeStops();
    firstLimits();
    showLimits();
    find();
    chosen = next ?? cheapest ?? groups[g].rows[0];
    showPlot();
    showRow();
  }

  // ---- table

  // A name; what is sorted by, if anything is; and how it is shown, if not as it is.
  const columns = [
    ["configuration", (r, i) => more[i].name],
    ["limits", null],  // filled by paint()
    ...(groups.length > 1 ? [["scene and size", (r, i) => groupName(groups[groupOf(i)])], ["pixels", (r) => r.accuracy.pixels, count]] : []),
    ["wrong, ppm", wrong, (v) => short(v)],
    ["faces", (r) => r.accuracy.visible_wrong, count],
    ["shadows", (r) => r.accuracy.shadow_wrong, count],
    ["gross", (r) => r.accuracy.gross_wrong, count],
    ["PSNR, dB", psnr, (v) => v === Infinity ? "equal" : v.toFixed(1)],
    ["FLIP", (r) => r.accuracy.flip ?? -1, (v) => v < 0 ? "\u2212" : v.toFixed(4)],
    ["depth, steps", (r) => r.accuracy.z_error_max_lsb, (v) => v.toFixed(2)],
    ["clocks a pixel", costs.clocks.of, (v, r) => about(v.toFixed(3), costs.clocks.estimated(r))],
    ["LUTs", costs.luts.of, (v, r) => about(digits(v, 0), !r.area.counted)],
    ["flip-flops", (r) => r.area.ffs, (v, r) => about(digits(v, 0), !r.area.counted)],
    ["RAM, bits", costs.ram.of, count],
    ["words a frame", costs.words.of, (v) => digits(v, 0)],
    ["golden, ns a pixel", (r) => r.speed.golden_ns_per_pixel, (v) => v.toFixed(1)],
  ];

  function fillTable() {
    const heads = columns.map(([name, of], c) => {
      if (!of) return make("th", name, {scope: "col", class: "state"});
      const on = sorted.column === c;
      const b = make("button", [name, make("span", on ? (sorted.down ? " \u2193" : " \u2191") : "", {"aria-hidden": "true"})], {type: "button"});
      b.addEventListener("click", () => {
        sorted = {column: c, down: on && !sorted.down};
        fillTable();
        $("table").tHead.rows[0].cells[c].firstElementChild.focus();
      });
      return make("th", b, {scope: "col", "aria-sort": on ? (sorted.down ? "descending" : "ascending") : "none"});
    });
    const order = rows.map((_, i) => i);
    if (sorted.column >= 0) {
      const of = columns[sorted.column][1];
      const by = (a, b) => typeof a === "string" ? a.localeCompare(b, "en", {numeric: true}) : a < b ? -1 : a > b ? 1 : 0;
      order.sort((a, b) => (sorted.down ? -1 : 1) * by(of(rows[a], a), of(rows[b], b)) || a - b);
    }
    const lines = order.map((i) => {
      const row = rows[i];
      const name = make("button", more[i].name, {type: "button", class: "row-name"});
      const cells = columns.map(([, of, text], c) => c === 0 ? make("th", [row.pareto ? "* " : "", name], {scope: "row"}) :
          !of ? make("td", "", {class: "state"}) : make("td", text ? text(of(row, i), row) : of(row, i)));
      const line = make("tr", cells, {"data-row": i});
      line.addEventListener("click", () => choose(i));
      return line;
    });
    $("table").replaceChildren(make("thead", make("tr", heads)), make("tbody", lines));
    paint();
  }

  // ---- the page

  $("command").textContent = "kage sweep";
  $("name").textContent = scenes.join(", ");
  $("mark").hidden = true;
  $("word").textContent = plural(rows.length, "configuration");
  $("headline").textContent = groups.map((g) => `${groupName(g)}: ${g.rows.length}`).join("; ");
  $("again").append(make("p", data.again), command(data.command));
  $("left-out").textContent = data.left_out;
  $("left-out").hidden = !data.left_out;

  if (rows.length) {
    for (const name of Object.keys(stops)) {
      $(name).addEventListener("input", (e) => setLimit(name, stops[name][Number(e.target.value)]));
      $(`${name}-text`).addEventListener("input", (e) => {
        const value = limitOf(name, e.target.value);
        if (value === null) e.target.setAttribute("aria-invalid", "true"); else setLimit(name, value, name);
      });
      $(`${name}-text`).addEventListener("change", () => showLimits());
    }
    $("limits").addEventListener("submit", (e) => e.preventDefault());
    fillRadios($("costs"), Object.values(costs).map((c) => c.name), 0, (k) => {
      cost = Object.keys(costs)[k];
      find();
      if (cheapest !== null) choose(cheapest);
    });
    $("group-line").hidden = groups.length < 2;
    $("group").append(...groups.map((g, k) => make("option", `${groupName(g)} (${plural(g.rows.length, "configuration")})`, {value: k})));
    $("group").addEventListener("change", (e) => setGroup(Number(e.target.value)));
    Plot.box.addEventListener("row", (e) => choose(e.detail));
    setGroup(0);
    fillTable();
  }
  Parts.sideways();
  document.body.dataset.ready = "yes";

  return {
    choose, setLimit, limitOf,
    get cheapest() { return cheapest; },
    get chosen() { return chosen; },
    get limits() { return limits; },
  };
})();
