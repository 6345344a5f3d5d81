# SPDX-License-Identifier: Apache-2.0
"""kage for testbenches in Python: streams, the golden core, and packs of test vectors.

    import kage

    core = kage.Golden("default")                    # a name, a YAML file, a stream file, or parameters
    for words in kage.frames("courtyard.kage"):
        frame = core.frame(words)
        print(frame.width, frame.height, frame.status, frame.lines[0][:3])

* `kage.stream` takes streams apart and puts them together; it needs nothing but Python.
* `kage.golden` is the golden core by libkage_golden: pixels of a frame, and every pixel's state after every token.
* `kage.pack` reads packs of test vectors, and has the program `kage` write them.
"""

from kage.golden import Frame, Golden, GoldenError, Pixel, Status, Step, library
from kage.pack import Pack, PackError, PackFrame, write_pack
from kage.stream import Codec, Config, read_sections, words_of

__all__ = [
    "Codec",
    "Config",
    "Frame",
    "Golden",
    "GoldenError",
    "Pack",
    "PackError",
    "PackFrame",
    "Pixel",
    "Status",
    "Step",
    "frames",
    "library",
    "read_sections",
    "words_of",
    "write_pack",
]


def frames(path):
    """The words of each frame of a stream file, an iterator of lists of integers. Raises ValueError for a file that is none,
    OSError for one that cannot be read."""
    import pathlib

    for tag, payload in read_sections(pathlib.Path(path).read_bytes()):
        if tag == "FRAM":
            yield list(words_of(payload))
