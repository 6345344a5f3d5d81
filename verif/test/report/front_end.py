# SPDX-License-Identifier: Apache-2.0
"""Runs of a core with a front end: the stage, the tokens that it makes, what they are of, and how to run it again."""

import json
import re

from looks import looks
from page import at_rest, check, panel, sheet, stalls_by_phase

# Entries of the history: index and text of the token, the token it comes from, and the first words of the RTL's events.
ENTRIES = """[...document.querySelectorAll('#pixel .history > li')].map(li => ({
    token: li.querySelector('.token')?.innerText ?? '', from: li.querySelector('.from')?.innerText ?? '',
    rtl: [...li.querySelectorAll('.rtl')].map(e => e.innerText.replace(/^RTL, (token \\d+, )?cycle \\d+, /, '').split(':')[0])}))"""


def front_end_run(b):
    b.open("front-end/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Different"), "the verdict is not Different")
    verdict = b.run("document.getElementById('verdict').innerText")
    check(
        "1 frame at the polygon level, 160x120, 19200 pixels compared, with --fault front_end_edge;" in verdict,
        f"front_end: not said what the frames are: {verdict}",
    )
    check("rtl/front_merge.sv" in verdict and "made by the front end, from " in verdict, f"front_end: {verdict}")
    first = re.search(r"frame 0, line (\d+), x (\d+), ", verdict)
    check(first is not None, f"front_end: no first difference: {verdict}")
    at_rest(b, f"0/{first[2]}/{first[1]}")
    check("They differ here" in panel(b), f"front_end: the first pixel does not differ: {panel(b)}")
    told(b)
    check(
        "--front-end rtl" in b.run("document.querySelector('#again .command code').innerText"), "not the command line"
    )
    parameters = dict(
        b.run(
            "[...document.querySelectorAll('#config tbody tr')].map(r => [r.cells[0].innerText, r.cells[1].innerText])"
        )
    )
    check(parameters.get("ACTIVE") == "512", f"front_end: parameters {parameters}")
    looks(b, "front-end")
    from_tokens(b)
    phases(b)


def told(b):
    """The first pixel: spans that are made, with their parts of the scene, and below each what the RTL did with it."""
    entries = b.run(ENTRIES)
    tokens = [e for e in entries if e["token"]]
    made = [e for e in tokens if e["token"].endswith(", made by the front end")]
    check(len(made) > 2, f"front_end: made are {made} of {tokens}")
    spans = [e for e in tokens if e["token"].split()[1] in ("OP", "SP", "EV")]
    check(spans and all(e["from"].startswith("from ") for e in spans), f"front_end: no part of the scene: {spans}")
    ends = {e["token"].split()[1].rstrip(","): e for e in tokens[-2:]}
    check(ends.keys() == {"ES", "RESOLVE"}, f"front_end: the last tokens are {tokens[-2:]}")
    if ends.keys() != {"ES", "RESOLVE"}:
        return
    check(
        ends["ES"]["token"].split()[0] == ends["RESOLVE"]["token"].split()[0], f"front_end: made of two tokens: {ends}"
    )
    # One token of the stream stands for both, and each has what the RTL did at it.
    check(ends["ES"]["rtl"] == ["state of a pixel"], f"front_end: at ES the RTL did {ends['ES']['rtl']}")
    rest = ends["RESOLVE"]["rtl"] + entries[-1]["rtl"]
    check(rest == ["pixel that leaves the line", "pixel of video"], f"front_end: behind ES the RTL did {rest}")


def from_tokens(b):
    """A pixel that nobody has told: of the page's own tokens, which are those that the front end makes."""
    frame = b.run("Explain.data.frames[0]")
    text = b.run(
        f"Explain.history(0, {frame['width'] // 2}, {frame['height'] - 2}).then(h => h.touches.map(t => t.text))"
    )
    check(
        any(t.endswith(", made by the front end") for t in text)
        and not any(t.split()[0] in ("AT", "POLYGON", "EDGE") for t in text),
        f"front_end: tokens {text}",
    )


def phases(b):
    """Tokens that stay in the front end have a row: their number and their stalls, and no clocks of the core behind it."""
    b.open("polygons/report.html")
    kept = json.load(open("polygons.json"))["each"][0]
    stalls_by_phase(b, kept)
    heads, *rows, _ = sheet(b, "phases")
    row = {r[0]: dict(zip(heads, r)) for r in rows}
    check(
        row["polygons"]["tokens"] > 100
        and [row["polygons"][k] for k in ("clocks", "pixels")] == ["", ""]
        and row["polygons"]["which"] == "GRADIENT, POLYGON, EDGE, AT"
        and row["state"]["which"] == "SHADE, TABLE, FACE, SEG, RESOLVE, END",
        f"front_end: phases {row['state']}, {row['polygons']}",
    )
    check(
        all(row["polygons"][k] > row["state"][k] for k in ("no input", "output blocked")),
        f"front_end: stalls of polygons {row['polygons']}, of the state {row['state']}",
    )
    b.open("default/report.html")
    check("polygons" not in [r[0] for r in sheet(b, "phases")], "a core without front end has a row of polygons")
