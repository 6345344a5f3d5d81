# SPDX-License-Identifier: Apache-2.0
"""The scene inside."""

from colors import BLUE, BRICK, IVORY, LEAF, MUSTARD, PLUM, ROSE, SAND, STONE, TEAL
from document import Document, perspective
from solids import box, dodecahedron, frustum, lathe, prism, sphere, tiled_slab
from vectors import circle, looking, sub


def inside():
    """The eye among shadows of a lamp behind it: within volumes, on their sides, the near plane cutting several."""
    d = Document("inside", 8, "casters between a point light and the eye, which is within their shadow volumes")
    light, dark, rest = tiled_slab(26, 30, 0.5, 13, 15)
    d.node(
        "floor",
        mesh=d.mesh("floor", d.flat(light, SAND), d.flat(dark, STONE), d.flat(rest, STONE)),
        translation=(0, 0, -3),
    )
    d.solid("back wall", box(26, 7, 0.5), IVORY, (0, 0, -15))
    # Between lamp and eye.
    for i, x in enumerate((-2.4, -1.3, 1.3, 2.4)):
        d.solid(f"post {i + 1}", box(0.3, 5.5, 0.3), BRICK, (x, 0, 6))
    d.solid("rail", box(6, 0.14, 0.2), MUSTARD, (0, 4.3, 6.3))
    d.solid("plate", box(1.5, 1.1, 0.1), PLUM, (0.1, 2.8, 4), ((0, 0, 1), 9))
    d.solid("ball", sphere(1, 0.34), TEAL, (-1.15, 3.2, 3.6))
    d.solid("tile", box(0.9, 0.1, 0.7), LEAF, (1.55, 3.05, 3.2), ((0, 0, 1), -20))
    d.solid("needle", lathe(5, [(0.12, 0), (0, 4.6)]), ROSE, (0.75, 0, 5.2))
    # In front of it, to be shadowed.
    d.solid("cone", lathe(16, [(1.1, 0), (0, 3.0)]), BLUE, (-4, 0, -8))
    d.solid("prism", prism(6, 1.0, 2.4), ROSE, (0.6, 0, -9))
    d.solid("pyramid", frustum(circle(4, 1.7, 0.5), 0, 2.2), MUSTARD, (4.3, 0, -7.5))
    d.solid("dodecahedron", dodecahedron(0.9), LEAF, (-1.5, 1.2, -5.6))
    d.lamp({"type": "point", "color": [1, 1, 1], "intensity": 100, "name": "lamp"}, translation=(0, 7, 12))
    path = [
        ((-2.75, 1.5, 0.0), (-0.6, 1.1, -9)),
        ((-2.0, 1.6, 0.4), (-0.5, 1.1, -9)),
        ((-1.35, 1.5, 0.2), (-0.3, 1.1, -9)),
        ((0.1, 1.45, 0.0), (0.0, 1.1, -9)),
        ((0.95, 1.6, -0.2), (0.3, 1.1, -9)),
        ((1.6, 1.4, 0.2), (0.4, 1.1, -9)),
        ((2.3, 1.45, 0.3), (0.5, 1.1, -9)),
        ((2.8, 1.2, 0.0), (0.6, 1.1, -9)),
        ((3.2, 1.2, 0.0), (0.6, 1.1, -9)),
    ]
    eyes = [e for e, _ in path]
    turns = [looking(sub(t, e)) for e, t in path]
    camera = d.camera(perspective(60, 0.5), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
