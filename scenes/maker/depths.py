# SPDX-License-Identifier: Apache-2.0
"""The scene depths."""

from colors import BLUE, BRICK, IVORY, LEAF, MUSTARD, PLUM, ROSE, SAND, SLATE, STONE, TEAL
from document import Document
from gem import gem
from solids import box, dodecahedron, octahedron, prism, sized, sphere, spiral
from vectors import axis_angle


def depths():
    """Seen in parallel, a unit being a pixel at 640x480, over the whole range of depth. The near plane is at z = 90, the last
    depth step at -90, the middle of the range at 0. Crests end right behind the near plane and feet at the last step, at edges
    that the snap moves over a pixel's centre: there depth is past its end and the core clamps it. Front faces that overlap in
    one plane tie. Boulders tumble through both halves of the range."""
    d = Document("depths", 4, "parallel view over the whole range of depth: ends that are clamped, faces that tie", 8)
    centres = (-280.5, -185, -102)  # of pixels at 640x480, at 320x240 and 64x48, and at 160x120

    def wedge(name, profile, low, high, color, lying=False, lean=0):
        """A body with the profile of (x, z) points, from low to high in y, where it is `lean` further on in x; or, lying, of (y, z)
        points from low to high in x."""
        around = sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(profile, profile[1:] + profile[:1]))
        if (around > 0) != lying:
            profile = profile[::-1]
        ends = [[(h, a, z) if lying else (a + by, h, z) for a, z in profile] for h, by in ((low, 0), (high, lean))]
        n = len(profile)
        sides = [[ends[0][i], ends[0][(i + 1) % n], ends[1][(i + 1) % n], ends[1][i]] for i in range(n)]
        d.solid(name, [ends[1], ends[0][::-1]] + sides, color)

    for i, x in enumerate(centres):
        # The steep faces' left edges miss the pixels' centres by less than the snap takes back, so depth goes past the edges
        # there. It goes hundreds of steps of 2^-24 before the first step at the upper crest, and beyond the last at the foot. Up
        # the lower crest it goes from step 4 to -4. Depth below 1 becomes 1, so the two tie, and the upper one was drawn first.
        wedge(
            "upper crest %d" % (i + 1),
            [(x, -30), (x + 40, -30), (x, 89.99996)],
            128,
            214,
            (BRICK, MUSTARD, ROSE)[i],
            lean=0.0015,
        )
        wedge("lower crest %d" % (i + 1), [(x, -44), (x + 52, -44), (x, 89.99996)], 120, 214, SLATE, lean=0.000031)
        wedge("foot %d" % (i + 1), [(x + 0.0015, -90), (x + 44, -90), (x + 44, 40)], -214, -128, (TEAL, BLUE, LEAF)[i])

    # Front faces in the plane z = 24, each over the next one, and a frame that all of them touch: the first drawn wins.
    tiles = ((0, 0, 120, 46), (74, 0, 120, 120), (0, 74, 120, 120), (0, 0, 46, 120), (30, 30, 90, 90))
    for i, (x0, y0, x1, y1) in enumerate(tiles):
        x, y = 96 + x0, 86 + y0
        wedge(
            "tile %d" % (i + 1),
            [(x, 24), (x, 4 - 9 * i), (x + x1 - x0, 4 - 9 * i), (x + x1 - x0, 24)],
            y,
            y + y1 - y0,
            (IVORY, SLATE, PLUM, SAND, ROSE)[i],
        )
    # Two roofs whose slopes lie in the same two planes.
    for i, (low, high, x0, x1) in enumerate(((-190, -130, 60, 260), (-208, -112, 120, 200))):
        wedge(
            f"roof {i + 1}",
            [(low, -20 - 24 * i), ((low + high) / 2, 20), (high, -20 - 24 * i)],
            x0,
            x1,
            (LEAF, MUSTARD)[i],
            True,
        )

    # A table in the far half under all that is in the middle, and boulders through the range's middle and the tiles.
    d.solid("table", [[(x, z, -y) for x, y, z in f] for f in box(420, 12, 190)], STONE, (30, 0, -70))
    boulders = (
        ("ball", sphere(1, 52), TEAL, (-40, 30, 0)),
        ("gem", sized(gem(), 46), BRICK, (30, -28, -6)),
        ("octahedron", octahedron(58), BLUE, (110, 40, 14)),
        ("dodecahedron", dodecahedron(44), MUSTARD, (170, -30, -20)),
        ("drum", [[(x, -z, y - 30) for x, y, z in f] for f in prism(17, 40, 60)], PLUM, (-130, -20, -12)),
    )
    for i, (name, faces, color, (x, y, z)) in enumerate(boulders):
        node = d.solid(name, faces, color)
        d.animate(
            node,
            range(5),
            translation=[(x + 9.3 * k * (-1) ** i, y, z + (13 - 5 * i) * k) for k in range(5)],
            rotation=[axis_angle(spiral(7)[i + 1], 20 * i + 31 * k) for k in range(5)],
        )

    d.sun((0.36, -0.48, -0.8))
    d.camera(
        {"type": "orthographic", "orthographic": {"xmag": 320, "ymag": 240, "znear": 10, "zfar": 200}},
        translation=(0, 0, 100),
    )
    return d
