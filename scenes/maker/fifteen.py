# SPDX-License-Identifier: Apache-2.0
"""The scene fifteen."""

import math

from document import Document, perspective
from solids import carved, frustum, lathe, prism, shifted, sized
from symmetry import as_cube, at
from vectors import axis_angle, circle, looking, sub, unit


def fifteen():
    """Polyhedra of fifteen faces each, one before another: the size of a body for which [Ohno 1985] gives an expansion
    unit its memory. They turn on the spot while the camera goes by."""
    d = Document("fifteen", 8, "eight convex polyhedra of fifteen faces, one before another: for expansion units", 8)
    corner = at(1.394, as_cube((1, 1, 1)))
    bodies = (
        ("prism", prism(13, 1.0, 2.2), (0.80, 0.30, 0.17), (-2.9, 0, -2.6), 0),
        ("pyramid", frustum(circle(14, 1.25), 0, 2.4), (0.90, 0.64, 0.12), (2.7, 0, -2.2), 0),
        ("cut pyramid", frustum(circle(13, 1.2), 0.5, 1.5), (0.10, 0.50, 0.48), (-0.6, 0, 1.6), 0),
        ("obelisk", lathe(7, [(0.8, 0), (0.62, 2.6), (0, 3.5)]), (0.62, 0.80, 0.84), (0.3, 0, -1.0), 0),
        (
            "crystal",
            lathe(5, [(0, -1.5), (0.85, -0.55), (0.85, 0.55), (0, 1.5)]),
            (0.50, 0.18, 0.46),
            (2.2, 1.5, 0.9),
            14,
        ),
        (
            "top",
            lathe(3, [(0, -1.4), (0.7, -0.8), (1.0, -0.1), (0.88, 0.5), (0.5, 1.0), (0, 1.25)]),
            (0.24, 0.55, 0.20),
            (-2.5, 1.5, 0.6),
            12,
        ),
        (
            "cut cube",
            carved(at(1, as_cube((1, 0, 0))) + corner + [((1, 1, 0), 1.24)]),
            (0.16, 0.32, 0.70),
            (1.3, 0.85, 3.0),
            20,
        ),
    )
    d.solid("stage", shifted(prism(13, 6.4, 0.4, 0.25), (0, -0.4, 0)), (0.80, 0.72, 0.58))
    for i, (name, faces, color, place, lean) in enumerate(bodies):
        if name == "cut cube":
            faces = sized(faces, 0.95)
        if len(faces) != 15:
            raise ValueError("%s has %d faces" % (name, len(faces)))
        axis = unit((math.sin(math.radians(lean)), math.cos(math.radians(lean)), 0))
        node = d.solid(name, faces, color, place)
        d.animate(node, range(9), rotation=[axis_angle(axis, 37 * i + (-16 if i % 2 else 12) * k) for k in range(9)])
    d.sun((0.66, -0.62, -0.42), (1.0, 0.96, 0.88))
    eyes = [(-4.2 + 1.05 * k, 3.2 + 0.12 * k, 9.2 - 0.06 * (k - 4) ** 2) for k in range(9)]
    turns = [looking(sub((0, 1.0, 0), e)) for e in eyes]
    camera = d.camera(perspective(40, 0.5), translation=eyes[0], rotation=turns[0])
    d.animate(camera, range(9), translation=eyes, rotation=turns)
    return d
