# SPDX-License-Identifier: Apache-2.0
"""Places that a symmetry repeats, and the faces of solids that have it."""

import math

from vectors import add, cross, dot, mul, unit


def orbit(v, *moves):
    """All that v becomes under the moves, however often and in whatever order."""
    found = [unit(v)]
    for p in found:
        for move in moves:
            q = move(p)
            if all(max(abs(q[k] - r[k]) for k in range(3)) > 1e-6 for r in found):
                found.append(q)
    return found


def around(v):
    return (v[1], v[2], v[0])


def halfway(v):
    return (-v[0], -v[1], v[2])


def opposite(v):
    return (-v[0], -v[1], -v[2])


def swapped(v):
    return (v[1], v[0], v[2])


def quarter(v):
    return (-v[1], v[0], v[2])


def fifth(v):
    """A fifth of a turn about a vertex of the icosahedron that halfway() and around() keep."""
    g = (1 + math.sqrt(5)) / 2
    k = unit((0, 1, g))
    c, s = math.cos(2 * math.pi / 5), math.sin(2 * math.pi / 5)
    return add(add(mul(v, c), mul(cross(k, v), s)), mul(k, dot(k, v) * (1 - c)))


def as_tetrahedron(v):
    return orbit(v, around, halfway, swapped)


def as_cube(v):
    return orbit(v, around, halfway, swapped, opposite)


def as_cube_turned(v):
    """Without mirror images."""
    return orbit(v, around, halfway, quarter)


def as_dodecahedron(v):
    return orbit(v, around, halfway, fifth, opposite)


def at(distance, normals):
    return [(n, distance) for n in normals]
