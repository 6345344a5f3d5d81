# SPDX-License-Identifier: Apache-2.0
"""The scene polyhedra."""

import math

from colors import tints
from document import Document, perspective
from gem import gem
from solids import antiprism, carved, frustum, lathe, prism, shifted, sized, sphere, spiral, stretched, trapezohedron
from symmetry import (
    around,
    as_cube,
    as_cube_turned,
    as_dodecahedron,
    as_tetrahedron,
    at,
    fifth,
    halfway,
    opposite,
    orbit,
)
from vectors import add, axis_angle, circle, looking, mul, sub


def polyhedra():
    """Convex polyhedra of 4 to 126 faces, no two alike, that tumble round a gem on rings, through each other and out of
    the picture."""
    d = Document("polyhedra", 8, "45 convex polyhedra of 4 to 126 faces tumble round a gem: for expansion units", 8)
    g = (1 + math.sqrt(5)) / 2
    tetra, cube, octa, dodeca, ico = (1, 1, 1), (1, 0, 0), (1, 1, 1), (0, 1, g), (1, 1, 1)
    rhombs, fives = (1, 1, 0), (1, 0, 0)  # on the axes of two of the cube and of the dodecahedron
    snub = (1, 1.8392868, 0.5436890)
    anti = [opposite(n) for n in as_tetrahedron(tetra)]
    times = range(9)

    def place(name, count, faces, color, path, axis, start, step):
        """A body that moves along a path, a point for each frame, and turns by `step` degrees from each to the next."""
        if len(faces) != count:
            raise ValueError("%s has %d faces, not %d" % (name, len(faces), count))
        turns = [axis_angle(axis, start + step * k) for k in times]
        d.animate(d.solid(name, faces, color, path[0]), times, translation=path, rotation=turns)

    def ring(radius, height, tilt, start, step):
        """A path on a circle round the gem, whose plane is tilted towards the eye, in degrees."""
        t = math.radians(tilt)
        out = []
        for k in times:
            a = math.radians(start + step * k)
            x, z = radius * math.cos(a), radius * math.sin(a)
            out.append((x, height + z * math.sin(t), z * math.cos(t)))
        return out

    def line(first, step):
        return [add(first, mul(step, k)) for k in times]

    d.solid("stage", lathe(60, [(12.6, -0.5), (13.0, -0.3), (13.0, 0)]), (0.74, 0.68, 0.58))
    d.solid("dais", lathe(12, [(4.6, 0), (4.6, 0.2), (4.4, 0.3)], 0.5), (0.56, 0.52, 0.48))

    # The gem, and crystals that grow through one another and into it.
    place("gem", 126, sized(gem(), 2.75), (0.80, 0.09, 0.16), line((0, 5.4, 0), (0, 0, 0)), (0.12, 1, 0.06), 0, 15)
    crystals = (
        (6, 3.3, 0.62, 0, 0, (0, 1, 0), 10),
        (5, 2.5, 0.50, 0.65, 0.25, (0.2, 0, -1), 24),
        (7, 2.6, 0.46, -0.6, 0.3, (0.3, 0, 1), 27),
        (8, 2.1, 0.42, 0.15, 0.75, (1, 0, 0.1), 30),
        (9, 2.0, 0.40, -0.2, -0.7, (-1, 0, 0.2), 25),
    )
    colors = tints((0.62, 0.80, 0.84), (0.16, 0.42, 0.62), len(crystals))
    for i, (n, height, radius, x, z, axis, lean) in enumerate(crystals):
        shard = lathe(
            n, [(radius * 0.7, -0.2), (radius, height * 0.55), (radius * 0.75, height * 0.78), (0, height)], 0.2 * i
        )
        d.solid("crystal %d" % (i + 1), shard, colors[i], (x, 0.3, z), (axis, lean))

    # The inner ring: faces as those of cube and tetrahedron, two bodies through each other at a time.
    inner = (
        ("cube", 6, carved(at(1, as_cube(cube))), 0.86),
        ("octahedron", 8, carved(at(1, as_cube(octa))), 1.0),
        ("rhombic dodecahedron", 12, carved(at(1, as_cube(rhombs))), 0.74),
        ("tetrahedron", 4, carved(at(1, as_tetrahedron(tetra))), 1.2),
        ("cuboctahedron", 14, carved(at(1, as_cube(cube)) + at(2 / math.sqrt(3), as_cube(octa))), 0.78),
        ("truncated tetrahedron", 8, carved(at(1, as_tetrahedron(tetra)) + at(5 / 3, anti)), 0.95),
        ("truncated cube", 14, carved(at(1, as_cube(cube)) + at(1.394, as_cube(octa))), 0.8),
        ("truncated octahedron", 14, carved(at(1, as_cube(octa)) + at(1.1547005, as_cube(cube))), 0.82),
        ("kite icositetrahedron", 24, carved(at(1, as_cube((1, 1, 1 + math.sqrt(2))))), 0.8),
        ("pentagon icositetrahedron", 24, carved(at(1, as_cube_turned(snub))), 0.8),
    )
    gold, brick = tints((0.92, 0.66, 0.12), (0.90, 0.50, 0.10), 5), tints((0.82, 0.22, 0.08), (0.64, 0.14, 0.10), 5)
    for i, (name, count, faces, size) in enumerate(inner):
        path = [add(p, (0.3 * (i % 2), 0.2 * (i % 2), 0)) for p in ring(3.9, 3.2, 10, 72 * (i // 2) + 20, 16)]
        place(
            name,
            count,
            sized(faces, size),
            (brick if i % 2 else gold)[i // 2],
            path,
            spiral(10)[i],
            25 * i,
            14 - 30 * (i % 2),
        )

    # The middle ring: faces as those of the dodecahedron and finer.
    middle = (
        ("dodecahedron", 12, carved(at(1, as_dodecahedron(dodeca))), 0.9),
        ("icosahedron", 20, carved(at(1, as_dodecahedron(ico))), 0.9),
        ("rhombic triacontahedron", 30, carved(at(1, as_dodecahedron(fives))), 0.9),
        ("truncated icosahedron", 32, carved(at(1, as_dodecahedron(ico)) + at(1.0265, as_dodecahedron(dodeca))), 0.9),
        ("truncated dodecahedron", 32, carved(at(1, as_dodecahedron(dodeca)) + at(1.168, as_dodecahedron(ico))), 0.9),
        (
            "snub body",
            38,
            carved(at(1, as_cube(cube)) + at(1.06, as_cube(octa)) + at(1.075, as_cube_turned(snub))),
            0.85,
        ),
        ("hexakis octahedron", 48, carved(at(1, as_cube((1, 1 + math.sqrt(2), 1 + 2 * math.sqrt(2))))), 0.85),
        ("pentagon hexecontahedron", 60, carved(at(1, orbit((0.55, 0.3, 1.35), around, halfway, fifth))), 0.9),
        ("kite hexecontahedron", 60, carved(at(1, as_dodecahedron((1, 1, g**3)))), 0.9),
        (
            "rhombicosidodecahedron",
            62,
            carved(
                at(1, as_dodecahedron(dodeca)) + at(1.0615, as_dodecahedron(ico)) + at(1.028, as_dodecahedron(fives))
            ),
            0.95,
        ),
        ("geodesic ball", 80, sphere(1, 1), 0.9),
        ("hexakis icosahedron", 120, carved(at(1, as_dodecahedron((1 / g, 1, 2 * g + 1)))), 0.95),
    )
    colors = tints((0.06, 0.48, 0.42), (0.24, 0.22, 0.68), len(middle))
    for i, (name, count, faces, size) in enumerate(middle):
        path = ring(6.3, 3.6, -14, 30 * ((5 * i) % 12), -11)
        place(name, count, sized(faces, size), colors[i], path, spiral(12)[(7 * i) % 12], 40 * i, 18)

    # The outer ring: pyramids, prisms and what is made of them.
    outer = (
        ("pyramid", 5, shifted(frustum(circle(4, 1.15, 0.5), 0, 1.5), (0, -0.4, 0)), 1.05),
        ("wedge", 5, stretched(shifted(prism(3, 1, 1.6), (0, -0.8, 0)), 1, 1, 0.8), 1.05),
        ("triangle bipyramid", 6, lathe(3, [(0, -1), (0.9, 0), (0, 1)]), 1.1),
        ("pentagon prism", 7, shifted(prism(5, 0.9, 1), (0, -0.5, 0)), 1.0),
        ("hexagon antiprism", 14, antiprism(6, 0.9, 0.9), 1.0),
        ("pentagon trapezohedron", 10, trapezohedron(5, 0.55), 1.1),
        ("square antiprism", 10, antiprism(4, 0.9, 1.2), 1.0),
        ("roofed block", 9, shifted(lathe(4, [(1, 0), (0.75, 0.7), (0, 1)], 0.5), (0, -0.4, 0)), 1.0),
        ("cut pyramid", 9, shifted(frustum(circle(7, 1), 0.45, 1.3), (0, -0.6, 0)), 1.05),
        ("spindle", 44, lathe(11, [(0, -1.4), (0.5, -0.5), (0.62, 0.1), (0.4, 0.8), (0, 1.2)]), 1.2),
        ("lens", 64, lathe(32, [(0, -0.45), (1.0, 0), (0, 0.45)]), 1.05),
    )
    colors = tints((0.56, 0.16, 0.48), (0.92, 0.58, 0.52), len(outer))
    for i, (name, count, faces, size) in enumerate(outer):
        path = ring(9.4, 3.0, -6, 360 / 11 * ((4 * i) % 11), 9)
        place(name, count, sized(faces, size), colors[i], path, spiral(11)[(3 * i) % 11], 50 * i, -20)

    # Bodies that leave or enter the picture: a coin rolls out below and a drum to the left, a cut stone comes down from
    # above and a faceted one flies off to the right.
    coin = [[(-p[1] + 0.2, p[0], p[2]) for p in f] for f in prism(124, 1.05, 0.4)]
    place("coin", 126, coin, (0.92, 0.74, 0.22), line((-3.1, 1.05, 1.6), (-0.1, 0, 1.65)), (1, 0, 0), 0, 90.04)
    drum = [[(p[0], -p[2], p[1] - 0.45) for p in f] for f in prism(40, 0.85, 0.9)]
    place("drum", 42, drum, (0.30, 0.56, 0.20), line((4.4, 0.85, 5.6), (-1.9, 0, 0)), (0, 0, 1), 0, 128.07)
    cut = lathe(16, [(0, -1.0), (1.0, 0.0), (1.0, 0.1), (0.8, 0.3), (0.55, 0.42)])
    place(
        "cut stone",
        65,
        sized(cut, 1.2),
        (0.90, 0.88, 0.80),
        line((-6.4, 11.2, -2.4), (0.35, -1.05, 0.2)),
        (0.3, 1, 0.2),
        0,
        25,
    )
    place(
        "star stone",
        24,
        sized(trapezohedron(12, 0.9), 1.2),
        (0.40, 0.62, 0.24),
        line((3.6, 6.4, 3.0), (0.95, 0.1, 0.1)),
        (1, 0.4, 0.3),
        30,
        -22,
    )

    d.sun((0.56, -0.76, -0.33), (1.0, 0.96, 0.88))
    eye, target = (0, 10.0, 16.0), (0, 3.1, 0)
    d.camera(perspective(45, 0.5), translation=eye, rotation=looking(sub(target, eye)))
    return d
