# SPDX-License-Identifier: Apache-2.0
"""The scene edges."""

from colors import BLUE, BRICK, IVORY, LEAF, MUSTARD, PLUM, ROSE, SLATE, STONE, TEAL
from document import Document
from solids import box, newell, octahedron, shifted
from vectors import circle, unit


def edges():
    """Seen in parallel, a unit being a pixel at 640x480: vertices on pixel centres, slivers, shared edges of all slopes, fans,
    T-junctions, coplanar overlaps, crossing planes. In the second frame everything is half a pixel away."""
    d = Document("edges", 2, "edges of every slope, slivers, T-junctions and crossing sheets, seen in parallel")
    colors = (BRICK, TEAL, MUSTARD, BLUE, LEAF, PLUM, ROSE, SLATE)

    def sheet(name, triangles, z=0, at=(0, 0)):
        """Triangles of (x, y) or (x, y, z) points, given the colours by turns, facing +z."""
        points, paint, corners = [], [], []
        for i, t in enumerate(triangles):
            p = [(q[0] + at[0], q[1] + at[1], q[2] if len(q) > 2 else z) for q in t]
            if newell(p)[2] < 0:
                p.reverse()
            points += p
            paint += [colors[i % len(colors)]] * 3
            corners.append((3 * i, 3 * i + 1, 3 * i + 2))
        normals = [n for i in range(0, len(points), 3) for n in [unit(newell(points[i : i + 3]))] * 3]
        d.node(name, mesh=d.mesh(name, d.primitive(points, corners, (1, 1, 1), normals, paint)))

    def rectangle(x0, y0, x1, y1):
        return [[(x0, y0), (x1, y0), (x1, y1)], [(x0, y0), (x1, y1), (x0, y1)]]

    d.solid("ground", shifted(box(700, 540, 10), (0, -270, 0)), STONE, (0, 0, -40))

    # A fan of 48 round a pixel centre, its rim on no grid at all.
    rim = circle(48, 86.3, 0.37)
    sheet("fan", [[(0, 0), rim[i], rim[(i + 1) % 48]] for i in range(48)], 20, (-205.5, 124.5))

    # Every slope p/10 and 10/p from one pixel centre, the other ends on pixel centres too.
    border = [(70, 7 * k) for k in range(-10, 10)] + [(-7 * k, 70) for k in range(-10, 10)]
    border += [(-70, -7 * k) for k in range(-10, 10)] + [(7 * k, -70) for k in range(-10, 10)]
    sheet("slopes", [[(0, 0), border[i], border[(i + 1) % 80]] for i in range(80)], 12, (-25.5, 134.5))

    # Slivers from a 256th to a pixel wide, lying, standing and oblique, one beside another.
    slivers = []
    for i in range(16):
        width = (1 + i * i) / 256
        slivers.append([(0.5, 6.5 * i + 0.5), (180.5, 6.5 * i + 0.5), (180.5, 6.5 * i + 0.5 + width)])
        slivers.append([(6.5 * i + 0.5, -8.5), (6.5 * i + 0.5 + width, -8.5), (6.5 * i + 0.5, -150.5)])
        slivers.append([(110.5, -8.5 - i), (190.5, -8.5 - 7 * i), (190.5, -8.5 - 7 * i + width)])
    sheet("slivers", slivers, 30, (105, 112))

    # Neighbours that meet at T-junctions: one tall rectangle against seven, whose heights share no factor.
    heights = (0, 3, 8, 19, 32, 49, 68, 97)
    parts = rectangle(0, 0, 40, 97)
    for low, high in zip(heights, heights[1:]):
        parts += rectangle(40, low, 82, high)
    sheet("junctions", parts, 8, (-290.5, -120.5))

    # Coplanar rectangles over one another, and sheets that cross.
    sheet(
        "overlap",
        rectangle(0, 0, 70, 50) + rectangle(20, 15, 90, 65) + rectangle(45, -10, 60, 80),
        16,
        (-180.5, -105.5),
    )
    sheet(
        "crossing",
        [
            [(0, 0, 0), (90, 0, 60), (90, 70, 60)],
            [(0, 0, 0), (90, 70, 60), (0, 70, 0)],
            [(0, 5, 60), (90, 5, 0), (90, 75, 0)],
            [(0, 5, 60), (90, 75, 0), (0, 75, 60)],
            [(-10, 35, 30), (100, 30, 30), (45, 90, 30)],
        ],
        0,
        (-55.5, -205.5),
    )

    # A net of shared edges: vertices on pixel centres of 640x480, of 320x240 (odd) and of 64x48 (5 beside a ten).
    columns, rows = 13, 9
    state = 12345
    net = {}
    for j in range(rows):
        for i in range(columns):
            state = (state * 1103515245 + 12345) % 2**31
            dx, dy = (state >> 16) % 9 - 4, (state >> 22) % 9 - 4
            x, y = 10 * i + 5, 10 * j + 5
            if (i + j) % 3 == 0:
                dx, dy = 0, 0
            elif (i + j) % 3 == 1:
                dx, dy = 2 * (dx // 2), 2 * (dy // 2)
            else:
                dx, dy = dx + 0.5, dy - 0.5
            net[i, j] = (x + dx, y + dy, (state >> 8) % 7)
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, b, c, e = net[i, j], net[i + 1, j], net[i + 1, j + 1], net[i, j + 1]
            triangles += [[a, b, c], [a, c, e]] if (i + j) % 2 else [[a, b, e], [b, c, e]]
    sheet("net", triangles, 0, (120, -200))

    # Convex casters whose outlines run through pixel centres.
    d.solid("brick", shifted(box(60, 30, 20), (0, 0, 0)), IVORY, (-239.5, -205.5, 30))
    d.solid("gem", octahedron(34), ROSE, (-139.5, -169.5, 40))

    d.sun((0.36, -0.48, -0.8))
    camera = d.camera(
        {"type": "orthographic", "orthographic": {"xmag": 320, "ymag": 240, "znear": 10, "zfar": 200}},
        translation=(0, 0, 100),
    )
    d.animate(camera, range(3), translation=[(0, 0, 100), (0.5, 0.5, 100), (0.5, 0.5, 100)])
    return d
