# SPDX-License-Identifier: Apache-2.0
"""Can a board be fed with a pack or a stream file: bytes a frame beside what its memory holds, and what memory, line and
screen pass in a second."""

import dataclasses
import json
import sys

import board as boards
import core
from trouble import Trouble

# docs/link.md: a byte has 10 bits on the line; a frame of STREAM has 63 words and 8 bytes beside them. Escaped bytes and
# waits for credit make it less.
LINE = 1 / 10 * (63 * 4) / (63 * 4 + 8)
LINK = "the serial line"
# rtl/board/sdram_memory.sv: a word in 2.1 clocks of the memory.
SDRAM_CLOCKS = 2.1


@dataclasses.dataclass(frozen=True)
class Frames:
    name: str
    parameters: dict  # of the core that they are for
    words: list  # of each frame
    width: int  # the widest
    height: int  # the highest


def of_pack(path):
    manifest = path / "manifest.json"
    try:
        pack = json.loads(manifest.read_text())
        frames = pack["frames"]
        size = [max(f[k] for f in frames) for k in ("width", "height")]
        return Frames(str(path), pack["config"], [f["words"] for f in frames], *size)
    except OSError as e:
        raise Trouble(f"{manifest}: {e.strerror}") from e
    except (ValueError, KeyError, TypeError) as e:
        raise Trouble(f"{manifest}: no manifest of a pack: {e}") from e


def of_stream(top, path):
    sys.path.insert(0, str(top / "python"))
    from kage import stream

    try:
        sections = list(stream.read_sections(path.read_bytes()))
        config = stream.Config.read(next(payload for tag, payload in sections if tag == "CONF"))
        frames = [stream.words_of(payload) for tag, payload in sections if tag in ("FRAM", "PORT")]
        heads = [stream.Codec(config).read_header(w) for w in frames]
    except OSError as e:
        raise Trouble(f"{path}: {e.strerror}") from e
    except (ValueError, StopIteration) as e:
        raise Trouble(f"{path}: {e or 'no stream file'}") from e
    if not frames:
        raise Trouble(f"{path}: has no frame")
    size = [max(h[k] for h in heads) for k in ("width", "height")]
    return Frames(str(path), vars(config), [len(w) for w in frames], *size)


def why_not(frames, b, facts, pixel):
    """Why the board does not take the frames, in words; None if it does. `pixel`: the parameters that decide pixels."""
    p = b.core.parameters
    other = [f"{k} {p[k]} and not {frames.parameters[k]}" for k in pixel if frames.parameters.get(k, p[k]) != p[k]]
    if other:
        return f"its core has {', '.join(other)}"
    if frames.parameters.get("BEAT_WORDS", 1) != p["BEAT_WORDS"]:
        return f"its core has BEAT_WORDS {p['BEAT_WORDS']} and not {frames.parameters['BEAT_WORDS']}"
    if frames.width > p["MAX_WIDTH"]:
        return f"a line has {frames.width} pixels, and MAX_WIDTH is {p['MAX_WIDTH']}"
    if frames.height > facts.lines:
        return f"a frame has {frames.height} lines, and the board keeps signatures of {facts.lines}"
    most = max(frames.words)
    if most + 2 > facts.words:
        place = frames.words.index(most)
        return f"frame {place} has {4 * (most + 2)} bytes in a list, and its memory {4 * facts.words}"
    return None


def hold(top, tools, frames, name):
    """The board, if it holds the frames; else Trouble says why, and which boards do."""
    pixel = [p["name"] for p in core.definition(top)["pixel_params"]]
    reasons = {}
    for other in [name, *(n for n in boards.names(top) if n != name)]:
        b = boards.find(top, other)
        facts = boards.facts(tools, top, b)
        reasons[other] = why_not(frames, b, facts, pixel)
        if other == name and reasons[other] is None:
            return b, facts
    able = [n for n, reason in reasons.items() if reason is None]
    # The memory is looked at last: all else fits.
    line = "; kage board plays it straight from the line" if "bytes in a list" in reasons[name] else ""
    raise Trouble(
        f"{frames.name}: {name} does not hold it: {reasons[name]}; "
        + (f"{', '.join(able)} would" if able else "no board of constraints/boards does")
        + line
    )


def in_one_list(words, room):
    """How many frames from the first on go into the memory: a count before each, a 0 behind the last."""
    used = 1
    for i, w in enumerate(words):
        used += w + 1
        if used > room:
            return i
    return len(words)


def span(seconds):
    return f"{seconds:.2f} s" if seconds >= 1 else f"{1e3 * seconds:.3g} ms"


def tell(frames, b, facts):
    words, most = frames.words, max(frames.words)
    mean = sum(words) / len(words)
    held = in_one_list(words, facts.words)
    sort = "SDRAM" if facts.sdram else "block RAM"
    print(
        f"{frames.name}: {len(words)} frames, up to {frames.width}x{frames.height}, of {4 * mean:.0f} bytes on average, {4 * most} at most"
    )
    print(
        f"{b.name}: {sort} of {4 * facts.words} bytes holds "
        + (
            f"all {held} frames in one list"
            if held == len(words)
            else f"{held} of {len(words)} frames at a time, from the first on"
        )
    )
    ways = [(LINK, facts.baud * LINE / 4, f"{facts.baud} baud")]
    if facts.sdram:
        rate = min(1e6 * facts.memory_mhz / SDRAM_CLOCKS, 1e6 * facts.core_mhz)
        ways.append(("SDRAM", rate, f"{facts.memory_mhz:g} MHz, a word in {SDRAM_CLOCKS} clocks"))
    else:
        ways.append(("block RAM", 1e6 * facts.core_mhz, f"{facts.core_mhz:g} MHz, a word a clock"))
    for name, rate, how in ways:
        said = f"{name} ({how}): {'at most ' if name == LINK else ''}{rate / 250:.0f} kB/s, a frame in {span(mean / rate)}, the largest in {span(most / rate)}"
        if facts.screen_hz:
            said += f": {'in time' if most / rate <= 1 / facts.screen_hz else 'too slow'} for {facts.screen_hz:.1f} Hz"
        print(said)
    if not facts.screen_hz:
        print("no screen: frames are played as fast as they come")
