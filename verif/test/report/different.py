# SPDX-License-Identifier: Apache-2.0
"""A run that is not the same: where, why, and what the page has no room for."""

import json
import os

from looks import looks
from page import at_rest, check, panel, pictures, pixel_on_canvas


def different_run(b):
    b.open("different/report.html")
    check(b.run("document.querySelector('h1').innerText").strip().endswith("Different"), "the verdict is not Different")
    check(
        "line 116, x 316" in b.run("document.getElementById('verdict').innerText"), "the first difference is not named"
    )
    check("rtl/pixel_banked.sv" in b.run("document.getElementById('verdict').innerText"), "the stage is not named")
    at_rest(b, "0/316/116")
    check("(golden " in panel(b) and "RTL, cycle" in panel(b), "the first pixel is not told with the RTL's values")
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
