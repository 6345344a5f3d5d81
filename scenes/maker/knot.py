# SPDX-License-Identifier: Apache-2.0
"""The scene knot."""

import math

from colors import ROSE, SAND, SLATE
from document import Document, perspective
from solids import tiled_slab
from vectors import add, axis_angle, cross, looking, mul, sub, unit


def knot():
    """A torus knot that turns over a floor under a lamp and shadows itself: closed, far from convex."""
    d = Document("knot", 8, "a closed torus knot with smooth normals turns under a point light and shadows itself")
    light, dark, rest = tiled_slab(9, 9, 0.3, 6, 6)
    d.node("floor", mesh=d.mesh("floor", d.flat(light, SAND), d.flat(dark, SLATE), d.flat(rest, SLATE)))

    def centre(a):  # winds three times through the hole on its two ways round
        r = 1.15 + 0.48 * math.cos(3 * a)
        return (r * math.cos(2 * a), 0.62 * math.sin(3 * a), r * math.sin(2 * a))

    steps, sides, tube = 112, 12, 0.27
    points, normals, triangles = [], [], []
    for i in range(steps):
        a = 2 * math.pi * i / steps
        p = centre(a)
        along = unit(sub(centre(a + 1e-3), centre(a - 1e-3)))
        # A frame that closes without twist: one axis stays square to the radius of the torus.
        axis = (math.cos(2 * a), 0, math.sin(2 * a))
        u = unit(cross(along, axis))
        v = cross(along, u)
        for k in range(sides):
            b = 2 * math.pi * k / sides
            n = add(mul(u, math.cos(b)), mul(v, math.sin(b)))
            points.append(add(p, mul(n, tube)))
            normals.append(n)
            j, m = (i + 1) % steps, (k + 1) % sides
            corners = (i * sides + k, i * sides + m, j * sides + m, j * sides + k)
            triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    mesh = d.mesh("knot", d.primitive(points, triangles, ROSE, normals))
    node = d.node("knot", mesh=mesh, translation=(0, 1.9, 0))
    # A whole turn about an oblique axis, so that its last key is its first.
    axis = (0.25, 1, 0.15)
    d.animate(node, range(9), rotation=[axis_angle(axis, 45.0 * k) for k in range(9)])
    d.lamp({"type": "point", "color": [1, 0.95, 0.85], "intensity": 100, "name": "lamp"}, translation=(-3.0, 6.0, 2.5))
    d.camera(perspective(40, 0.5), translation=(1.2, 4.6, 6.2), rotation=looking(sub((0, 1.0, 0), (1.2, 4.6, 6.2))))
    return d
