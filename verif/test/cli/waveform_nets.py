#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""waveform_nets.py FILE.gtkw: whether the waveform that a GTKWave save file names has all of the nets that it names.

Reads the hierarchy of an FST file, which Verilator's writer packs by LZ4: the block's format is in the LZ4 project's
lz4_Block_format.md, the hierarchy's tags are those of fstapi.h.
"""

import re
import struct
import sys


def unpacked(data, size):
    """An LZ4 block."""
    out, at = bytearray(), 0

    def length(n):
        nonlocal at
        more = 255 if n == 15 else 0
        while more == 255:
            more = data[at]
            at += 1
            n += more
        return n

    while True:
        token = data[at]
        at += 1
        n = length(token >> 4)
        out += data[at : at + n]
        at += n
        if at >= len(data):
            break
        back = struct.unpack_from("<H", data, at)[0]
        at += 2
        for _ in range(length(token & 15) + 4):
            out.append(out[-back])
    assert len(out) == size, "the hierarchy does not unpack"
    return bytes(out)


def hierarchy(path):
    data, at = open(path, "rb").read(), 0
    while at < len(data):
        kind, size = data[at], struct.unpack_from(">Q", data, at + 1)[0]
        if kind == 6:
            return unpacked(data[at + 17 : at + 1 + size], struct.unpack_from(">Q", data, at + 9)[0])
        at += 1 + size
    sys.exit(f"{path}: no hierarchy packed by LZ4")


def nets(tree):
    """Full names, vectors with their range and no space before it."""
    at, scopes = 0, []

    def text():
        nonlocal at
        end = tree.index(0, at)
        at, word = end + 1, tree[at:end].decode()
        return word

    def number():
        nonlocal at
        while tree[at] & 128:
            at += 1
        at += 1

    while at < len(tree):
        tag = tree[at]
        at += 1
        if tag == 254:
            at += 1
            scopes.append(text())
            text()
        elif tag == 255:
            scopes.pop()
        elif tag == 252:
            at += 2
            text()
            number()
        elif tag < 32:
            at += 1
            yield ".".join([*scopes, text().replace(" ", "")])
            number()
            number()


save = open(sys.argv[1]).read()
there = set(nets(hierarchy(re.search(r'^\[dumpfile\] "(.*)"$', save, re.M)[1])))
wanted = re.findall(r"^(\w+\..*)$", save, re.M)
missing = [n for n in wanted if n not in there]
if missing or len(wanted) < 15:
    sys.exit(f"{sys.argv[1]}: {len(wanted)} nets, of which the waveform lacks {missing}")
