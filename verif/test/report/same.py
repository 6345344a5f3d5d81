# SPDX-License-Identifier: Apache-2.0
"""A run that is the same, and one of which an earlier run has compared most."""

import json
import os

from looks import looks
from page import at_rest, check, chosen, mode, panel, pixel_on_canvas, sheet, stalls_by_phase


def same_run(b):
    b.open("same/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Same"), "the verdict is not Same")
    check(b.run("document.querySelectorAll('#strip button').length") == 8, "not eight frames")
    check(
        b.run(
            "Explain.data.frames.every(f => Array.from({length: 480}, (_, y) => Explain.has(f.frame, y)).every(Boolean))"
        ),
        "the courtyard's page lacks tokens",
    )
    for part in (clicks, keys, wheel, buttons, tab_stops, tables):
        part(b)
    looks(b, "same")


def clicks(b):
    """A click tells the pixel that was clicked."""
    for x, y in ((100, 200), (0, 0), (639, 479)):
        pixel_on_canvas(b, x, y)
        at_rest(b, f"0/{x}/{y}")
        check(f"column {x}, line {y}" in panel(b), f"a click on {x},{y} tells {panel(b)[:80]}")
        check("the pixel leaves with colour" in panel(b) or "background" in panel(b), f"no history of {x},{y}")


def keys(b):
    """Keys on the picture move the pixel, choose pictures and frames, and zoom."""
    pixel_on_canvas(b, 100, 200)
    at_rest(b, "0/100/200")
    for key, shift, where in (
        ("ArrowRight", False, "0/101/200"),
        ("ArrowDown", False, "0/101/201"),
        ("ArrowLeft", True, "0/91/201"),
        ("ArrowUp", True, "0/91/191"),
    ):
        b.key(key, shift)
        at_rest(b, where)
    for key, wanted in (
        ("2", "rtl"),
        ("3", "difference"),
        ("1", "golden"),
        (" ", "rtl"),
        (" ", "golden"),
        ("4", "wipe"),
        ("1", "golden"),
    ):
        b.key(key)
        check(mode(b) == wanted, f"key {key!r} gives {mode(b)}")
    before = b.run("View.scale()")
    b.key("+")
    b.key("+")
    check(b.run("View.scale()") > 3 * before, "+ does not zoom")
    b.key("-")
    b.key("0")
    check(b.run("View.scale()") == before, "0 does not show all")
    b.key("n")
    at_rest(b, "1/91/191")
    b.key("p")
    at_rest(b, "0/91/191")


def wheel(b):
    """The wheel scrolls the page unless ctrl is held, zoomed or not."""
    before = b.run("View.scale()")
    turn = "View.canvas.dispatchEvent(new WheelEvent('wheel', {deltaX: %d, deltaY: %d, ctrlKey: %s, cancelable: true, bubbles: true}))"
    check(b.run(turn % (0, -100, "true")) is False and b.run("View.scale()") > before, "ctrl and the wheel do not zoom")
    large = b.run("View.scale()")
    check(b.run(turn % (0, -100, "false")) is True and b.run("View.scale()") == large, "the wheel alone zooms")
    b.run(turn % (100, 0, "true"))
    check(b.run("View.scale()") == large, "the wheel zooms sideways")
    b.key("0")


def buttons(b):
    """Buttons: frames, zoom, modes; the form."""
    before = b.run("View.scale()")
    b.click("#strip button:nth-child(4)")
    at_rest(b, "3/91/191")
    b.click("#in")
    check(b.run("View.scale()") > before, "the button + does not zoom")
    b.click("#fit")
    for key in ("n", "2", "+"):
        b.key(key)
    check(
        (chosen(b), mode(b), b.run("View.scale()")) == ("3/91/191", "golden", before), "letters act beside the picture"
    )
    b.click("#modes button:nth-child(4)")
    check(b.run("!document.getElementById('wipe-label').hidden"), "no slider")
    b.run("document.getElementById('wipe').focus()")
    b.key("ArrowRight")
    check(b.run("document.getElementById('wipe').value") == "51", "the slider does not take an arrow")
    b.run(
        "document.getElementById('x').focus(); document.getElementById('x').value = 12; document.getElementById('y').value = 34"
    )
    b.key("Enter")
    at_rest(b, "3/12/34")


def tab_stops(b):
    """Tab comes to everything; each stop is seen."""
    b.open("same/report.html")
    stops = set()
    for _ in range(40):
        b.key("Tab")
        stops.add(
            b.run("(() => { const e = document.activeElement; return e.id || e.parentElement.id || e.tagName; })()")
        )
        check(
            b.run(
                "document.activeElement === document.body || getComputedStyle(document.activeElement).outlineStyle !== 'none'"
            ),
            f"no focus to be seen on {stops}",
        )
    for stop in ("strip", "modes", "out", "in", "fit", "canvas", "x", "y"):
        check(stop in stops, f"Tab does not come to {stop}: {stops}")


def tables(b):
    """Sums, clocks by phase, stalls, the configuration, and how to run it again."""
    kept = json.load(open("same.json"))
    total = b.run("document.querySelector('#table tfoot').innerText").replace("\u202f", "").split()
    check(str(kept["cycles"]) in total and str(kept["spans"]) in total, f"the table's sums: {total}")
    phases = dict(
        line.split("\t")[:2]
        for line in b.run("document.querySelector('#phases').innerText").replace("\u202f", "").splitlines()
        if "\t" in line
    )
    del phases["phase"]
    clocks = {name: int(n) for name, n in phases.items()}
    rtl = clocks.pop("RTL")
    check(sum(clocks.values()) == rtl and abs(clocks["the rest"]) < 0.01 * rtl, f"clocks by phase: {phases}")
    stalls_by_phase(b, kept["each"][0])
    check(
        b.run("document.querySelectorAll('#config tbody tr').length") == len(kept["config"]), "parameters are missing"
    )
    check(b.run("document.querySelector('#again code').innerText") == os.getcwd(), "not the folder of the run")
    check(
        "kage cosim courtyard --out same --json same.json" in b.run("document.getElementById('again').innerText"),
        "not the command line",
    )


def recalled_run(b):
    """Which frames were compared by an earlier run: in the headline, the table, and below the picture."""
    b.open("taken/report.html")
    check(
        "3 frames, 2 of them taken from earlier runs" in b.run("document.getElementById('headline').innerText"),
        "the headline",
    )
    taken = json.load(open("taken.json"))["verdicts"]["taken_frames"]
    heads, *rows, _ = sheet(b, "table")
    said = [row[heads.index("verdict")] for row in rows]
    check(
        said == ["same, by an earlier run" if i in taken else "same" for i in range(3)],
        f"verdicts in the table: {said}",
    )
    check(all(row[heads.index("clocks")] > 0 for row in rows), "no clocks of a frame that was taken")
    for i in range(3):
        b.run(f"document.querySelector('#strip button[data-frame=\"{i}\"]').click()")
        b.until(f"document.getElementById('caption').innerText.startsWith('Frame {i},')")
        told = "an earlier run found that" in b.run("document.getElementById('caption').innerText")
        check(told == (i in taken), f"the caption of frame {i}")
