// SPDX-License-Identifier: Apache-2.0
// What all pages are made with: the data, elements, tables, command lines to copy, the verdict. All text is set as text,
// never as HTML.
"use strict";

const Parts = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);

  function make(tag, content = "", attributes = {}) {
    const e = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
    for (const part of [content].flat()) e.append(part);
    return e;
  }
  const count = (n) => n === undefined || n === null ? "" : n.toLocaleString("en").replaceAll(",", "\u202f");
  const plural = (n, what) => `${count(n)} ${what}${n === 1 ? "" : "s"}`;

  // Of a record's clocks those that the RTL lost at its ports; and what the tables have of it.
  const stalls = (s) => [s.input_starved, s.output_blocked];
  const numbers = (r) => [r.cycles, ...stalls(r.stalled), r.spans, r.span_pixels, r.segments];

  function table(element, heads, rows, foot) {
    const row = (cells, tag) => make("tr", cells.map((c) => make(tag, c instanceof Node ? c : String(c))));
    element.replaceChildren(make("thead", row(heads, "th")), make("tbody", rows.map((r) => row(r, "td"))));
    if (foot) element.append(make("tfoot", row(foot, "td")));
  }

  async function copy(text, code, button) {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch {
      // Without the right to write to the clipboard the line is selected, ready for the reader's own keys.
      getSelection().selectAllChildren(code);
      button.textContent = "Selected";
    }
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  }

  function command(text) {
    const code = make("code", text);
    const button = make("button", "Copy", {type: "button", "aria-label": `Copy: ${text}`});
    button.addEventListener("click", () => copy(text, code, button));
    return make("div", [code, button], {class: "command"});
  }

  // What the verdict is of: the command's words, the name; then terms of [what, text or element].
  function verdict(same, command, name, headline, terms) {
    $("verdict").className = same ? "same" : "different";
    $("command").textContent = command;
    $("name").textContent = name;
    $("mark").textContent = same ? "\u2713" : "\u2717";
    $("word").textContent = same ? "Same" : "Different";
    $("headline").textContent = headline;
    const list = make("dl");
    for (const [term, text] of terms) list.append(make("dt", term), make("dd", text));
    if (terms.length) $("first").append(list);
  }

  // The verdict of a frame that has one.
  const verdictWord = (frame) => !frame.same ? "different" : frame.taken ? "same, by an earlier run" : "same";

  // The terms of a difference's first divergence; of none, where one was looked for, the text that says so.
  function divergenceTerms({divergence, no_divergence}, gtkwave) {
    if (!divergence) return no_divergence ? [["First divergence", no_divergence]] : [];
    const terms = [["First divergence", divergence.text]];
    if (divergence.waits) terms.push(["Who waits", divergence.waits]);
    if (gtkwave) terms.push(["Waveform", make("code", gtkwave)]);
    return terms;
  }

  function configTable(element, config) {
    table(element, ["parameter", "value", "meaning"],
          Object.entries(config).map(([name, value]) => [name, value, data.meanings[name]]));
    element.classList.add("config");
    for (const row of element.rows) row.cells[2].className = "meaning";
  }

  // Tables that are wider than the page scroll by themselves; their edges and a line below say where they go on.
  function sideways() {
    for (const box of document.querySelectorAll(".scroll")) {
      const look = () => {
        const beyond = box.scrollWidth - box.clientWidth;
        box.classList.toggle("wide", beyond > 1);
        box.classList.toggle("more-left", beyond > 1 && box.scrollLeft > 1);
        box.classList.toggle("more-right", beyond > 1 && box.scrollLeft < beyond - 1);
      };
      box.after(make("p", "The table goes on sideways: scroll it.", {class: "sideways"}));
      box.addEventListener("scroll", look, {passive: true});
      const observer = new ResizeObserver(look);
      observer.observe(box);
      if (box.firstElementChild) observer.observe(box.firstElementChild);  // filled later
    }
  }

  return {data, $, make, count, plural, copy, stalls, numbers, table, command, verdict, verdictWord, divergenceTerms, configTable, sideways};
})();
