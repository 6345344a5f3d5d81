# SPDX-License-Identifier: Apache-2.0
"""Clicks and keys on the pages that run.sh had written, held against kage itself."""

import json
import os
import random
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser

kage, chromium, pictures = sys.argv[1:]
failures = 0


def check(good, what):
    global failures
    if not good:
        failures += 1
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


def tables_scroll(b, name, width):
    """A table that is cut off says so, at the edge where it goes on and in words; one that is not says nothing."""
    seen = b.run("""Array.from(document.querySelectorAll('.scroll')).filter(e => e.checkVisibility()).map(e => ({
        beyond: e.scrollWidth - e.clientWidth, right: e.classList.contains('more-right'), left: e.classList.contains('more-left'),
        said: e.nextElementSibling.classList.contains('sideways') && e.nextElementSibling.checkVisibility()}))""")
    for k, e in enumerate(seen):
        cut = e["beyond"] > 1
        check((e["right"], e["said"], e["left"]) == (cut, cut, False), f"{name}: table {k} at {width}: {e}")
    return any(e["beyond"] > 1 for e in seen)


def looks(b, name):
    cut = False
    for width, height, phone in ((1900, 1000, False), (1280, 900, False), (390, 844, True), (320, 568, True)):
        b.size(width, height, phone)
        laid_out(b)
        cut = tables_scroll(b, name, width) or cut
        edges = b.run("""(() => { const h = document.querySelector('header').getBoundingClientRect();
            const s = document.querySelector('main > section').getBoundingClientRect(); return [h.left - s.left, h.right - s.right]; })()""")
        check(max(map(abs, edges)) < 1, f"{name}: at {width} the verdict ends {edges} pixels beside what is below it")
        for dark in (False, True):
            b.dark(dark)
            check(overflow(b) <= 0, f"{name}: {overflow(b)} pixels too wide for {width}")
            b.run("scrollTo(0, 0)")
            b.screenshot(f"{pictures}/{name}-{width}{'-dark' if dark else ''}.png", full=phone)
    b.dark(False)
    check(cut, f"{name}: no table was cut off, at no width")
    b.run("document.querySelector('.scroll.wide').scrollLeft = 1e6")
    b.until("document.querySelector('.scroll.more-left:not(.more-right)') !== null")
    b.size(1280, 900)
    laid_out(b)


def before_pictures(b):
    """What stands there before the pictures are read: their scale, and a word in the pixel's panel."""
    script = b.call(
        "Page.addScriptToEvaluateOnNewDocument",
        source="HTMLImageElement.prototype.decode = () => new Promise(() => {});",
    )["identifier"]
    b.open("same/report.html", ready=False)
    b.until("typeof View !== 'undefined' && View.canvas.clientWidth > 0")
    laid_out(b)
    check(b.run("document.body.dataset.ready") is None, "the pictures are there although nothing decodes them")
    scale = b.run("parseInt(document.getElementById('scale').value)")
    check(
        scale == b.run("Math.round(Math.min(View.canvas.clientWidth / 640, View.canvas.clientHeight / 480) * 100)"),
        f"before its picture the scale is {scale} %",
    )
    check(panel(b).strip() != "", "before the pictures the pixel's panel is empty")
    b.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


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
    # A click tells the pixel that was clicked.
    for x, y in ((100, 200), (0, 0), (639, 479)):
        pixel_on_canvas(b, x, y)
        at_rest(b, f"0/{x}/{y}")
        check(f"column {x}, line {y}" in panel(b), f"a click on {x},{y} tells {panel(b)[:80]}")
        check("the pixel leaves with colour" in panel(b) or "background" in panel(b), f"no history of {x},{y}")
    # Keys on the picture.
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
    # The wheel scrolls the page unless ctrl is held, zoomed or not.
    wheel = "View.canvas.dispatchEvent(new WheelEvent('wheel', {deltaX: %d, deltaY: %d, ctrlKey: %s, cancelable: true, bubbles: true}))"
    check(
        b.run(wheel % (0, -100, "true")) is False and b.run("View.scale()") > before, "ctrl and the wheel do not zoom"
    )
    large = b.run("View.scale()")
    check(b.run(wheel % (0, -100, "false")) is True and b.run("View.scale()") == large, "the wheel alone zooms")
    b.run(wheel % (100, 0, "true"))
    check(b.run("View.scale()") == large, "the wheel zooms sideways")
    b.key("0")
    # Buttons: frames, zoom, modes; the form.
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
    # Tab comes to everything; each stop is seen.
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
    # Tables.
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
    looks(b, "same")


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


def different_run(b):
    b.open("different/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Different"), "the verdict is not Different")
    check(
        "line 116, x 316" in b.run("document.getElementById('verdict').innerText"), "the first difference is not named"
    )
    check("rtl/pixel_banked.sv" in b.run("document.getElementById('verdict').innerText"), "the stage is not named")
    at_rest(b, "0/316/116")
    check("differs" in panel(b) and "RTL, cycle" in panel(b), "the first pixel is not told with the RTL's values")
    check(
        "from the cap of the shadow of obelisk" in panel(b), "the first pixel is not told with the parts of the scene"
    )
    check("--frame 0 --pixel 316,116 --fault wrong_compare --rtl" in panel(b), "no command line to copy")
    # Every differing pixel has its history; a click on another one.
    check(
        b.run("""(async () => {
      const rtl = View.rtlColor, golden = View.goldenColor;
      for (let y = 0; y < 480; y += 7)
        for (let x = 0; x < 640; x += 5)
          if (golden(x, y).some((v, i) => v !== rtl(x, y)[i]) && !Explain.has(0, y)) return false;
      return true;
    })()"""),
        "a differing pixel has no history",
    )
    looks(b, "different")
    pixel_on_canvas(b, 400, 400)
    at_rest(b, "0/400/400")
    check("They differ here" in panel(b), "400,400 is not told as different")
    b.size(390, 844, True)
    pixel_on_canvas(b, 200, 300, tap=True)
    b.until(
        "/^0\\/(199|200|201)\\/(299|300|301)$/.test(document.getElementById('pixel').dataset.done)"
    )  # a pixel is half a point wide
    b.size(1280, 900)
    b.click("#show-first")
    at_rest(b, "0/316/116")
    check(b.run("View.scale()") >= 16, "the first pixel is not shown large")
    b.screenshot(f"{pictures}/different-zoom.png")
    b.click("#fit")
    b.click("#modes button:nth-child(4)")
    b.screenshot(f"{pictures}/different-slider.png")
    check(
        "gtkwave different/" in b.run("document.getElementById('first').innerText"), "no line that opens the waveform"
    )
    no_rtl_picture(b)


def no_rtl_picture(b):
    """Where the page has no room for what the RTL drew, it does not say that this is what the golden model drew."""
    page = open("different/report.html").read()
    begin = page.index('<script type="application/json" id="data">') + len('<script type="application/json" id="data">')
    end = page.index("</script>", begin)
    data = json.loads(page[begin:end])
    frame = next(f for f in data["frames"] if not f["same"])
    frame["rtl"]["data"] = frame["difference"]["data"] = None
    os.makedirs("smaller", exist_ok=True)
    with open("smaller/report.html", "w") as f:
        f.write(page[:begin] + json.dumps(data).replace("<", "\\u003c") + page[end:])
    b.open("smaller/report.html")
    at_rest(b, "0/316/116")
    swatches = b.run("document.querySelector('#pixel .swatches').innerText")
    check("golden" in swatches and "RTL" not in swatches, f"a colour of the RTL without its picture: {swatches}")
    check(
        b.run("[...document.querySelectorAll('#pixel code')].at(-1).innerText").endswith("--rtl"),
        "no command that runs the RTL",
    )
    caption = b.run("document.getElementById('caption').innerText")
    check(
        "The RTL's picture is not on this page" in caption and "_actual.png" in caption,
        f"not said that it is missing: {caption}",
    )


def full_page(b):
    """Tokens that do not fit: the command instead, and it is right."""
    b.open("full/report.html")
    missing = b.run(
        "(() => { for (const f of Explain.data.frames) for (let y = 0; y < f.height; ++y)"
        " if (!Explain.has(f.frame, y)) return [f.frame, y]; return null; })()"
    )
    check(missing is not None, "all of polyhedra fits: this test needs a larger run")
    if missing:
        frame, y = missing
        b.run(f"Report.select({frame}, 300, {y})")
        at_rest(b, f"{frame}/300/{y}")
        check("has no room for the tokens of this line" in panel(b), "not said that the line is missing")
        line = b.run("document.querySelector('#pixel code').innerText")
        r = subprocess.run(["bash", "-c", line.replace("kage ", f"'{kage}' ", 1)], capture_output=True, text=True)
        check(
            r.returncode == 0 and f"frame {frame}, pixel 300,{y}:" in r.stdout,
            f"{line}: {r.stdout[:100]} {r.stderr[:200]}",
        )


def odd_name(b):
    b.open("odd/report.html")
    name = "a<b>&'\"$x <!-- --> <script>alert(1)"
    check(b.run("document.getElementById('name').innerText") == name, "the name is another")
    check(b.run("document.title").endswith(name), "the title is another")
    line = b.run("document.querySelector('#again .command code').innerText")
    line = line.replace("kage ", f"'{kage}' ", 1).replace("--out odd", "--out odd-again --json -")
    r = subprocess.run(["bash", "-c", line], capture_output=True, text=True)
    check(r.returncode == 0 and json.loads(r.stdout)["seed"] == 9, f"{line}: {r.stderr[:200]}")
    check(os.path.exists("odd-again/report.html"), "the line did not run the same thing")


def joined_run(b):
    b.open("joined/report.html")
    kept = json.load(open("joined.json"))
    check(
        b.run("document.querySelector('h1').innerText").strip().endswith("Different"),
        "joined: the verdict is not Different",
    )
    verdict = b.run("document.getElementById('verdict').innerText")
    check(
        "courtyard, " + kept["first_difference"]["text"] in verdict,
        f"joined: the first difference is not told: {verdict}",
    )
    check(
        "rtl/pixel_banked.sv" in verdict and "3 differences more" in verdict,
        f"joined: the stage is not named: {verdict}",
    )
    scenes = sheet(b, "scenes")
    for scene, row in zip(kept["scenes"], scenes[1:]):
        check(
            row[:7] == [scene["scene"], "different", scene["frames"], 3, "160x120", scene["cycles"], 0],
            f"joined: row {row}",
        )
    check(scenes[-1][5] == kept["cycles"] and scenes[-1][8] == kept["spans"], f"joined: sums {scenes[-1]}")
    frames = sheet(b, "table")[1:]
    check(
        [r[:2] for r in frames] == [[s, f] for s in ("courtyard", "penumbra") for f in range(3)],
        f"joined: frames {frames}",
    )
    check([r[2] for r in frames] == ["different", "different", "not compared"] * 2, "joined: the frames' verdicts")
    check(
        [r[3] for r in frames] == ["Shard 1/2", "Shard 2/2", "Shard 1/2", "Shard 2/2", "Shard 1/2", "Shard 2/2"],
        "joined: the frames' shards",
    )
    parts = b.run("document.getElementById('parts').innerText")
    for i, name in enumerate(("1/2", "2/2")):
        check(
            f"--shard {name}" in parts and os.getcwd() in parts and "Verilator" in parts,
            f"joined: no way to run shard {name} again",
        )
    check(b.run("document.querySelectorAll('#configs table').length") == 2, "joined: not two configurations")
    # Keys come to every link, and the link of a frame to that frame.
    stops = set()
    for _ in range(30):
        b.key("Tab")
        stops.add(b.run("document.activeElement.getAttribute('href') || document.activeElement.tagName"))
    links = set(b.run("[...document.querySelectorAll('a')].map(a => a.getAttribute('href'))"))
    check(
        links <= stops and len(links) == 8 and "SUMMARY" in stops and "BUTTON" in stops,
        f"Tab comes to {stops} of {links}",
    )
    looks(b, "joined")
    b.click("#table tbody tr:nth-child(2) a")
    b.until(
        "location.href.includes('/2/courtyard/report.html#frame=1') && document.body && document.body.dataset.ready === 'yes'"
    )
    check("Frame 1, column" in panel(b) and "They differ here" in panel(b), "the link does not show the frame")
    b.open("gone/report.html")
    check(
        b.run("document.querySelectorAll('a').length") == 0
        and "its page is not here" in b.run("document.body.innerText"),
        "links to pages that are not there",
    )
    # The tokens of a shard's frames, whatever their numbers.
    b.open("part/report.html")
    check(
        b.run("Explain.data.frames.map(f => [f.frame, Explain.has(f.frame, 40)]).join()") == "1,true,4,true",
        "tokens of a shard's frames are missing",
    )
    # One scene, all the same; a frame that is no shard's first.
    b.open("joined-same/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Same"), "joined: the verdict is not Same")
    each = {f["frame"]: f for f in json.load(open("joined-same.json"))["each"]}
    rows = sheet(b, "table")[1:]
    check(
        [r[5] for r in rows] == [each[i]["stalled"]["input_starved"] for i in range(3)] and rows[2][5] > 0,
        f"joined: stalls {rows}",
    )
    looks(b, "joined-same")
    b.click("#table tbody tr:nth-child(3) a")
    b.until(
        "location.href.includes('/1/report.html#frame=2') && document.body && document.body.dataset.ready === 'yes'"
    )
    check("Frame 2, column" in panel(b), "the link does not show the frame")
    stalls_by_phase(b, each[2])
    check(len(each[2]["stalled_by_phase"]) > 2, f"input lacked in one phase only: {each[2]}")


TELL = """(async () => {
  const h = await Explain.history(%d, %d, %d);
  if (h === null) return null;
  const golden = (await View.goldenColor(%d, %d));
  return {...h, golden};
})()"""


def as_explain(frame, x, y, h):
    """What kage explain prints, from what the page tells."""
    count = len(h["touches"])
    lines = [f"frame {frame}, pixel {x},{y}: " + ("1 token touches it" if count == 1 else f"{count} tokens touch it")]
    for t in h["touches"]:
        lines += [f"{t['token']:>8}  {t['text']}", " " * 12 + t["effect"]]
        lines += [" " * 12 + line for line in t.get("tree", [])]
        if "now" in t:
            lines.append(" " * 12 + "now " + t["now"])
    return "\n".join(lines + [" " * 12 + h["color_text"]]) + "\n"


def histories(b):
    seed = int(os.environ.get("KAGE_SEED", "1"))
    chance = random.Random(seed)
    kinds = set()
    for folder in ("default", "inside", "soft", "lights", "glass", "polyhedra", "smooth", "tiny", "odd", "different"):
        b.open(f"{folder}/report.html")
        width, height, frames = b.run(
            "[Explain.data.frames[0].width, Explain.data.frames[0].height, Explain.data.frames.length]"
        )
        for k in range(12):
            frame, x, y = chance.randrange(frames), chance.randrange(width), chance.randrange(height)
            if k == 0:
                frame, x, y = frames - 1, 0, height - 1
            b.run(f"Report.select({frame}, {x}, {y})")
            h = b.run(TELL % (frame, x, y, x, y))
            line = b.run(f"Explain.command({frame}, {x}, {y})").replace("kage ", f"'{kage}' ", 1)
            r = subprocess.run(["bash", "-c", line], capture_output=True, text=True)
            check(r.returncode == 0, f"{line}: {r.stderr}")
            kinds |= {t["text"].split()[0] for t in h["touches"]}
            # After notes; which part of the scene a token is of the page has for told pixels only.
            told = "".join(
                s for s in r.stdout[r.stdout.find("frame ") :].splitlines(True) if not s.startswith(" " * 12 + "from ")
            )
            check(
                as_explain(frame, x, y, h) == told,
                f"{folder} (seed {seed}): the page tells\n{as_explain(frame, x, y, h)}but {line} tells\n{told}",
            )
            check(
                h["golden"] == h["color"],
                f"{folder} {frame} {x},{y}: the picture has {h['golden']}, the history {h['color']}",
            )
    wanted = {"OP", "SP", "NC", "IF", "EV", "ES", "RESOLVE", "TP", "TREE"}
    check(kinds >= wanted, f"no history with {wanted - kinds} in it: take more pixels")


with Browser(chromium) as browser:
    for part in (before_pictures, same_run, recalled_run, different_run, full_page, odd_name, joined_run, histories):
        part(browser)
    check(not browser.errors, f"the console has errors: {browser.errors[:3]}")
    outside = [
        u
        for u in browser.requests
        if not u.startswith(("data:", "file:")) or (u.startswith("file:") and not u.endswith("report.html"))
    ]
    check(not outside, f"the page loads {outside[:3]}")
sys.exit(failures != 0)
