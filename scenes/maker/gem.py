# SPDX-License-Identifier: Apache-2.0
"""The gem of two scenes."""

import math

from solids import carved
from symmetry import at
from vectors import circle


def gem():
    """A brilliant of 126 faces: a table, and rings of facets whose planes touch a body that is flat above its girdle and
    deep below."""
    planes = [((0, 1, 0), 0.46)]
    for n, degrees, turn in (
        (5, 66, 0),
        (10, 53, 0.25),
        (20, 40, 0.5),
        (20, 22, 0),
        (20, 0, 0.5),
        (20, -22, 0),
        (20, -34, 0.5),
        (10, -42, 0.25),
    ):
        a = math.radians(degrees)
        c, s = math.cos(a), math.sin(a)
        depth = 0.58 if s > 0 else 0.95
        planes += at(math.sqrt(c * c + s * s * depth * depth), [(x * c, s, z * c) for x, z in circle(n, 1, turn)])
    return carved(planes)
