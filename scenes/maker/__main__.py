# SPDX-License-Identifier: Apache-2.0
"""See scenes/make."""

import argparse
import os
import sys

from canopy import canopy
from courtyard import courtyard
from cutaway import cutaway
from depths import depths
from edges import edges
from fifteen import fifteen
from glass import glass
from inside import inside
from knot import knot
from penumbra import penumbra
from polyhedra import polyhedra
from three_lights import three_lights

SCENES_DIR = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SCENES = {
    "courtyard": courtyard,
    "knot": knot,
    "inside": inside,
    "edges": edges,
    "polyhedra": polyhedra,
    "fifteen": fifteen,
    "glass": glass,
    "penumbra": penumbra,
    "three-lights": three_lights,
    "canopy": canopy,
    "cutaway": cutaway,
    "depths": depths,
}


def main():
    parser = argparse.ArgumentParser(prog="scenes/make", description="Write kage's built-in scenes as glTF 2.0.")
    parser.add_argument("--out", default=SCENES_DIR, metavar="DIR", help="where to (default: scenes)")
    parser.add_argument("--check", action="store_true", help="write nothing; fail if a file differs")
    arguments = parser.parse_args()
    stale = []
    for name, build in SCENES.items():
        path = os.path.join(arguments.out, name + ".gltf")
        text = build().text().encode("ascii")
        if arguments.check:
            try:
                with open(path, "rb") as f:
                    same = f.read() == text
            except OSError:
                same = False
            if not same:
                stale.append(name)
        else:
            with open(path, "wb") as f:
                f.write(text)
    if stale:
        sys.exit("scenes/make: not up to date: {}; run scenes/make".format(", ".join(stale)))


main()
