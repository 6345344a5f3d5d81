# SPDX-License-Identifier: Apache-2.0
"""polygons.py SOURCE: writes polygons.kage, a frame at the polygon level made by hand; spans.kage, the spans that it comes to;
and broken.kage, where an edge has no polygon (PORT). Variants of polygons.kage:

  other.kage    one depth has another value
  edge.kage     one edge has another value
  place.kage    one place has another value
  fewer.kage    without a polygon
  smaller.kage  of a core that keeps fewer polygons
  two.kage      two frames, of which the second is edge.kage's
  same.kage     the first frame twice
  mixed.kage    two.kage with its second frame as spans

The words are read back, and the golden core draws the first two files alike."""

import sys

source = sys.argv[1]
sys.path.insert(0, f"{source}/python")
from kage.golden import Golden  # noqa: E402
from kage.stream import POLYGON_VERSION, Codec, Config, payload_of, write_sections  # noqa: E402

WIDTH, HEIGHT = 16, 6
ONE = 1 << 24  # an LSB of a plane
codec = Codec(Config(ACTIVE=8))


def frame(version, tokens, number=0):
    words = codec.write_header(version=version, width=WIDTH, height=HEIGHT, background=0, frame=number)
    for token in tokens:
        words += codec.pack(token)
    if list(codec.tokens(words)) != [{**zeros(t), **t} for t in tokens]:
        sys.exit("FAILED: the tokens that are read are not those that were written")
    return words


def zeros(token):
    """Fields that a token does not name are 0."""
    return {name: [0] * 3 if channel >= 0 else 0 for name, channel, *_ in codec.layout[token["kind"]][0]}


def polygon(at, look, value, left, right, bottom):
    """From line 1 on, as high as its edges go."""
    edges = (
        {
            "kind": "EDGE",
            "side": side,
            "last": 1,
            "top_x": x * 256,
            "top_y": 256,
            "bottom_x": x * 256,
            "bottom_y": bottom * 256,
        }
        for side, x in enumerate((left, right))
    )
    return [
        {"kind": "AT", **at},
        {"kind": "POLYGON", **look, "value": value * ONE, "right": 2 * ONE, "down": 3 * ONE},
        *edges,
    ]


def depth(at):
    """A span's depth in its field: half an LSB is added."""
    return at * 2048 + 1024


def op(line):
    at = 1000 + 3 * line + 2 * 2
    return {"kind": "OP", "xl": 2, "xr": 10, "class": 1, "z": depth(at), "dz": 2 * 2048, "color": [200, 100, 50]}


def sp(line):
    return {"kind": "SP", "xl": 4, "xr": 8, "w": 1, "z": depth(500 + 3 * line + 2 * 4), "dz": 2 * 2048}


def ev(xl, xr):
    return {"kind": "EV", "xl": xl, "xr": xr}


def eol(y):
    return {"kind": "EOL", "y": y}


def at_polygons(value=1000, right=10, volume=5, shadow=True):
    return [
        {"kind": "SHADE", "shade": 128},
        eol(0),
        *polygon({"layer": 0}, {"class": 1, "color": [200, 100, 50]}, value, 2, right, 4),
        *(polygon({"layer": 1, "volume": volume, "rank": 1}, {"w": 1}, 500, 4, 8, 3) if shadow else []),
        eol(1),
        {"kind": "AT", "layer": 1, "volume": 6},
        {"kind": "NC", "xl": 0, "xr": WIDTH, "w": 1},
        *map(eol, range(2, HEIGHT)),
        {"kind": "END"},
    ]


of_spans = [
    {"kind": "SHADE", "shade": 128},
    eol(0),
    *(op(1), sp(1), ev(4, 8), {"kind": "RESOLVE"}, eol(1)),
    *(op(2), sp(2), ev(4, 8), {"kind": "IF", "w": 1}, ev(0, WIDTH), {"kind": "RESOLVE"}, eol(2)),
    *(op(3), *map(eol, range(3, HEIGHT))),
    {"kind": "END"},
]


def write(name, *frames, tag="FRAM", **other):
    text = "".join(f"{key}: {value}\n" for key, value in {**vars(codec.config), **other}.items())
    with open(name, "wb") as file:
        file.write(write_sections([("CONF", text.encode()), *((tag, payload_of(words)) for words in frames)]))


polygons, spans = frame(POLYGON_VERSION, at_polygons()), frame(1, of_spans)
write("polygons.kage", polygons)
write("spans.kage", spans)
write("other.kage", frame(POLYGON_VERSION, at_polygons(1001)))
write("edge.kage", frame(POLYGON_VERSION, at_polygons(right=11)))
write("place.kage", frame(POLYGON_VERSION, at_polygons(volume=4)))
write("fewer.kage", frame(POLYGON_VERSION, at_polygons(shadow=False)))
write("smaller.kage", polygons, ACTIVE=2)
write("two.kage", polygons, frame(POLYGON_VERSION, at_polygons(right=11), 1))
write("same.kage", polygons, frame(POLYGON_VERSION, at_polygons(), 1))
write("mixed.kage", polygons, frame(1, of_spans, 1))
broken = at_polygons()
broken.insert(2, {"kind": "EDGE"})
write("broken.kage", frame(POLYGON_VERSION, broken), tag="PORT")

golden = Golden(codec.config)
drawn = golden.frame(polygons)
if not drawn.status or drawn.lines != golden.frame(spans).lines or len(set(drawn.lines)) < 4:
    sys.exit(f"FAILED: the two levels are not drawn alike: {drawn}")
steps = list(golden.steps(polygons))
kinds = " ".join(step.kind for step in steps)
if kinds != "HEADER SHADE EOL AT POLYGON EDGE EDGE AT POLYGON EDGE EDGE EOL AT NC EOL EOL EOL EOL END":
    sys.exit(f"FAILED: steps {kinds}")
made = [text.split()[0] for step in steps for text in step.made]
if made != [token["kind"] for token in of_spans]:
    sys.exit(f"FAILED: made {made}")
