# SPDX-License-Identifier: Apache-2.0
"""Reads FST waveforms as Verilator writes them.

The writer packs hierarchy and values by LZ4, whose block's format is in the LZ4 project's lz4_Block_format.md. The
file's own format is that of GTKWave's fstapi.c: blocks of a tag and a length, numbers of a variable length by 7 bits,
and for each net the chain of its changes.
"""

import struct
import sys
import zlib

GEOMETRY, HIERARCHY, VALUES = 3, 6, 8


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
    assert len(out) == size, "a block does not unpack"
    return bytes(out)


def inflated(data, size):
    """As it stands where that is no longer than packed."""
    return data if len(data) == size else zlib.decompress(data)


class Bytes:
    """Read from the front."""

    def __init__(self, data, at=0):
        self.data, self.at = data, at

    def byte(self):
        self.at += 1
        return self.data[self.at - 1]

    def long(self):
        self.at += 8
        return struct.unpack_from(">Q", self.data, self.at - 8)[0]

    def number(self, signed=False):
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 127) << shift
            shift += 7
            if not byte & 128:
                break
        return value - (1 << shift) if signed and byte & 64 else value

    def take(self, size):
        self.at += size
        return self.data[self.at - size : self.at]

    def text(self):
        end = self.data.index(0, self.at)
        word = self.data[self.at : end].decode()
        self.at = end + 1
        return word


class Fst:
    """nets: {full name, a vector's with its range and no space before it: handle, from 0}."""

    def __init__(self, path):
        self.nets, self.bits, self.changes = {}, [], None
        data, at, self.values = open(path, "rb").read(), 0, []
        while at < len(data):
            kind, block = data[at], Bytes(data, at + 1)
            at += 1 + block.long()
            if kind == HIERARCHY:
                size = block.long()
                self.read_hierarchy(Bytes(unpacked(data[block.at : at], size)))
            elif kind == GEOMETRY:
                size, count = block.long(), block.long()
                lengths = Bytes(inflated(data[block.at : at], size))
                self.bits = [lengths.number() for _ in range(count)]
            elif kind == VALUES:
                self.values.append((block, at))
        if not self.nets:
            sys.exit(f"{path}: no hierarchy packed by LZ4")

    def read_hierarchy(self, tree):
        scopes, handles = [], 0
        while tree.at < len(tree.data):
            tag = tree.byte()
            if tag == 254:
                tree.byte()
                scopes.append(tree.text())
                tree.text()
            elif tag == 255:
                scopes.pop()
            elif tag == 252:
                tree.take(2)
                tree.text()
                tree.number()
            elif tag < 32:
                tree.byte()
                name = ".".join([*scopes, tree.text().replace(" ", "")])
                tree.number()
                alias = tree.number()
                handles += alias == 0
                self.nets[name] = (alias or handles) - 1

    def first(self):
        """The first time."""
        block, _ = self.values[0]
        return struct.unpack_from(">Q", block.data, block.at)[0]

    def of(self, name):
        """[(time, value)] of a net, as numbers, by rising times."""
        handle = self.nets[name]
        all_changes = []
        for block, end in self.values:
            all_changes += self.of_block(Bytes(block.data, block.at), end, handle)
        return all_changes

    def of_block(self, block, end, handle):
        data, first = block.data, block.long()
        block.take(16)  # the last time, and memory
        size, packed, _ = block.number(), block.number(), block.number()
        frame = inflated(block.take(packed), size)
        block.number()
        start = block.at
        assert block.byte() == ord("4"), "values are packed otherwise than by LZ4"
        size, packed, count = struct.unpack_from(">3Q", data, end - 24)
        times = Bytes(inflated(data[end - 24 - packed : end - 24], size))
        time, clock = [], 0
        for _ in range(count):
            clock += times.number()
            time.append(clock)
        index_end = end - 24 - packed - 8
        index = index_end - struct.unpack_from(">Q", data, index_end)[0]
        where, length = chain(Bytes(data[index:index_end]), index - start)[handle]
        bits = self.bits[handle]
        before = sum(self.bits[:handle])
        value = frame[before : before + bits]
        if b"x" not in value:  # so it is until it is written first
            yield first, int(value, 2)
        if where == 0:
            return
        changes = Bytes(data, start + where)
        size = changes.number()
        packed = data[changes.at : start + where + length]
        changes, at = Bytes(unpacked(packed, size) if size else packed), 0
        while changes.at < len(changes.data):
            number = changes.number()
            if bits == 1:
                assert number & 1 == 0, "a bit that is neither 0 nor 1"
                at += number >> 2
                yield time[at], number >> 1 & 1
            else:
                assert number & 1 == 0, "a vector of other bits than 0 and 1"
                at += number >> 1
                whole = int.from_bytes(changes.take((bits + 7) // 8), "big")
                yield time[at], whole >> -bits % 8


def chain(table, end):
    """Where the changes of each net lie, and their length: 0 for none."""
    where, lengths, place, last, alias = [], [], 0, None, 0
    while table.at < len(table.data):
        if table.data[table.at] & 1:
            step = table.number(signed=True) >> 1
            if step > 0:
                place += step
                if last is not None:
                    lengths[last] = place - where[last]
                last = len(where)
                where.append(place)
                lengths.append(0)
                continue
            if step < 0:
                alias = step
            where.append(0)
            lengths.append(alias)
        else:
            none = table.number() >> 1
            where += [0] * none
            lengths += [0] * none
    if last is not None:
        lengths[last] = end - where[last]
    for i, length in enumerate(lengths):
        if length < 0:
            where[i], lengths[i] = where[-length - 1], lengths[-length - 1]
    return list(zip(where, lengths))


def at(changes, time):
    """The value at a time."""
    return [value for when, value in changes if when <= time][-1]
