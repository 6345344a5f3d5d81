# SPDX-License-Identifier: Apache-2.0
"""Packs of test vectors (docs/vectors.md): reading one, and having the program `kage` write one."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
from collections.abc import Sequence

from kage import stream

SCHEMA = "kage.pack/1"


class PackError(Exception):
    """Why a pack cannot be read or written, in one line."""


@dataclasses.dataclass(frozen=True)
class PackFrame:
    """A frame of a pack: its words without the last beat's zeros, and its lines, CHANNELS bytes a pixel."""

    what: str
    error: str  #: the name of its error, "NONE" for a sound one
    words: list[int]
    lines: list[bytes]


class Pack:
    """A pack of a whole core. Reads the manifest, and holds each file that it reads against its hash."""

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = pathlib.Path(folder)
        path = self.folder / "manifest.json"
        try:
            self.manifest = json.loads(path.read_text())
        except OSError as e:
            raise PackError(f"{path}: {e.strerror}") from e
        except (ValueError, RecursionError) as e:  # the latter: nested too deeply
            raise PackError(f"{path}: not JSON: {e}") from e
        if not isinstance(self.manifest, dict) or self.manifest.get("schema") != SCHEMA:
            raise PackError(f"{path}: not a pack of format {SCHEMA}")
        try:
            self.config = stream.Config(**self.manifest["config"])
        except (KeyError, TypeError) as e:
            raise PackError(f"{path}: its configuration is not one: {e}") from e

    def frames(self) -> list[PackFrame]:
        """All frames in order, malformed ones too. Raises PackError where the files have not what the manifest says."""
        try:
            return self._frames()
        except (KeyError, TypeError, ValueError) as e:
            raise PackError(f"{self.folder / 'manifest.json'}: not as a pack's is: {e!r}") from e

    def _frames(self) -> list[PackFrame]:
        words = self._bytes("stimulus.bin")
        pixels = self._bytes("pixels.bin")
        frames, beat_at, pixel_at = [], 0, 0
        beat = 4 * self.config.BEAT_WORDS
        for f in self.manifest["frames"]:
            taken = words[beat_at : beat_at + f["beats"] * beat]
            beat_at += f["beats"] * beat
            row = f["width"] * self.config.CHANNELS
            lines = [pixels[pixel_at + y * row : pixel_at + (y + 1) * row] for y in range(f["height"])]
            pixel_at += f["height"] * row
            numbers = [int.from_bytes(taken[4 * i : 4 * i + 4], "little") for i in range(f["words"])]
            frames.append(PackFrame(f["what"], f["error"], numbers, lines))
        if beat_at != len(words) or pixel_at != len(pixels):
            raise ValueError("its frames are not all of stimulus.bin and pixels.bin")
        return frames

    def _bytes(self, name: str) -> bytes:
        (file,) = [f for f in self.manifest["files"] if f["name"] == name]
        try:
            data = (self.folder / name).read_bytes()
        except OSError as e:
            raise PackError(f"{self.folder / name}: {e.strerror}") from e
        if hashlib.sha256(data).hexdigest() != file["sha256"]:
            raise PackError(f"{self.folder / name}: not what the manifest says")
        return data


def write_pack(source: str | os.PathLike[str], out: str | os.PathLike[str], options: Sequence[str] = ()) -> Pack:
    """Has `kage vectors SOURCE --out OUT OPTIONS...` write a pack: of a scene or stream file, or "random". The program is
    $KAGE, the source tree's build/release/bin/kage, or the `kage` in the PATH. Raises PackError with the program's line."""
    built = pathlib.Path(__file__).resolve().parents[2] / "build/release/bin/kage"
    program = os.environ.get("KAGE") or (str(built) if built.exists() else shutil.which("kage"))
    if not program:
        raise PackError(
            "kage: not found: build it (tools/demo) and put build/release/bin into PATH, or name the program in $KAGE"
        )
    try:
        done = subprocess.run(
            [program, "vectors", os.fspath(source), "--out", os.fspath(out), *options], capture_output=True, text=True
        )
    except OSError as e:
        raise PackError(f"{program}: {e.strerror}") from e
    if done.returncode != 0:
        raise PackError(
            done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"{program}: {done.returncode}"
        )
    return Pack(out)
