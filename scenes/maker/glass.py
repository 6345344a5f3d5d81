# SPDX-License-Identifier: Apache-2.0
"""The scene glass."""

import math

from colors import BRICK, IVORY, LEAF, MUSTARD, ROSE, SAND, STONE
from document import Document, perspective
from solids import box, dodecahedron, lathe, octahedron, prism, shifted, sphere, tiled_slab
from vectors import add, looking, mul, sub


def glass():
    """Translucent panes among opaque bodies: panes that cross, three that overlap each other in a ring, panes within a glass
    box and behind bodies, and a glass body with another in it. The camera goes half way round."""
    d = Document(
        "glass", 8, "ten panes and three bodies of glass among opaque ones: for exact order", 8, double_sided=True
    )

    def pane(name, width, height, color, at, turn=None):
        w, h = width / 2, height / 2
        d.solid(name, [[(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)]], color, at, turn)

    up = (0, 1, 0)
    light, dark, rest = tiled_slab(14, 14, 0.4, 7, 7)
    d.node("floor", mesh=d.mesh("floor", d.flat(light, SAND), d.flat(dark, STONE), d.flat(rest, STONE)))
    d.solid("column", prism(12, 0.45, 2.6), IVORY, (-3.2, 0, -2.4))
    d.solid("block", box(1.1, 1.0, 1.1), BRICK, (3.0, 0, -2.6), (up, 25))
    d.solid("cone", lathe(14, [(0.7, 0), (0, 1.9)]), MUSTARD, (-2.9, 0, 2.6))
    d.solid("ball", sphere(1, 0.55), LEAF, (3.1, 0.6, 2.3))
    d.solid("core", dodecahedron(0.42), ROSE, (0, 1.0, 0), (up, 15))
    # Through each other.
    pane("red pane", 3.2, 2.2, (0.85, 0.16, 0.14, 0.45), (2.6, 1.2, 0), (up, 35))
    pane("blue pane", 3.2, 2.0, (0.15, 0.30, 0.85, 0.45), (2.6, 1.1, 0), (up, -50))
    pane("slanting pane", 2.6, 1.6, (0.20, 0.75, 0.35, 0.4), (2.6, 1.15, 0), ((1, 0.2, 0), 62))
    # Each over the next, and the last over the first: no order of whole panes is right.
    for k, color in enumerate(((0.95, 0.75, 0.15, 0.55), (0.10, 0.65, 0.65, 0.55), (0.70, 0.20, 0.65, 0.55))):
        a = math.radians(90 + 120 * k)
        out = (math.cos(a), math.sin(a), 0)
        along = (-math.sin(a), math.cos(a), 0)
        corners = [
            add(mul(out, r), add(mul(along, s), (0, 0, 0.16 if s > 0 else -0.16)))
            for r, s in ((0.30, -1.15), (0.62, -1.15), (0.62, 1.15), (0.30, 1.15))
        ]
        d.solid("ring pane %d" % (k + 1), [corners], color, (-2.5, 1.35, 0.6), (up, 20))
    # Within a box of glass, the core before and behind them.
    d.solid("case", shifted(box(1.9, 1.9, 1.9), (0, 0.05, 0)), (0.75, 0.85, 0.95, 0.25), (0, 0, 0), (up, 12))
    pane("case pane 1", 1.5, 1.4, (0.95, 0.55, 0.15, 0.5), (0, 1.0, 0.55), (up, 12))
    pane("case pane 2", 1.5, 1.4, (0.25, 0.45, 0.95, 0.5), (0, 1.0, -0.6), (up, 30))
    # One body of glass in another.
    d.solid("gem", sphere(1, 0.8), (0.55, 0.85, 0.75, 0.35), (0.3, 0.85, 3.4))
    d.solid("heart", octahedron(0.45), (0.90, 0.20, 0.45, 0.6), (0.3, 0.85, 3.4), (up, 20))
    # Behind the bodies, whichever way one looks.
    pane("screen 1", 3.0, 2.4, (0.35, 0.55, 0.85, 0.35), (-0.2, 1.3, -3.6), (up, 8))
    pane("screen 2", 2.4, 2.0, (0.85, 0.65, 0.35, 0.35), (-4.4, 1.1, 0.2), (up, 80))
    d.sun((0.5, -0.75, -0.42), (1.0, 0.97, 0.9))
    eyes = []
    for k in range(9):
        a = math.radians(-62 + 15.5 * k)
        eyes.append((9.6 * math.sin(a), 4.6 - 0.2 * k, 9.6 * math.cos(a)))
    turns = [looking(sub((0, 0.75, 0.2), e)) for e in eyes]
    camera = d.camera(perspective(40, 0.5), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
