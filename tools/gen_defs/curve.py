# SPDX-License-Identifier: Apache-2.0
"""The display's curve, sRGB (IEC 61966-2-1), as the least linear light of each displayed value."""

import decimal

FRAC = 32  # fraction bits of a threshold


def thresholds():
    """The least light, in 2^-FRAC of white, that shows each value 1 .. 255: it is no nearer to the value below."""
    with decimal.localcontext() as context:
        context.prec = 60
        found = []
        for shown in range(1, 256):
            s = (decimal.Decimal(shown) - decimal.Decimal("0.5")) / 255
            if s <= decimal.Decimal("0.04045"):
                light = s / decimal.Decimal("12.92")
            else:
                light = ((s + decimal.Decimal("0.055")) / decimal.Decimal("1.055")) ** decimal.Decimal("2.4")
            found.append(int((light * 2**FRAC).to_integral_value(rounding=decimal.ROUND_CEILING)))
        return found
