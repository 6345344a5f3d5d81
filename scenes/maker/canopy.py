# SPDX-License-Identifier: Apache-2.0
"""The scene canopy."""

import math

from colors import BRICK, SAND, SLATE
from document import Document, perspective
from solids import box, frustum, newell, tiled_slab
from vectors import add, axis_angle, circle, cross, looking, mul, sub, unit


def canopy():
    """Trees of 2,640 leaves, each folded along its middle and open: tiny casters that close nothing, in the sun."""
    d = Document(
        "canopy",
        8,
        "three trees of 2,640 leaves, each leaf folded and open: thousands of tiny casters",
        double_sided=True,
    )
    light, dark, rest = tiled_slab(16, 14, 0.4, 8, 7)
    d.node("ground", mesh=d.mesh("ground", d.flat(light, SAND), d.flat(dark, (0.62, 0.58, 0.44)), d.flat(rest, SAND)))
    state = 2024

    def chance(low, high):
        nonlocal state
        state = (state * 1103515245 + 12345) % 2**31
        return low + (high - low) * (state >> 8) / (1 << 23)

    def twig(name, color):
        points, normals, triangles = [], [], []
        for k in range(60):
            a, h = chance(0, 2 * math.pi), chance(-0.35, 0.45)
            r = chance(0.15, 0.62) * math.sqrt(1.1 - abs(h))
            at = (r * math.cos(a), h, r * math.sin(a))
            along = unit((math.cos(a) + chance(-0.7, 0.7), chance(-0.7, 0.4), math.sin(a) + chance(-0.7, 0.7)))
            side = unit(cross(along, (chance(-0.3, 0.3), 1, chance(-0.3, 0.3))))
            up = cross(side, along)
            long, wide, fold = chance(0.11, 0.19), chance(0.035, 0.06), chance(0.01, 0.03)
            tip, middle = add(at, mul(along, long)), add(at, mul(along, long * 0.45))
            left = add(add(middle, mul(side, wide)), mul(up, fold))
            right = add(sub(middle, mul(side, wide)), mul(up, fold))
            for face in ([at, tip, left], [at, right, tip]):
                first = len(points)
                points += face
                normals += [unit(newell(face))] * 3
                triangles.append((first, first + 1, first + 2))
        return d.mesh(name, d.primitive(points, triangles, color, normals))

    twigs = [
        twig("twig %d" % (i + 1), c) for i, c in enumerate(((0.25, 0.45, 0.12), (0.33, 0.50, 0.14), (0.42, 0.47, 0.13)))
    ]
    for t, (x, z, height) in enumerate(((-2.3, -0.6, 2.1), (1.1, -2.2, 2.6), (2.6, 1.3, 1.8))):
        d.solid("trunk %d" % (t + 1), frustum(circle(9, 0.16), 0.55, height + 0.5), (0.36, 0.24, 0.15), (x, 0, z))
        for k in range((14, 17, 13)[t]):
            a, r = 2.4 * k, 0.32 * math.sqrt(k)
            place = (x + r * math.cos(a), height + chance(0.0, 1.0) * (1.25 - 0.45 * r), z + r * math.sin(a))
            d.node(
                "twig %d.%d" % (t + 1, k + 1),
                mesh=twigs[k % 3],
                translation=place,
                rotation=axis_angle((chance(-0.3, 0.3), 1, chance(-0.3, 0.3)), chance(0, 360)),
            )
    d.solid("bench", box(1.5, 0.08, 0.4), BRICK, (-0.5, 0.4, 1.7), ((0, 1, 0), 20))
    for i, (x, z) in enumerate(((-1.1, 1.75), (0.0, 1.4))):
        d.solid("foot %d" % (i + 1), box(0.1, 0.4, 0.3), SLATE, (x, 0, z), ((0, 1, 0), 20))
    d.sun((0.42, -0.8, -0.25), (1.0, 0.96, 0.86))
    eyes = [(-4.4 + 0.9 * k, 3.3 - 0.25 * k, 6.6 - 0.12 * k * (8 - k) / 2) for k in range(9)]
    turns = [looking(sub((0.1, 1.2, -0.3), e)) for e in eyes]
    camera = d.camera(perspective(48, 0.3), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
