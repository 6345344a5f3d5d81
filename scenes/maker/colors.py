# SPDX-License-Identifier: Apache-2.0
"""The colours of the scenes."""

IVORY = (0.86, 0.80, 0.68)
SAND = (0.80, 0.70, 0.53)
STONE = (0.62, 0.55, 0.45)
BRICK = (0.78, 0.30, 0.17)
TEAL = (0.10, 0.50, 0.48)
MUSTARD = (0.88, 0.62, 0.12)
BLUE = (0.16, 0.32, 0.70)
PLUM = (0.50, 0.18, 0.46)
LEAF = (0.24, 0.55, 0.20)
ROSE = (0.86, 0.45, 0.45)
SLATE = (0.40, 0.45, 0.52)


def tints(low, high, n):
    """n colours from one to another."""
    return [tuple(low[k] + (high[k] - low[k]) * i / max(n - 1, 1) for k in range(3)) for i in range(n)]
