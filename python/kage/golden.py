# SPDX-License-Identifier: Apache-2.0
"""The golden core, by libkage_golden (ref/include/kage/golden.h has the contract of each function).

The library is the file that $KAGE_GOLDEN names, if that is set. Else it is looked for beside this file, where `pip install
./python` puts it if the source tree has been built. Then it is looked for in build/release/lib of the source tree that this
file lies in or was installed from, and last where the system looks for libraries.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import dataclasses
import functools
import os
import pathlib
from collections.abc import Iterable, Iterator, Mapping, Sequence

from kage import stream
from kage.golden_numbers import KINDS, PIXEL

ABI = 1
_HERE = pathlib.Path(__file__).resolve().parent
_TAKER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.POINTER(ctypes.c_ubyte), ctypes.c_int)

# Results of kage_golden_word(), and those of kage_golden_pixel() that stand for no value.
_ERROR, _TOKEN, _END, _FAILED = -1, 1, 2, 3
_ABSENT, _ANY = -1, -2


class GoldenError(Exception):
    """The golden core refused a call; the text says why, in one line."""


@dataclasses.dataclass(frozen=True)
class Status:
    """How a frame ended. `error` is the code of docs/stream.md, "Errors", 0 for none; then all but the text is 0."""

    error: int
    frame: int
    line: int
    token: int
    unit: int
    text: str

    def __bool__(self) -> bool:
        """Whether the frame is sound."""
        return self.error == 0

    def __str__(self) -> str:
        return self.text


@dataclasses.dataclass(frozen=True)
class Frame:
    """The pixels of a frame. `lines` has a bytes object for each line, CHANNELS bytes a pixel, channel 0 first, 0 .. 255; it
    is empty if the header is refused. After an error the lines that had not ended are background."""

    width: int
    height: int
    lines: list[bytes]
    status: Status


@dataclasses.dataclass(frozen=True)
class Pixel:
    """A pixel's state, as docs/stream.md has it. None: the configuration has no such field, or any value is right, as of a
    colour that was never drawn."""

    z: int | None  #: all ones: clear
    color: tuple[int | None, ...]  #: by channel, 0 .. 255
    normal_class: int | None
    dsf: int | None
    fsf: int | None
    counts: tuple[int | None, ...]  #: by light


@dataclasses.dataclass(frozen=True)
class Step:
    """A token that has done what it does. `core.pixel(x)` tells the state behind it until the next step."""

    index: int
    kind: str  #: "OP", "EOL", ...; "HEADER" for token 0
    text: str
    line: int  #: lines that have ended
    made: tuple[
        str, ...
    ] = ()  #: at the polygon level the texts of the spans and ends that it has come to, in their order


def _candidates() -> Iterator[str]:
    if os.environ.get("KAGE_GOLDEN"):
        yield os.environ["KAGE_GOLDEN"]
        return
    yield from map(str, (_HERE / "libkage_golden.so", _HERE.parents[1] / "build/release/lib/libkage_golden.so"))
    yield _installed_from()
    yield ctypes.util.find_library("kage_golden") or ""


def _installed_from() -> str:
    """The library of the source tree that this package was installed from, built or not; "" if it was not installed."""
    try:
        return (_HERE / "built_library.txt").read_text().strip()
    except OSError:
        return ""


@functools.cache
def library() -> ctypes.CDLL:
    """The library, loaded once. Raises GoldenError where it is not found or is of another version."""
    path = next((p for p in _candidates() if p and (os.sep not in p or os.path.exists(p))), None)
    if path is None:
        place = os.environ.get("KAGE_GOLDEN") or _installed_from()
        raise GoldenError(
            f"libkage_golden.so: not found{f' as {place}' if place else ''}: build kage (tools/demo), or name it in $KAGE_GOLDEN"
        )
    try:
        lib = ctypes.CDLL(path)
        version = lib.kage_golden_abi()
    except (OSError, AttributeError) as e:
        raise GoldenError(f"{path}: {e}") from e
    if version != ABI:
        raise GoldenError(f"{path}: version {version} of the golden core's interface, and this package is for {ABI}")
    core, text, number = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    for name, result, arguments in (
        ("create", core, [text]),
        ("create_parameters", core, [text]),
        ("destroy", None, [core]),
        ("error", text, [core]),
        ("parameter", number, [core, text]),
        ("word", number, [core, ctypes.c_uint]),
        ("feed", number, [core, ctypes.POINTER(ctypes.c_uint), number]),
        ("finish", number, [core]),
        ("token_kind", number, [core]),
        ("token_index", number, [core]),
        ("token_text", text, [core]),
        ("made", number, [core]),
        ("choose_made", number, [core, number]),
        ("line", number, [core]),
        ("pixel", number, [core, number, number]),
        ("on_line", None, [core, _TAKER, core]),
        ("status", ctypes.c_longlong, [core, number]),
        ("status_text", text, [core]),
    ):
        function = getattr(lib, f"kage_golden_{name}")
        function.restype, function.argtypes = result, arguments
    return lib


class Golden:
    """A golden core: words of frames in, pixels out. It is for one thread at a time.

    config: a name in rtl/defs/configs.yaml, a YAML file, a stream file (its own configuration), a `kage.Config`, or a
    mapping of parameters, of which those left out have their defaults. Raises GoldenError for one that is illegal.
    """

    def __init__(self, config: str | os.PathLike[str] | stream.Config | Mapping[str, int]):
        self._core = None
        self._lib = library()
        if isinstance(config, stream.Config):
            config = dataclasses.asdict(config)
        if isinstance(config, Mapping):
            text = "{" + ", ".join(f"{name}: {int(value)}" for name, value in config.items()) + "}"
            self._core = self._lib.kage_golden_create_parameters(text.encode())
        else:
            self._core = self._lib.kage_golden_create(os.fspath(config).encode())
        if not self._core:
            raise GoldenError(self._lib.kage_golden_error(None).decode())
        values = {name: self._lib.kage_golden_parameter(self._core, name.encode()) for name in stream.PARAMETERS}
        #: the core's parameters
        self.config = stream.Config(**values)
        self._lines: list[bytes] = []
        self._open = False  # a frame has begun by steps
        self._taker = _TAKER(lambda _, y, pixels, size: self._lines.append(ctypes.string_at(pixels, size)))
        self._lib.kage_golden_on_line(self._core, self._taker, None)

    def __del__(self) -> None:
        if getattr(self, "_core", None):
            self._lib.kage_golden_destroy(self._core)

    def frame(self, words: Sequence[int]) -> Frame:
        """Draw a whole frame, sound or malformed: `words` of 32 bits, the last one with TLAST."""
        self._forget()
        array = (ctypes.c_uint * len(words))(*words)
        if self._lib.kage_golden_feed(self._core, array, len(words)) == _ERROR:
            raise GoldenError(self._lib.kage_golden_error(self._core).decode())
        return self._finish()

    def steps(self, words: Iterable[int]) -> Iterator[Step]:
        """Give a frame word by word; a step for each token that was accepted, up to END or one that is refused. After all
        words, `finished` is the frame."""
        self._forget()
        self._open = True
        going = True  # no END and no error yet
        for word in words:
            what = self._lib.kage_golden_word(self._core, word)
            if what == _ERROR:
                raise GoldenError(self._lib.kage_golden_error(self._core).decode())
            if going and what in (_TOKEN, _END):
                yield Step(
                    self._lib.kage_golden_token_index(self._core),
                    KINDS[self._lib.kage_golden_token_kind(self._core)],
                    self._lib.kage_golden_token_text(self._core).decode(),
                    self._lib.kage_golden_line(self._core),
                    tuple(self._made()),
                )
            going = going and what not in (_END, _FAILED)
        self.finished = self._finish()

    def _made(self) -> Iterator[str]:
        for i in range(self._lib.kage_golden_made(self._core)):
            self._lib.kage_golden_choose_made(self._core, i)
            yield self._lib.kage_golden_token_text(self._core).decode()
        self._lib.kage_golden_choose_made(self._core, -1)

    def pixel(self, x: int) -> Pixel:
        """The state of a pixel of the line at hand, behind the last step. Raises IndexError where the line has no such
        pixel, and behind END, where there is no line."""

        def field(number: int) -> int | None:
            value = self._lib.kage_golden_pixel(self._core, x, number)
            return None if value in (_ABSENT, _ANY) else value

        if self._lib.kage_golden_pixel(self._core, x, PIXEL["z"]) == _ABSENT:
            raise IndexError(f"no pixel {x} in the line at hand")
        return Pixel(
            field(PIXEL["z"]),
            tuple(field(PIXEL["color"] + c) for c in range(self.config.CHANNELS)),
            field(PIXEL["class"]),
            field(PIXEL["dsf"]),
            field(PIXEL["fsf"]),
            tuple(field(PIXEL["count"] + i) for i in range(self.config.LIGHTS if self.config.COUNT_BITS else 0)),
        )

    def _forget(self) -> None:
        """A frame whose steps were not all asked for ends here, so that the next one begins."""
        if self._open:
            self._lib.kage_golden_finish(self._core)
        self._open = False
        self._lines.clear()

    def _finish(self) -> Frame:
        self._open = False
        self._lib.kage_golden_finish(self._core)
        values = [self._lib.kage_golden_status(self._core, i) for i in range(7)]
        status = Status(*values[:5], self._lib.kage_golden_status_text(self._core).decode())
        return Frame(values[5], values[6], list(self._lines), status)
