# SPDX-License-Identifier: Apache-2.0
"""The scene three-lights."""

import math

from document import Document, perspective
from smooth import smooth_sphere
from solids import box, dodecahedron, prism, shifted
from vectors import looking, sub


def three_lights():
    """Red, green and blue lamps over white bodies: where two are kept out the third colours the shadow. The red one is a spot,
    the blue one a disc, the green one the sun; red and blue go round."""
    d = Document("three-lights", 8, "white bodies under a red spot, a green sun and a blue disc: coloured shadows")
    white = (0.82, 0.82, 0.82)
    d.solid("floor", shifted(box(16, 0.4, 16), (0, -0.4, 0)), white)
    d.solid("wall", box(16, 4.5, 0.4), white, (0, 0, -4.6))
    d.solid("column", prism(16, 0.5, 2.4), white, (-1.3, 0, -0.9))
    d.solid("block", box(1.1, 1.1, 1.1), white, (1.5, 0, -0.4), ((0, 1, 0), 30))
    d.solid("slab", box(0.2, 1.8, 1.2), white, (0.2, 0, 1.4), ((0, 1, 0), -35))
    d.solid("gem", dodecahedron(0.55), white, (2.4, 0.85, 1.7), ((0, 1, 0), 10))
    d.node("ball", mesh=d.mesh("ball", smooth_sphere(d, 2, 0.6, white)), translation=(-2.5, 0.62, 1.3))
    times = range(9)
    red, blue, red_turns = [], [], []
    for k in times:
        a = math.radians(18 * k)
        red.append((4.2 * math.cos(a + 2.3), 5.0, 4.2 * math.sin(a + 2.3)))
        blue.append((4.6 * math.cos(0.7 - a), 3.6, 4.6 * math.sin(0.7 - a)))
        red_turns.append(looking(sub((-0.3, 0, 0), red[-1]), (0.1, 1, 0.2)))
    lamp = d.lamp(
        {
            "type": "spot",
            "color": [1, 0.22, 0.16],
            "intensity": 75,
            "name": "red",
            "spot": {"innerConeAngle": 0.45, "outerConeAngle": 0.85},
        },
        translation=red[0],
        rotation=red_turns[0],
    )
    d.animate(lamp, times, translation=red, rotation=red_turns)
    d.sun((0.45, -0.8, -0.4), (0.14, 0.75, 0.25))
    lamp = d.lamp(
        {
            "type": "point",
            "color": [0.2, 0.32, 1],
            "intensity": 48,
            "name": "blue",
            "extras": {"kage": {"shape": "disc", "radius": 0.3}},
        },
        translation=blue[0],
        rotation=looking((-1, -1, -0.5)),
    )
    d.animate(lamp, times, translation=blue)
    eye = (0.6, 5.2, 8.4)
    d.camera(perspective(42, 0.5), translation=eye, rotation=looking(sub((0.1, 0.6, -0.2), eye)))
    return d
