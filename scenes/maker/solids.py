# SPDX-License-Identifier: Apache-2.0
"""Solids: lists of faces, each a list of points, counter-clockwise seen from outside."""

import math

from vectors import add, circle, cross, dot, mul, sub, unit


def box(w, h, d):
    """Standing on y = 0, its middle at the origin."""
    return frustum([(w / 2, d / 2), (w / 2, -d / 2), (-w / 2, -d / 2), (-w / 2, d / 2)], 1, h)


def frustum(base, share, height):
    """From a base polygon at y = 0 to its image, smaller by `share`, at `height`. Share 0 makes a pyramid."""
    low = [(x, 0, z) for x, z in base]
    high = [(x * share, height, z * share) for x, z in base]
    n = len(base)
    faces = [low[::-1]]
    if share > 0:
        faces.append(high)
    for i in range(n):
        j = (i + 1) % n
        faces.append([low[i], low[j], high[j], high[i]] if share > 0 else [low[i], low[j], high[0]])
    return faces


def prism(n, radius, height, turn=0.0):
    return frustum(circle(n, radius, turn), 1, height)


def lathe(n, profile, turn=0.0):
    """A convex body from rings (radius, y), upward; radius 0 at an end is a point."""
    rings = [[(x, y, z) for x, z in circle(n, r, turn)] if r > 0 else [(0, y, 0)] for r, y in profile]
    faces = []
    if len(rings[0]) > 1:
        faces.append(rings[0][::-1])
    if len(rings[-1]) > 1:
        faces.append(rings[-1])
    for low, high in zip(rings, rings[1:]):
        for i in range(n):
            j = (i + 1) % n
            a, b = low[i % len(low)], low[j % len(low)]
            c, d = high[j % len(high)], high[i % len(high)]
            face = [a, b, c, d]
            faces.append([p for k, p in enumerate(face) if p != face[k - 1]])
    return faces


def icosahedron():
    g = (1 + math.sqrt(5)) / 2
    p = [
        (-1, g, 0),
        (1, g, 0),
        (-1, -g, 0),
        (1, -g, 0),
        (0, -1, g),
        (0, 1, g),
        (0, -1, -g),
        (0, 1, -g),
        (g, 0, -1),
        (g, 0, 1),
        (-g, 0, -1),
        (-g, 0, 1),
    ]
    t = [
        (0, 11, 5),
        (0, 5, 1),
        (0, 1, 7),
        (0, 7, 10),
        (0, 10, 11),
        (1, 5, 9),
        (5, 11, 4),
        (11, 10, 2),
        (10, 7, 6),
        (7, 1, 8),
        (3, 9, 4),
        (3, 4, 2),
        (3, 2, 6),
        (3, 6, 8),
        (3, 8, 9),
        (4, 9, 5),
        (2, 4, 11),
        (6, 2, 10),
        (8, 6, 7),
        (9, 8, 1),
    ]
    p = [unit(v) for v in p]
    return [[p[i] for i in face] for face in t]


def sphere(levels, radius):
    faces = icosahedron()
    for _ in range(levels):
        finer = []
        for a, b, c in faces:
            ab, bc, ca = unit(add(a, b)), unit(add(b, c)), unit(add(c, a))
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        faces = finer
    return [[mul(p, radius) for p in f] for f in faces]


def dodecahedron(radius):
    """The dual of the icosahedron: a pentagon for each of its vertices."""
    ico = icosahedron()
    middle = [unit(mul(add(add(f[0], f[1]), f[2]), 1 / 3)) for f in ico]
    faces = []
    for v in sorted({p for f in ico for p in f}):
        around = [(f, middle[i]) for i, f in enumerate(ico) if v in f]
        # From face to face over the edge that leaves v.
        ring = [around[0]]
        while len(ring) < 5:
            f = ring[-1][0]
            last = f[(f.index(v) + 2) % 3]
            ring.append(next(a for a in around if a[0][(a[0].index(v) + 1) % 3] == last))
        faces.append([mul(m, radius) for _, m in ring])
    return faces


def octahedron(radius):
    return lathe(4, [(0, -radius), (radius, 0), (0, radius)])


def carved(planes):
    """The convex body that half-spaces have in common, each given by its outward normal, of any length, and the distance
    of its plane from the origin. Every plane has to give a face, and they come in the order of the planes."""
    planes = [(unit(n), d) for n, d in planes]
    corners = []

    def corner(p):  # the same for every face that meets there, so that the body closes
        for q in corners:
            if max(abs(p[k] - q[k]) for k in range(3)) < 1e-7:
                return q
        corners.append(p)
        return p

    faces = []
    for i, (n, d) in enumerate(planes):
        u = unit(cross(n, (0, 0, 1) if abs(n[2]) < 0.8 else (1, 0, 0)))
        v = cross(n, u)
        face = [add(mul(n, d), add(mul(u, 50 * a), mul(v, 50 * b))) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        for k, (m, e) in enumerate(planes):
            if k == i:
                continue
            over = [dot(m, p) - e for p in face]
            kept = []
            for j, p in enumerate(face):
                if over[j - 1] * over[j] < 0 and min(abs(over[j - 1]), abs(over[j])) > 1e-9:
                    share = over[j - 1] / (over[j - 1] - over[j])
                    kept.append(add(face[j - 1], mul(sub(p, face[j - 1]), share)))
                if over[j] <= 1e-9:
                    kept.append(p)
            face = kept
        face = [corner(p) for p in face]
        face = [p for k, p in enumerate(face) if p != face[k - 1]]
        if len(face) < 3:
            raise ValueError("plane %d gives no face" % i)
        faces.append(face)
    return faces


def antiprism(n, radius, height):
    """Between two circles of n points, one turned by half a step."""
    low = [(x, -height / 2, z) for x, z in circle(n, radius)]
    high = [(x, height / 2, z) for x, z in circle(n, radius, 0.5)]
    faces = [low[::-1], high]
    for i in range(n):
        j = (i + 1) % n
        faces += [[low[i], low[j], high[i]], [low[j], high[j], high[i]]]
    return faces


def trapezohedron(n, sharpness):
    """2n kites: planes that lean up and, half a step on, down."""
    planes = [((x, sharpness, z), 1) for x, z in circle(n, 1)] + [((x, -sharpness, z), 1) for x, z in circle(n, 1, 0.5)]
    return carved(planes)


def spiral(n):
    """n directions, evenly over the sphere: from pole to pole, a golden angle apart."""
    out = []
    for i in range(n):
        y = 1 - (2 * i + 1) / n
        a = math.pi * (3 - math.sqrt(5)) * i
        r = math.sqrt(1 - y * y)
        out.append((r * math.cos(a), y, r * math.sin(a)))
    return out


def sized(faces, radius):
    """Scaled so that its furthest point has that distance from the origin."""
    furthest = max(math.sqrt(dot(p, p)) for f in faces for p in f)
    return [[mul(p, radius / furthest) for p in f] for f in faces]


def stretched(faces, x, y, z):
    return [[(p[0] * x, p[1] * y, p[2] * z) for p in f] for f in faces]


def shifted(faces, by):
    return [[add(p, by) for p in f] for f in faces]


def tiled_slab(width, depth, thickness, columns, rows):
    """A slab whose top, at y = 0, is cut into tiles. Returns the tiles of either colour and the other faces. Its sides
    take up the tiles' corners, so that it is closed."""
    xs = [width * (i / columns - 0.5) for i in range(columns + 1)]
    zs = [depth * (i / rows - 0.5) for i in range(rows + 1)]
    tiles = ([], [])
    for i in range(columns):
        for j in range(rows):
            tiles[(i + j) % 2].append(
                [(xs[i], 0, zs[j + 1]), (xs[i + 1], 0, zs[j + 1]), (xs[i + 1], 0, zs[j]), (xs[i], 0, zs[j])]
            )
    y = -thickness

    def low(p):
        return (p[0], y, p[2])

    south = [(x, 0, zs[-1]) for x in reversed(xs)]
    east = [(xs[-1], 0, z) for z in zs]
    north = [(x, 0, zs[0]) for x in xs]
    west = [(xs[0], 0, z) for z in reversed(zs)]
    # Fans from the lower corner under the last point, so that no triangle is flat.
    sides = [[low(edge[-1]), low(edge[0])] + edge for edge in (south, west, north, east)]
    sides[1] = [low(west[0]), low(west[-1])] + west[::-1]
    sides[3] = [low(east[0]), low(east[-1])] + east[::-1]
    bottom = [(xs[0], y, zs[0]), (xs[-1], y, zs[0]), (xs[-1], y, zs[-1]), (xs[0], y, zs[-1])]
    return tiles[0], tiles[1], outward(sides) + [bottom]


def outward(faces):
    """Turn faces of a convex body round the origin's vertical axis outward."""
    centre = mul((0, 1, 0), sum(p[1] for f in faces for p in f) / sum(len(f) for f in faces))
    out = []
    for f in faces:
        n = newell(f)
        out.append(f if dot(n, sub(f[0], centre)) > 0 else [f[0]] + f[:0:-1])
    return out


def newell(face):
    n = (0.0, 0.0, 0.0)
    for i in range(1, len(face) - 1):
        n = add(n, cross(sub(face[i], face[0]), sub(face[i + 1], face[0])))
    return n
