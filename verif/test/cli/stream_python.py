#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stream_python.py KAGE SOURCE FILE...: python/kage/stream.py against the program: each token of each file is what
`kage info --tokens` says, and what is written again of what was read is the very file. Prints the kinds that were there."""

import pathlib
import subprocess
import sys

kage, source, *files = sys.argv[1:]
sys.path.insert(0, f"{source}/python")
from kage import stream as ks  # noqa: E402


def told(file, frame):
    """The program's text for a frame's tokens."""
    run = subprocess.run([kage, "info", file, "--tokens", str(frame)], capture_output=True, text=True, check=True)
    lines = iter(run.stdout.splitlines())
    while not next(lines).startswith(f"frame {frame}:"):
        pass
    return [line.split("  ", 1)[1] if line[0] != " " else line.strip().split("  ", 1)[1] for line in lines]


def fail(text):
    sys.exit(f"FAILED: {text}")


kinds = set()
for file in files:
    data = pathlib.Path(file).read_bytes()
    sections = list(ks.read_sections(data))
    config = ks.Config.read(sections[0][1])
    codec = ks.Codec(config)
    if config.faults():
        fail(f"{file}: {config.faults()}")
    again, frame = [], 0
    for tag, payload in sections:
        if tag == "FRAM":
            words = ks.words_of(payload)
            header = codec.read_header(words)
            if (
                header["magic"] != ks.MAGIC
                or header["version"] not in (ks.VERSION, ks.POLYGON_VERSION)
                or header["param_hash"] != config.hash()
            ):
                fail(f"{file}: frame {frame}: header {header}")
            tokens = list(codec.tokens(words))
            size = f"header: {header['width']}x{header['height']}, "
            said = told(file, frame)
            if not said[0].startswith(size):
                fail(f"{file}: frame {frame}: {said[0]} and not {size}")
            for index, (token, text) in enumerate(zip(tokens, said[1:], strict=True), 1):
                if codec.text(token) != text:
                    fail(f"{file}: frame {frame}, token {index}: {codec.text(token)} and not {text}")
            fields = ("version", "width", "height", "background", "frame")
            words = codec.write_header(**{name: header[name] for name in fields})
            for token in tokens:
                words += codec.pack(token)
            payload = ks.payload_of(words)
            kinds |= {token["kind"] for token in tokens}
            frame += 1
        again.append((tag, payload))
    if frame == 0 or ks.write_sections(again) != data:
        fail(f"{file}: what is written again is another file")

# A value that its field does not hold is refused, and so is what is no token.
codec = ks.Codec(ks.Config(X_BITS=4, MAX_WIDTH=15))
for wrong in ({"kind": "OP", "xl": 16}, {"kind": "OP", "z": 2**36}, {"kind": "SP", "w": -3}, {"kind": "TP"}):
    try:
        codec.pack(wrong)
    except ValueError:
        continue
    fail(f"{wrong} is packed")
for words in ([0], [13], [6]):  # no kind, one that the configuration lacks, a cut one
    try:
        codec.unpack(words)
    except ValueError:
        continue
    fail(f"{words} is unpacked")
for wrong in (
    {"kind": "OP", "xll": 3},
    {"kind": "EOL", "y": 2**16},
):  # a field that there is not; one that is too large
    try:
        codec.pack(wrong)
    except ValueError:
        continue
    fail(f"{wrong} is packed")


def refused(text, work):
    """`work` has to end in a ValueError that says `text`."""
    try:
        work()
    except ValueError as e:
        if text in str(e):
            return
        fail(f"{e} and not {text}")
    fail(f"not refused: {text}")


frame = codec.write_header(width=4, height=1, background=0, frame=0) + codec.pack({"kind": "EOL", "y": 0})
end = codec.pack({"kind": "END"})
list(codec.tokens(frame + end))  # is whole
refused("token 2, word 6: the words end where a token should begin", lambda: list(codec.tokens(frame)))
refused("1 words behind END", lambda: list(codec.tokens(frame + end + [0])))
refused("END: bits behind its last field are set", lambda: list(codec.tokens(frame + [end[0] | 1 << 31])))
data = pathlib.Path(files[0]).read_bytes()
for size in (*range(8, len(data), max(1, len(data) // 300)), *range(len(data) - 40, len(data))):  # cut anywhere
    refused("cut", lambda size=size: list(ks.read_sections(data[:size])))
spoilt = bytearray(data)
spoilt[40] ^= 1
refused("the checksum of CONF is wrong", lambda: list(ks.read_sections(bytes(spoilt))))
refused("no stream file", lambda: list(ks.read_sections(b"PNG")))
if ks.Config(MAX_WIDTH=2048).faults() != ["MAX_WIDTH must be at most 2^X_BITS - 1: xr may be the width"]:
    fail(ks.Config(MAX_WIDTH=2048).faults())
print(" ".join(sorted(kinds)))
