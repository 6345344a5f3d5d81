# SPDX-License-Identifier: Apache-2.0
"""The scene courtyard."""

from colors import BLUE, BRICK, IVORY, LEAF, MUSTARD, PLUM, ROSE, SAND, SLATE, STONE, TEAL
from document import Document, perspective
from solids import box, dodecahedron, frustum, lathe, octahedron, outward, prism, sphere, tiled_slab
from vectors import circle, looking, sub


def courtyard():
    """A walled yard in a low sun, and a camera that comes through its gate."""
    d = Document("courtyard", 8, "14 convex bodies and five walls in a low sun; the camera comes in through the gate")
    light, dark, rest = tiled_slab(16, 14, 0.25, 8, 7)
    floor = d.mesh("floor", d.flat(light, SAND), d.flat(dark, STONE), d.flat(rest, STONE))
    d.node("floor", mesh=floor)
    for name, w, deep, x, z in (
        ("north wall", 16, 0.5, 0, -6.75),
        ("west wall", 0.5, 13, -7.75, 0),
        ("east wall", 0.5, 13, 7.75, 0),
        ("gate left", 5, 0.5, -5.5, 6.75),
        ("gate right", 5, 0.5, 5.5, 6.75),
    ):
        d.solid(name, box(w, 1.6, deep), IVORY, (x, 0, z))

    obelisk = lathe(4, [(0.85, 0), (0.5, 3.4), (0, 4.0)], 0.5)
    d.solid("obelisk", obelisk, BRICK, (0, 0, -1.2))
    for i, (x, z) in enumerate(((-5.2, -4.8), (-1.8, -4.8), (1.8, -4.8), (5.2, -4.8))):
        d.solid("column %d" % (i + 1), prism(16, 0.42, 3.0, 0.5), IVORY, (x, 0, z))
    d.solid("ball", sphere(2, 0.95), TEAL, (3.0, 0.95, 0.6))
    d.solid("dodecahedron", dodecahedron(0.85), PLUM, (-3.2, 0.68, 1.2), ((1, 0, 0), 31.717474))
    d.solid("octahedron", octahedron(0.75), MUSTARD, (-5.4, 0.75, -1.6), ((0, 1, 0), 20))
    d.solid("hexagon", prism(6, 0.8, 1.1), BLUE, (5.3, 0, -1.8))
    d.solid("pyramid", frustum(circle(4, 1.15, 0.5), 0, 1.5), MUSTARD, (-1.4, 0, 3.2), ((0, 1, 0), 33))
    d.solid("cone", lathe(24, [(0.75, 0), (0, 2.0)]), LEAF, (-5.6, 0, 3.4))
    d.solid("crate", box(1.3, 0.9, 1.3), ROSE, (5.3, 0, 3.4), ((0, 1, 0), 14))
    d.solid("crate above", box(0.8, 0.7, 0.8), SLATE, (5.25, 0.9, 3.35), ((0, 1, 0), 52))
    wedge = outward(
        [
            [(-0.7, 0, 0.5), (0.7, 0, 0.5), (0.7, 0, -0.5), (-0.7, 0, -0.5)],
            [(-0.7, 0, 0.5), (0.7, 0, 0.5), (0.7, 0.9, -0.5), (-0.7, 0.9, -0.5)],
            [(-0.7, 0, -0.5), (-0.7, 0.9, -0.5), (0.7, 0.9, -0.5), (0.7, 0, -0.5)],
            [(0.7, 0, 0.5), (0.7, 0, -0.5), (0.7, 0.9, -0.5)],
            [(-0.7, 0, 0.5), (-0.7, 0.9, -0.5), (-0.7, 0, -0.5)],
        ]
    )
    d.solid("wedge", wedge, SLATE, (1.9, 0, 3.5), ((0, 1, 0), 118))

    d.sun((0.80, -0.56, -0.14), (1.0, 0.96, 0.88))
    # Eye and the point it looks at, a key for each frame.
    path = [
        ((-6.5, 5.4, 12.0), (-0.2, 0.7, -0.6)),
        ((-4.0, 4.9, 11.6), (-0.1, 0.7, -0.7)),
        ((-1.6, 4.2, 10.6), (0.0, 0.7, -0.9)),
        ((0.2, 3.4, 9.2), (0.1, 0.8, -1.2)),
        ((1.0, 2.7, 7.6), (0.0, 0.9, -1.4)),
        ((0.6, 2.3, 6.0), (0.0, 1.0, -1.8)),
        ((0.4, 2.6, 4.6), (0.3, 1.0, -2.6)),
        ((1.0, 3.4, 3.4), (0.8, 0.9, -3.4)),
        ((2.4, 4.2, 3.0), (1.0, 0.6, -3.0)),
    ]
    eyes = [e for e, _ in path]
    turns = [looking(sub(t, e)) for e, t in path]
    camera = d.camera(perspective(48, 0.25), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(len(path)), translation=eyes, rotation=turns)
    return d
