# SPDX-License-Identifier: Apache-2.0
"""The clock that a stream needs on a core, beside the one that is reached."""

import json
import subprocess

from trouble import Trouble


def clocks_of(kage, stream, parameters, folder):
    """The clocks that `kage info STREAM --clocks` counts for the core with these parameters."""
    config = folder / "core.yaml"
    config.write_text("".join(f"{k}: {v}\n" for k, v in parameters.items()))
    command = [kage, "info", stream, "--clocks", "--config", config, "--json", "-"]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise Trouble(done.stderr.strip().removeprefix("kage: ") or f"kage info: exit code {done.returncode}")
    clocks = json.loads(done.stdout)["clocks"]
    if clocks["frames"] == 0:
        raise Trouble(f"{stream}: no frame is sound, so none needs a clock")
    return clocks


def need_of(stream, clocks, fps, total_lines):
    """MHz. Each line has the time of one line of the display, which draws `total_lines` in a frame, blanking included. The
    worst line decides, or where a buffer of some lines stands behind the core, the worst lines that lie together."""
    lines = total_lines or clocks["height"]
    if lines < clocks["height"]:
        raise Trouble(f"--total-lines {lines}: the stream's frames have {clocks['height']} lines")
    scale = lines * fps / 1e6
    return {
        "stream": str(stream),
        "fps": fps,
        "total_lines": lines,
        "mean_mhz": clocks["mean_line"] * scale,
        "worst_window_mhz": clocks["worst_window"]["clocks_each"] * scale,
        "window_lines": clocks["worst_window"]["lines"],
        "worst_line_mhz": clocks["worst_line"]["clocks"] * scale,
    }


def verdict(need, reached):
    """yes, buffered, or no."""
    if reached >= need["worst_line_mhz"]:
        return "yes"
    return "buffered" if reached >= need["worst_window_mhz"] else "no"


def tell(need, reached):
    said = {
        "yes": f"yes, {reached:.1f} MHz is enough",
        "buffered": f"only with a buffer of {need['window_lines']} lines: {reached:.1f} MHz is less than the worst line needs",
        "no": f"no, {reached:.1f} MHz is too little",
    }[verdict(need, reached)]
    return (
        f"{need['stream']}, {need['fps']:g} frames/s of {need['total_lines']} lines, needs {need['worst_line_mhz']:.1f} MHz for its worst "
        f"line, {need['worst_window_mhz']:.1f} for its worst {need['window_lines']} neighbouring lines, {need['mean_mhz']:.1f} on average: {said}"
    )
