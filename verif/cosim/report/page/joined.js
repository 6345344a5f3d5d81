// SPDX-License-Identifier: Apache-2.0
// The page over several scenes and shards: verdict, tables, and the way to each run's own page.
"use strict";

(() => {
  const {data, $, make, count, plural, table, command} = Parts;
  const name = (scene) => data.scenes[scene].scene;  // each is a record: docs/schema/cosim.json
  const word = (same) => same === null ? "not compared" : same ? "same" : "different";
  const page = (part, scene) => part.runs.find((r) => r.scene === scene)?.page ?? null;
  const link = (text, address) => address === null ? text : make("a", text, {href: address});
  const partOf = (row) => data.parts.find((p) => p.index === row.part);

  // Of the register check, which has no frame, behind all frames.
  const place = (run) => run.difference.frame ?? Number.MAX_VALUE;

  // All differences, as far as shards found them: the first frame of the first scene is what the verdict tells.
  function differences() {
    const all = data.parts.flatMap((part) => part.runs.filter((r) => r.difference).map((r) => ({part, ...r})));
    return all.sort((a, b) => a.scene - b.scene || place(a) - place(b));
  }

  const several = data.scenes.length > 1;
  const ofScene = (scene, text) => several ? `${name(scene)}, ${text}` : text;

  function verdict() {
    const [first, ...more] = differences();
    const terms = [];
    if (first) {
      const {text, frame} = first.difference;
      terms.push(["First difference", ofScene(first.scene, text)]);
      terms.push(...Parts.divergenceTerms(first.difference, first.gtkwave));
      if (first.page) terms.push(["Look at it", link(frame === null ? "the page of its run" : `frame ${frame} on the page of its run`, first.page)]);
    }
    if (more.length) terms.push(["Other runs", `${plural(more.length, "difference")} more, below`]);
    Parts.verdict(data.same, data.command, data.name, data.headline, terms);
  }

  const numbers = (r) => Parts.numbers(r).map(count);
  const heads = ["clocks", "no input", "output blocked", "spans", "span pixels", "segments"];
  const bad = (element, rows) => rows.forEach((r, i) => { if (r.same !== true) element.tBodies[0].rows[i].className = r.same === null ? "none" : "bad"; });

  function scenes() {
    const columns = data.scenes.map((s) => [s.frames, s.total_frames, ...Parts.numbers(s)]);
    const [frames, total, ...sums] = columns.reduce((sum, row) => sum.map((n, i) => n + row[i])).map(count);
    table($("scenes"), ["scene", "verdict", "frames compared", "of", "size", ...heads, "configuration"],
          data.scenes.map((s) => [s.scene, word(s.same), count(s.frames), count(s.total_frames), `${s.width}x${s.height}`,
                                  ...numbers(s), s.config_name]),
          several ? ["all", word(data.same), frames, total, "", ...sums, ""] : null);
    bad($("scenes"), data.scenes);
  }

  function frames() {
    const row = (f) => {
      const part = partOf(f);
      const address = f.same === null ? null : page(part, f.scene);
      return [name(f.scene), link(String(f.frame), address && `${address}#frame=${f.frame}`), f.same === null ? word(null) : Parts.verdictWord(f), part.name,
              ...f.stalled ? [...numbers(f), count(f.words)] : Array(heads.length + 1).fill("")];
    };
    table($("table"), ["scene", "frame", "verdict", "run", ...heads, "words"], data.frames.map(row));
    bad($("table"), data.frames);
    $("left-out").textContent = data.left_out ? `${plural(data.left_out, "frame")} more, none of them different, are not listed.` : "";
  }

  function runLine(part, r) {
    const text = `${name(r.scene)}: ${word(r.same)}, ${plural(r.frames, "frame")}`;
    const item = make("li", r.page === null ? `${text}; its page is not here` : [`${text}; `, link("its page", r.page)]);
    if (!r.difference) return item;
    item.className = "bad";
    item.append(make("div", r.difference.text));
    if (r.difference.divergence) item.append(make("div", `first divergence: ${r.difference.divergence.text}`));
    return item;
  }

  function parts() {
    $("parts-title").textContent = data.command === "kage merge" ? "Shards, and how to run them again" : "Run it again";
    for (const p of data.parts)
      $("parts").append(make("section", [
        make("h3", `${p.name}: ${word(p.same)}`, p.same ? {} : {class: "badly"}),
        make("ul", p.runs.map((r) => runLine(p, r))),
        make("p", ["In ", make("code", p.folder), ", with the RTL of ", make("code", p.rtl), ":"]),
        command(p.again),
        make("p", `${p.file ? `Report ${p.file}. ` : ""}Seed ${data.seed}. Golden model ${p.golden_seconds.toFixed(3)} s, RTL ` +
            `${p.rtl_seconds.toFixed(3)} s. Made by ${p.versions.join("; ")}.`, {class: "note"}),
      ], {class: "part"}));
    if (new Set(data.parts.map((p) => p.versions.join())).size > 1)
      $("parts").prepend(make("p", "The shards were made by different versions.", {class: "badly"}));
    for (const s of data.scenes) {
      const said = [...s.degraded.map((what) => `drawn without ${what}`), ...s.notes];
      for (const note of said) $("parts").append(make("p", `${s.scene}: ${note}`, {class: "note"}));
    }
  }

  // One table for all scenes that have the same one.
  function configs() {
    const groups = new Map();
    for (const s of data.scenes) {
      const key = JSON.stringify([s.config_name, s.config]);
      if (!groups.has(key)) groups.set(key, {scene: s, names: []});
      groups.get(key).names.push(s.scene);
    }
    for (const {scene, names} of groups.values()) {
      const element = make("table");
      Parts.configTable(element, scene.config);
      $("configs").append(make("details", [
        make("summary", `${scene.config_name}: ${names.join(", ")}`),
        make("div", element, {class: "scroll", tabindex: 0, role: "region", "aria-label": `Parameters of ${names.join(", ")}`}),
      ], groups.size === 1 ? {open: ""} : {}));
    }
  }

  verdict();
  scenes();
  frames();
  parts();
  configs();
  Parts.sideways();
  document.body.dataset.ready = "yes";
})();
