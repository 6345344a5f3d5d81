# SPDX-License-Identifier: Apache-2.0
"""A page in all its widths, light and dark, and before its pictures are read."""

from page import check, laid_out, overflow, panel, pictures


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
    """The page before the pictures are read: their scale, and a word in the pixel's panel."""
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
