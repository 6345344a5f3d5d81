# SPDX-License-Identifier: Apache-2.0
"""A reader's actions on a page and their effects: pixels clicked, keys, the panel, tables as numbers."""

import json
import sys

kage, chromium, pictures = sys.argv[1:]
failures = []


def check(good, what):
    if not good:
        failures.append(what)
        print("FAILED:", what)


def chosen(b):
    return b.run("document.getElementById('pixel').dataset.done")


def panel(b):
    return b.run("document.getElementById('pixel').innerText")


def mode(b):
    return b.run("document.querySelector('#modes [aria-checked=true]').dataset.mode")


def pixel_on_canvas(b, x, y, tap=False):
    """Clicks or taps the middle of a pixel of a picture that is shown whole."""
    b.run("document.getElementById('canvas').scrollIntoView({block: 'center'})")
    left, top, width, height, w, h = b.run(
        "(() => { const r = View.canvas.getBoundingClientRect(); const f = Explain.data.frames[0];"
        " return [r.left, r.top, r.width, r.height, f.width, f.height]; })()"
    )
    s = min(width / w, height / h)
    (b.tap_at if tap else b.click_at)(
        left + (width - w * s) / 2 + (x + 0.5) * s, top + (height - h * s) / 2 + (y + 0.5) * s
    )


def overflow(b):
    return b.run("document.documentElement.scrollWidth - document.documentElement.clientWidth")


def at_rest(b, where):
    b.until(f"document.getElementById('pixel').dataset.done === {json.dumps(where)}")


def laid_out(b):
    """Waits until the page has its layout, and what it does to a new layout has one too."""
    b.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")


def sheet(b, table):
    """A table's cells, heads first, numbers as numbers."""
    rows = b.run(
        f"[...document.querySelectorAll('#{table} tr')].map(r => [...r.cells].map(c => c.innerText.replaceAll('\\u202f', '')))"
    )
    return [[int(c) if c.isdigit() else c for c in row] for row in rows]


def stalls_by_phase(b, frame):
    """The table of phases has the frame's stalls, and where they were."""
    heads, *rows, total = sheet(b, "phases")
    at = [heads.index("no input"), heads.index("output blocked")]
    check(
        all(sum(row[i] for row in rows if row[i] != "") == total[i] for i in at), f"the stalls' sums: {rows}, {total}"
    )
    check(
        [total[i] for i in at] == [frame["stalled"][k] for k in ("input_starved", "output_blocked")], f"stalls: {total}"
    )
    said = {row[0].replace("the rest", "behind the last token"): [row[i] for i in at] for row in rows}
    for name, s in frame["stalled_by_phase"].items():
        check(said[name] == [s["input_starved"], s["output_blocked"]], f"stalls of {name}: {said}")
