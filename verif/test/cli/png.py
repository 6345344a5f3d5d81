# SPDX-License-Identifier: Apache-2.0
"""Pixels of the pictures that kage writes."""

import struct
import zlib


def pixels(name):
    """The bytes of a PNG of 8 bits, red, green, blue, in reading order."""
    data, at, packed = open(name, "rb").read(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
            assert body[8:13] == bytes([8, 2, 0, 0, 0])
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    raw, line, out = zlib.decompress(packed), bytearray(3 * width), bytearray()
    for y in range(height):
        row = raw[y * (3 * width + 1) : (y + 1) * (3 * width + 1)]
        above, line = line, bytearray(row[1:])
        for i in range(3 * width):
            left, up, corner = (line[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[row[0]]) & 255
        out += line
    return bytes(out)
