# SPDX-License-Identifier: Apache-2.0
"""Verilator's own objects, which are the same in every model, kept between builds."""

import contextlib
import errno
import hashlib
import os
import pathlib
import stat
import struct
import subprocess
import zlib

from steps import fail


class Runtime:
    """Verilator's own objects, the same in every model of a tool and its flags: kept beside the models."""

    def __init__(self, verilator, cxx, flags, obj):
        self.obj = obj
        versions = [
            subprocess.run([*tool, "--version"], capture_output=True, text=True).stdout for tool in ([verilator], cxx)
        ]
        own = (obj / "Vkage_classes.mk").read_text().split("### Object file lists")[0]  # threads, tracing and the like
        key = hashlib.sha256(
            "\0".join([*versions, *flags, own, (obj / "from_verilator.hpp").read_text()]).encode()
        ).hexdigest()[:24]
        cache = os.environ.get("XDG_CACHE_HOME") or (
            os.path.join(os.environ["HOME"], ".cache") if os.environ.get("HOME") else None
        )
        self.folder = pathlib.Path(cache) / "kage" / "verilator" / key if cache else None
        if self.folder:
            for folder in (self.folder.parent.parent, self.folder.parent, self.folder):
                trust(folder, link=True)

    def take(self, names):
        for name in names if self.folder else ():
            try:
                trust(self.folder / name)
                whole = (self.folder / name).read_bytes()
                if whole[-SUM_BYTES:] == check_sum(whole[:-SUM_BYTES]):  # a damaged one is compiled
                    (self.obj / name).write_bytes(whole[:-SUM_BYTES])
            except OSError:
                (self.obj / name).unlink(missing_ok=True)  # it is compiled: make would take half of one for the whole

    def keep(self, names):
        for name in names if self.folder else ():
            try:
                self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
                data = (self.obj / name).read_bytes()
                # Among the build's own files, which go if it is killed; beside its place where that is another disk.
                if not any(self.put(data + check_sum(data), place, name) for place in (self.obj, self.folder)):
                    return
            except OSError:
                return  # the next one compiles them too

    def put(self, data, place, name):
        """Keep `data` as `name`, by way of a file in the folder `place`; False if that is on another disk."""
        partial = place / f".{name}.{os.getpid()}"
        try:
            with open(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600), "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, self.folder / name)
            return True
        except OSError as e:
            if e.errno == errno.EXDEV:
                return False
            raise
        finally:
            with contextlib.suppress(OSError):
                partial.unlink()


SUM_BYTES = 12


def check_sum(data):
    """The bytes that stand behind a kept object: its length and CRC-32."""
    return struct.pack("<QI", len(data), zlib.crc32(data))


def trust(path, link=False):
    """Stop if somebody else could have put `path` there: what is kept becomes part of a program. With `link` it may be a link,
    which then must be this user's too, as what it leads to."""
    try:
        states = [path.lstat(), path.stat()]
    except FileNotFoundError:
        return
    linked = stat.S_ISLNK(states[0].st_mode)
    others = any(s.st_uid not in (0, os.geteuid()) for s in states) or states[1].st_mode & 0o022
    if others or (linked and not link):
        what = "somebody else's, or others may write to it" if others else "a link"
        fail(
            f"{path}: it is {what}, and what is kept there becomes part of RTL models: remove it, or set XDG_CACHE_HOME to a folder of your own"
        )
