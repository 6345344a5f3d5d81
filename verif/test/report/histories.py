# SPDX-License-Identifier: Apache-2.0
"""Histories of pixels, held against kage explain's."""

import os
import random
import subprocess

from page import check, kage

TELL = """(async () => {
  const h = await Explain.history(%d, %d, %d);
  if (h === null) return null;
  const golden = (await View.goldenColor(%d, %d));
  return {...h, golden};
})()"""


def as_explain(frame, x, y, h):
    """The output of kage explain, from the data of the page."""
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
    for folder in (
        "default",
        "inside",
        "soft",
        "lights",
        "glass",
        "polyhedra",
        "smooth",
        "tiny",
        "odd",
        "different",
        "meshes",
        "polygons",
        "polygons-inside",
        "polygons-glass",
        "front-end",
    ):
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
            # After notes; of which part of the scene a token is, and what is left out, the page has for told pixels only.
            told = "".join(
                s for s in r.stdout[r.stdout.find("frame ") :].splitlines(True) if not s.startswith(" " * 12 + "from ")
            ).split(" " * 12 + "left out, ")[0]
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
