# SPDX-License-Identifier: Apache-2.0
"""Vectors, points and rotations as tuples of numbers."""

import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return mul(a, 1 / math.sqrt(dot(a, a)))


def rounded(v, digits=6):
    """Numbers for a file: no negative zero, integers without a point."""
    out = []
    for x in v:
        x = round(float(x), digits)
        out.append(int(x) if x == int(x) else x)
    return out


def circle(n, radius, turn=0.0):
    """n points (x, z), counter-clockwise seen from above (+y), i.e. from +x towards -z."""
    angles = [2 * math.pi * (i + turn) / n for i in range(n)]
    return [(radius * math.cos(a), -radius * math.sin(a)) for a in angles]


def axis_angle(axis, degrees):
    a = math.radians(degrees) / 2
    s = math.sin(a)
    u = unit(axis)
    return (u[0] * s, u[1] * s, u[2] * s, math.cos(a))


def looking(forward, up=(0, 1, 0)):
    """The rotation that turns -z to `forward` and +y as near as can be to `up`."""
    z = mul(unit(forward), -1)
    x = unit(cross(up, z))
    y = cross(z, x)
    trace = x[0] + y[1] + z[2]
    candidates = [trace, x[0], y[1], z[2]]
    k = candidates.index(max(candidates))
    if k == 0:
        q = (y[2] - z[1], z[0] - x[2], x[1] - y[0], 1 + trace)
    elif k == 1:
        q = (1 + x[0] - y[1] - z[2], y[0] + x[1], z[0] + x[2], y[2] - z[1])
    elif k == 2:
        q = (y[0] + x[1], 1 - x[0] + y[1] - z[2], z[1] + y[2], z[0] - x[2])
    else:
        q = (z[0] + x[2], z[1] + y[2], 1 - x[0] - y[1] + z[2], x[1] - y[0])
    length = math.sqrt(sum(c * c for c in q))
    return tuple(c / length for c in q)
