# SPDX-License-Identifier: Apache-2.0
"""The scene penumbra."""

from colors import BRICK, IVORY, MUSTARD, PLUM, ROSE, SAND, SLATE, TEAL
from document import Document, perspective
from smooth import smooth_sphere
from solids import box, lathe, prism, shifted, tiled_slab
from vectors import looking, sub


def penumbra():
    """A window as the only light: what stands on the floor has sharp shadows at its foot and soft ones at its head, and a grating
    that rises through the frames loses its own."""
    d = Document("penumbra", 8, "posts, balls, a cone and a grating under a window of light: soft shadows")
    light, dark, rest = tiled_slab(12, 10, 0.4, 6, 5)
    d.node("floor", mesh=d.mesh("floor", d.flat(light, IVORY), d.flat(dark, SAND), d.flat(rest, SAND)))
    d.solid("wall", box(12, 5, 0.4), IVORY, (0, 0, -5.2))
    d.node("ball", mesh=d.mesh("ball", smooth_sphere(d, 3, 0.8, TEAL)), translation=(0.2, 0.95, 0.4))
    d.node("high ball", mesh=d.mesh("high ball", smooth_sphere(d, 2, 0.35, ROSE)), translation=(2.4, 2.3, -0.6))
    for i in range(6):
        d.solid(f"post {i + 1}", prism(8, 0.09, 2.2), BRICK, (-3.4 + 0.5 * i, 0, -1.6 - 0.12 * i))
    d.solid("step", box(1.6, 0.35, 1.0), MUSTARD, (3.2, 0, 1.4), ((0, 1, 0), 25))
    d.solid("cone", lathe(20, [(0.5, 0), (0, 1.5)]), PLUM, (-1.9, 0, 1.9))
    bars = []
    for k in range(7):
        bars += shifted(box(2.4, 0.06, 0.09), (0, 0, -0.9 + 0.3 * k))
    grating = d.solid("grating", bars, SLATE, (2.9, 0.4, -2.4))
    d.animate(grating, range(9), translation=[(2.9, 0.4 + 0.24 * k, -2.4) for k in range(9)])
    d.lamp(
        {
            "type": "point",
            "color": [1, 0.96, 0.9],
            "intensity": 400,
            "name": "window",
            "extras": {"kage": {"shape": "rectangle", "width": 1.8, "height": 1.2}},
        },
        translation=(-3.2, 5.6, 4.2),
        rotation=looking(sub((0.5, 0, -1), (-3.2, 5.6, 4.2))),
    )
    eyes = [(1.6 - 0.25 * k, 4.4, 8.6 - 0.05 * k) for k in range(9)]
    turns = [looking(sub((0.1, 0.7, -0.6), e)) for e in eyes]
    camera = d.camera(perspective(42, 0.5), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
