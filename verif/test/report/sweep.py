# SPDX-License-Identifier: Apache-2.0
"""The page of kage sweep in a browser: limits, the cheapest row, the plot, the row that is shown, the table."""

import json
import math
import random
import subprocess
import sys

from browser import Browser
from page import check, chromium, failures, kage, laid_out, overflow, pictures

PAGE = "elsewhere/page/sweep.html"
rows = json.load(open("rows.json"))
first = [i for i, r in enumerate(rows) if r["look"]["width"] == 96]
COSTS = {
    "luts": lambda r: r["area"]["luts"],
    "clocks": lambda r: r["speed"]["rtl_cycles_per_pixel"],
    "ram": lambda r: r["area"]["ram_bits"],
    "words": lambda r: r["speed"]["words_per_frame"],
}


def wrong(r):
    return 1e6 * (r["accuracy"]["visible_wrong"] + r["accuracy"]["shadow_wrong"]) / r["accuracy"]["pixels"]


def psnr(r):
    return math.inf if r["accuracy"]["psnr"] is None else r["accuracy"]["psnr"]


def beyond(r, limits):
    """The limits that a row is beyond, as the table names them."""
    flip = r["accuracy"]["flip"]
    told = {
        "gross": r["accuracy"]["gross_wrong"] > 0,
        "wrong": wrong(r) > limits["wrong"],
        "PSNR": psnr(r) < limits["psnr"],
        "FLIP": (math.inf if flip is None else flip) > limits["flip"],
        "clocks": COSTS["clocks"](r) > limits["clocks"],
    }
    return ", ".join(name for name, over in told.items() if over)


def cheapest(some, limits, cost):
    """The choice of the page by docs/sweep.md, implemented a second time."""
    within = [i for i, r in enumerate(some) if not beyond(r, limits)]
    order = [COSTS[cost], wrong, lambda r: -psnr(r), *COSTS.values()]
    return min(within, key=lambda i: ([of(some[i]) for of in order], i), default=None)


def literal(value):
    if isinstance(value, dict):
        return "{" + ",".join(f"{k}:{literal(v)}" for k, v in value.items()) + "}"
    return {math.inf: "Infinity", -math.inf: "-Infinity"}.get(value) or repr(value)


def choosing(b):
    """The page's rule is the stated one, for limits at, above and below what rows have, with ties and gross rows."""
    random.seed(7)
    found = 0
    for n in range(400):
        some = json.loads(json.dumps(random.choices(rows, k=random.randint(1, 9))))
        for r in some:
            r["accuracy"]["gross_wrong"] = random.choice([0, 0, 0, 1])
            if random.random() < 0.3:
                r["area"]["luts"] = 5000
            if random.random() < 0.1:
                r["accuracy"]["flip"] = None
        one = random.choice(some)
        limits = {
            "wrong": random.choice([0, wrong(one), wrong(one) * 0.99, math.inf]),
            "psnr": random.choice([psnr(one), 40, math.inf, -math.inf]),
            "flip": random.choice([math.inf, math.inf, one["accuracy"]["flip"] or 0]),
            "clocks": random.choice([math.inf, COSTS["clocks"](one)]),
        }
        cost = random.choice(list(COSTS))
        want = cheapest(some, limits, cost)
        members = list(range(len(some)))
        got = b.run(f"Choose.cheapest({json.dumps(some)}, {members}, {literal(limits)}, {json.dumps(cost)})")
        check(got == want, f"choice {n}: {got} for {want}, {limits}, {cost}")
        found += want is not None
    check(60 < found < 380, f"a test of choices in which {found} of 400 find any")


def now(b):
    return b.run(
        "({cheapest: Sweep.cheapest, chosen: Sweep.chosen, shown: Number(document.getElementById('row').dataset.row)})"
    )


def drag(b, name, share):
    """The slider's knob by the mouse to a share of its length."""
    b.run(f"document.getElementById('{name}').scrollIntoView({{block: 'center'}})")
    left, top, width, height, at = b.run(
        f"(() => {{ const e = document.getElementById('{name}'); const r = e.getBoundingClientRect();"
        " return [r.x, r.y, r.width, r.height, e.value / e.max]; })()"
    )
    y = top + height / 2
    x = [left + 8 + (width - 16) * s for s in (at, (at + share) / 2, share)]
    b.call("Input.dispatchMouseEvent", type="mousePressed", x=x[0], y=y, button="left", clickCount=1)
    for to in x[1:]:
        b.call("Input.dispatchMouseEvent", type="mouseMoved", x=to, y=y, button="left", buttons=1)
    b.call("Input.dispatchMouseEvent", type="mouseReleased", x=x[2], y=y, button="left", clickCount=1)


def numbers(b):
    """The page's limits as Python's."""
    text = b.run("Object.fromEntries(Object.entries(Sweep.limits).map(([k, v]) => [k, String(v)]))")
    return {k: float(v.replace("Infinity", "inf")) for k, v in text.items()}


def states(b):
    """The table, and the panel, say in words how rows stand to the limits."""
    at = numbers(b)
    heads = b.run("[...document.querySelectorAll('#table thead th')].map(h => h.innerText.trim())")
    told = dict(
        b.run(
            "[...document.querySelectorAll('#table tbody tr')].map(r => [Number(r.dataset.row), r.cells["
            f"{heads.index('limits')}].innerText])"
        )
    )
    for i, r in enumerate(rows):
        over = beyond(r, at)
        want = "\u2212" if i not in first else f"beyond: {over}" if over else "within"
        if i == now(b)["cheapest"]:
            want = "cheapest"
        check(told[i] == want, f"row {i} is told to be {told[i]!r}, and is {want!r}")
    shown = b.run("document.querySelector('#row .figures dd').innerText")
    check(shown == told[now(b)["shown"]], f"the panel says {shown!r}")


def limits(b):
    base = rows[0]
    at = numbers(b)
    check(not beyond(base, at), f"the first limits forbid the base: {at}")
    seen = set()
    for share in (0, 0.2, 0.4, 0.6, 0.8, 1):
        drag(b, "wrong", share)
        drag(b, "psnr", 1 - share)
        want = cheapest([rows[i] for i in first], numbers(b), "luts")
        got = now(b)
        check(
            got["cheapest"] == (None if want is None else first[want]), f"after a drag: {got} for {want}, {numbers(b)}"
        )
        if want is not None:
            check(got["chosen"] == got["shown"] == got["cheapest"], f"the cheapest is not shown: {got}")
        seen.add(want)
        states(b)
    check(len(seen) >= 2, f"drags find {seen} only")
    # FLIP by its slider, from any to none.
    b.run("Sweep.setLimit('wrong', Infinity), Sweep.setLimit('psnr', -Infinity)")
    seen = set()
    for share in (1, 0.7, 0.4, 0.2, 0):
        drag(b, "flip", share)
        want = cheapest([rows[i] for i in first], numbers(b), "luts")
        check(now(b)["cheapest"] == (None if want is None else first[want]), f"FLIP at {numbers(b)}: {now(b)}")
        states(b)
        seen.add(want)
    check(len(seen) >= 2 and numbers(b)["flip"] < 0.01, f"drags of FLIP find {seen} only, at {numbers(b)}")
    b.run("Sweep.setLimit('flip', Infinity)")
    # Figures that are typed, keys on a slider, another cost; what is no figure is marked and changes nothing.
    b.run(
        "(() => { const e = document.getElementById('wrong-text'); e.value = '1500.5'; e.dispatchEvent(new Event('input')); })()"
    )
    check(numbers(b)["wrong"] == 1500.5, f"a typed limit: {numbers(b)}")
    check(b.run("Sweep.limitOf('wrong', ' 17\\u202f253.5 ')") == 17253.5, "a figure as the page shows it is none")
    b.run(
        "(() => { const e = document.getElementById('wrong-text'); e.value = 'x'; e.dispatchEvent(new Event('input')); })()"
    )
    check(numbers(b)["wrong"] == 1500.5, "what is no figure is taken")
    check(b.run("document.getElementById('wrong-text').getAttribute('aria-invalid')") == "true", "it is not marked")
    b.run("document.getElementById('wrong').focus()")
    b.key("ArrowLeft")
    check(numbers(b)["wrong"] < 1500.5, f"a key on the slider: {numbers(b)}")
    for k, cost in enumerate(COSTS):
        b.click(f"#costs button:nth-of-type({k + 1})")
        want = cheapest([rows[i] for i in first], numbers(b), cost)
        check(now(b)["cheapest"] == first[want], f"the cheapest in {cost}: {now(b)}, {want}")
    b.click("#costs button:nth-of-type(1)")
    # Nothing is good enough.
    b.run("Sweep.setLimit('clocks', 0.001)")
    check("None of these" in b.run("document.getElementById('found').innerText"), "none is found, and not said")
    check(b.run("document.querySelectorAll('#plot .beyond').length") == len(first), "not all points are pale")
    states(b)
    b.run("Sweep.setLimit('clocks', Infinity)")


def yaml_works(b):
    """The parameters that are copied are a file for --config, and the line beside it runs."""
    b.run("navigator.clipboard.writeText = (t) => { window.copied = t; return Promise.resolve(); }")
    b.run("document.querySelector('#found details').open = true")
    b.click("#found details .command button")
    copied = b.run("copied")
    with open("chosen.yaml", "w") as f:
        f.write(copied)
    line = b.run("document.querySelectorAll('#found .command')[1].querySelector('code').innerText")
    r = subprocess.run(["bash", "-c", line.replace("kage ", f"'{kage}' ", 1)], capture_output=True, text=True)
    check(r.returncode == 0, f"{line}: {r.stderr}")
    # The line beside the row's sources of error draws a map of each.
    row, line = b.run(
        "(() => { Sweep.choose(Sweep.cheapest); const d = document.querySelector('#row details'); d.open = true;"
        " return [Sweep.chosen, d.querySelector('.command code').innerText]; })()"
    )
    check(line == b.run(f"Parts.data.more[{row}].command") + " --error-map", f"the line of maps: {line}")
    r = subprocess.run(
        ["bash", "-c", line.replace("kage ", f"'{kage}' ", 1) + " --out maps"], capture_output=True, text=True
    )
    check(r.returncode == 0 and "each source alone" in r.stdout, f"{line}: {r.stdout}{r.stderr}")


def places(b):
    return b.run(
        "(() => { const s = document.querySelector('#plot svg'); s.scrollIntoView({block: 'center'}); const m = s.getScreenCTM();"
        " return [...s.querySelectorAll('g[data-row]')].map(g => [Number(g.dataset.row), g.dataset.x * m.a + m.e, g.dataset.y * m.d + m.f]); })()"
    )


def plot(b):
    """A click or a tap on a point shows its row, with its own picture; keys go along; each row can be reached by the mouse."""
    all_places = places(b)
    check(sorted(row for row, _, _ in all_places) == first, "the plot lacks rows")
    reached = set()
    for row, x, y in all_places:
        for _ in range(sum(math.hypot(x - a, y - c) < 6 for _, a, c in all_places)):
            b.click_at(x, y)
            reached.add(now(b)["shown"])
            if row in reached:
                break
    check(reached == set(first), f"clicks reach {len(reached)} of {len(first)} rows")
    row = b.run("Sweep.chosen")
    # The picture as it is, and the map four times as wide.
    b.until(
        "[...document.querySelectorAll('#row img')].length > 0 && [...document.querySelectorAll('#row img')].every((i, n) => i.complete && i.naturalWidth === [96, 384][n])"
    )
    files = b.run("[...document.querySelectorAll('#row img')].map(i => i.getAttribute('src'))")
    own = b.run(f"Parts.data.more[{row}].pictures[0]")
    check(files == [f for f in (own["picture"], own["map"]) if f], f"pictures of row {row}: {files}")
    b.click("#row .group button:nth-of-type(2)")
    check(
        b.run("document.querySelector('#row img').getAttribute('src')")
        == b.run(f"Parts.data.more[{row}].pictures[1].picture"),
        "the second frame is not shown",
    )
    b.run("document.getElementById('plot').focus()")
    for key in ("ArrowRight", "ArrowLeft"):
        for _ in first:
            b.key(key)
    cheap = min(first, key=lambda i: COSTS["luts"](rows[i]))
    check(now(b)["shown"] == cheap, f"the left end of the plot by keys: {now(b)}, {cheap}")
    figures = b.run("document.querySelector('#row .figures').innerText")
    check(f"{rows[cheap]['speed']['rtl_cycles_per_pixel']:.3f}" in figures, "the panel lacks the clocks")
    every = b.run(
        "[...document.querySelectorAll('#row details:last-of-type tbody tr')].map(r => [...r.cells].map(c => c.textContent))"
    )

    def flat(value, name=""):
        if isinstance(value, dict):
            for key, inner in value.items():
                yield from flat(inner, f"{name}.{key}" if name else key)
        else:
            yield name

    want = [name for name in flat({k: v for k, v in rows[cheap].items() if k not in ("schema", "config")})]
    check([name for name, _ in every] == want, "the panel lacks figures")
    # Another plot keeps the row.
    b.click("#tabs button:nth-of-type(2)")
    check(sorted(row for row, _, _ in places(b)) == first and now(b)["shown"] == cheap, "the second plot")
    check(
        b.run("document.querySelectorAll('#plot .ring.chosen').length") == 1, "the row is not marked in the second plot"
    )
    b.click("#tabs button:nth-of-type(1)")


def table(b):
    def names():
        return b.run("[...document.querySelectorAll('#table tbody tr')].map(r => Number(r.dataset.row))")

    check(names() == list(range(len(rows))), "the table lacks rows")
    heads = b.run("[...document.querySelectorAll('#table thead th')].map(h => h.innerText.trim())")
    check(heads[1] == "limits" and "pixels" in heads, f"columns: {heads}")
    for head, of in (
        ("pixels", lambda r: r["accuracy"]["pixels"]),
        ("LUTs", COSTS["luts"]),
        ("wrong, ppm", wrong),
        ("PSNR, dB", psnr),
        ("clocks a pixel", COSTS["clocks"]),
    ):
        for down in (False, True):
            b.click(f"#table thead th:nth-child({heads.index(head) + 1}) button")
            want = sorted(range(len(rows)), key=lambda i: ((-1 if down else 1) * of(rows[i]), i))
            check(names() == want, f"sorted by {head}, {'down' if down else 'up'}: {names()}")
            said = b.run(
                f"document.querySelector('#table thead th:nth-child({heads.index(head) + 1})').getAttribute('aria-sort')"
            )
            check(said == ("descending" if down else "ascending"), f"{head}: {said}")
    other = next(i for i in range(len(rows)) if i not in first)
    b.click(f"#table tr[data-row='{other}'] button")
    check(now(b)["shown"] == other and b.run("document.getElementById('group').value") == "1", "a row of another size")
    check(b.run("document.getElementById('plot').hidden"), "a plot of a single configuration")
    b.click(f"#table tr[data-row='{first[3]}'] button")
    check(now(b)["shown"] == first[3] and not b.run("document.getElementById('plot').hidden"), "and back")


def looks(b):
    for width, height, phone in ((1920, 1080, False), (1280, 900, False), (768, 1024, True), (320, 568, True)):
        b.size(width, height, phone)
        laid_out(b)
        b.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        check(overflow(b) <= 0, f"{overflow(b)} pixels too wide for {width}, with all open")
        b.run("document.querySelectorAll('details').forEach(d => { d.open = false; })")
        laid_out(b)
        small = b.run(
            "[...document.querySelectorAll('#plot svg text')].map(t => parseFloat(t.getAttribute('font-size')) * t.ownerSVGElement.getScreenCTM().a)"
        )
        check(small and min(small) >= 8.5, f"letters of {min(small)} pixels in the plot at {width}")
        for dark in (False, True):
            b.dark(dark)
            check(overflow(b) <= 0, f"{overflow(b)} pixels too wide for {width}")
            b.run("scrollTo(0, 0)")
            b.screenshot(f"{pictures}/sweep-{width}{'-dark' if dark else ''}.png", full=True)
        b.dark(False)
        if phone:
            row, x, y = places(b)[1]
            b.tap_at(x, y)
            b.until(f"Plot.together({row}).includes(Sweep.chosen)")
    b.size(1280, 900)
    laid_out(b)


def main():
    with Browser(chromium) as b:
        b.open("flipless/sweep.html")
        check(b.run("document.getElementById('flip-limit').checkVisibility()") is False, "a limit of FLIP without FLIP")
        check(b.run("Sweep.cheapest") is not None, "without FLIP none is the cheapest")
        b.open(PAGE)
        choosing(b)
        limits(b)
        yaml_works(b)
        plot(b)
        table(b)
        looks(b)
        check(not b.errors, f"the console says {b.errors[:3]}")
        beside = [u for u in b.requests if not u.startswith(("data:", "file://"))]
        check(not beside, f"the page asks for {beside[:3]}")
    return 1 if failures else 0


sys.exit(main())
