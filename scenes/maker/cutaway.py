# SPDX-License-Identifier: Apache-2.0
"""The scene cutaway."""

from colors import BRICK, IVORY, LEAF, MUSTARD, PLUM, ROSE, SAND, SLATE, STONE, TEAL
from document import Document, perspective
from solids import box, octahedron, tiled_slab
from vectors import circle, looking, sub


def cutaway():
    """The camera flies through bodies and shadows: into a hollow pillar and out of it, along a lamp's shadow planes, through a
    body that another holds, and past open sheets."""
    d = Document(
        "cutaway", 8, "the camera flies through hollow and solid bodies and past open sheets", double_sided=True
    )
    light, dark, rest = tiled_slab(20, 12, 0.4, 10, 6)
    d.node("floor", mesh=d.mesh("floor", d.flat(light, SAND), d.flat(dark, STONE), d.flat(rest, STONE)))
    d.solid("wall", box(20, 5, 0.4), IVORY, (0, 0, -6.2))

    def ring(n, outer, inner, height):  # a pillar with a hole, not convex
        o, i = circle(n, outer), circle(n, inner)
        faces = []
        for k in range(n):
            m = (k + 1) % n
            oa, ob, ia, ib = o[k], o[m], i[k], i[m]

            def up(p):
                return (p[0], height, p[1])

            def low(p):
                return (p[0], 0, p[1])

            faces += [
                [low(oa), low(ob), up(ob), up(oa)],
                [up(ia), up(ib), low(ib), low(ia)],
                [up(oa), up(ob), up(ib), up(ia)],
                [low(oa), low(ia), low(ib), low(ob)],
            ]
        return faces

    d.solid("hollow pillar", ring(14, 0.9, 0.6, 3.2), BRICK, (-3.2, 0, 0.2))
    d.solid("block", box(1.6, 2.4, 1.6), TEAL, (0, 0, 0.1), ((0, 1, 0), 15))
    d.solid("core", octahedron(0.5), MUSTARD, (0, 1.3, 0.1))
    d.solid(
        "sheet", [[(-0.9, 0, 0), (0.9, 0, 0), (0.9, 2.2, 0), (-0.9, 2.2, 0)]], ROSE, (2.9, 0.2, 0.4), ((0, 1, 0), 70)
    )
    d.solid(
        "turned sheet",
        [[(-0.7, 2.0, 0), (0.7, 2.0, 0), (0.7, 0, 0), (-0.7, 0, 0)]],
        LEAF,
        (4.3, 0.1, -0.6),
        ((0, 1, 0), -40),
    )
    d.solid("gate", box(0.3, 2.8, 0.3), SLATE, (5.6, 0, 1.1))
    d.solid("beam", box(11, 0.25, 0.25), PLUM, (0.4, 2.9, 1.0))
    for k in range(8):
        d.solid(
            "louvre %d" % (k + 1), box(0.9, 0.06, 1.4), STONE, (-6.6 + 0.02 * k, 0.4 + 0.33 * k, -1.0), ((0, 0, 1), 30)
        )
    d.lamp({"type": "point", "color": [1, 0.97, 0.9], "intensity": 300, "name": "lamp"}, translation=(1.2, 5.2, 5.4))
    path = [
        ((-6.2, 1.5, 2.2), (-3.2, 1.4, 0.2)),
        ((-3.9, 1.5, 0.55), (-2, 1.3, -0.4)),
        ((-3.15, 1.45, 0.2), (0, 1.3, 0)),
        ((-2.2, 1.4, 0.15), (1, 1.3, -0.2)),
        ((-0.65, 1.35, 0.12), (2, 1.2, 0)),
        ((0.05, 1.3, 0.1), (3, 1.1, 0)),
        ((1.3, 1.25, 0.3), (4, 1.0, -0.6)),
        ((2.95, 1.2, 0.45), (5.6, 1.0, 0.5)),
        ((4.4, 1.3, 0.9), (6.5, 0.9, -2)),
    ]
    eyes = [e for e, _ in path]
    turns = [looking(sub(t, e)) for e, t in path]
    camera = d.camera(perspective(64, 0.12), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
