# SPDX-License-Identifier: Apache-2.0
"""Bodies with the normals of what they stand for."""

from solids import sphere
from vectors import unit


def smooth_sphere(d, levels, radius, color):
    """A primitive: a ball with the normals of a ball."""
    places, points, triangles = {}, [], []
    for face in sphere(levels, radius):
        for p in face:
            if p not in places:
                places[p] = len(points)
                points.append(p)
        triangles.append(tuple(places[p] for p in face))
    return d.primitive(points, triangles, color, [unit(p) for p in points])
